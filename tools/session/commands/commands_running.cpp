// The commands that run forwards.
#include <fmt/format.h>

#include "interpreter/base/text.hpp"
#include "tools/session/commands/commands.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/words/words.hpp"

namespace s7200::tools::commands {

Reply step(Session& session, const Words& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return wrong(expects("step", "how many instructions, for example: step 5"));
  return go(session, {.goal = goal::instructions(*count), .show = Session::Show::All});
}

Reply over(Session& session, const Words&) {
  return go(session, {.goal = goal::over(session.cpu().state()), .show = Session::Show::Started});
}

Reply out(Session& session, const Words&) {
  const State& now = session.cpu().state();
  if (now.mode == Mode::Run && !goal::is_in_routine(now)) {
    session.said << "this is the main program, in no subroutine and no interrupt routine; 'scan' runs to the next scan\n";
    return {};
  }
  return go(session, {.goal = goal::out(now)});
}

Reply network(Session& session, const Words&) {
  return go(session, {.goal = goal::network_over(session.cpu().state(), session.listing())});
}

Reply interrupt(Session& session, const Words& arguments) {
  const auto ends = wants_end(arguments);
  if (!ends) return wrong(expects("interrupt", kBeginsOrEnds));
  const Cpu& cpu = session.cpu();
  return go(session, {.goal = *ends ? goal::interrupt_ends(cpu.state()) : goal::interrupt_begins(cpu.program())});
}

Reply scan(Session& session, const Words& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return wrong(expects("scan", "how many scans, for example: scan 3"));
  return go(session, {.goal = goal::scan(session.cpu().state(), *count)});
}

Reply continue_run(Session& session, const Words& arguments) {
  RunTo run{.goal = goal::none(), .stop_at_answer = true, .of_all = true};
  Words words = arguments;
  run.to_scan_end = !words.empty() && stl::lower_case(words.back()) == "scan";
  if (run.to_scan_end) words.pop_back();
  if (!words.empty()) {
    const auto time = parse_duration(joined(words));
    if (!time || *time == 0)
      return wrong(
          expects("continue", fmt::format("a duration above 0 in {}, and scan if it is to go on to the end of the scan, "
                                          "for example: continue 250ms, continue 1s scan",
                                          kTimeUnits)));
    run.limit = *time;
  }
  return go(session, run);
}

Reply until(Session& session, const Words& arguments) {
  std::string why;
  const auto target = find_op(session, arguments, "until", why);
  if (!target) return wrong(why);
  return go(session, {.goal = goal::place(*target)});
}

}  // namespace s7200::tools::commands

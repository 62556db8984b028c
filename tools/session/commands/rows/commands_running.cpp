// The commands that run forwards.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/session/causes/coils.hpp"
#include "tools/session/commands/answers/cause_reports.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/rows/commands.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/words/words.hpp"

namespace s7200::tools::commands {
namespace {

/// An output that several instructions write is on when the last of them has left it on: then the outputs get it. Nothing if
/// the wish is about none.
std::optional<Bits> output_with_several_coils(const Session& session, const Wish& wish) {
  for (const Bits& bit : bits_of(wish))
    if (area_of(bit) == Area::Q && coils_of(session.cpu(), bit).size() > 1) return bit;
  return {};
}

/// `Q0.5 is written by = Horn:Q0.5 in line 12 and = Horn:Q0.5 in line 40: it is looked at when a scan is over`
std::string several_coils_text(const Session& session, const Bits& output) {
  return fmt::format("{} is written by {}: it is looked at when a scan is over\n", memory_text(output),
                     coils_text(session.program(), coils_of(session.cpu(), output)));
}

/// To where a wish comes to hold, or to the limit, where what blocks it is said.
Reply run_until(Session& session, const Wish& wish, Time limit) {
  const auto output = output_with_several_coils(session, wish);
  const bool in_between = output && !coils_to_come(session.cpu(), *output).empty();
  const auto holds = holds_now(wish, session.cpu());
  if (!holds || (*holds && !in_between)) return obstacles_to(session, wish);
  const auto is_reached = [&, cpu = &session.cpu(), scan = session.cpu().state().scans](const State& state, std::uint32_t,
                                                                                        const Stepper::Progress&) mutable {
    if (output && (state.scans == scan || state.in_interrupt)) return false;
    scan = state.scans;
    return holds_now(wish, *cpu).value_or(false);
  };
  if (output) session.said << several_coils_text(session, *output);
  Reply run = go(session, {.goal = is_reached, .limit = limit});
  const std::string stopped = run.json.is_object() ? run.json.value("stopped", "") : "";
  if (stopped == "goal")
    for (const Bits& bit : bits_of(wish)) run.text += to_come_text(session, bit);
  if (stopped != "limit" && stopped != "CPU") return run;
  Reply blocked = obstacles_to(session, wish);
  blocked.text = run.text + blocked.text;
  blocked.json["stopped"] = stopped;
  return blocked;
}

}  // namespace

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
  Words words = arguments;
  Time limit = RunTo::kUsualLimit;
  if (const auto within = std::ranges::find(words, "within", stl::lower_case); within != words.end()) {
    const auto time = parse_duration(joined({within + 1, words.end()}));
    if (!time || *time == 0)
      return wrong(expects(
          "until", fmt::format("a duration above 0 in {} after within, for example: until Q0.3 within 30s", kTimeUnits)));
    limit = *time;
    words.erase(within, words.end());
  }
  const auto target = find_op(session, words, "until");
  if (target) return go(session, {.goal = goal::place(*target), .limit = limit});
  const std::string text = joined(words);
  const auto wish = words.empty() ? std::nullopt : parse_wish(text, session.program());
  const bool names_memory = wish && (wish->bit || !wish->condition->places().empty());
  if (names_memory) return run_until(session, *wish, limit);
  const bool is_condition = text.find_first_of("<>=") != std::string::npos || stl::lower_case(text).starts_with("not ");
  if (is_condition) return wrong(fmt::format("until: {}", wish.why()));
  return wrong(target.why().starts_with("until expects")
                   ? target.why() + ", or a condition, for example: until Q0.3, until VW10 > 5"
                   : target.why());
}

}  // namespace s7200::tools::commands

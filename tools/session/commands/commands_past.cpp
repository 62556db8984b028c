// The commands that go to another moment, and that begin a new branch.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/counted.hpp"
#include "interpreter/base/text.hpp"
#include "tools/session/commands/commands.hpp"
#include "tools/session/commands/moments_json.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools::commands {

Reply back(Session& session, const Words& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return wrong(expects("back", "how many commands, for example: back 2"));
  if (session.kept.empty()) {
    session.said << "there is no earlier state: no command has run anything, or all states kept have been used\n";
    return {};
  }
  if (*count > session.kept.size())
    session.said << fmt::format("only {} {} kept\n", counted(session.kept.size(), "earlier state"),
                                session.kept.size() == 1 ? "is" : "are");
  session.kept.resize(session.kept.size() - std::min<std::size_t>(*count, session.kept.size()) + 1);
  const History::BranchPtr left = session.history.here().branch;
  session.history.return_to(session.kept.back().place);
  session.said << fmt::format("back to before '{}'\n", stl::printable(session.kept.back().command));
  session.stepper.look_at(session.kept.back().station);
  session.kept.pop_back();
  session.note_going_elsewhere();
  if (session.history.here().branch != left) note_new_branch(session);
  show_place(session);
  return {};
}

Reply back_step(Session& session, const Words& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return wrong(expects("rstep", "how many instructions, for example: rstep 5"));
  return go_back(session, goal::back_instruction(), *count);
}

Reply back_over(Session& session, const Words&) { return go_back(session, goal::back_over(session.cpu().state()), 1); }

Reply back_out(Session& session, const Words&) {
  const State& now = session.cpu().state();
  if (!goal::is_in_routine(now)) {
    session.said
        << "this is the main program, in no subroutine and no interrupt routine; 'rscan' goes to the start of its scan\n";
    return {};
  }
  return go_back(session, goal::back_out(now), 1);
}

Reply back_network(Session& session, const Words&) {
  return go_back(session, goal::back_network_over(session.cpu().state(), session.listing()), 1);
}

Reply back_interrupt(Session& session, const Words& arguments) {
  const auto ends = wants_end(arguments);
  if (!ends) return wrong(expects("rinterrupt", kBeginsOrEnds));
  const Program& program = session.program();
  return go_back(session, *ends ? goal::back_interrupt_ends(program) : goal::back_interrupt_begins(program), 1);
}

Reply back_scan(Session& session, const Words& arguments) {
  const auto count = parse_count(arguments);
  if (!count) return wrong(expects("rscan", "how many scans, for example: rscan 3"));
  return go_back(session, goal::back_scan(), *count);
}

Reply back_continue(Session& session, const Words&) { return go_back(session, goal::none(), 1, true); }

Reply back_until(Session& session, const Words& arguments) {
  std::string why;
  const auto target = find_op(session, arguments, "runtil", why);
  if (!target) return wrong(why);
  return go_back(session, goal::place(*target), 1);
}

Reply at(Session& session, const Words& arguments) {
  if (arguments.empty()) return wrong(expects("at", "a moment, for example: at 15.193ms, at -5ms, at start, at end"));
  std::string why;
  const auto time = parse_moment(joined(arguments), session.history, why);
  if (!time) return wrong(why);
  remember(session);
  if (!go_to_parsed(session.history, *time)) {
    session.kept.pop_back();
    session.said << session.setup.interruption() << '\n';
    return {};
  }
  return arrive(session);
}

Reply fork(Session& session, const Words&) {
  if (!session.history.in_the_past()) {
    session.said << "this is the newest moment: nothing has run after it\n";
    return {};
  }
  act(session, SetMemory{});
  return {};
}

Reply past(Session& session, const Words&) {
  const History::Usage usage = session.history.usage();
  constexpr double kMegabyte = 1 << 20;
  session.said << fmt::format(
      "from {}, {}, to {}; now {}\n"
      "{}, one every {} or more; {:.1f} of {:.0f} MB; {} from outside\n",
      moment_text(usage.oldest.time), oldest_text(session.history), moment_text(session.history.newest().time),
      moment_text(session.history.now().time), counted(usage.checkpoints, "checkpoint"), format_duration(usage.interval),
      static_cast<double>(usage.bytes) / kMegabyte, static_cast<double>(session.setup.bound) / kMegabyte,
      counted(session.history.actions().size(), "action"));
  return {.json = moments_json(session)};
}

Reply restart(Session& session, const Words&) {
  remember(session);
  session.history.restart();
  session.looked_at.clear();
  note_new_branch(session);
  return arrive(session);
}

}  // namespace s7200::tools::commands

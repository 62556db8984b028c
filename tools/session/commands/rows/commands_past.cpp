// The commands that go to another moment, and that begin a new branch.
#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/session/commands/answers/moments_json.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/rows/commands.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools::commands {
namespace {

constexpr std::uint32_t kUsualActions = 50, kMostActions = 1000;

std::string assignments_text(const char* what, const std::vector<Assignment>& assignments) {
  std::string text = what;
  for (const Assignment& one : assignments) text += fmt::format(" {}={}", one.place.name_of(0), one.value);
  return text;
}

/// What the port of a bridge was told. Empty if it has put nothing on the line.
std::string text_of_bridge(const serial::HostCall& call, const std::string& name) {
  if (call.what != serial::HostCall::What::Send) return {};
  Bytes bytes;
  for (const serial::HostCharacter& character : call.characters) bytes.push_back(character.byte);
  return fmt::format("{} sends {}", name.empty() ? "the bridge" : name, serial::to_hex(bytes));
}

/// As it would be typed. Empty if it has changed nothing for the PLCs.
std::string text_of_action(const History& history, std::size_t number) {
  const Action& action = *history.action(number);
  if (const auto* const set = std::get_if<SetMemory>(&action))
    return set->assignments.empty() ? "" : assignments_text(are_inputs(*set) ? "input" : "set", set->assignments);
  if (const auto* const force = std::get_if<Force>(&action)) return assignments_text("force", force->assignments);
  if (const auto* const call = std::get_if<serial::HostCall>(&action))
    return text_of_bridge(*call, history.bridge_of(history.station_of_action(number)));
  return describe(action);
}

}  // namespace

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
  const auto target = find_op(session, arguments, "runtil");
  if (!target) return wrong(target.why());
  return go_back(session, goal::place(*target), 1);
}

Reply at(Session& session, const Words& arguments) {
  if (arguments.empty()) return wrong(expects("at", "a moment, for example: at 15.193ms, at -5ms, at start, at end"));
  const auto time = parse_moment(joined(arguments), session.history);
  if (!time) return wrong(time.why());
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

Reply actions(Session& session, const Words& arguments) {
  const auto most = arguments.empty() ? kUsualActions : parse_count(arguments);
  if (!most || *most > kMostActions)
    return wrong(expects("actions", fmt::format("how many, up to {}, for example: actions 100", kMostActions)));
  Reply reply{.json = {{"count", 0}, {"actions", Json::array()}}};
  std::vector<Json> newest_first;
  std::size_t count = 0;
  for (std::size_t number = session.history.now().actions; number-- > 0 && session.history.action(number);) {
    const std::string text = text_of_action(session.history, number);
    if (text.empty() || ++count > *most) continue;
    const Time at = session.history.moment_of_action(number).time;
    newest_first.push_back({{"at_ns", at}, {"text", text}});
    if (const std::size_t station = session.history.station_of_action(number); session.history.stations() > 1)
      newest_first.back()["station"] = session.history.name_of(std::min(station, session.history.stations() - 1));
  }
  reply.json["count"] = count;
  for (auto one = newest_first.rbegin(); one != newest_first.rend(); ++one) {
    reply.text += fmt::format("{}  {}{}\n", clock_text((*one)["at_ns"].get<Time>()),
                              one->contains("station") ? (*one)["station"].get<std::string>() + ": " : "",
                              stl::printable((*one)["text"].get<std::string>()));
    reply.json["actions"].push_back(std::move(*one));
  }
  if (count == 0) reply.text = "nothing was done from outside up to now\n";
  if (count > *most) reply.text += fmt::format("and {} before these\n", counted(count - *most, "action"));
  return reply;
}

Reply restart(Session& session, const Words&) {
  remember(session);
  session.history.restart();
  session.looked_at.clear();
  note_new_branch(session);
  return arrive(session);
}

}  // namespace s7200::tools::commands

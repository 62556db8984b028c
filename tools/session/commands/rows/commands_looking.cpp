// The commands that show the program and the machine, and that choose what is shown.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/analysis/drawn_networks.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/session/commands/answers/ladder_flow.hpp"
#include "tools/session/commands/answers/status.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/rows/commands.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/ladder/ladder_json.hpp"
#include "tools/views/ladder/ladder_text.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools::commands {
namespace {

constexpr std::size_t kListed = 15, kListedBefore = 6;

/// Instructions, as `status` shows them.
constexpr std::uint32_t kShown = 15, kBefore = 6;
constexpr std::uint32_t kMostShown = 1000;  ///< of those that are named by their numbers

Reply status_reply(Session& session, std::uint32_t first, std::uint32_t end) {
  const LastExecutions last = last_executions_of(session, first, end);
  Reply reply{.json = status_json(session, last), .interrupted = last.interrupted};
  for (const std::string& line : status_lines(session, first, end, last)) reply.text += line + '\n';
  return reply;
}

/// From one line to another.
Reply status_of_lines(Session& session, const Words& numbers) {
  const auto from = parse_decimal<std::uint32_t>(numbers[0]), to = parse_decimal<std::uint32_t>(numbers[1]);
  if (!from || !to || *to < *from || *to - *from >= kMostShown)
    return wrong(expects("status", fmt::format("the first and the last line, at most {}: status 1 100", kMostShown)));
  const auto ops = static_cast<std::uint32_t>(session.program().ops.size());
  const std::uint32_t first = session.listing().op_from_line(*from).value_or(ops);
  return status_reply(session, first, session.listing().op_from_line(*to + 1).value_or(ops));
}

/// A peer or a bridge; null if there is none of that name.
const LineStation* without_program(const Session& session, std::string_view name) {
  for (const LineStation& one : session.history.line_stations())
    if (one.kind != LineStation::Kind::Plc && one.name == name) return &one;
  return nullptr;
}

}  // namespace

Reply station(Session& session, const Words& arguments) {
  if (!session.is_system())
    return wrong("there is one PLC only, without a name; a system file has several: s7200 debug SYSTEM.yaml");
  if (arguments.empty()) {
    for (std::size_t station = 0; station < session.stations.size(); ++station)
      session.said << fmt::format("{} {:<{}}  {}\n", station == session.focus() ? '>' : ' ', session.name_of(station),
                                  session.name_width(), place_line(session, station));
    for (const LineStation& one : session.history.line_stations())
      if (one.kind != LineStation::Kind::Plc)
        session.said << fmt::format("  {:<{}}  {} on line {}\n", stl::printable(one.name), session.name_width(),
                                    kind_text(one.kind), stl::printable(one.line_name));
    return {};
  }
  if (const LineStation* const other = without_program(session, joined(arguments)))
    return wrong(
        fmt::format("{} is {}; it has no program to step through", stl::printable(other->name), kind_text(other->kind)));
  const auto named = std::ranges::find(session.setup.stations, joined(arguments), &DebuggedStation::name);
  if (named == session.setup.stations.end())
    return wrong(fmt::format("there is no station '{}'; 'station' lists them", stl::shortened(joined(arguments))));
  session.stepper.look_at(static_cast<std::size_t>(named - session.setup.stations.begin()));
  show_place(session);
  return {};
}

Reply list(Session& session, const Words& arguments) {
  const auto mark = [&session](std::uint32_t op) { return mark_of(session, op); };
  if (arguments.empty()) {
    session.said << session.listing().around(session.listing().line_of(session.current_op().value_or(0)), kListedBefore,
                                             kListed, mark);
    return {};
  }
  const auto line = find_program_line(joined(arguments), session.program(), session.listing());
  if (line) {
    session.said << session.listing().around(*line, kListedBefore, kListed, mark);
    return {};
  }
  if (!line.why().empty()) return wrong(line.why());
  const auto op = find_op(session, arguments, "list");
  if (!op) return wrong(op.why());
  session.said << session.listing().around(session.listing().line_of(*op), 0, kListed, mark);
  return {};
}

Reply status(Session& session, const Words& arguments) {
  if (arguments.size() == 2 && std::ranges::all_of(arguments, is_whole_number)) return status_of_lines(session, arguments);
  const auto named = arguments.empty() ? std::nullopt : find_op(session, arguments, "status");
  if (!named.why().empty()) return wrong(named.why());
  const auto place = arguments.empty() ? session.current_op() : named.if_any();
  const auto ops = static_cast<std::uint32_t>(session.program().ops.size());
  const std::uint32_t at = place.value_or(0);
  const std::uint32_t first = arguments.empty() ? at - std::min(at, kBefore) : at;
  const bool network = !arguments.empty() && stl::upper_case(arguments[0]).starts_with("NETWORK");
  std::uint32_t end = first;
  while (end < std::min(ops, first + kShown) && (end == first || !network || !session.listing().begins_network(end))) ++end;
  return status_reply(session, first, end);
}

Reply ladder(Session& session, const Words& arguments) {
  const auto named = arguments.empty() ? std::nullopt : find_op(session, arguments, "ladder");
  if (!named.why().empty()) return wrong(named.why());
  const auto place = arguments.empty() ? session.current_op() : named.if_any();
  const Program& program = session.program();
  const std::vector<DrawnNetwork> networks = drawn_networks(program.source);
  auto network = std::ranges::find_if(networks, [&](const DrawnNetwork& each) { return place.value_or(0) < each.end; });
  if (network == networks.end()) return wrong("there is no network");
  if (network->ladder.head && network + 1 != networks.end()) ++network;  // of a routine or a label: what follows it
  if (!network->why_not.empty())
    return {.text = network_text(*network, program.source, false), .json = network_json(*network, program.source)};
  const LastExecutions last = last_executions_of(session, network->first, network->end);
  const LadderFlow flow = ladder_flow(program, *network, last);
  Reply reply{.text = network_text(*network, program.source, false, &flow),
              .json = network_json(*network, program.source, &flow),
              .interrupted = last.interrupted};
  if (last.of.empty())
    reply.text += last.interrupted
                      ? "interrupted while its last execution was looked for\n"
                      : "not executed within " + format_duration(session.simulation().time() - last.since) + "\n";
  return reply;
}

Reply registers(Session& session, const Words&) {
  say_without_power(session);
  session.said << registers_text(session.cpu(), session.listing());
  return {};
}

Reply stack(Session& session, const Words&) {
  session.said << stack_text(session.cpu().state());
  return {};
}

Reply port(Session& session, const Words&) {
  say_without_power(session);
  const serial::Simulation& simulation = session.simulation();
  Reply reply{.text = port_text(simulation),
              .json = {{"port", simulation.port()}, {"mode", control_byte_text(session.cpu().state(), simulation.port())}}};
  for (const auto& [name, poller] : session.history.pollers())
    if (simulation.has_master() && poller->is_on(session.simulation().line().line()))
      reply.text += fmt::format("           (the master of 'send'; {} asks by itself)\n", stl::printable(name));
  return reply;
}

Reply errors(Session& session, const Words&) {
  const std::string text = errors_text(session.cpu());
  session.said << (text.empty() ? "no errors\n" : text);
  return {};
}

Reply trace(Session& session, const Words& arguments) {
  const std::string word = arguments.size() == 1 ? stl::lower_case(arguments[0]) : "";
  if (word != "on" && word != "off") return wrong(expects("trace", "on or off"));
  session.trace.turn(word == "on");
  return {};
}

Reply layout(Session& session, const Words& arguments) {
  const std::string word = arguments.size() == 1 ? stl::lower_case(arguments[0]) : "";
  if (word != "on" && word != "off") return wrong(expects("layout", "on or off"));
  return {.error = session.onlooker.show_layout(word == "on")};
}

Reply quit(Session& session, const Words&) {
  session.quit_asked = true;
  return {};
}

}  // namespace s7200::tools::commands

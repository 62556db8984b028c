// The commands that do something to the PLC, as a programming device, a master on its line or its terminals do.
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "tools/session/causes/line/two_masters.hpp"
#include "tools/session/commands/looked_at.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/rows/commands.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/words/fault_words.hpp"
#include "tools/session/words/force_words.hpp"
#include "tools/session/words/frame_words.hpp"
#include "tools/session/words/line_words.hpp"
#include "tools/session/words/mode_words.hpp"
#include "tools/session/words/words.hpp"

namespace s7200::tools::commands {
namespace {

/// {"values": [{"name": "VW40", "value": "16#0005 (5)"}], "text": "16#0005 (5)"}: as it is then.
Json assigned_json(const Cpu& cpu, const std::vector<Assignment>& assignments) {
  Json values = Json::array();
  std::string text;
  for (const Assignment& one : assignments) {
    const std::string value = value_of(cpu, one.place);
    values.push_back({{"name", one.place.name_of(0)}, {"value", value}});
    text += (text.empty() ? "" : ", ") + value;
  }
  return {{"values", values}, {"text", text}};
}

/// {"forced": [{"name": "VW10", "value": "16#0005 (5)"}], "text": "…"}: all that is.
Json forced_json(const Cpu& cpu) {
  Json all = Json::array();
  std::string text;
  for (const Forced& one : forced_in(cpu)) {
    all.push_back({{"name", one.place.name_of(0)}, {"value", one.value}});
    text += fmt::format("{:<8} {}\n", one.place.name_of(0), one.value);
  }
  return {{"forced", all}, {"text", text.empty() ? "nothing is forced" : text}};
}

Reply assign_all(Session& session, const Words& arguments, bool inputs_only) {
  if (std::string why = without_power(session, inputs_only ? "input" : "set"); !why.empty()) return wrong(why);
  std::vector<Assignment> assignments;
  for (const std::string& text : assignments_of(arguments)) {
    const auto assignment = parse_assignment(text, session.program());
    if (!assignment) return wrong(assignment.why());
    if (std::string refused = not_settable(assignment->place); !refused.empty()) return wrong(refused);
    if (inputs_only && !is_from_field(assignment->place))
      return wrong(
          fmt::format("'{}' is not an input; 'input' expects for example I0.3=1 or AIW0=6400, and 'set' writes other memory",
                      stl::shortened(text)));
    assignments.push_back(*assignment);
  }
  act(session, SetMemory{assignments});
  for (const Assignment& assignment : assignments)
    if (const std::string forced = forced_text(session, session.cpu(), {bits_of(assignment.place)}); !forced.empty())
      session.said << fmt::format("{} keeps what is forced until 'unforce {}':{}\n", assignment.place.name_of(0),
                                  assignment.place.name_of(0), forced);
  const auto is_input = [](const Assignment& a) { return a.place.area == Area::I; };
  if (std::any_of(assignments.begin(), assignments.end(), is_input) && standing_at(session.cpu().state()))
    session.said << "the input points are set; the program finds them in I when the next scan reads its inputs\n";
  return {.json = assigned_json(session.cpu(), assignments)};
}

/// The last at which a frame was sent on the line of the one that it looks at.
std::size_t station_of_request(Session& session) {
  for (std::size_t number = session.history.now().actions; number > 0;) {
    const Action* const action = session.history.action(--number);
    if (!action) break;
    if (!std::holds_alternative<SendFrame>(*action)) continue;
    const std::size_t station = session.history.station_of_action(number);
    if (&session.stations[station].simulation->line() == &session.simulation().line()) return station;
  }
  return session.focus();
}

/// The request is that of the station that it was sent at.
Reply cancel_request(Session& session) {
  const auto cancel = cancel_of(session.simulation());
  if (!cancel) return wrong("send cancel: " + cancel.why());
  const std::string text = cancelled_text(*cancel, session.simulation());
  act(session, *cancel, station_of_request(session));
  return {.text = text, .json = {{"frame", serial::to_hex(session.simulation().master().exchange().request)}}};
}

/// Of the PLC that it looks at; time goes on.
Reply switch_power(Session& session, bool on) {
  const std::string_view word = on ? "on" : "off";
  if (session.simulation().plc().powered() == on)
    return wrong(
        fmt::format("power {}: {} is {} power already", word, session.name_of(session.focus()), on ? "with" : "without"));
  act(session, SetPower{on});
  session.said << fmt::format(
      "{} {}\n", session.name_of(session.focus()),
      on ? "has power again, and begins with what it has kept" : "has no power from now on; 'power on' brings it back");
  return arrive(session);
}

}  // namespace

Reply set(Session& session, const Words& arguments) {
  if (arguments.empty()) return wrong(expects("set", "an address and a value, for example: set VW100=5"));
  return assign_all(session, arguments, false);
}

Reply input(Session& session, const Words& arguments) {
  if (arguments.empty()) return wrong(expects("input", "an input and its level, for example: input I0.3=1"));
  return assign_all(session, arguments, true);
}

Reply force(Session& session, const Words& arguments) {
  const Cpu& cpu = session.cpu();
  if (arguments.empty()) {
    const std::vector<Forced> all = forced_in(cpu);
    if (all.empty()) session.said << "nothing is forced; 'force I0.3=1' forces an input\n";
    for (const Forced& forced : all)
      session.said << session.red(fmt::format("{:<8} {}", forced.place.name_of(0), forced.value)) << '\n';
    return {.json = forced_json(cpu)};
  }
  if (const std::string why = without_power(session, "force"); !why.empty()) return wrong(why);
  auto force = force_of(assignments_of(arguments), cpu);
  if (!force) return wrong(force.why());
  act(session, std::move(*force));
  return {.json = forced_json(cpu)};
}

Reply unforce(Session& session, const Words& arguments) {
  if (arguments.empty()) return wrong(expects("unforce", "addresses that 'force' lists, or all"));
  if (const std::string why = without_power(session, "unforce"); !why.empty()) return wrong(why);
  auto unforce = unforce_of(arguments, session.cpu());
  if (!unforce) return wrong(unforce.why());
  if (!unforce->places.empty()) act(session, std::move(*unforce));
  return {.json = forced_json(session.cpu())};
}

Reply mode(Session& session, const Words& arguments) {
  if (const std::string why = without_power(session, "mode"); !why.empty()) return wrong(why);
  const auto set = mode_of(joined(arguments), session.simulation());
  if (!set) return wrong(set.why());
  act(session, *set);
  return arrive(session);
}

Reply power(Session& session, const Words& arguments) {
  Words words = arguments;
  const std::string first = words.empty() ? "" : stl::lower_case(words.front());
  if (words.size() == 1 && (first == "off" || first == "on")) return switch_power(session, first == "on");
  if (session.is_system() && first != "all")
    return wrong(
        "power of which PLCs? 'power off' and 'power on' switch this one, 'power all' switches every PLC off and on "
        "again");
  if (session.is_system()) words.erase(words.begin());
  const bool lost = !words.empty() && stl::lower_case(words.back()) == "lost";
  if (lost) words.pop_back();
  const auto off = words.empty() ? std::optional<Time>(0) : parse_duration(joined(words));
  if (!off)
    return wrong(
        expects("power", fmt::format("{}how long it was off, in {}, and lost if that was too long for the RAM: power {}8h, "
                                     "power {}lost",
                                     session.is_system() ? "off, on, or all, " : "off, on, or ", kTimeUnits,
                                     session.is_system() ? "all " : "", session.is_system() ? "all " : "")));
  const std::string requests = requests_under_way(session);
  remember(session);
  auto looked_at = looked_at_here(session);
  session.history.power_cycle(lost, *off);
  session.looked_at_before[session.history.here().branch->power] = std::move(looked_at);
  session.said << fmt::format(
      "power was off{}: {}\n", *off == 0 ? "" : " for " + format_duration(*off),
      lost ? "the EEPROM is left, RAM and clock are lost" : "retentive memory, EEPROM and clock are kept");
  if (!requests.empty())
    session.said << fmt::format("under way when power went off, and nobody waits for an answer any more: {}\n", requests);
  note_new_branch(session);
  return arrive(session);
}

Reply send(Session& session, const Words& arguments) {
  if (arguments.size() == 1 && stl::lower_case(arguments[0]) == "cancel") return cancel_request(session);
  if (arguments.empty() || (arguments.size() == 1 && stl::lower_case(arguments[0]) == "crc"))
    return wrong(
        expects("send",
                "a frame in hex, text in quotation marks, or a request, for example: send 01 03 00 00 00 02 crc, send "
                "'HELLO\\r', or send read 40011:2"));
  const auto frame = parse_frame(joined(arguments), session.setup.slave);
  if (!frame) return wrong(fmt::format("send {}: {}", joined(arguments), frame.why()));
  const auto send = send_of(*frame, session.simulation(), session.master(session.focus()));
  if (!send) return wrong("send: " + send.why());
  act(session, *send);
  session.said << sent_text(*send, session.simulation()) << other_master_text(session.history, session.focus());
  if (!session.simulation().plc().powered()) session.said << without_power_text(session.name_of(session.focus())) << '\n';
  return {.json = {{"frame", serial::to_hex(*frame)}}};
}

Reply fault(Session& session, const Words& arguments) {
  std::string text;
  if (!arguments.empty()) {
    const auto inject = fault_of(joined(arguments), session.history, session.focus());
    if (!inject) return wrong(inject.why());
    act(session, *inject);
    text = fault_text(*inject);
  } else {
    text = faults_text(session.history, session.focus());
  }
  return {.text = text, .json = {{"text", text}}};
}

}  // namespace s7200::tools::commands

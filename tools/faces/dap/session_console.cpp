// The commands of the debug console. Anything else that is typed there is an expression.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "tools/faces/dap/messages.hpp"
#include "tools/faces/dap/session.hpp"
#include "tools/session/commands/fault_words.hpp"
#include "tools/session/observers/last_instructions.hpp"

namespace s7200::tools::dap {

/// In the order of the help; `help` of one has a line for each form.
std::span<const Session::ConsoleCommand> Session::console_commands() {
  using Rest = const std::string&;
  static constexpr ConsoleCommand kCommands[] = {
      {"set", "set ADDRESS=VALUE      writes memory; I addresses are the input points\n",
       [](Session& session, Rest rest) { return session.set_in_console(rest); }},
      {"mode", "mode run | stop        what a programming device asks the CPU for\n",
       [](Session& session, Rest rest) { return session.change_mode(rest), std::string(); }},
      {"power", "power off | on         of this PLC; time goes on, a step without power lets 100 ms pass\n",
       [](Session& session, Rest rest) { return session.switch_power(rest), std::string(); }},
      {"send",
       "send HEX… | 'TEXT' [crc]  sends a frame, with its Modbus CRC if crc is given\n"
       "send read 40011:2 | write 00003=on [station n]  a Modbus request\n"
       "send cancel            abandons the request\n",
       [](Session& session, Rest rest) {
         return session.send_frame({{"frame", rest}}), std::string();
       }},
      {"fault",
       "fault KIND[:PARAMETER=VALUE,…] [station=NAME] | none  injects a fault on the line, or clears all; alone lists "
       "them\n",
       [](Session& session, Rest rest) {
         return rest.empty() ? faults_text(session.debuggee_->history(), session.looks_at())
                             : text_in(session.inject_fault({{"fault", rest}}), "text");
       }},
      {"force", "force [ADDRESS=VALUE…]  holds values across scans; alone lists what is forced\n",
       [](Session& session, Rest rest) {
         return text_in(session.force({{"values", rest}}), "text");
       }},
      {"unforce", "unforce ADDRESS… | all  releases them\n",
       [](Session& session, Rest rest) {
         return text_in(session.unforce({{"places", rest}}), "text");
       }},
      {"who", "who ADDRESS | event N  the instruction that wrote an address last, or attached an event\n",
       [](Session& session, Rest rest) { return text_in(session.find_writer(rest).body, "text"); }},
      {"why", "why                    what decided that it has come here: contacts, a jump, a conditional return\n",
       [](Session& session, Rest) { return text_in(session.find_decision().body, "text"); }},
      {"history", "history [n]            the last 10 instructions before now, or n\n",
       [](Session& session, Rest rest) { return session.history_in_console(rest); }},
      {"timeline", "timeline               what the CPU did since the last request began\n",
       [](Session& session, Rest) { return text_in(session.timeline(Json::object()), "text"); }},
      {"help", "", [](Session&, Rest) { return console_help(); }}};
  return kCommands;
}

std::string Session::console_help() {
  std::string text =
      "An expression in STL terms shows its value: VW100, VB0:16, *VD3570:word, VW2 * 2 + 1, M31.7 and VW3300 > 8.\n";
  for (const ConsoleCommand& command : console_commands()) text += command.help;
  return text;
}

const Session::ConsoleCommand* Session::console_command(std::string_view word) {
  const auto commands = console_commands();
  const auto found = std::ranges::find(commands, stl::lower_case(word), &ConsoleCommand::word);
  return found == commands.end() ? nullptr : &*found;
}

std::string Session::set_in_console(const std::string& rest) {
  const std::size_t equals = rest.find('=');
  if (equals == std::string::npos) throw Refused("set expects an address and a value, for example: set VW100=5");
  return text_in(assign(std::string(stl::trim(rest.substr(0, equals))), std::string(stl::trim(rest.substr(equals + 1)))),
                 "value");
}

std::string Session::history_in_console(const std::string& rest) {
  const auto count = rest.empty() ? std::optional(std::int64_t{kUsualInstructions}) : parse_decimal<std::int64_t>(rest);
  const Json all = last_instructions({{"count", count.value_or(0)}});
  std::string text;
  for (const Json& one : all["instructions"])
    text += fmt::format("{}  {:<7} {}\n", text_in(one, "time"), text_in(one, "routine"), text_in(one, "text"));
  return text;
}

}  // namespace s7200::tools::dap

// What a saved session depends on besides the program, and how its file begins.
#include <fmt/format.h>

#include <algorithm>

#include "tools/session/commands/session_file.hpp"

namespace s7200::tools {

std::string session_beginning() { return fmt::format("{{\n  \"format\": \"{}", kAnySessionFormat); }

std::vector<SessionOption> options_of(const serial::MasterSettings& master, const ClockTime& clock) {
  const auto number = [](const auto& given) { return given ? fmt::format("{}", *given) : std::string("as the port"); };
  return {{"--baud", number(master.baud)},
          {"--parity", master.parity ? std::string(word_of(*master.parity)) : "as the port"},
          {"--data-bits", number(master.data_bits)},
          {"--stop-bits", number(master.stop_bits)},
          {"--timeout", format_duration(master.timeout, 9)},
          {"--gap", master.gap == 0 ? "none" : format_duration(master.gap, 9)},
          {"--clock", fmt::format("{:02}-{:02}-{:02} {:02}:{:02}:{:02}", clock.year, clock.month, clock.day, clock.hour,
                                  clock.minute, clock.second)}};
}

std::string differences(const std::vector<SessionOption>& then, const std::vector<SessionOption>& now) {
  const auto value_in = [](const std::vector<SessionOption>& options, const std::string& name) {
    const auto found = std::ranges::find(options, name, &SessionOption::name);
    return found == options.end() ? std::string("none") : found->value;
  };
  std::string text;
  const auto compare = [&](const std::string& name) {
    const std::string old = value_in(then, name), is = value_in(now, name);
    if (old != is) text += fmt::format("{}{} {} (here {})", text.empty() ? "" : ", ", name, old, is);
  };
  for (const SessionOption& option : then) compare(option.name);
  for (const SessionOption& option : now)
    if (std::ranges::find(then, option.name, &SessionOption::name) == then.end()) compare(option.name);
  return text;
}

}  // namespace s7200::tools

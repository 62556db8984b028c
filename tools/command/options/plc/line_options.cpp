#include "tools/command/options/plc/line_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>

#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/number_option.hpp"

namespace s7200::tools {
void add_line_options(CLI::App& app, serial::LineSettings& line, const std::string& otherwise) {
  const auto add_number = [&](const char* name, auto& value, Between<std::uint64_t> range, const char* text) {
    using Number = typename std::remove_reference_t<decltype(value)>::value_type;
    return add_whole_number(
        app, name, [&value](std::uint64_t given) { value = static_cast<Number>(given); }, range, text, otherwise);
  };
  add_number("--baud", line.baud, {serial::kSlowestBaud, serial::kFastestBaud}, "baud rate of the other end of the line")
      ->group(help_group::kLine);
  app.add_option_function<std::string>(
         "--parity",
         [&line](const std::string& given) {
           line.parity = static_cast<Parity>(std::ranges::find(kParityWords, given) - kParityWords.begin());
         },
         fmt::format("its parity [{}]", otherwise))
      ->check(CLI::IsMember(std::set<std::string>(kParityWords.begin(), kParityWords.end())))
      ->type_name("PARITY")
      ->group(help_group::kLine);
  add_number("--data-bits", line.data_bits, {7, 8}, "its data bits");
  add_number("--stop-bits", line.stop_bits, {1, 2}, "its stop bits");
}

void add_master_options(CLI::App& app, serial::MasterSettings& master) {
  add_line_options(app, master);
  add_duration(app, "--timeout", master.timeout, "how long to wait for an answer to start [1s]")->group(help_group::kLine);
  add_duration(app, "--gap", master.gap, "pause between the characters of a request [none]");
}

}  // namespace s7200::tools

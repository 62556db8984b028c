#include "tools/command/options/master_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/command/options/number_option.hpp"

namespace s7200::tools {

void LineOptions::add_to(CLI::App& app, const std::string& otherwise) {
  add_whole_number(app, "--baud", baud, {50, 1'000'000}, "baud rate of the other end of the line", otherwise);
  app.add_option("--parity", parity, fmt::format("its parity: none, even, odd [{}]", otherwise))
      ->check(CLI::IsMember({"port", "none", "even", "odd"}))
      ->type_name("PARITY");
  add_whole_number(app, "--data-bits", data_bits, {7, 8}, "its data bits", otherwise);
  add_whole_number(app, "--stop-bits", stop_bits, {1, 2}, "its stop bits", otherwise);
}

SerialFormat LineOptions::format_over(SerialFormat port) const {
  if (baud != 0) port.baud = baud;
  if (data_bits != 0) port.data_bits = static_cast<std::uint8_t>(data_bits);
  if (parity == "none") port.parity = Parity::None;
  if (parity == "even") port.parity = Parity::Even;
  if (parity == "odd") port.parity = Parity::Odd;
  if (stop_bits != 0) port.stop_bits = static_cast<std::uint8_t>(stop_bits);
  return port;
}

SerialFormat LineOptions::format_for(const serial::Simulation& simulation) const {
  const auto& port = simulation.cpu().state().port[0];
  return format_over(port.active ? port.format : SerialFormat{});
}

void MasterOptions::add_to(CLI::App& app) {
  LineOptions::add_to(app);
  add_duration(app, "--timeout", timeout, "how long to wait for an answer to start [1s]");
  add_duration(app, "--gap", gap, "pause between the characters of a request [none]");
}

}  // namespace s7200::tools

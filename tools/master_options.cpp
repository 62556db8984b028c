#include "tools/master_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/duration_option.hpp"

namespace s7200::tools {

void LineOptions::add_to(CLI::App& app, const std::string& otherwise) {
  app.add_option("--baud", baud, fmt::format("baud rate of the other end of the line (default: {})", otherwise))
      ->check(CLI::Range(50, 1'000'000));
  app.add_option("--parity", parity, fmt::format("its parity: none, even, odd (default: {})", otherwise))
      ->check(CLI::IsMember({"port", "none", "even", "odd"}));
  app.add_option("--data-bits", data_bits, fmt::format("its data bits: 7 or 8 (default: {})", otherwise))
      ->check(CLI::IsMember({7, 8}));
  app.add_option("--stop-bits", stop_bits, fmt::format("its stop bits: 1 or 2 (default: {})", otherwise))
      ->check(CLI::IsMember({1, 2}));
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
  const auto& port = simulation.cpu().state().port;
  return format_over(port.active ? port.format : SerialFormat{});
}

void MasterOptions::add_to(CLI::App& app) {
  LineOptions::add_to(app);
  add_duration(app, "--timeout", timeout, "how long to wait for the begin of an answer (default 1s)");
  add_duration(app, "--gap", gap, "between the characters of a request (default none)");
}

}  // namespace s7200::tools

#include "tools/master_options.hpp"

#include <CLI/CLI.hpp>

#include "tools/duration_option.hpp"

namespace s7200::tools {

void MasterOptions::add_to(CLI::App& app) {
  app.add_option("--baud", baud, "baud rate of the master (default: as the program set its port)")
      ->check(CLI::Range(50, 1'000'000));
  app.add_option("--parity", parity, "none, even, odd (default: as the program set its port)")
      ->check(CLI::IsMember({"port", "none", "even", "odd"}));
  app.add_option("--data-bits", data_bits, "7 or 8 (default: as the program set its port)")->check(CLI::IsMember({7, 8}));
  app.add_option("--stop-bits", stop_bits, "1 or 2")->check(CLI::IsMember({1, 2}))->capture_default_str();
  add_duration(app, "--timeout", timeout, "how long to wait for the begin of an answer (default 1s)");
  add_duration(app, "--gap", gap, "between the characters of a request (default none)");
}

SerialFormat MasterOptions::format_for(const serial::Simulation& simulation) const {
  SerialFormat format = simulation.cpu().state().port.active ? simulation.cpu().state().port.format : SerialFormat{};
  if (baud != 0) format.baud = baud;
  if (data_bits != 0) format.data_bits = static_cast<std::uint8_t>(data_bits);
  if (parity == "none") format.parity = Parity::None;
  if (parity == "even") format.parity = Parity::Even;
  if (parity == "odd") format.parity = Parity::Odd;
  format.stop_bits = static_cast<std::uint8_t>(stop_bits);
  return format;
}

const serial::Exchange& MasterOptions::exchange(serial::Simulation& simulation, const modbus::Frame& frame,
                                                const SerialFormat& format) const {
  simulation.master_uart().configure(format);
  simulation.master().start({.frame = frame, .timeout = timeout, .gap = gap}, simulation.time());
  return simulation.finish_exchange();
}

}  // namespace s7200::tools

#include "tools/command/options/plc/bridge_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>

#include "interpreter/base/text/text.hpp"
#include "tools/bridge/device_bridge.hpp"
#include "tools/bridge/pty_bridge.hpp"
#include "tools/bridge/tcp_bridges.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/serial_device.hpp"

namespace s7200::tools {

Result<std::unique_ptr<Bridge>> make_bridge(BridgeKind kind, const std::string& where, const serial::LineSettings& line,
                                            Time timeout) {
  const auto address = row_of(kind).place == kPortPlace ? parse_listen_address(where) : ListenAddress{};
  if (!address) return address.trouble();
  switch (kind) {
    case BridgeKind::Pty:
      return make_pty_bridge(where, line);
    case BridgeKind::Tcp:
      return make_tcp_bridge(*address);
    case BridgeKind::Rfc2217:
      return make_rfc2217_bridge(*address, line);
    case BridgeKind::RtuOverTcp:
      return make_rtu_over_tcp_bridge(*address, timeout);
    case BridgeKind::ModbusTcp:
      return make_modbus_tcp_bridge(*address, timeout);
    case BridgeKind::Device:
      return make_device_bridge(where);
  }
  return std::nullopt;
}

LiveMessages print_live_messages() {
  return {[](const std::string& text) { fmt::print(stderr, "{}\n", stl::printable(text)); }, print_note};
}

void BridgeOptions::add_bridges(CLI::App& app) {
  for (const BridgeRow& row : kBridges) {
    app.add_option(std::string(row.option), where_[static_cast<std::size_t>(row.kind)], std::string(row.meaning))
        ->type_name(std::string(row.place))
        ->group(row.kind == BridgeKind::Pty && !has_ptys() ? help_group::kNone : help_group::kBridge);
  }
}

void BridgeOptions::add_pace(CLI::App& app) {
  app.add_flag("--realtime", realtime_, "as fast as the clock; with a bridge that is so of itself")->group(help_group::kRun);
  add_real_number(
      app, "--speed",
      [this](double speed) {
        speed_ = speed;
        speed_given_ = true;
      },
      {0.001, 1000}, "times as fast as the clock, with a bridge too", "1")
      ->group(help_group::kRun);
}

void BridgeOptions::add_to(CLI::App& app) {
  add_pace(app);
  add_bridges(app);
  add_line_options(app, line_, has_ptys() ? "the program's; with --pty its client's" : "the program's");
  add_duration(app, "--timeout", timeout_, "how long --modbus-tcp and --rtu-over-tcp wait for an answer to start [400ms]");
}

bool BridgeOptions::prepare() {
  const BridgeRow* chosen = nullptr;
  for (const BridgeRow& row : kBridges) {
    if (where(row.kind).empty()) continue;
    if (chosen) return print_error(fmt::format("{} and {}: one bridge at a time", chosen->option, row.option)), false;
    chosen = &row;
  }
  if (!chosen) return true;
  const std::string& there = where(chosen->kind);
  auto bridge = make_bridge(chosen->kind, there, line_, timeout_);
  if (!bridge) return print_error(fmt::format("{} {}: {}", chosen->option, stl::shortened(there), bridge.why())), false;
  bridge_ = *std::move(bridge);
  return true;
}

}  // namespace s7200::tools

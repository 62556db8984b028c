#include "tools/command/options/bridge_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <utility>

#include "interpreter/base/text.hpp"
#include "tools/bridge/device_bridge.hpp"
#include "tools/bridge/pty_bridge.hpp"
#include "tools/bridge/tcp_bridges.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/terminal.hpp"

namespace s7200::tools {
namespace {

constexpr const char* kBridges = "Bridges: join the line to masters outside, in real time, one of";

}  // namespace

std::unique_ptr<Bridge> make_bridge(std::string_view kind, const std::string& where, const serial::LineSettings& line,
                                    Time timeout, std::string& why) {
  if (kind == "pty") return make_pty_bridge(where, line);
  if (kind == "device") return make_device_bridge(where);
  const auto address = parse_listen_address(where, why);
  if (!address) return nullptr;
  if (kind == "tcp") return make_tcp_bridge(*address);
  return kind == "rtu-over-tcp" ? make_rtu_over_tcp_bridge(*address, timeout) : make_modbus_tcp_bridge(*address, timeout);
}

LiveMessages print_live_messages() {
  return {[](const std::string& text) { fmt::print(stderr, "{}\n", stl::printable(text)); }, print_note};
}

void BridgeOptions::add_bridges(CLI::App& app) {
  const auto add = [&](const char* name, std::string& value, const char* type, const char* text) {
    app.add_option(name, value, text)->type_name(type)->group(kBridges);
  };
  add("--pty", pty_, "LINK", "a serial port that programs of this computer open as LINK (see the end about parity)");
  add("--tcp", tcp_, "[ADDRESS:]PORT", "raw bytes over TCP, clients share the line; without ADDRESS for this computer only");
  add("--rtu-over-tcp", rtu_over_tcp_, "[ADDRESS:]PORT", "Modbus RTU frames over TCP; clients take turns");
  add("--modbus-tcp", modbus_tcp_, "[ADDRESS:]PORT", "a gateway from Modbus TCP; unit 0 is broadcast");
  add("--device", device_, "DEVICE", "a serial device of this computer, set as the program sets its port");
}

void BridgeOptions::add_pace(CLI::App& app) {
  app.add_flag("--realtime", realtime_, "as fast as the clock; with a bridge that is so of itself");
  add_real_number(
      app, "--speed",
      [this](double speed) {
        speed_ = speed;
        speed_given_ = true;
      },
      {0.001, 1000}, "how many times as fast as the clock, for example 20 or 0.5, with a bridge too", "1");
}

void BridgeOptions::add_to(CLI::App& app) {
  add_pace(app);
  add_bridges(app);
  add_line_options(app, line_, "the program's; with --pty its client's");
  add_duration(app, "--timeout", timeout_, "how long --modbus-tcp and --rtu-over-tcp wait for an answer to start [400ms]");
}

bool BridgeOptions::prepare() {
  const std::pair<std::string_view, const std::string*> kinds[] = {
      {"pty", &pty_}, {"tcp", &tcp_}, {"rtu-over-tcp", &rtu_over_tcp_}, {"modbus-tcp", &modbus_tcp_}, {"device", &device_}};
  std::string_view chosen;
  const std::string* where = nullptr;
  for (const auto& [kind, value] : kinds) {
    if (value->empty()) continue;
    if (where) {
      print_error(fmt::format("--{} and --{}: one bridge at a time", chosen, kind));
      return false;
    }
    chosen = kind;
    where = value;
  }
  if (!where) return true;
  std::string why;
  bridge_ = make_bridge(chosen, *where, line_, timeout_, why);
  if (!bridge_) print_error(fmt::format("--{} {}: {}", chosen, stl::shortened(*where), why));
  return bridge_ != nullptr;
}

}  // namespace s7200::tools

#include "tools/command/options/bridge_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <functional>

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
  using Make = std::function<std::unique_ptr<Bridge>()>;
  struct Kind {
    const char* option;
    const std::string* value;
    Make make;
  };
  bool fine = true;
  const auto listen = [&](const char* option, const std::string& text, const auto& make) -> std::unique_ptr<Bridge> {
    std::string why;
    const auto address = parse_listen_address(text, why);
    if (address) return make(*address);
    print_error(fmt::format("{} {}: {}", option, stl::shortened(text), why));
    fine = false;
    return nullptr;
  };
  const std::array<Kind, 5> kinds{{
      {"--pty", &pty_, [&] { return make_pty_bridge(pty_, line_); }},
      {"--tcp", &tcp_, [&] { return listen("--tcp", tcp_, make_tcp_bridge); }},
      {"--rtu-over-tcp", &rtu_over_tcp_,
       [&] {
         return listen("--rtu-over-tcp", rtu_over_tcp_,
                       [&](const auto& a) { return make_rtu_over_tcp_bridge(a, timeout_); });
       }},
      {"--modbus-tcp", &modbus_tcp_,
       [&] {
         return listen("--modbus-tcp", modbus_tcp_, [&](const auto& a) { return make_modbus_tcp_bridge(a, timeout_); });
       }},
      {"--device", &device_, [&] { return make_device_bridge(device_); }},
  }};
  const Kind* chosen = nullptr;
  for (const Kind& kind : kinds) {
    if (kind.value->empty()) continue;
    if (chosen) {
      print_error(fmt::format("{} and {}: one bridge at a time", chosen->option, kind.option));
      return false;
    }
    chosen = &kind;
  }
  if (chosen) bridge_ = chosen->make();
  return fine;
}

}  // namespace s7200::tools

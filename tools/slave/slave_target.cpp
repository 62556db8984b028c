#include "tools/slave/slave_target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/plan/reading/system_reader.hpp"
#include "tools/slave/host_slave.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kTcp = "tcp://", kModbusTcp = "modbus-tcp://";
constexpr const char* kModbusPort = "502";  // Modbus Messaging on TCP/IP, 2.1

void split(const std::string& text, std::string_view address, SlaveTarget& target) {
  std::string_view rest = address;
  if (!rest.empty() && rest.front() == '[') {
    const std::size_t end = rest.find(']');
    if (end == std::string_view::npos)
      throw std::invalid_argument(fmt::format("'{}': ']' is missing", stl::shortened(text)));
    target.host = rest.substr(1, end - 1);
    rest.remove_prefix(end + 1);
  } else {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    target.host = rest.substr(0, end);
    rest.remove_prefix(end);
  }
  if (!rest.empty() && rest.front() == ':') target.port = rest.substr(1);
  const bool port_wanted = !rest.empty() || target.kind == SlaveTarget::Kind::Tcp;
  if (target.host.empty() || (port_wanted && target.port.empty()) || target.port.find(':') != std::string::npos)
    throw std::invalid_argument(
        fmt::format("'{}' is not an address; write for example tcp://192.168.0.5:4001 or "
                    "modbus-tcp://192.168.0.5, an IPv6 address as [::1]",
                    stl::shortened(text)));
  if (!port_wanted) target.port = kModbusPort;
  const bool number = target.port.find_first_not_of("0123456789") == std::string::npos;
  if (number && parse_decimal<std::uint16_t>(target.port).value_or(0) == 0)
    throw std::invalid_argument(fmt::format("'{}': ports are 1 to 65535", stl::shortened(text)));
}

/// Whether a text is a host and a port: `127.0.0.1:5029`, `plc:502`, but not a drive of Windows.
bool is_host_and_port(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon < 2 || text.find('/') != std::string::npos) return false;
  return parse_decimal<std::uint16_t>(std::string_view(text).substr(colon + 1)).value_or(0) != 0;
}

}  // namespace

SlaveTarget parse_slave_target(const std::string& text) {
  SlaveTarget target;
  if (text.starts_with(kTcp)) {
    target.kind = SlaveTarget::Kind::Tcp;
    split(text, std::string_view(text).substr(kTcp.size()), target);
  } else if (text.starts_with(kModbusTcp)) {
    target.kind = SlaveTarget::Kind::ModbusTcp;
    split(text, std::string_view(text).substr(kModbusTcp.size()), target);
  } else if (is_other_plc(text)) {
    target.kind = SlaveTarget::Kind::Peer;
    target.path = text.substr(kOtherPlc.size());
  } else if (text.find("://") != std::string::npos) {
    throw std::invalid_argument(fmt::format("'{}': there is no such way to a slave; write {}HOST:PORT or {}HOST:PORT",
                                            stl::shortened(text), kTcp, kModbusTcp));
  } else {
    std::error_code error;
    if (is_host_and_port(text) && !std::filesystem::exists(file_path(text), error))
      throw std::invalid_argument(fmt::format("'{}' is not a file: for a slave over TCP write {}{} (Modbus RTU) or {}{}",
                                              stl::shortened(text), kTcp, text, kModbusTcp, text));
    target.kind = names_serial_device(text) ? SlaveTarget::Kind::Device
                  : is_system_file(text)    ? SlaveTarget::Kind::System
                                            : SlaveTarget::Kind::Program;
    target.path = text;
  }
  return target;
}

bool is_other_plc(std::string_view text) { return text.starts_with(kOtherPlc); }

std::string slave_targets_help(std::initializer_list<SlaveTarget::Kind> without, std::string_view device) {
  using enum SlaveTarget::Kind;
  const std::string devices = fmt::format("{}{}", example_of_serial_device(), has_ptys() ? ", or a pty by its link" : "");
  const std::string device_row = fmt::format("  {:38}{}\n", devices, device);
  const std::pair<SlaveTarget::Kind, std::string_view> rows[] = {
      {Program, "  PROGRAM                               an STL file or document, in simulation; - is standard input\n"},
      {System, "  SYSTEM.yaml                           PLCs and lines, in simulation; --at says where the master joins\n"},
      {Device, device_row},
      {Tcp,
       "  tcp://HOST:PORT                       the characters of a serial line over TCP, as serial servers offer it\n"},
      {ModbusTcp, "  modbus-tcp://HOST[:PORT]              Modbus TCP, port 502 unless one is given\n"},
      {Peer,
       "  westinghouse:MODEL                    a simulated PLC of the Westinghouse family, alone on a line; --plc sets "
       "it\n"}};
  std::string text = "Targets:\n";
  for (const auto& [kind, row] : rows)
    if (std::ranges::find(without, kind) == without.end()) text += row;
  return text;
}

std::unique_ptr<Slave> connect(const SlaveTarget& target, const SerialFormat& format, IsComplete is_complete,
                               StopToken stop) {
  switch (target.kind) {
    case SlaveTarget::Kind::Program:
    case SlaveTarget::Kind::System:
    case SlaveTarget::Kind::Peer:
      break;
    case SlaveTarget::Kind::Device:
      return std::make_unique<RtuSlave>(target.path, format, is_complete, stop);
    case SlaveTarget::Kind::Tcp:
      return std::make_unique<RtuSlave>(target.host, target.port, is_complete, stop);
    case SlaveTarget::Kind::ModbusTcp:
      return std::make_unique<ModbusTcpSlave>(target.host, target.port, stop);
  }
  throw std::invalid_argument(
      fmt::format("'{}' is in simulation; name a serial device, tcp:// or modbus-tcp://", stl::shortened(target.path)));
}

}  // namespace s7200::tools

// The kinds of bridge that join a line to programs and devices of this computer, with their words.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace s7200::tools {

enum class BridgeKind : std::uint8_t { Pty, Tcp, Rfc2217, RtuOverTcp, ModbusTcp, Device };

struct BridgeRow {
  BridgeKind kind;
  std::string_view option;  ///< of the command line; without its dashes it is the key of a system file
  std::string_view place;   ///< where it is, as the help names that
  std::string_view meaning;

  constexpr std::string_view word() const { return option.substr(2); }
};

inline constexpr std::string_view kPortPlace = "[ADDRESS:]PORT";
inline constexpr std::array kBridges{
    BridgeRow{BridgeKind::Pty, "--pty", "LINK", "a serial port that programs of this computer open as LINK"},
    BridgeRow{BridgeKind::Tcp, "--tcp", kPortPlace,
              "raw bytes over TCP, clients share the line; without ADDRESS for this computer only"},
    BridgeRow{BridgeKind::Rfc2217, "--rfc2217", kPortPlace,
              "a serial port over TCP; the client sets its rate, parity, data bits and break"},
    BridgeRow{BridgeKind::RtuOverTcp, "--rtu-over-tcp", kPortPlace, "Modbus RTU frames over TCP; clients take turns"},
    BridgeRow{BridgeKind::ModbusTcp, "--modbus-tcp", kPortPlace, "a gateway from Modbus TCP; unit 0 is broadcast"},
    BridgeRow{BridgeKind::Device, "--device", "DEVICE",
              "a serial device of this computer, set as the program sets its port"},
};

constexpr const BridgeRow& row_of(BridgeKind kind) { return *std::ranges::find(kBridges, kind, &BridgeRow::kind); }

}  // namespace s7200::tools

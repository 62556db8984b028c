// The settings of the station at the other end of a line.
#pragma once

#include <cstdint>
#include <optional>

#include "interpreter/base/serial_format.hpp"

namespace s7200::serial {

/// The range of a line's baud rate, in bits per second.
inline constexpr std::uint32_t kSlowestBaud = 50, kFastestBaud = 1'000'000;

/// The settings that the user gave; any other setting follows the port of the program.
struct LineSettings {
  std::optional<std::uint32_t> baud{};  ///< bits a second
  std::optional<Parity> parity{};
  std::optional<std::uint8_t> data_bits{}, stop_bits{};

  bool operator==(const LineSettings&) const = default;

  /// The format of `port` with the given settings in place of its own.
  SerialFormat over(SerialFormat port) const {
    port.baud = baud.value_or(port.baud);
    port.parity = parity.value_or(port.parity);
    port.data_bits = data_bits.value_or(port.data_bits);
    port.stop_bits = stop_bits.value_or(port.stop_bits);
    return port;
  }

  /// Replaces settings with those that `given` has.
  void override_with(const LineSettings& given) {
    if (given.baud) baud = given.baud;
    if (given.parity) parity = given.parity;
    if (given.data_bits) data_bits = given.data_bits;
    if (given.stop_bits) stop_bits = given.stop_bits;
  }
};

}  // namespace s7200::serial

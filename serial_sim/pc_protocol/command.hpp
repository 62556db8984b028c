// Commands: 33 bytes, which read or write up to eight bytes of a CPU.
//
//   0       'g'                       12–13  digits of data to be written, as a byte; of a read any value
//   1       5 reads, 6 writes         14–29  data, always full
//   2–3     station                   30–31  XOR of bytes 1 to 29
//   4–11    area and number           32     'G'
//
// All but bytes 0, 1 and 32 are hex digits, two for a byte, upper case: so neither 'g' nor 'G' can occur in them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/result.hpp"

namespace s7200::pc_protocol {

inline constexpr std::size_t kCommandLength = 33, kMostBytes = 8;

/// A memory area, as the upper word of an S7-200 pointer.
enum class Area : std::uint16_t { I = 0x0000, Q = 0x0100, M = 0x0200, V = 0x0800 };

/// The address of a byte in a CPU.
struct Address {
  Area area = Area::V;
  std::uint16_t number = 0;

  bool operator==(const Address&) const = default;
};

/// Reads `VB100`, `MB8`, `IB0`, `QB0` in either case. Trouble for anything else.
Result<Address> parse_address(std::string_view text);

/// The name of an area, as in `V`, and of an address, as in `VB100`.
std::string_view area_name(Area area);
std::string notation(const Address& address);

enum class Type : std::uint8_t { Read = 5, Write = 6 };

struct Command {
  Type type = Type::Read;
  std::uint8_t station = 0;
  Address address{};
  Bytes data{};  ///< to be written

  bool operator==(const Command&) const = default;
};

/// The message of a command, whose `data` has kMostBytes at most.
Bytes to_bytes(const Command& command);

/// A command of the right form. Returns nothing for anything else.
std::optional<Command> parse_command(std::span<const std::uint8_t> bytes);

/// The check code: the XOR of `characters`.
std::uint8_t check_code(std::span<const std::uint8_t> characters);

/// Appends two hex digits for each byte.
void append_digits(Bytes& to, std::span<const std::uint8_t> bytes);

/// The bytes that pairs of hex digits stand for. Returns nothing for an odd count, and for what is not an upper case digit.
std::optional<Bytes> from_digits(std::span<const std::uint8_t> digits);

}  // namespace s7200::pc_protocol

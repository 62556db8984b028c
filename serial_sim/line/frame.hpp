// Frames: characters in a row, as they are sent and as people type them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/bytes.hpp"

namespace s7200::serial {

inline constexpr std::size_t kLongestRawFrame = 1024;

/// A character of a raw frame.
struct FrameCharacter {
  std::uint8_t byte = 0;
  bool wrong_parity = false;  ///< to be sent with its parity bit the wrong way round

  bool operator==(const FrameCharacter&) const = default;
};

using Frame = std::vector<FrameCharacter>;

Frame to_frame(std::span<const std::uint8_t> bytes);
Bytes bytes_of(std::span<const FrameCharacter> frame);

/// Whether a character has wrong parity; such a frame can only be sent in a format with parity.
bool has_wrong_parity(std::span<const FrameCharacter> frame);

struct FrameError {
  std::size_t column = 1;  ///< in the text, from 1
  std::string message;

  bool operator==(const FrameError&) const = default;
};

struct ParsedFrame {
  Frame frame;  ///< of use only if there are no errors
  std::vector<FrameError> errors;

  bool ok() const { return errors.empty(); }
};

/// Reads `01 03 00 0a`, `01-03`, `0x01,0x03`: two hex digits a byte, blanks or signs between bytes as you like, `p` after a
/// byte to send it with wrong parity. From one to 1024 bytes.
ParsedFrame parse_hex_frame(std::string_view text);

/// Bytes in hex: `01 03 00 0a`
std::string to_hex(std::span<const std::uint8_t> bytes);

/// Bytes in hex with `p` for wrong parity, as parse_hex_frame reads them.
std::string to_hex(std::span<const FrameCharacter> frame);

}  // namespace s7200::serial

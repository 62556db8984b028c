// How an exchange is to end, and whether it did.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "serial_sim/line/frame.hpp"
#include "tools/scenario/reading/text.hpp"

namespace s7200::tools {

struct Expected {
  enum class Kind : std::uint8_t {
    Silence,    ///< no character came
    Any,        ///< any characters came
    Frame,      ///< these bytes
    Echo,       ///< the request, byte by byte
    Exception,  ///< from that station, to that function, with that code
    Values,     ///< these registers or bits, in an answer of the right shape
    Accepted,   ///< an answer of the right shape: what was asked for, or that it was written
    Refused,    ///< an exception of any code
  };

  Kind kind{};
  std::vector<BytePattern> frame{};                    ///< of Frame; without CRC if has_crc is asked for
  std::uint8_t exception = 0;                          ///< of Exception
  std::vector<std::optional<std::uint16_t>> values{};  ///< of Values
};

/// Whether the response is as expected; `has_crc`: a right CRC must be at its end.
bool fulfilled(const Expected& expected, bool has_crc, const Bytes& request, const Bytes& response);

/// The bytes that would have been right, as far as they are known; none if they are not.
std::vector<BytePattern> bytes_expected(const Expected& expected, bool has_crc, const Bytes& request);

/// Of what no one asked for the request is empty.
std::string in_words(const Expected& expected, const Bytes& request);

}  // namespace s7200::tools

// The answer to a request, judged in the same terms for every protocol.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/bytes.hpp"

namespace s7200::serial {

enum class Verdict : std::uint8_t {
  Right,      ///< what the request earns, as far as a master can tell
  Exception,  ///< the slave refused, in the right form
  Silent,     ///< no characters came
  Wrong,      ///< anything else
};

struct Answer {
  Verdict verdict = Verdict::Silent;
  std::string fault;            ///< what is wrong: `wrong CRC`, `answer of station 2, not 1`
  std::uint16_t exception = 0;  ///< code of the exception
  bool lasting = false;         ///< what is wrong stays so, however often it is asked

  /// The values that were read, one for each bit, byte or register that was asked for.
  std::vector<std::uint16_t> values;

  /// Data that is not values; the protocol says what it means.
  Bytes bytes;
};

/// A refusal in any protocol but Modbus, which has exceptions: `error 16#12: no session`.
inline std::string error_text(std::uint16_t code, std::string_view name) {
  return fmt::format("error 16#{:02X}: {}", code, name);
}

}  // namespace s7200::serial

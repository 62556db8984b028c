// What a slave answered: checked against the request byte by byte, decoded, and said in words.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "serial_sim/modbus/crc.hpp"

namespace s7200::modbus {

enum class Verdict : std::uint8_t {
  Right,      ///< what the request earns, as far as a master can tell
  Exception,  ///< the slave refused, in the right form
  Silent,     ///< nothing came
  Wrong,      ///< anything else
};

struct Answer {
  Verdict verdict = Verdict::Silent;
  std::string fault;           ///< what is wrong: `wrong CRC`, `answer of station 2, not 1`
  std::uint8_t exception = 0;  ///< its code

  /// Of reads: the bits, 0 or 1, or the registers, those of file records one reference after the other. Of function 8: the
  /// data words.
  std::vector<std::uint16_t> values;

  /// Of functions 7 and 17: the data without its byte count. Of references of a maker's own kind: theirs. Of functions that
  /// are not in the table: all data.
  Bytes bytes;
};

/// Both are RTU frames. An answer of more than 4 characters is never taken for right if its CRC is not.
Answer check_answer(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response);

/// What the answer says, in one line for people: `3 registers: 16#1234 16#0000 16#FFFF`, `coils 0…7: 1010 1010`,
/// `exception 2: illegal data address`, or what is wrong with it.
std::string describe(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response);

}  // namespace s7200::modbus

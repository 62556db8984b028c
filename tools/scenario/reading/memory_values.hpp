// Memory in a scenario: what is put into it, and what must be in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interpreter/program/operands/address.hpp"
#include "interpreter/program/program.hpp"
#include "tools/scenario/reading/value_reader.hpp"
#include "tools/scenario/result.hpp"

namespace s7200::tools {

/// `{VW20: 16#1234, I0.3: 1}`
std::vector<Assignment> read_assignments(ValueReader& values, const YamlNode& map, const AddressSpace& space);

struct MemoryExpected {
  /// From … to, both included, as an instruction reads the value: bytes without a sign, words and double words with one,
  /// unless a limit is larger than that, and reals.
  struct Limits {
    double from = 0, to = 0;
    bool is_signed = true;
    bool operator==(const Limits&) const = default;
  };

  MemoryRange range{};
  std::vector<BytePattern> bytes{};  ///< as they lie in memory; of a bit, 0 or 1
  std::optional<Limits> limits{};    ///< instead of the bytes
  std::string address{}, written{};  ///< as they were written

  bool fits(const std::vector<std::uint8_t>& found) const;
};

/// `{VW20: 16#1234, VW22: 5..10, VD24: 1.5, VB0:4: 01 02 .. 04}`
std::vector<MemoryExpected> read_memory_expected(ValueReader& values, const YamlNode& map, const AddressSpace& space);

/// What memory was to hold and holds. Of reals and of limits the bytes say little.
Finding memory_finding(const Program& program, const MemoryExpected& expected, const Bytes& found);

}  // namespace s7200::tools

// Which memory of a PLC the instructions of a part of the past may have written. Who looks for the last write of an address
// need not play the parts that cannot have it.
#pragma once

#include <cstdint>
#include <vector>

#include "interpreter/cpu/cpu.hpp"
#include "tools/session/past/actions/access.hpp"

namespace s7200::tools {

/// Of a part of the past.
struct WrittenMemory {
  std::vector<bool> executed{};  ///< by instruction, with power flow
  std::vector<bool> blocks{};    ///< of the image, to which pointers and counts led
  bool unknown = false;          ///< something else may have written as well, or nobody looked

  void add(const WrittenMemory& other);
};

/// Must be told what is executed, and keeps it.
class WriteMarker {
 public:
  explicit WriteMarker(const Cpu& cpu);

  WrittenMemory nothing() const;

  /// In front of an instruction, and after it.
  void before(std::uint32_t op);
  void executed(const InstructionRecord& record, WrittenMemory& written) const;

  /// Whether all that writes there is kept, or sets `unknown`.
  bool knows(const MemoryRange& range) const;

  /// Instructions that may write there without a pointer or a count.
  std::vector<std::uint32_t> writers_of(const Bits& range) const;

  /// Whether there may have been a write; `writers` are those of the range.
  static bool may_hold(const WrittenMemory& written, const Bits& range, const std::vector<std::uint32_t>& writers);

 private:
  enum class Writes : std::uint8_t {
    Operands,   ///< where they stand, or nothing
    Elsewhere,  ///< where a pointer or a count says
    Unknown     ///< entries of tables, strings
  };
  static Writes writes_of(const Program& program, std::uint32_t op);

  const Cpu& cpu_;
  std::vector<Writes> writes_;   // by instruction
  bool receives_later_ = false;  // some instruction lets the system write V memory after it
  std::vector<Bits> next_{};     // of the instruction that comes, if it writes elsewhere
};

}  // namespace s7200::tools

// Executed instructions as text. What does not change from one execution to the next is made once for each op: a trace has
// millions of lines.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "interpreter/program/program.hpp"
#include "interpreter/trace/text/line_parts.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// An operand of an instruction whose value is recorded.
struct WatchedValue {
  std::size_t operand = 0;  ///< its place in InstructionRecord::value
  std::string name;         ///< as the program writes it: `VW3300`
  Width width = Width::Byte;
  bool real = false;
};

std::vector<WatchedValue> watched_values(const Program& program, std::uint32_t op);

class InstructionLines {
 public:
  /// The program must live as long as this.
  explicit InstructionLines(const Program& program) : program_(program), ops_(program.ops.size()) {}

  /// Appends `  15.193000  line 42    MOVW    VW3300, AC0   S0=1 VW3300=16#0006 AC0=16#0006  53 us` and a line end.
  void append_line(fmt::memory_buffer& text, const InstructionRecord& record);

 private:
  struct OpText {
    bool made = false;
    std::string head;  ///< `line 42    MOVW    VW3300, AC0   S0=`
    std::vector<WatchedValue> values;
    Time took = -1;
    std::string duration;  ///< of `took`: it is nearly always the same
  };

  static OpText make(const Program& program, std::uint32_t op);
  static void append_what(fmt::memory_buffer& text, const OpText& op, const InstructionRecord& record);
  static void append_values(fmt::memory_buffer& text, const OpText& op, const InstructionRecord& record);
  friend std::string describe(const InstructionRecord& record, const Program& program);
  friend std::string values_text(const InstructionRecord& record, const Program& program);

  const Program& program_;
  std::vector<OpText> ops_;
};

/// `line 42    MOVW    VW3300, AC0   S0=1 VW3300=16#0006 AC0=16#0006`
std::string describe(const InstructionRecord& record, const Program& program);

/// ` VW3300=16#0006 AC0=16#0006`
std::string values_text(const InstructionRecord& record, const Program& program);

}  // namespace s7200

// The condition of an instruction in words: `(I0.0 or M0.1) and not VW10 > 5`.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "interpreter/analysis/flow/ways.hpp"

namespace s7200 {

class RungText {
 public:
  /// The text of an operand of an op.
  using OperandText = std::function<std::string(std::uint32_t op, std::size_t operand)>;

  /// `ways` must live as long as this.
  RungText(const Ways& ways, OperandText operand_text) : ways_(ways), operand_text_(std::move(operand_text)) {}

  /// What a level of the logic stack is in front of an op, 0 the top: `always` if it uses none.
  std::string of(std::uint32_t op, std::size_t level) const;

 private:
  std::string of_gate(const NetworkLogic& logic, std::size_t gate, int strength) const;
  std::string of_contact(const NetworkLogic::Contact& contact, bool negated) const;

  const Ways& ways_;
  OperandText operand_text_;
};

}  // namespace s7200

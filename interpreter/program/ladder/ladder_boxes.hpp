// The boxes of the ladder editor: which instruction each stands for, and which operand each of its pins is.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "interpreter/model/instruction.hpp"
#include "interpreter/stl/ast.hpp"
#include "interpreter/stl/drawings/ladder.hpp"

namespace s7200 {

/// A box whose name is not the mnemonic of its instruction, or whose pins are in another order than the operands.
struct LadderBox {
  enum class Form : std::uint8_t {
    Pins,        ///< the operands are pins
    InPlace,     ///< IN, OUT: OUT = f(IN)
    Shift,       ///< IN, N, OUT
    Sum,         ///< IN1, IN2, OUT; the inputs may be swapped
    Difference,  ///< IN1, IN2, OUT
    Product      ///< IN1, IN2 words, OUT a double word whose low word is IN1 first
  };

  std::string_view name, mnemonic;
  Form form;
  std::string_view move{};  ///< of IN to OUT
  std::array<std::string_view, 3> pins{};
};

/// Returns null for a name (upper case) that is not in the table.
const LadderBox* find_ladder_box(std::string_view name);

/// The low word of a double word, VW102 of VD100; an accumulator is its own low word. Returns nothing for what has none.
std::optional<stl::Operand> low_word(const stl::Operand& operand);

/// An operand as it stands in a drawing: without its symbol, which is beside the drawing.
stl::LadderText operand_in_ladder(const stl::Operand& operand);

/// An output as it is drawn: a coil or a box with its pins. `program` has the names of a subroutine's parameters.
stl::LadderElement ladder_output(const stl::Statement& statement, const Instruction& instruction,
                                 const stl::Source& program);

}  // namespace s7200

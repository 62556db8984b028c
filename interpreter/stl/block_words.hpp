// The words of the blocks of a Micro/WIN export, for those who read and who write them.
#pragma once

#include <array>
#include <string_view>

#include "interpreter/stl/ast.hpp"

namespace s7200::stl {

/// The words for a kind of block, and the instructions that begin and end its routine in a listing.
struct BlockWords {
  std::string_view keyword, letters;
  std::string_view name;  ///< of a block without one, before its number; the main program has no number
  std::string_view head, end;
};

/// The words of blocks, by Block::Kind.
inline constexpr std::array kBlockWords{
    BlockWords{"ORGANIZATION_BLOCK", "OB", "MAIN", "", "MEND"},
    BlockWords{"SUBROUTINE_BLOCK", "SBR", "SBR_", "SBR", "RET"},
    BlockWords{"INTERRUPT_BLOCK", "INT", "INT_", "INT", "RETI"},
};

constexpr const BlockWords& words(Block::Kind kind) { return kBlockWords[static_cast<std::size_t>(kind)]; }

/// The words that begin declarations of variables, by Variable::Kind.
inline constexpr std::array<std::string_view, 4> kDeclarationWords{"VAR_INPUT", "VAR_IN_OUT", "VAR_OUTPUT", "VAR"};

constexpr std::string_view word(Variable::Kind kind) { return kDeclarationWords[static_cast<std::size_t>(kind)]; }

struct TypeWord {
  std::string_view name;
  Size size;  ///< in local memory; a string is a pointer to it
};

/// The words of types, by Variable::Type.
inline constexpr std::array kTypeWords{
    TypeWord{"BOOL", Size::Bit},    TypeWord{"BYTE", Size::Byte},   TypeWord{"CHAR", Size::Byte},
    TypeWord{"WORD", Size::Word},   TypeWord{"INT", Size::Word},    TypeWord{"DWORD", Size::Double},
    TypeWord{"DINT", Size::Double}, TypeWord{"REAL", Size::Double}, TypeWord{"STRING", Size::Double},
};

constexpr const TypeWord& word(Variable::Type type) { return kTypeWords[static_cast<std::size_t>(type)]; }

}  // namespace s7200::stl

// Text to AST. Knows the shape of a line but no instruction: a new mnemonic never touches it.
#pragma once

#include <string>
#include <string_view>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/stl/ast.hpp"

namespace s7200::stl {

struct ParseResult {
  Source source;
  Diagnostics diagnostics;
  std::vector<std::uint32_t> left_out{};  ///< lines between the statements of a document that were taken for text
  bool block_export = false;              ///< of Micro/WIN 32, which is not read yet: the diagnostics say just that
};

/// Reads a plain STL text in UTF-8. Every line is read on its own, so no error hides another.
///
///   line      : [ NETWORK [n] | mnemonic { operand } ] [ ';' ] [ '//' comment ]
///   operands  : separated by commas, or by blanks or tabs
///   any case; CR LF, LF or CR line ends; blanks or tabs anywhere between tokens; K4, K-5 and KHFF as constants
ParseResult parse(std::string_view text, std::string name);

}  // namespace s7200::stl

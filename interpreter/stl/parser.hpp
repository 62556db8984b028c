// Text to AST. Knows the shape of a line but no instruction: a new mnemonic never touches it.
#pragma once

#include <string>
#include <string_view>

#include "interpreter/stl/ast.hpp"
#include "interpreter/base/diagnostic.hpp"

namespace s7200::stl {

struct ParseResult {
  Source source;
  Diagnostics diagnostics;
};

/// Reads a plain STL text in UTF-8. Every line is read on its own, so no error hides another.
///
///   line      : [ NETWORK [n] | mnemonic { operand } ] [ ';' ] [ '//' comment ]
///   operands  : separated by commas, or by blanks or tabs
///   any case; CR LF, LF or CR line ends; blanks or tabs anywhere between tokens; K4, K-5 and KHFF as constants
ParseResult parse(std::string_view text, std::string name);

}  // namespace s7200::stl

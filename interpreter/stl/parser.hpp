// Text to AST. Knows the shape of a line but no instruction: a new mnemonic never touches it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/base/result.hpp"
#include "interpreter/stl/ast.hpp"

namespace s7200::stl {

struct ParseResult {
  Source source;
  Diagnostics diagnostics;
  std::vector<std::uint32_t> left_out{};  ///< lines between the statements of a document that were taken for text
  std::vector<std::string> notes{};       ///< what is worth knowing of how it was read, each with the name of its file
};

/// The cause of the diagnostics about German addresses. They are read like the international ones, so a caller that takes
/// the source for a German one has only to leave these diagnostics out.
inline constexpr const char* kGermanAddresses = "German addresses";

/// Reads a plain STL text in UTF-8. Every line is read on its own, so no error hides another.
///
///   line      : [ NETWORK [n] | mnemonic { operand } ] [ ';' ] [ '//' comment ]
///   operands  : separated by commas, or by blanks or tabs
///   any case; CR LF, LF or CR line ends; blanks or tabs anywhere between tokens; K4, K-5 and KHFF as constants
ParseResult parse(std::string_view text, std::string name);

/// What is said of several statements in one line, of which `later` are the mnemonics of all but the first, and what to do.
std::string several_statements(const std::vector<std::string>& later);
std::string new_lines_with(const std::vector<std::string>& later);

/// Reads a text that is one operand, with a German address as well. Trouble if it is not.
Result<Operand> parse_operand(std::string_view text);

/// The bytes of a text between quotes: `AB$0D$L`.
Result<std::string> parse_characters(std::string_view text);

}  // namespace s7200::stl

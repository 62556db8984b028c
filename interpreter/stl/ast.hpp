// STL source as it was written, before anything is known about instructions or CPUs.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "interpreter/base/source.hpp"

namespace s7200::stl {

/// `4`, `-5`, `16#FF`, `2#1010`, `'AB'`, and in S7-Micro/DOS notation `K4`, `KHFF`.
struct Integer {
  std::int64_t value = 0;  ///< -2^31 … 2^32-1
  enum class Form : std::uint8_t { Decimal, Hex, Binary, Ascii } form = Form::Decimal;
  std::uint8_t characters = 0;  ///< of an ASCII constant: 1, 2 or 4

  bool operator==(const Integer&) const = default;
};

/// `1.0`, `-3.5E+4`
struct Real {
  float value = 0;
  bool operator==(const Real&) const = default;
};

enum class Size : std::uint8_t { None, Bit, Byte, Word, Double };

/// `VB100`, `I0.3`, `VX10.3`, `T33`, `AIW4`, `AC0`, `SMB30`: letters split into area and size. DBW10 is VW10.
struct Address {
  std::string area;          ///< upper case: I Q V M SM S L AI AQ T C HC AC; not yet checked against a CPU
  Size size = Size::None;    ///< as written; Bit when a bit number follows; Word for AI4 and AQ4, which are words anyway
  std::uint32_t number = 0;  ///< byte offset, or the number of a T, C, HC or AC
  std::uint8_t bit = 0;

  bool operator==(const Address&) const = default;
};

/// `&VB100`
struct AddressOf {
  Address target;
  bool operator==(const AddressOf&) const = default;
};

/// `*VD100`, `*AC1`
struct Indirect {
  Address pointer;
  bool operator==(const Indirect&) const = default;
};

/// Any other name: a symbol, `#local`. Kept for the message about it.
struct Name {
  std::string text;
  bool operator==(const Name&) const = default;
};

using OperandValue = std::variant<Integer, Real, Address, AddressOf, Indirect, Name>;

struct Operand {
  OperandValue value;
  Position position{};
};

/// One instruction. Labels, routine heads and block ends are instructions too (LBL, SBR, INT, MEND …).
struct Statement {
  std::string mnemonic;  ///< upper case
  Position position{};
  std::vector<Operand> operands;
  std::string comment;  ///< UTF-8, without the `//`, trimmed at the end
};

/// A line that holds no instruction: `NETWORK 3 // title`, a comment, or nothing.
struct NetworkHead {
  std::uint32_t number = 0;  ///< 0: not numbered
  Position position{};
  std::string comment;
};
struct CommentLine {
  std::string text;  ///< UTF-8, without the `//`, trimmed at the end
  std::uint32_t line = 0;
};
struct BlankLine {
  std::uint32_t line = 0;
};

using Line = std::variant<Statement, NetworkHead, CommentLine, BlankLine>;

struct Source : SourceLines {
  std::vector<Line> lines;  ///< what they mean, in order; unreadable lines are left out
};

/// Whether two sources differ only in comments, blank lines, positions and notation (K4 and 4, 16#FF and 255).
bool same_program(const Source& a, const Source& b);

}  // namespace s7200::stl

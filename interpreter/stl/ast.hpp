// STL source as it was written, before anything is known about instructions or CPUs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "interpreter/base/source.hpp"

namespace s7200::stl {

/// An integer: `4`, `-5`, `16#FF`, `2#1010`, `'AB'`, and in S7-Micro/DOS notation `K4`, `KHFF`.
struct Integer {
  std::int64_t value = 0;  ///< -2^31 … 2^32-1
  enum class Form : std::uint8_t { Decimal, Hex, Binary, Ascii } form = Form::Decimal;
  std::uint8_t characters = 0;  ///< of an ASCII constant: 1, 2 or 4

  bool operator==(const Integer&) const = default;
};

/// A real number: `1.0`, `-3.5E+4`
struct Real {
  float value = 0;
  bool operator==(const Real&) const = default;
};

enum class Size : std::uint8_t { None, Bit, Byte, Word, Double };

/// An address, with its letters split into area and size: `VB100`, `I0.3`, `VX10.3`, `T33`, `AIW4`, `AC0`, `SMB30`. DBW10 is
/// VW10.
struct Address {
  std::string area;          ///< upper case: I Q V M SM S L AI AQ T C HC AC; not yet checked against a CPU
  Size size = Size::None;    ///< as written; Bit when a bit number follows; Word for AI4 and AQ4, which are words anyway
  std::uint32_t number = 0;  ///< byte offset, or the number of a T, C, HC or AC
  std::uint8_t bit = 0;

  bool operator==(const Address&) const = default;
};

/// The address of an operand: `&VB100`
struct AddressOf {
  Address target;
  bool operator==(const AddressOf&) const = default;
};

/// An operand behind a pointer: `*VD100`, `*AC1`
struct Indirect {
  Address pointer;
  bool operator==(const Indirect&) const = default;
};

/// Any other name: a symbol, `#local`, `"Pump 1"`, with its & or * before it.
struct Name {
  std::string text;
  std::string reason{};  ///< why it does not stand for an address, if more can be said than that it is not defined
  bool operator==(const Name&) const = default;
};

using OperandValue = std::variant<Integer, Real, Address, AddressOf, Indirect, Name>;

struct Operand {
  OperandValue value;
  Position position{};
  std::string symbol{};  ///< the name that stands for the address, as written; empty if there is none
};

/// An instruction. Labels, routine heads and block ends are instructions too (LBL, SBR, INT, MEND …).
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

/// A variable of a block: `ptr : DWORD; // comment`, in the local memory of the block.
struct Variable {
  enum class Kind : std::uint8_t { Input, InOut, Output, Temporary };
  enum class Type : std::uint8_t { Bool, Byte, Char, Word, Int, DWord, DInt, Real, String };

  std::string name;
  Kind kind = Kind::Temporary;
  Type type = Type::Bool;
  Address address{};
  Position position{};
  std::string comment;
};

/// A block of a Micro/WIN export. What it does is in the lines, between its head and its end.
struct Block {
  enum class Kind : std::uint8_t { Main, Subroutine, Interrupt };

  Kind kind = Kind::Main;
  std::uint32_t number = 0;
  std::string name{};
  std::string title{};
  Position position{};
  std::uint32_t last_line = 0;
  std::vector<Variable> variables{};  ///< in the order of their kinds
};

/// A row of a symbol table.
struct Symbol {
  std::string name;
  std::optional<OperandValue> value;  ///< an address, a constant, or the Name of a block: SBR0, INT0, OB1
  Position position{};
  std::string comment;
};

/// Characters of a data block: `'AB'`, or `"AB"`, which has its length before it.
struct Text {
  std::string bytes;
  bool operator==(const Text&) const = default;
};

/// A line of a data block: `VW2 100, 200  // comment`, only values, which follow those of the line before, or only a
/// comment.
struct DataLine {
  struct Value {
    std::variant<Integer, Real, Text> value;
    Position position{};
  };

  std::optional<Operand> address;
  std::vector<Value> values;
  Position position{};
  std::string comment{};  ///< UTF-8, without the `//`, trimmed at the end

  bool only_comment() const { return !address && values.empty(); }
};

struct Source : SourceLines {
  std::vector<Line> lines;  ///< what they mean, in order; unreadable lines are left out
  std::vector<Block> blocks{};
  std::vector<Symbol> symbols{};
  std::vector<DataLine> data{};
};

/// Whether two sources differ only in comments, blank lines, positions and notation (K4 and 4, 16#FF and 255).
bool same_program(const Source& a, const Source& b);

}  // namespace s7200::stl

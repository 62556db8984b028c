// Headings of routines in listings: MAIN, SBR_0, INT_0, the names that Micro/WIN gives routines by itself.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/stl/parser.hpp"

namespace s7200::stl {

/// The main program, or subroutine or interrupt routine number `number`.
struct RoutineName {
  Block::Kind kind = Block::Kind::Main;
  std::uint32_t number = 0;

  bool operator==(const RoutineName&) const = default;
};

/// The routine that a default name stands for: `SBR_0`, `INT_12`, in any case. Nothing for other names, and for MAIN, which
/// nothing can call.
std::optional<RoutineName> default_routine(std::string_view name);

/// The routine whose heading a line is: `MAIN`, `SBR_0`, `INT_0:`, `MAIN (OB1)`, `SBR_0:SBR0`, `--- Subroutine 0 ---`, a
/// comment allowed after it. `SBR 0` is a statement, not a heading.
std::optional<RoutineName> routine_heading(std::string_view line);

/// The mnemonic of the statement that stands for the heading of the main program until put_main_program_first().
inline constexpr std::string_view kMainHeading = "MAIN";

/// The words of another language that a line begins with, `Unterprogramm`, and the kind of routine whose heading they are.
struct HeadingWords {
  std::size_t bytes = 0;
  Block::Kind kind = Block::Kind::Main;
};
std::optional<HeadingWords> foreign_heading(std::string_view line);

/// The name in a line that begins as the heading of a routine and ends in one: `SUBROUTINE Init`. Empty for any other line.
std::string_view name_in_heading(std::string_view line);

bool is_main_heading(const Statement& statement);

/// Reads like parse(), with the routines in the order of the text, and the heading of the main program as a statement.
ParseResult parse_lines(std::string_view text, std::string name);

/// Moves the main program before the other routines, wherever its heading stands, and makes a comment of the heading.
void put_main_program_first(ParseResult& listing);

}  // namespace s7200::stl

// A program in the strings of JSON, of a C or Python source, or of a log: its line ends are written as \n.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace s7200::stl {

struct ProgramInStrings {
  std::string text;
  std::string note;  ///< where it was, for the user
};

/// The program in the strings of a text. Returns nothing if the text has lines that are statements themselves, or no string
/// or several strings with a program.
std::optional<ProgramInStrings> program_in_strings(std::string_view text);

}  // namespace s7200::stl

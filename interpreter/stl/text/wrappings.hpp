// What a program stands in: <pre> of a page, CDATA of XML, a string over several lines, a here document, a block of YAML.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/stl/text/plain_page.hpp"

namespace s7200::stl::plain {

/// The part of each line that belongs to the program, and what it was cut out of.
struct Wrapped {
  std::vector<Part> parts{};
  Change change = kWrapping;
};

/// Whether something that holds a program may begin in a line.
bool may_open_wrapping(std::string_view line);

/// The program between such marks. Nothing if there are none, if statements stand outside of them, or if several of them
/// hold statements, unless all are <pre>.
std::optional<Wrapped> wrapped_program(const std::vector<std::string>& lines, bool html,
                                       const IsInstruction& is_instruction);

}  // namespace s7200::stl::plain

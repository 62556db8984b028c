// A statement of the program as a sentence names it.
#pragma once

#include <cstdint>
#include <string>

#include "interpreter/program/program.hpp"

namespace s7200 {

/// `LDW= AC0, 0`: in a sentence, not in a column.
std::string short_text(const stl::Statement& statement);

/// `  // not quiet yet`; nothing without a comment.
std::string comment_of(const stl::Statement& statement);

/// The number that a line of the program has in its own file, after that file's name if it is not the first: `12`,
/// `pump.awl:12`.
std::string line_number(std::uint32_t line, const Program& program);

/// The place of an instruction: `line 12`; of a file beside the program's own, `stand-in:modbus_slave.awl:230`.
std::string line_of(std::uint32_t op, const Program& program);

/// `ATCH 120, 10 in line 665`
std::string named_without_comment(std::uint32_t op, const Program& program);

/// `ATCH 120, 10 in line 665  // not quiet yet`: at the end of what is said.
std::string named_in_sentence(std::uint32_t op, const Program& program);

}  // namespace s7200

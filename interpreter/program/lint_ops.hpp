// What the warnings about a whole program ask of its ops: where they are written, and which memory they use.
//
// The program may have errors: of a statement with a wrong operand the operand is unread, and a statement that says nothing
// is an unread op. Both may be anything.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interpreter/program/program.hpp"

namespace s7200::lint {

const stl::Position& place(const Program& program, std::uint32_t op);
std::uint32_t line(const Program& program, std::uint32_t op);
/// An operand as it is written.
std::string written(const Program& program, std::uint32_t op, std::size_t operand);

/// A statement of which nothing is known: it may do anything to memory and leave its routine.
const Instruction& unread_instruction();
inline bool is_unread(const Op& op) { return op.instruction == &unread_instruction(); }
bool has_unread(const Program& program);

/// Bits of the image, numbered from its start.
struct Bits {
  std::uint64_t first = 0, count = 1;
  bool overlap(const Bits& other) const { return first < other.first + other.count && other.first < first + count; }
  bool contain(const Bits& other) const { return other.first >= first && other.first + other.count <= first + count; }
};

/// Of a direct operand in memory, as far as a block may reach.
Bits bits_of(const Program& program, const Op& op, std::size_t operand);

/// Whether a pointer may lead to these bits: to special and analog memory only if the program makes a pointer to it.
bool pointers_reach(const Program& program, const Bits& bits);

/// Whether any operand, or any written one, may overlap these bits.
bool touches(const Program& program, const Op& op, const Bits& bits, bool only_written);

std::vector<std::uint32_t> ops_with(const Program& program, Effect effect);
std::vector<std::uint32_t> attachments(const Program& program);

}  // namespace s7200::lint

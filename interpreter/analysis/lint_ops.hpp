// What the warnings about a whole program ask of its ops: where they are written, and which memory they use. The program may
// have errors (unread.hpp).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interpreter/program/program.hpp"
#include "interpreter/program/unread.hpp"

namespace s7200::lint {

const stl::Position& place(const Program& program, std::uint32_t op);
std::uint32_t line(const Program& program, std::uint32_t op);
/// An operand as it is written.
std::string written(const Program& program, std::uint32_t op, std::size_t operand);

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

// What the warnings about a whole program ask of its ops: where they are written, and which memory they use. The program may
// have errors (unread.hpp).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200::lint {

const stl::Position& place(const Program& program, std::uint32_t op);
std::uint32_t line(const Program& program, std::uint32_t op);
/// An operand as it is written.
std::string written(const Program& program, std::uint32_t op, std::size_t operand);

/// Whether a pointer may lead to these bits: to special and analog memory only if the program makes a pointer to it.
bool pointers_reach(const Program& program, const Bits& bits);

/// Whether an access that a pointer leads to counts as one of these bits.
bool is_meant(const Program& program, const MemoryAccess& access, const Bits& bits);

/// Whether an op may write some of these bits.
bool may_write(const Facts& facts, std::uint32_t op, const Bits& bits);

std::vector<std::uint32_t> ops_with(const Program& program, Effect effect);
std::vector<std::uint32_t> attachments(const Program& program);

}  // namespace s7200::lint

// Which bits of the image an instruction reads and writes: its operands, through pointers too, and what it changes besides.
//
// What an instruction may do counts with power flow; without it most do nothing. Not in the image, and so not here: the
// logic stack, ENO, the inputs of counters, queues and ports. What the system does between instructions is not an effect of
// any, but what RCV, NETR and NETW let it store counts as written by them, and what a subroutine hands back as written by
// its CALL and by its RET and CRET.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/analysis/effects/pointers.hpp"

namespace s7200 {

/// How certain an access is.
enum class Certainty : std::uint8_t {
  /// Each execution with power flow accesses all of these bits, unless it ends with a run-time error or one of the flags of
  /// kFailures. RTA with a size below 3, which it cannot write, clears fewer, and RCV that ends a reception writes nothing.
  Must,
  /// An execution accesses some of these bits, or none.
  May
};

/// Number of the operand of what is accessed besides the operands.
inline constexpr std::uint8_t kNoOperand = 0xFF;

struct MemoryAccess {
  Bits bits;
  Role role = Role::In;  ///< In: they are read; Out: written; InOut: some read, some written, some both
  Certainty certainty = Certainty::Must;
  std::uint8_t operand = kNoOperand;  ///< its number
  bool by_pointer = false;            ///< a pointer leads to them

  bool reads() const { return role != Role::Out; }
  bool writes() const { return role != Role::In; }
};

/// What op number `op` of a program accesses whenever it is executed: each bit that it reads is in an access that reads(),
/// each bit that it changes in one that writes(). Constants of the program are left out. The op may be unread
/// (program/loading/unread.hpp): then it may read and write anything. `pointers` are those of the program.
std::vector<MemoryAccess> effects_of(const Program& program, std::uint32_t op, const Pointers& pointers);

/// The same for an execution that finds the memory `image`: the counts and pointers in it are known. A pointer that points
/// nowhere leads to no access.
std::vector<MemoryAccess> effects_now(const Program& program, std::uint32_t op, std::span<const std::uint8_t> image);

/// The place of the pointer that leads op number `op` to an access, or of the word that says where in V its profile is; nothing
/// if none does, and for the parameters of a CALL.
std::optional<std::uint32_t> pointer_of(const Program& program, std::uint32_t op, const MemoryAccess& access);

/// How many bits an operand reaches at most from a place in the image.
std::uint64_t reach_of(const Program& program, const Op& op, std::size_t operand, std::uint32_t place);

/// The bits of a direct operand in memory, as far as it may reach.
Bits bits_of(const Program& program, const Op& op, std::size_t operand);

}  // namespace s7200

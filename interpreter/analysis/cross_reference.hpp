// The cross reference of a program: which instructions read and write each address, each constant, and what pointers reach.
//
// Addresses that overlap are one entry with its parts: VW99, VB100, V100.3. Blocks (BMB, FILL, S with a count), what XMT and
// RCV find in memory, and pointers do not join entries: they are listed with each entry that they may reach. Local memory is
// another one in each routine. Left out are SM1 and SM4.3, which nearly every instruction writes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"

namespace s7200 {

/// An access of an op, to memory as programs name it (memory_names.hpp).
struct Use {
  std::uint32_t op = 0;
  MemoryAccess access;
};

/// Memory that overlaps.
struct ReferenceEntry {
  Bits bits;                             ///< from the first to the last of it
  std::optional<std::uint32_t> routine;  ///< of local memory: in ControlFlow::routines
  std::vector<Bits> parts;               ///< as operands name it, in order; a part that holds others comes first
  std::vector<Use> uses;                 ///< of the parts, by op
  std::vector<Use> reached;              ///< of blocks and pointers that may reach it, by op
  std::vector<std::string> symbols;      ///< names of the program for parts of it
};

/// A pointer that instructions go through, and what they may reach.
struct PointerEntry {
  std::uint32_t at = 0;                      ///< its place in the image
  std::optional<std::uint32_t> routine;      ///< of one in local memory
  std::vector<Bits> targets;                 ///< what it may lead to, for all its uses
  std::optional<Pointers::Unknown> unknown;  ///< why it may lead anywhere
  std::vector<std::uint32_t> ops;            ///< that go through it
};

/// A constant that instructions use.
struct ConstantEntry {
  struct Place {
    std::uint32_t op = 0;
    std::uint8_t operand = 0;
  };
  std::string text;  ///< as written the first time: 16#FF, 100, 1.5, &VB100
  std::vector<Place> places;
};

struct CrossReference {
  std::vector<ReferenceEntry> entries;  ///< by area (I, Q, AI, AQ, V, M, SM, S, T, C, HC, AC, L), then by address
  std::vector<PointerEntry> pointers;
  std::vector<ConstantEntry> constants;     ///< integers by value, then the others
  std::vector<std::string> unused_symbols;  ///< that stand for memory no instruction uses
  std::vector<std::uint32_t> unread;        ///< ops of which nothing is known, in a program with errors
};

CrossReference cross_reference(const Facts& facts);

/// How far a program uses an entry by itself. Inputs and outputs and the like are used by the CPU and the field, too.
enum class Usage : std::uint8_t {
  Both,
  NeverRead,
  NeverWritten,
  SetByData,   ///< by the data block, and by no instruction
  OnlyChanged  ///< counted, shifted or set in place, but nothing else looks at it
};
/// Only for memory that nothing but the program writes: V, M, S, T and C, bits for which no pointer is in question.
Usage usage_of(const Program& program, const ReferenceEntry& entry);

/// Whether an access through a pointer may be anywhere in an area.
bool is_anywhere(const Program& program, const MemoryAccess& access);

}  // namespace s7200

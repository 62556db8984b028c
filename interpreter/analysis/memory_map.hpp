// What a program uses of each memory area and what it leaves free, its timers and counters, and what its data block sets.
//
// Used is what instructions name, with the blocks that they copy or fill as far as these may reach. Where pointers lead is
// told apart from it: a pointer that may lead anywhere would use all of an area. Free is what neither uses.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interpreter/analysis/cross_reference.hpp"

namespace s7200 {

struct MemoryMap {
  /// Memory without a gap.
  struct Used {
    Bits bits;
    std::vector<std::uint32_t> routines;  ///< that use it, in ControlFlow::routines
    bool by_data = false;                 ///< the data block sets some of it
  };
  /// A pointer, and an op that goes through it.
  struct Through {
    std::uint32_t op = 0, at = 0;  ///< `at`: the pointer's place in the image

    bool operator==(const Through&) const = default;
  };
  /// Memory that no instruction names, but that may be used through pointers.
  struct Perhaps {
    std::vector<Bits> bits;        ///< by address
    std::vector<Through> through;  ///< by op
  };
  struct AreaUse {
    Area area{};
    std::optional<std::uint32_t> routine;  ///< of local memory
    Bits all;                              ///< what the CPU has
    std::vector<Used> used;                ///< by address
    std::vector<Used> idle;                ///< that part of it which only routines name that are never executed
    std::vector<Perhaps> perhaps;          ///< by address
    std::vector<Bits> free, retentive;     ///< by address
    std::vector<std::size_t> pointers;     ///< that may reach it: in CrossReference::pointers
  };
  /// A timer or a counter that an instruction runs.
  struct Element {
    std::uint32_t number = 0;
    std::uint32_t op = 0;
    std::optional<std::int32_t> preset;  ///< if it is a constant
  };
  /// Bytes that the data block sets.
  struct Data {
    Bits bits;
    std::vector<std::uint32_t> writers;  ///< ops that name some of them and write
  };

  std::vector<AreaUse> areas;             ///< those that the program uses, in the order of the cross reference
  std::vector<Element> timers, counters;  ///< by number
  std::vector<Data> data;
  std::vector<std::uint32_t> savers;  ///< ops that write SMB31, and so may save V memory to EEPROM
};

MemoryMap memory_map(const Facts& facts, const CrossReference& reference);

}  // namespace s7200

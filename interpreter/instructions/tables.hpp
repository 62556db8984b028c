// Bodies: tables (facts 6.10). A table is its length in entries, the number of entries in it, and the entries: all words.
//
// The manual does not say what is left in the place that FIFO or LIFO vacates (xxxx in its figures: C233-01, 9-109). Here
// it keeps its value.
//
// Not documented, modelled so:
// - A table with a length of 0 or above 100, or with more entries than its length, is range error 0091.
//   [Vectors.ATT, Vectors.FIFO]
// - ATT takes the time of the entries even if the table is full. [Vectors.ATT]
// - FIFO and LIFO write DATA last, which shows if DATA is inside the table. [Vectors.FIFO, Vectors.LIFO]
#pragma once

#include "interpreter/instructions/compare.hpp"

namespace s7200::bodies {

inline constexpr std::uint32_t kLongestTable = 100;

/// Length, number of entries, and where they are.
struct TableView {
  std::uint32_t length, count;
  std::uint32_t count_at, entries_at;

  std::uint8_t* entry(Core& core, std::uint32_t i) const { return &core.s.image[entries_at + 2 * i]; }
};

/// The table at `at`; reports a range error and returns nothing if there is none.
inline std::optional<TableView> table_at(Core& core, std::uint32_t at) {
  if (core.in_area(at, 4)) {
    const TableView table{load16(&core.s.image[at]), load16(&core.s.image[at + 2]), at + 2, at + 4};
    const bool fits = table.length >= 1 && table.length <= kLongestTable && core.in_area(at, 4 + 2 * table.length);
    if (fits && table.count <= table.length) return table;
  }
  core.run_error(RunError::OperandRange);
  return {};
}

/// ATT DATA, TBL
inline void add_to_table(Core& core, const Op& op) {
  const auto table = table_at(core, op[1].at);
  if (!table) return;
  core.spend(op, table->count);
  if (table->count == table->length) return core.set_flags(kTableFull, kTableFull);
  store16(table->entry(core, table->count), core.get<std::uint16_t>(op[0]));
  store16(&core.s.image[table->count_at], static_cast<std::uint16_t>(table->count + 1));
  core.set_flags(kTableFull, 0);
}

/// FIFO TBL, DATA and LIFO TBL, DATA
template <bool first>
void take_from_table(Core& core, const Op& op) {
  const auto table = table_at(core, op[0].at);
  if (!table) return;
  core.spend(op, table->count);
  if (table->count == 0) return core.set_flags(kTableEmpty, kTableEmpty);
  const std::uint32_t last = table->count - 1;
  const std::uint16_t value = load16(table->entry(core, first ? 0 : last));
  if (first) std::memmove(table->entry(core, 0), table->entry(core, 1), 2 * last);
  store16(&core.s.image[table->count_at], static_cast<std::uint16_t>(last));
  core.put(op[1], value);
  core.set_flags(kTableEmpty, 0);
}

/// FND SRC, PATRN, INDX: SRC is the number of entries; the entries follow it. Searches from INDX; INDX is then the entry
/// found, or the number of entries.
template <Relation relation>
void find_in_table(Core& core, const Op& op) {
  const std::uint32_t count = core.get<std::uint16_t>(op[0]);
  if (count > kLongestTable || !core.in_area(op[0].at, 2 + 2 * count)) return core.run_error(RunError::OperandRange);
  const auto pattern = core.get<std::int16_t>(op[1]);
  const std::uint32_t from = core.get<std::uint16_t>(op[2]);
  std::uint32_t i = from, looked_at = 0;
  bool found = false;
  for (; i < count && !found; ++i, ++looked_at)
    found = holds(relation, static_cast<std::int16_t>(load16(&core.s.image[op[0].at + 2 + 2 * i])), pattern);
  core.spend(op, looked_at);
  core.put(op[2], static_cast<std::uint16_t>(found ? i - 1 : count));
}

}  // namespace s7200::bodies

// Facts 6.10: a table is its length TL, its count of entries EC, then the entries.
#include "tests/reference_model/instructions.hpp"
#include "tests/reference_model/values.hpp"

namespace s7200::reference {
namespace {

struct Table {
  Place length, count, entries;

  Place entry(std::size_t i) const { return {entries.bytes, entries.at + 2 * i}; }
};

Table table_at(const Place& place) {
  if (!holds(place, 4)) throw RunTimeError{0x91};
  const std::size_t length = read(place, 2);
  if (length < 1 || length > 100 || !holds(place, 4 + 2 * length)) throw RunTimeError{0x91};
  if (read(Place{place.bytes, place.at + 2}, 2) > length) throw RunTimeError{0x91};
  return {place, {place.bytes, place.at + 2}, {place.bytes, place.at + 4}};
}

void add_to_table(Machine& m) {
  const std::uint32_t data = m.in(0, 2);
  const Table table = table_at(m.place(1, 2));
  const std::uint32_t length = read(table.length, 2), count = read(table.count, 2);
  const bool full = count == length;
  if (!full) {
    write(table.entry(count), 2, data);
    write(table.count, 2, count + 1);
  }
  set_flag(m, kTableFull, full);
  m.spend_units(count);
}

/// The number of entries of a table to take one from; 0 sets the flag.
std::uint32_t count_to_take_from(Machine& m, const Table& table) {
  const std::uint32_t count = read(table.count, 2);
  set_flag(m, kTableEmpty, count == 0);
  m.spend_units(count);
  return count;
}

void first_in_first_out(Machine& m) {
  const Place place = m.place(0, 2), data = m.place(1, 2);
  const Table table = table_at(place);
  const std::uint32_t count = count_to_take_from(m, table);
  if (count == 0) return;
  const std::uint32_t taken = read(table.entry(0), 2);
  for (std::size_t i = 0; i + 1 < count; ++i) write(table.entry(i), 2, read(table.entry(i + 1), 2));
  write(table.count, 2, count - 1);
  write(data, 2, taken);  // last, because it may be inside the table
}

void last_in_first_out(Machine& m) {
  const Place place = m.place(0, 2), data = m.place(1, 2);
  const Table table = table_at(place);
  const std::uint32_t count = count_to_take_from(m, table);
  if (count == 0) return;
  const std::uint32_t taken = read(table.entry(count - 1), 2);
  write(table.count, 2, count - 1);
  write(data, 2, taken);
}

bool matches(const std::string& relation, std::int32_t entry, std::int32_t pattern) {
  if (relation == "=") return entry == pattern;
  if (relation == "<>") return entry != pattern;
  if (relation == "<") return entry < pattern;
  return entry > pattern;
}

void find(Machine& m, const std::string& relation) {
  const Place source = m.place(0, 2), index = m.place(2, 2);
  const std::int32_t pattern = signed16(m.in(1, 2));
  const std::uint32_t count = read(source, 2);
  if (count > 100 || !holds(source, 2 + 2 * count)) throw RunTimeError{0x91};
  std::uint32_t looked_at = 0, found = count;
  for (std::uint32_t i = read(index, 2); i < count && found == count; ++i) {
    ++looked_at;
    if (matches(relation, signed16(read(Place{source.bytes, source.at + 2 + 2 * i}, 2)), pattern)) found = i;
  }
  write(index, 2, found);
  m.spend_units(looked_at);
}

}  // namespace

void add_tables(Instructions& all) {
  all["ATT"] = {true, add_to_table};
  all["FIFO"] = {true, first_in_first_out};
  all["LIFO"] = {true, last_in_first_out};
  for (const std::string relation : {"=", "<>", "<", ">"})
    all["FND" + relation] = {true, [=](Machine& m) { find(m, relation); }};
}

}  // namespace s7200::reference

// Facts 6.5: move, block move, fill, swap.
#include "tests/reference_model/instructions.hpp"

namespace s7200::reference {
namespace {

void move(Machine& m, std::size_t width) {
  const std::uint32_t value = m.in(0, width);
  write(m.place(1, width), width, value);
}

std::size_t count_of(Machine& m) {
  const std::size_t count = m.in(2, 1);
  if (count == 0) throw RunTimeError{0x92};
  return count;
}

void move_block(Machine& m, std::size_t width) {
  const Place from = m.place(0, width), to = m.place(1, width);
  const std::size_t count = count_of(m);
  if (!holds(from, count * width) || !holds(to, count * width)) throw RunTimeError{0x91};
  Bytes copy;
  for (std::size_t i = 0; i < count * width; ++i) copy.push_back(from.bytes->at(from.at + i));
  for (std::size_t i = 0; i < copy.size(); ++i) to.bytes->at(to.at + i) = copy[i];
  m.spend_units(static_cast<std::uint32_t>(count));
}

void fill(Machine& m) {
  const std::uint32_t value = m.in(0, 2);
  const Place to = m.place(1, 2);
  const std::size_t count = count_of(m);
  if (!holds(to, 2 * count)) throw RunTimeError{0x91};
  for (std::size_t i = 0; i < count; ++i) write(Place{to.bytes, to.at + 2 * i}, 2, value);
  m.spend_units(static_cast<std::uint32_t>(count));
}

void swap(Machine& m) {
  const Place word = m.place(0, 2);
  const std::uint32_t value = read(word, 2);
  write(word, 2, value >> 8 | value << 8);
}

}  // namespace

void add_moves(Instructions& all) {
  all["MOVB"] = {true, [](Machine& m) { move(m, 1); }};
  all["MOVW"] = {true, [](Machine& m) { move(m, 2); }};
  all["MOVD"] = {true, [](Machine& m) { move(m, 4); }};
  all["MOVR"] = {true, [](Machine& m) { move(m, 4); }};
  all["BMB"] = {true, [](Machine& m) { move_block(m, 1); }};
  all["BMW"] = {true, [](Machine& m) { move_block(m, 2); }};
  all["FILL"] = {true, fill};
  all["SWAP"] = {true, swap};
}

}  // namespace s7200::reference

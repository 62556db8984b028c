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

/// The eight points of a byte of their image.
Place points_of(const Place& byte, const Bytes& image, Bytes& points) {
  if (byte.bytes != &image) throw RunTimeError{0x91};
  return {&points, byte.at};
}

void read_points(Machine& m) {
  const Place from = m.place(0, 1), to = m.place(1, 1);
  write(to, 1, read(points_of(from, m.memory.I, m.memory.input_points), 1));
}

void write_points(Machine& m) {
  const std::uint32_t value = m.in(0, 1);
  const Place to = m.place(1, 1);
  write(points_of(to, m.memory.Q, m.memory.output_points), 1, value);
  write(to, 1, value);
}

void fill(Machine& m) {
  const std::uint32_t value = m.in(0, 2);
  const Place to = m.place(1, 2);
  const std::size_t count = count_of(m);
  if (!holds(to, 2 * count)) throw RunTimeError{0x91};
  for (std::size_t i = 0; i < count; ++i) write(Place{to.bytes, to.at + 2 * i}, 2, value);
  m.spend_units(static_cast<std::uint32_t>(count));
}

std::uint32_t milliseconds(const Machine& m) { return static_cast<std::uint32_t>(m.time / 1'000'000); }

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
  all["BMD"] = {true, [](Machine& m) { move_block(m, 4); }};
  all["BIR"] = {true, read_points};
  all["BIW"] = {true, write_points};
  all["BITIM"] = {true, [](Machine& m) { write(m.place(0, 4), 4, milliseconds(m)); }};
  all["CITIM"] = {true, [](Machine& m) {
                    const std::uint32_t since = m.in(0, 4);
                    write(m.place(1, 4), 4, milliseconds(m) - since);
                  }};
  all["FILL"] = {true, fill};
  all["SWAP"] = {true, swap};
}

}  // namespace s7200::reference

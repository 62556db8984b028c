// Facts 6.8: shifts clamp their count, rotates take it modulo the width; one bit at a time. SHRB.
#include <algorithm>
#include <cstdlib>

#include "tests/reference_model/instructions.hpp"
#include "tests/reference_model/values.hpp"

namespace s7200::reference {
namespace {

/// A value as its bits, number 0 first.
std::vector<bool> bits_of(std::uint32_t value, std::size_t width) {
  std::vector<bool> bits(8 * width);
  for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = (value >> i) & 1;
  return bits;
}

std::uint32_t value_of(const std::vector<bool>& bits) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bits.size(); ++i)
    if (bits[i]) value |= 1u << i;
  return value;
}

/// Moves all bits one place up, `enters` at the bottom; returns what leaves at the top.
bool move_up(std::vector<bool>& bits, bool enters) {
  const bool leaves = bits.back();
  bits.insert(bits.begin(), enters);
  bits.pop_back();
  return leaves;
}

bool move_down(std::vector<bool>& bits, bool enters) {
  const bool leaves = bits.front();
  bits.erase(bits.begin());
  bits.push_back(enters);
  return leaves;
}

void shift(Machine& m, std::size_t width, bool left) {
  const Place out = m.place(0, width);
  const std::uint32_t count = std::min(m.in(1, 1), static_cast<std::uint32_t>(8 * width));
  std::vector<bool> bits = bits_of(read(out, width), width);
  bool last = false;
  for (std::uint32_t i = 0; i < count; ++i) last = left ? move_up(bits, false) : move_down(bits, false);
  write(out, width, value_of(bits));
  set_flag(m, kZero, value_of(bits) == 0);
  if (count > 0) set_flag(m, kOverflow, last);
  m.spend_units(count);
}

void rotate(Machine& m, std::size_t width, bool left) {
  const Place out = m.place(0, width);
  const std::uint32_t count = m.in(1, 1) % static_cast<std::uint32_t>(8 * width);
  std::vector<bool> bits = bits_of(read(out, width), width);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (left)
      move_up(bits, bits.back());
    else
      move_down(bits, bits.front());
  }
  write(out, width, value_of(bits));
  set_flag(m, kZero, value_of(bits) == 0);
  if (count > 0) set_flag(m, kOverflow, left ? bits.front() : bits.back());  // where the bit that went round came in
  m.spend_units(count);
}

void shift_register(Machine& m) {
  const bool data = read(m.bit(0));
  const int n = static_cast<std::int8_t>(m.in(2, 1));
  if (n == 0 || n > 64 || n < -64) throw RunTimeError{0x92};
  const auto count = static_cast<std::size_t>(std::abs(n));
  const BitPlace first = m.bit(1);
  if (first.number + count > 8 * first.bytes->size()) throw RunTimeError{0x91};
  std::vector<bool> bits(count);
  for (std::size_t i = 0; i < count; ++i) bits[i] = read(BitPlace{first.bytes, first.number + i});
  const bool out = n > 0 ? move_up(bits, data) : move_down(bits, data);
  for (std::size_t i = 0; i < count; ++i) write(BitPlace{first.bytes, first.number + i}, bits[i]);
  set_flag(m, kOverflow, out);
  m.spend_units(static_cast<std::uint32_t>(count));
}

}  // namespace

void add_shifts(Instructions& all) {
  all["SLW"] = {true, [](Machine& m) { shift(m, 2, true); }};
  all["SRW"] = {true, [](Machine& m) { shift(m, 2, false); }};
  all["SLD"] = {true, [](Machine& m) { shift(m, 4, true); }};
  all["SRD"] = {true, [](Machine& m) { shift(m, 4, false); }};
  all["RLW"] = {true, [](Machine& m) { rotate(m, 2, true); }};
  all["RRW"] = {true, [](Machine& m) { rotate(m, 2, false); }};
  all["RLD"] = {true, [](Machine& m) { rotate(m, 4, true); }};
  all["RRD"] = {true, [](Machine& m) { rotate(m, 4, false); }};
  all["SLB"] = {true, [](Machine& m) { shift(m, 1, true); }};
  all["SRB"] = {true, [](Machine& m) { shift(m, 1, false); }};
  all["RLB"] = {true, [](Machine& m) { rotate(m, 1, true); }};
  all["RRB"] = {true, [](Machine& m) { rotate(m, 1, false); }};
  all["SHRB"] = {true, shift_register};
}

}  // namespace s7200::reference

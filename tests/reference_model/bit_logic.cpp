// Facts 6.2: contacts, stack operations, edges, coils, set and reset.
#include "tests/reference_model/instructions.hpp"

namespace s7200::reference {
namespace {

/// Edge memory of an EU or ED, which starts as if there had been no edge.
bool& remembered(Machine& m, bool initial) { return m.edge_memory.emplace(m.position, initial).first->second; }

void edge_up(Machine& m) {
  bool& before = remembered(m, true);
  const bool now = m.stack[0];
  m.stack[0] = now && !before;
  before = now;
}

void edge_down(Machine& m) {
  bool& before = remembered(m, false);
  const bool now = m.stack[0];
  m.stack[0] = !now && before;
  before = now;
}

void and_load(Machine& m) {
  const bool result = m.stack[0] && m.stack[1];
  m.pop();
  m.stack[0] = result;
}

void or_load(Machine& m) {
  const bool result = m.stack[0] || m.stack[1];
  m.pop();
  m.stack[0] = result;
}

void coil(Machine& m) { write(m.bit(0), m.stack[0]); }

void immediate_coil(Machine& m) {
  write(m.bit(0), m.stack[0]);
  write(m.point(0), m.stack[0]);
}

/// N bits from the first on, checked to exist.
std::size_t count_of_bits(Machine& m) {
  const std::size_t count = m.in(1, 1);
  if (count == 0) throw RunTimeError{0x92};
  const BitPlace first = m.bit(0);
  if (first.number + count > 8 * first.bytes->size()) throw RunTimeError{0x91};
  return count;
}

void write_bits(BitPlace bit, std::size_t count, bool value) {
  for (std::size_t i = 0; i < count; ++i, ++bit.number) write(bit, value);
}

void set(Machine& m, std::size_t count, bool value) {
  write_bits(m.bit(0), count, value);
  m.spend_units(static_cast<std::uint32_t>(count));
}

void reset(Machine& m) {
  const std::size_t count = count_of_bits(m);
  const stl::Address& first = m.address(0);
  const bool numbered = first.size == stl::Size::None;  // T33, C4
  for (std::size_t i = 0; numbered && i < count; ++i) {
    const std::size_t number = first.number + i;
    write(Place{first.area == "T" ? &m.memory.T : &m.memory.C, 2 * number}, 2, 0);
    if (first.area != "T") continue;
    if (m.timers[number].off_delay || !is_100_ms(number)) m.timers[number].enabled = false;  // facts 9.1
    m.timers[number].input = false;
  }
  set(m, count, false);
}

void set_immediate(Machine& m, bool value) {
  const std::size_t count = count_of_bits(m);
  write_bits(m.point(0), count, value);
  set(m, count, value);
}

}  // namespace

void add_bit_logic(Instructions& all) {
  all["LD"] = {false, [](Machine& m) { m.push(m.rail && read(m.bit(0))); }};
  all["LDN"] = {false, [](Machine& m) { m.push(m.rail && !read(m.bit(0))); }};
  all["LDI"] = {false, [](Machine& m) { m.push(m.rail && read(m.point(0))); }};
  all["LDNI"] = {false, [](Machine& m) { m.push(m.rail && !read(m.point(0))); }};
  all["A"] = {false, [](Machine& m) { m.stack[0] = m.stack[0] && read(m.bit(0)); }};
  all["AN"] = {false, [](Machine& m) { m.stack[0] = m.stack[0] && !read(m.bit(0)); }};
  all["AI"] = {false, [](Machine& m) { m.stack[0] = m.stack[0] && read(m.point(0)); }};
  all["ANI"] = {false, [](Machine& m) { m.stack[0] = m.stack[0] && !read(m.point(0)); }};
  all["O"] = {false, [](Machine& m) { m.stack[0] = m.stack[0] || (m.rail && read(m.bit(0))); }};
  all["ON"] = {false, [](Machine& m) { m.stack[0] = m.stack[0] || (m.rail && !read(m.bit(0))); }};
  all["OI"] = {false, [](Machine& m) { m.stack[0] = m.stack[0] || (m.rail && read(m.point(0))); }};
  all["ONI"] = {false, [](Machine& m) { m.stack[0] = m.stack[0] || (m.rail && !read(m.point(0))); }};
  all["NOT"] = {false, [](Machine& m) { m.stack[0] = !m.stack[0]; }};
  all["EU"] = {false, edge_up};
  all["ED"] = {false, edge_down};
  all["ALD"] = {false, and_load};
  all["OLD"] = {false, or_load};
  all["LPS"] = {false, [](Machine& m) { m.push(m.stack[0]); }};
  all["LRD"] = {false, [](Machine& m) { m.stack[0] = m.stack[1]; }};
  all["LPP"] = {false, [](Machine& m) { m.pop(); }};
  all["LDS"] = {false, [](Machine& m) { m.push(m.stack[m.number(0)]); }};
  all["AENO"] = {false, [](Machine& m) { m.stack[0] = m.stack[0] && m.eno; }};
  all["="] = {false, coil};
  all["=I"] = {false, immediate_coil};
  all["S"] = {true, [](Machine& m) { set(m, count_of_bits(m), true); }};
  all["R"] = {true, reset};
  all["SI"] = {true, [](Machine& m) { set_immediate(m, true); }};
  all["RI"] = {true, [](Machine& m) { set_immediate(m, false); }};
  all["NOP"] = {false, [](Machine&) {}};
}

}  // namespace s7200::reference

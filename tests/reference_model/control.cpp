// Facts 6.12 and 4.6: jumps, loops, subroutines, SCR segments, ends; of the interrupts only what shows without one.
#include "tests/reference_model/instructions.hpp"
#include "tests/reference_model/values.hpp"

namespace s7200::reference {
namespace {

constexpr std::size_t kCallDepth = 8;

void jump(Machine& m) {
  m.stack[0] = true;
  m.next = m.find_label(m.number(0));
}

/// FINAL, found now (a bad pointer shows before anything is done) but read only when needed: it may overlap INDX.
std::function<std::int32_t()> final_value(Machine& m, const stl::Operand& operand) {
  if (std::holds_alternative<stl::Integer>(operand.value)) return [&] { return signed16(m.value_of(operand, 2)); };
  return [place = m.place_of(operand, 2)] { return signed16(read(place, 2)); };
}

void begin_loop(Machine& m) {
  const Place index = m.place(0, 2);
  const std::uint32_t initial = m.in(1, 2);
  const auto last = final_value(m, m.statement().operands[2]);
  write(index, 2, initial);
  if (signed16(initial) > last()) m.next = m.find_next(m.position) + 1;
}

/// NEXT works on the operands of its FOR.
void next_pass(Machine& m) {
  const std::size_t head = m.find_for(m.position);
  const auto& operands = m.statements()[head].operands;
  const Place index = m.place_of(operands[0], 2);
  m.value_of(operands[1], 2);
  const auto last = final_value(m, operands[2]);
  const std::uint32_t before = read(index, 2);
  write(index, 2, before + 1);
  m.stack[0] = true;
  if (signed16(before) < last()) m.next = head + 1;
}

void call(Machine& m) {
  if (m.calls.size() == kCallDepth) throw RunTimeError{0x08};
  m.calls.push_back({m.next, m.stack, m.rail});
  m.stack = {true};
  m.rail = true;
  m.enter_level(m.calls.size());
  m.next = m.find_subroutine(m.number(0));
}

void return_to_caller(Machine& m) {
  m.stack = m.calls.back().stack;
  m.rail = m.calls.back().rail;
  m.next = m.calls.back().return_to;
  m.calls.pop_back();
  m.enter_level(m.calls.size());
  m.eno = true;
}

/// Facts 9.1: the segment always runs; without power on its rail its contacts give no power flow.
void load_segment(Machine& m) {
  m.rail = read(m.bit(0));
  m.push(m.rail);
}

/// A transition to the segment that it is in leaves that segment on.
void segment_transition(Machine& m) {
  const auto& own = std::get<stl::Address>(m.statements()[m.find_lscr(m.position)].operands[0].value);
  write(BitPlace{&m.memory.S, std::size_t{8} * own.number + own.bit}, false);
  write(m.bit(0), true);
}

/// On to the SCRE.
void leave_segment(Machine& m) {
  while (m.statements()[m.next].mnemonic != "SCRE") ++m.next;
}

void nothing(Machine&) {}

}  // namespace

void add_control(Instructions& all) {
  all["JMP"] = {true, jump};
  all["LBL"] = {false, nothing};
  all["FOR"] = {true, begin_loop};
  all["NEXT"] = {false, next_pass};
  all["CALL"] = {true, call};
  all["SBR"] = {false, nothing};
  all["RET"] = {false, return_to_caller};
  all["CRET"] = {true, return_to_caller};
  all["END"] = {true, [](Machine& m) { m.end_program(); }};
  all["MEND"] = {false, [](Machine& m) { m.end_program(); }};
  all["STOP"] = {true, [](Machine& m) { m.stop(); }};
  all["WDR"] = {true, [](Machine& m) { m.restart_watchdog(); }};
  all["LSCR"] = {false, load_segment};
  all["SCRT"] = {true, segment_transition};
  all["CSCRE"] = {true, leave_segment};
  all["SCRE"] = {false, [](Machine& m) { m.rail = true; }};
  all["ENI"] = {true, [](Machine& m) { m.enable_interrupts(true); }};
  all["DISI"] = {true, [](Machine& m) { m.enable_interrupts(false); }};
  all["ATCH"] = {true, nothing};
  all["DTCH"] = {true, nothing};
  all["INT"] = {false, nothing};
  all["RETI"] = {false, nothing};
}

}  // namespace s7200::reference

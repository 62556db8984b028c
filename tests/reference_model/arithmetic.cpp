// Facts 6.6 and 6.7: integer and real arithmetic, logic operations.
#include <cmath>

#include "tests/reference_model/instructions.hpp"
#include "tests/reference_model/values.hpp"

namespace s7200::reference {
namespace {

/// Stores a result of 16 or 32 bits, wrapped if it does not fit: the rule of the CPUs 21x.
void store_sum(Machine& m, const Place& out, std::size_t width, std::int64_t sum) {
  const auto bits = static_cast<std::uint32_t>(static_cast<std::uint64_t>(sum));
  const std::int64_t stored = width == 2 ? signed16(bits) : signed32(bits);
  write(out, width, bits);
  set_flag(m, kZero, stored == 0);
  set_flag(m, kOverflow, stored != sum);
  set_flag(m, kNegative, stored < 0);
}

std::int64_t signed_value(std::uint32_t bits, std::size_t width) { return width == 2 ? signed16(bits) : signed32(bits); }

void add(Machine& m, std::size_t width, int sign) {
  const std::int64_t in1 = signed_value(m.in(0, width), width);
  const Place out = m.place(1, width);
  store_sum(m, out, width, signed_value(read(out, width), width) + sign * in1);
}

void increment(Machine& m, std::size_t width, int by) {
  const Place out = m.place(0, width);
  store_sum(m, out, width, signed_value(read(out, width), width) + by);
}

void multiply(Machine& m) {
  const std::int64_t in1 = signed16(m.in(0, 2));
  const Place out = m.place(1, 4);
  store_sum(m, out, 4, in1 * signed16(read(out, 4) & 0xFFFF));
  set_flag(m, kDivisionByZero, false);
}

void divide(Machine& m) {
  const std::int32_t divisor = signed16(m.in(0, 2));
  const Place out = m.place(1, 4);
  const std::int32_t dividend = signed16(read(out, 4) & 0xFFFF);
  set_flag(m, kDivisionByZero, divisor == 0);
  if (divisor == 0) return;
  const std::int32_t quotient = dividend / divisor, remainder = dividend % divisor;
  const auto low = static_cast<std::uint32_t>(quotient) & 0xFFFF, high = static_cast<std::uint32_t>(remainder) & 0xFFFF;
  write(out, 4, high << 16 | low);
  set_flag(m, kZero, quotient == 0);
  set_flag(m, kOverflow, quotient > 32767);
  set_flag(m, kNegative, signed16(low) < 0);
}

// --- reals ---

void store_real(Machine& m, const Place& out, bool legal, float result) {
  legal = legal && std::isfinite(result);
  if (legal) write(out, 4, std::bit_cast<std::uint32_t>(result));
  set_flag(m, kZero, legal && result == 0.0f);
  set_flag(m, kOverflow, !legal);
  set_flag(m, kNegative, legal && result < 0.0f);
}

float calculate(char operation, float out, float in1) {
  switch (operation) {
    case '+':
      return out + in1;
    case '-':
      return out - in1;
    case '*':
      return out * in1;
    default:
      return out / in1;
  }
}

void real_operation(Machine& m, char operation) {
  const float in1 = real(m.in(0, 4));
  const Place out = m.place(1, 4);
  const float before = real(read(out, 4));
  if (operation == '/') {
    set_flag(m, kDivisionByZero, in1 == 0.0f);
    if (in1 == 0.0f) return;
  }
  store_real(m, out, std::isfinite(in1) && std::isfinite(before), calculate(operation, before, in1));
}

void square_root(Machine& m) {
  const float in = real(m.in(0, 4));
  const Place out = m.place(1, 4);
  const bool legal = std::isfinite(in) && !(in < 0.0f);
  store_real(m, out, legal, legal ? std::sqrt(in) : 0.0f);
}

// --- logic ---

void store_logic(Machine& m, const Place& out, std::size_t width, std::uint32_t result) {
  write(out, width, result);
  set_flag(m, kZero, read(out, width) == 0);
}

void combine(Machine& m, std::size_t width, char operation) {
  const std::uint32_t in1 = m.in(0, width);
  const Place out = m.place(1, width);
  const std::uint32_t before = read(out, width);
  store_logic(m, out, width, operation == '&' ? before & in1 : operation == '|' ? before | in1 : before ^ in1);
}

void invert(Machine& m, std::size_t width) {
  const Place out = m.place(0, width);
  store_logic(m, out, width, ~read(out, width));
}

}  // namespace

void add_arithmetic(Instructions& all) {
  all["+I"] = {true, [](Machine& m) { add(m, 2, 1); }};
  all["-I"] = {true, [](Machine& m) { add(m, 2, -1); }};
  all["+D"] = {true, [](Machine& m) { add(m, 4, 1); }};
  all["-D"] = {true, [](Machine& m) { add(m, 4, -1); }};
  all["INCW"] = {true, [](Machine& m) { increment(m, 2, 1); }};
  all["DECW"] = {true, [](Machine& m) { increment(m, 2, -1); }};
  all["INCD"] = {true, [](Machine& m) { increment(m, 4, 1); }};
  all["DECD"] = {true, [](Machine& m) { increment(m, 4, -1); }};
  all["MUL"] = {true, multiply};
  all["DIV"] = {true, divide};
  all["+R"] = {true, [](Machine& m) { real_operation(m, '+'); }};
  all["-R"] = {true, [](Machine& m) { real_operation(m, '-'); }};
  all["*R"] = {true, [](Machine& m) { real_operation(m, '*'); }};
  all["/R"] = {true, [](Machine& m) { real_operation(m, '/'); }};
  all["SQRT"] = {true, square_root};
  all["ANDW"] = {true, [](Machine& m) { combine(m, 2, '&'); }};
  all["ORW"] = {true, [](Machine& m) { combine(m, 2, '|'); }};
  all["XORW"] = {true, [](Machine& m) { combine(m, 2, '^'); }};
  all["ANDD"] = {true, [](Machine& m) { combine(m, 4, '&'); }};
  all["ORD"] = {true, [](Machine& m) { combine(m, 4, '|'); }};
  all["XORD"] = {true, [](Machine& m) { combine(m, 4, '^'); }};
  all["INVW"] = {true, [](Machine& m) { invert(m, 2); }};
  all["INVD"] = {true, [](Machine& m) { invert(m, 4); }};
}

}  // namespace s7200::reference

// Facts 6.6 and 6.7: integer and real arithmetic, logic operations.
#include <cmath>

#include "tests/reference_model/instructions.hpp"
#include "tests/reference_model/values.hpp"

namespace s7200::reference {
namespace {

/// Stores a result of 16 or 32 bits, wrapped if it does not fit.
void store_wrapped(Machine& m, const Place& out, std::size_t width, std::int64_t sum) {
  const auto bits = static_cast<std::uint32_t>(static_cast<std::uint64_t>(sum));
  const std::int64_t stored = width == 2 ? signed16(bits) : signed32(bits);
  write(out, width, bits);
  set_flag(m, kZero, stored == 0);
  set_flag(m, kOverflow, stored != sum);
  set_flag(m, kNegative, stored < 0);
}

/// What does not fit: a CPU 21x wraps, a CPU 22x leaves the operands alone (facts 9.1).
void store_sum(Machine& m, const Place& out, std::size_t width, std::int64_t sum) {
  const std::int64_t limit = std::int64_t{1} << (8 * width - 1);
  if (!m.kind.keeps_operands || (sum >= -limit && sum < limit)) return store_wrapped(m, out, width, sum);
  set_flag(m, kZero, false);
  set_flag(m, kOverflow, true);
  set_flag(m, kNegative, false);
}

std::int64_t signed_value(std::uint32_t bits, std::size_t width) { return width == 2 ? signed16(bits) : signed32(bits); }

void add(Machine& m, std::size_t width, int sign) {
  const std::int64_t in1 = signed_value(m.in(0, width), width);
  const Place out = m.place(1, width);
  store_sum(m, out, width, signed_value(read(out, width), width) + sign * in1);
}

void increment(Machine& m, std::size_t width, int by) {
  const Place out = m.place(0, width);
  store_wrapped(m, out, width, signed_value(read(out, width), width) + by);
}

void increment_byte(Machine& m, std::uint32_t by) {
  const Place out = m.place(0, 1);
  const std::uint32_t before = read(out, 1), after = (before + by) & 0xFF;
  write(out, 1, after);
  set_flag(m, kZero, after == 0);
  set_flag(m, kOverflow, by == 1 ? before == 255 : before == 0);
}

/// *I, /I, *D, /D: the result is as wide as the operands, or nothing is stored.
void same_width(Machine& m, std::size_t width, char operation) {
  const std::int64_t in1 = signed_value(m.in(0, width), width);
  const Place out = m.place(1, width);
  const std::int64_t before = signed_value(read(out, width), width);
  if (operation == '/' && in1 == 0) return set_flag(m, kDivisionByZero, true);
  const std::int64_t result = operation == '*' ? before * in1 : before / in1, limit = std::int64_t{1} << (8 * width - 1);
  const bool fits = result >= -limit && result < limit;
  if (fits) write(out, width, static_cast<std::uint32_t>(static_cast<std::uint64_t>(result)));
  set_flag(m, kZero, fits && result == 0);
  set_flag(m, kOverflow, !fits);
  set_flag(m, kNegative, fits && result < 0);
  set_flag(m, kDivisionByZero, false);
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
  if (quotient > 32767 && m.kind.keeps_operands) {
    set_flag(m, kZero, false);
    set_flag(m, kOverflow, true);
    set_flag(m, kNegative, false);
    return;
  }
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

void function(Machine& m, long double (*f)(long double)) {
  const float in = real(m.in(0, 4));
  const Place out = m.place(1, 4);
  store_real(m, out, std::isfinite(in), static_cast<float>(f(static_cast<long double>(in))));
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
  for (const std::size_t width : {std::size_t{2}, std::size_t{4}})
    for (const char operation : {'*', '/'})
      all[std::string{operation} + (width == 2 ? "I" : "D")] = {true, [=](Machine& m) { same_width(m, width, operation); }};
  all["INCB"] = {true, [](Machine& m) { increment_byte(m, 1); }};
  all["DECB"] = {true, [](Machine& m) { increment_byte(m, 255); }};
  all["SIN"] = {true, [](Machine& m) { function(m, [](long double x) { return std::sin(x); }); }};
  all["COS"] = {true, [](Machine& m) { function(m, [](long double x) { return std::cos(x); }); }};
  all["TAN"] = {true, [](Machine& m) { function(m, [](long double x) { return std::tan(x); }); }};
  all["LN"] = {true, [](Machine& m) { function(m, [](long double x) { return std::log(x); }); }};
  all["EXP"] = {true, [](Machine& m) { function(m, [](long double x) { return std::exp(x); }); }};
  all["ANDB"] = {true, [](Machine& m) { combine(m, 1, '&'); }};
  all["ORB"] = {true, [](Machine& m) { combine(m, 1, '|'); }};
  all["XORB"] = {true, [](Machine& m) { combine(m, 1, '^'); }};
  all["INVB"] = {true, [](Machine& m) { invert(m, 1); }};
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

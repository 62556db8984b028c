// Facts 6.3: LDB= … OR<=. A bad pointer stops the CPU, and so does a real operand that is not a number (facts 5.1, 9.1).
#include <cmath>

#include "tests/reference_model/instructions.hpp"
#include "tests/reference_model/strings.hpp"
#include "tests/reference_model/values.hpp"

namespace s7200::reference {
namespace {

template <class Value>
bool compare(const std::string& relation, Value a, Value b) {
  if (relation == "=") return a == b;
  if (relation == ">=") return a >= b;
  if (relation == "<>") return !(a == b);
  if (relation == ">") return a > b;
  if (relation == "<") return a < b;
  return a <= b;
}

bool compare_reals(const std::string& relation, float a, float b) {
  if (std::isnan(a) || std::isnan(b)) throw RunTimeError{0x0F};
  return compare(relation, a, b);
}

/// Strings, one character after the other.
bool same_strings(Machine& m) {
  follow_pointers(m, {1, 1});
  const std::string a = string_in(m, 0), b = string_in(m, 1);
  std::size_t compared = 0;
  bool same = true;
  while (same && compared < a.size() && compared < b.size()) {
    same = a[compared] == b[compared];
    ++compared;
  }
  m.spend_units(static_cast<std::uint32_t>(compared));
  return same && a.size() == b.size();
}

bool holds_true(Machine& m, const std::string& type, const std::string& relation) {
  if (type == "S") return same_strings(m) == (relation == "=");
  if (type == "B") return compare(relation, m.in(0, 1), m.in(1, 1));
  if (type == "W") return compare(relation, signed16(m.in(0, 2)), signed16(m.in(1, 2)));
  if (type == "D") return compare(relation, signed32(m.in(0, 4)), signed32(m.in(1, 4)));
  const float a = real(m.in(0, 4)), b = real(m.in(1, 4));
  return compare_reals(relation, a, b);
}

void contact(Machine& m, const std::string& join, const std::string& type, const std::string& relation) {
  bool result = false;
  try {
    result = holds_true(m, type, relation);
  } catch (const RunTimeError& error) {
    m.fatal_error(error.code == 0x0F ? 0x12 : error.code == 0x91 ? 0x14 : 0x11, m.position);
    throw;
  }
  if (join == "LD")
    m.push(m.rail && result);
  else if (join == "A")
    m.stack[0] = m.stack[0] && result;
  else
    m.stack[0] = m.stack[0] || (m.rail && result);
}

}  // namespace

void add_compares(Instructions& all) {
  for (const std::string join : {"LD", "A", "O"})
    for (const std::string type : {"B", "W", "D", "R"})
      for (const std::string relation : {"=", ">=", "<=", "<>", ">", "<"})
        all[join + type + relation] = {false, [=](Machine& m) { contact(m, join, type, relation); }};
  for (const std::string join : {"LD", "A", "O"})
    for (const std::string relation : {"=", "<>"})
      all[join + "S" + relation] = {false, [=](Machine& m) { contact(m, join, "S", relation); }};
}

}  // namespace s7200::reference

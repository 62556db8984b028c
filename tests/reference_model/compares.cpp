// Facts 6.3: LDB= … OR<=. A bad pointer stops the CPU (facts 5.1).
#include "tests/reference_model/instructions.hpp"
#include "tests/reference_model/values.hpp"

namespace s7200::reference {
namespace {

template <class Value>
bool compare(const std::string& relation, Value a, Value b) {
  if (relation == "=") return a == b;
  if (relation == ">=") return a >= b;
  return a <= b;
}

bool holds_true(Machine& m, const std::string& type, const std::string& relation) {
  if (type == "B") return compare(relation, m.in(0, 1), m.in(1, 1));
  if (type == "W") return compare(relation, signed16(m.in(0, 2)), signed16(m.in(1, 2)));
  if (type == "D") return compare(relation, signed32(m.in(0, 4)), signed32(m.in(1, 4)));
  return compare(relation, real(m.in(0, 4)), real(m.in(1, 4)));
}

void contact(Machine& m, const std::string& join, const std::string& type, const std::string& relation) {
  bool result = false;
  try {
    result = holds_true(m, type, relation);
  } catch (const RunTimeError&) {
    m.fatal_error(0x11, m.position);
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
      for (const std::string relation : {"=", ">=", "<="})
        all[join + type + relation] = {false, [=](Machine& m) { contact(m, join, type, relation); }};
}

}  // namespace s7200::reference

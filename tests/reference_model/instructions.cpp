#include "tests/reference_model/instructions.hpp"

namespace s7200::reference {

const Instructions& instructions() {
  static const Instructions kAll = [] {
    Instructions all;
    add_bit_logic(all);
    add_compares(all);
    add_moves(all);
    add_arithmetic(all);
    add_shifts(all);
    add_conversions(all);
    add_tables(all);
    add_strings(all);
    add_timers_and_counters(all);
    add_control(all);
    return all;
  }();
  return kAll;
}

}  // namespace s7200::reference

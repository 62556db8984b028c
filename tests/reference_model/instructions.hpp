// What each instruction does, found by its name.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "tests/reference_model/machine.hpp"

namespace s7200::reference {

struct Instruction {
  bool needs_power = false;  ///< a box: skipped while S0 is 0
  std::function<void(Machine&)> execute;
};

using Instructions = std::map<std::string, Instruction>;

const Instructions& instructions();

// One for each group; instructions() puts them together.
void add_bit_logic(Instructions& all);
void add_compares(Instructions& all);
void add_moves(Instructions& all);
void add_arithmetic(Instructions& all);
void add_shifts(Instructions& all);
void add_conversions(Instructions& all);
void add_tables(Instructions& all);
void add_strings(Instructions& all);
void add_timers_and_counters(Instructions& all);
void add_control(Instructions& all);

}  // namespace s7200::reference

// The contents of the loops of measure_times.stl: which figures of a table of times one repetition of each consists of.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "interpreter/program/checking/checker.hpp"

namespace s7200::tools {

/// A figure that repetitions consist of: of an instruction in some areas, or of a system time.
struct Form {
  std::string mnemonic;
  const TimeRow* row = nullptr;  ///< of the table that is corrected
  bool per_unit = false;         ///< its figure per unit, not the base

  bool operator==(const Form&) const = default;
};

/// The greatest distance of the true figure from `figure`.
Time farthest(Time figure, const TimeRange& range);

/// The times that a CPU runs with of its own, with what its other tables know besides: a line for each set of first operands
/// that no table tells apart, and a figure for each area that with any of them adds time; each with bounds that hold what
/// any of them says.
TimeTable told_apart(const CpuModel& model);

/// How often each of the forms is taken.
using Repetition = std::vector<double>;

struct Loops {
  std::vector<Form> forms;
  std::vector<Repetition> loops;                      ///< by their numbers
  std::map<std::size_t, Repetition> interrupts = {};  ///< of loops that have any, by the same: of each interrupt
};

/// The program that this version of the command knows, for a CPU; null if the CPU cannot run it.
std::shared_ptr<const Program> measuring_program(const CpuModel& model, const TimeTable& times);

/// Runs each loop in simulation, twice and once, and takes the instructions that one repetition more consists of. The forms
/// are of `times`, which outlives them.
Loops find_loops(const CpuModel& model, const TimeTable& times);

}  // namespace s7200::tools

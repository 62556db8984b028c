// The tables of execution times that have a name: those of the CPUs, and others of the same CPUs from other sources.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/times.hpp"

namespace s7200 {

/// The text in the source of a figure that was fitted to this scan. cpu214_times.csv has it, too.
inline constexpr std::string_view kFirstScanOfTip41 = "first scan of Application Tip 41";

struct NamedTimes {
  std::string_view name;        ///< cpu214_from_22x
  std::string_view about;       ///< where its figures come from, in one line
  CpuSet cpus;                  ///< whose times these are
  bool own;                     ///< they are what these CPUs run with if nothing else is asked for
  const TimeTable& (*table)();  ///< read when it is first asked for
};

const std::vector<NamedTimes>& named_times();

/// Returns null for a name that no table has.
const NamedTimes* find_times(std::string_view name);

/// The tables for a CPU, its own first.
std::vector<const NamedTimes*> times_of(const CpuModel& model);

/// The names of the tables for a CPU: `cpu214, cpu214_from_22x`
std::string names_of_times(const CpuModel& model);

}  // namespace s7200

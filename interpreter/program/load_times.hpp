// The execution times of a CPU: its own, or those of a table that is named or in a file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times.hpp"

namespace s7200 {

/// `table`: the name of a table of this CPU, or else a CSV file; its figures replace those of the CPU. Empty: the CPU's own.
/// Only lines that are in use are in it. Returns nothing and adds to `errors` if there is none, and for a file with names,
/// forms or units that this CPU's tables do not have, or with the times of another CPU.
std::optional<TimeTable> load_times(const CpuModel& model, const std::string& table, std::vector<std::string>& errors);

}  // namespace s7200

// The execution times of a CPU: its own, or those of a table that is named or in a file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/file_source.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/times.hpp"

namespace s7200 {

/// The times of a CPU with the figures of a table of it that has a name; its own for an empty name.
TimeTable times_named(const CpuModel& model, std::string_view name);

/// `table`: the name of a table of this CPU, or else a CSV file of `files`; its figures replace those of the CPU. Empty: the
/// CPU's own. Only lines that are in use are in it. Returns nothing and adds to `errors` if there is none, and for a file
/// with names, forms or units that this CPU's tables do not have, or with the times of another CPU.
std::optional<TimeTable> load_times(const CpuModel& model, const std::string& table, const FileSource& files,
                                    std::vector<std::string>& errors);

}  // namespace s7200

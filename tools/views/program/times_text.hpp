// Execution times as text and JSON: one table, or several side by side.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/times.hpp"

namespace s7200::tools {

/// A table under the name it was asked for by.
struct TitledTimes {
  std::string title;
  TimeTable times;
};

/// A row for each line of the table, in lines of at most `width` characters.
std::string table_text(const CpuModel& model, const TimeTable& times, std::size_t width);
nlohmann::ordered_json table_json(const TimeTable& times);

/// The tables with names that there are for the CPU, each with where it is from.
std::string tables_text(const CpuModel& model);
nlohmann::ordered_json tables_json(const CpuModel& model);

/// Tables side by side. Rows that are the same in all tables are one row: instructions and the areas of their first operand.
/// A table's name that is too long for its column makes the lines longer than `width`.
std::string side_by_side_text(const CpuModel& model, const std::vector<TitledTimes>& tables, std::size_t width);
nlohmann::ordered_json side_by_side_json(const CpuModel& model, const std::vector<TitledTimes>& tables);

}  // namespace s7200::tools

// Execution times as text and JSON: one table, or several side by side.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times.hpp"

namespace s7200::tools {

/// A table under the name it was asked for by.
struct TitledTimes {
  std::string title;
  TimeTable times;
};

/// A line for each line of the table.
std::string table_text(const CpuModel& model, const TimeTable& times);
nlohmann::ordered_json table_json(const TimeTable& times);

/// The tables with names that there are for the CPU, each with where it is from.
std::string tables_text(const CpuModel& model);
nlohmann::ordered_json tables_json(const CpuModel& model);

/// Tables side by side. Rows that are the same in all tables are one line: instructions and the areas of their first
/// operand.
std::string side_by_side_text(const CpuModel& model, const std::vector<TitledTimes>& tables);
nlohmann::ordered_json side_by_side_json(const CpuModel& model, const std::vector<TitledTimes>& tables);

}  // namespace s7200::tools

#include "interpreter/program/load_times.hpp"

#include <fmt/format.h>

#include "interpreter/model/named_times.hpp"
#include "interpreter/program/load.hpp"

namespace s7200 {

std::optional<TimeTable> load_times(const CpuModel& model, const std::string& table, std::vector<std::string>& errors) {
  TimeTable times = default_times(model);
  if (table.empty()) return times;
  if (const NamedTimes* named = find_times(table)) {
    if (named->cpus & model.self) {
      times.add(named->table);
      return times;
    }
    errors.push_back(fmt::format("{} has times of {}; tables for CPU {}: {}", table, to_text(named->cpus), model.name,
                                 names_of_times(model)));
    return {};
  }
  std::string why;
  const auto csv = read_text(table, why);
  if (!csv) {
    errors.push_back(fmt::format("cannot read {}: {}; tables for CPU {} that have a name: {}", table, why, model.name,
                                 names_of_times(model)));
    return {};
  }
  const auto wrong = times.add(*csv, table);
  errors.insert(errors.end(), wrong.begin(), wrong.end());
  return wrong.empty() ? std::optional(times) : std::nullopt;
}

}  // namespace s7200

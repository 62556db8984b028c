// An earlier result of bench, and whether it is comparable.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "tools/command/options/plc/program_options.hpp"
#include "tools/measuring/measure.hpp"

namespace s7200::tools {

struct EarlierBench {
  std::map<std::string, double> speeds;  ///< by the names of their figures
  nlohmann::json measured;               ///< with what it was measured, among other things
};

/// With what figures are measured: two results are comparable if this is the same in both.
nlohmann::ordered_json measured_with(const ProgramOptions& options, const Program& program, Time each);

/// Reads what `bench --json` printed. Nothing after a message, also if a figure is not a rate above 0.
std::optional<EarlierBench> read_earlier_bench(const std::string& path);

/// Notes where the two were not measured in the same way.
void warn_of_differences(const nlohmann::ordered_json& now, const EarlierBench& before, const std::string& path);

/// How many times as fast it is now; nothing if there was no such figure.
std::optional<double> ratio_of(const Figure& figure, const EarlierBench& before);

/// What `bench --json` prints of a figure.
nlohmann::ordered_json json_of(const Figure& figure, const EarlierBench& before);

}  // namespace s7200::tools

#include "tools/views/program/import_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/views/program/check_report.hpp"

namespace s7200::tools {

std::size_t count_statements(const stl::Source& source) {
  return static_cast<std::size_t>(std::count_if(source.lines.begin(), source.lines.end(), [](const stl::Line& line) {
    return std::holds_alternative<stl::Statement>(line);
  }));
}

void add_import_results(nlohmann::ordered_json& results, const SourceText& text, const std::string& output,
                        const std::string& stl) {
  results["encoding"] = text.encoding;
  results["instructions"] = count_statements(text.parsed.source);
  results["left_out"] = text.parsed.left_out;
  results["output"] = output.empty() ? nullptr : nlohmann::ordered_json(output);
  results["stl"] = output.empty() ? nlohmann::ordered_json(stl) : nullptr;
}

std::string comparison_summary(const LadderComparison& comparison) {
  return fmt::format("{}: {} drawn, {} of them like the STL; {}\n", stl::printable(comparison.source.name),
                     s7200::counted(comparison.networks, "network"), comparison.same, counted(comparison.diagnostics));
}

void add_comparison(nlohmann::ordered_json& results, const LadderComparison& comparison) {
  results["encoding"] = comparison.encoding;
  results["networks"] = comparison.networks;
  results["same"] = comparison.same;
  results["diagnostics"] = to_json(comparison.diagnostics, comparison.source);
}

}  // namespace s7200::tools

// The report on an imported document, and on the comparison of its drawings with its STL.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "interpreter/program/ladder/ladder_compare.hpp"
#include "interpreter/program/load.hpp"

namespace s7200::tools {

std::size_t count_statements(const stl::Source& source);

/// The keys of an import but `document`. `output`: the file that was written, or nothing, and then `stl` is among the
/// results.
void add_import_results(nlohmann::ordered_json& results, const SourceText& text, const std::string& output,
                        const std::string& stl);

/// One line with the number of drawn networks, of those that do what the STL does, and of differences.
std::string comparison_summary(const LadderComparison& comparison);

/// Adds the summary as above and all diagnostics.
void add_comparison(nlohmann::ordered_json& results, const LadderComparison& comparison);

}  // namespace s7200::tools

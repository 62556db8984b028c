// How scenarios went, as Markdown: for the summary of a job, or a comment beside a change.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/scenario/reporting/messages.hpp"
#include "tools/scenario/reporting/report.hpp"

namespace s7200::tools {

/// Tells our files from others.
inline constexpr std::string_view kMarkdownBeginning = "<!-- Results of s7200 test -->\n";

/// Totals, a row for each file, and what failed with what was found. `link`: the address of a page about a scenario by its
/// number; a finding whose moment is known leads to that moment of it. No links without it.
std::string to_markdown(const std::vector<Report>& reports, const std::function<std::string(std::size_t number)>& link = {});

/// Of what kept scenarios from being run: each mistake with its place.
std::string to_markdown(const Messages& messages);

}  // namespace s7200::tools

// How scenarios went, for continuous integration.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/scenario/reporting/messages.hpp"
#include "tools/scenario/reporting/report.hpp"

namespace s7200::tools {

/// Tells our files from others.
inline constexpr std::string_view kJunitBeginning =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- Results of s7200 test -->\n";

/// The XML that continuous integration reads: a suite for each file, a case for each scenario. A rule that says should and
/// is broken counts as skipped there, which has no third way.
/// `link`: a page about a scenario by its number, a property of its case and a line of what failed; none without it.
std::string to_junit(const std::vector<Report>& reports, const std::function<std::string(std::size_t number)>& link = {});

/// Of what kept scenarios from being run: an error for each mistake in a file, at its place.
std::string to_junit(const Messages& messages);

}  // namespace s7200::tools

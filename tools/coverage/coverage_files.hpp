// What was tried, as files: a page with the source, and the format of lcov.
#pragma once

#include <string>
#include <string_view>

#include "tools/coverage/coverage_report.hpp"

namespace s7200::tools {

/// Tells our files from others.
inline constexpr std::string_view kCoveragePageBeginning =
    "<!DOCTYPE html>\n<html lang=\"en\">\n<!-- Coverage of s7200 test -->\n";
inline constexpr std::string_view kLcovBeginning = "TN:s7200\n";

/// One page: the figures of each program, and its source with what was tried at each line.
std::string coverage_page(const CoverageOfPrograms& coverage);

/// For genhtml and what else reads lcov: a function for each routine, a line for each instruction, and of each contact two
/// branches, closed and open. What was tried counts as 1, however often that was.
std::string coverage_lcov(const CoverageOfPrograms& coverage);

}  // namespace s7200::tools

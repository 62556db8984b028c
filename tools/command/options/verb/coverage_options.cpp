#include "tools/command/options/verb/coverage_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/command/options/wanted_file.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/testing/test_output.hpp"
#include "tools/coverage/coverage_files.hpp"

namespace s7200::tools {
namespace {

/// `90%`, `87.5`
double parse_percent(std::string given) {
  const std::string shown = stl::shortened(given);
  if (given.ends_with('%')) given.pop_back();
  const auto percent = parse_decimal<double>(given);
  if (!percent || !(*percent >= 0 && *percent <= 100))
    throw CLI::ValidationError("--coverage-at-least", fmt::format("'{}' is not a share from 0% to 100%", shown));
  return *percent;
}

}  // namespace

void CoverageOptions::add_to(CLI::App& app, const char* group) {
  app.add_flag("--coverage", shown_, "show what of the program was never tried")->group(group);
  app.add_option("--coverage-html", page_, "write the source with what was tried at each line as HTML")->type_name("FILE");
  app.add_option("--coverage-lcov", lcov_, "write what was tried for genhtml and others that read lcov")->type_name("FILE");
  app.add_option_function<std::string>(
         "--coverage-at-least", [this](const std::string& given) { at_least_ = parse_percent(given); },
         "fail if less of the instructions, or of the contacts both ways, was tried")
      ->type_name("SHARE");
}

void CoverageOptions::claim(WrittenFiles& files) {
  if (page_ == "-" || lcov_ == "-")
    throw std::invalid_argument("--coverage-html and --coverage-lcov write files; '-' is none");
  page_to_ = claim_wanted(files, "--coverage-html", page_,
                          {"a page of s7200 test --coverage-html", std::string(kCoveragePageBeginning)});
  lcov_to_ =
      claim_wanted(files, "--coverage-lcov", lcov_, {"a file of s7200 test --coverage-lcov", std::string(kLcovBeginning)});
}

void CoverageOptions::add_to(nlohmann::ordered_json& results, const CoverageOfPrograms& coverage) const {
  if (!wanted()) return;
  results["coverage"] = nlohmann::ordered_json::array();
  for (const ProgramCoverage& each : coverage.programs()) results["coverage"].push_back(coverage_json(each));
}

bool CoverageOptions::show(const CoverageOfPrograms& coverage, bool json) const {
  if (shown_ && !json)
    for (const ProgramCoverage& each : coverage.programs()) fmt::print("\n{}", coverage_text(each));
  const bool page_written = write_wanted(page_to_, coverage_page(coverage));
  return write_wanted(lcov_to_, coverage_lcov(coverage)) && page_written;
}

bool CoverageOptions::is_enough(const CoverageOfPrograms& coverage) const {
  if (!at_least_) return true;
  bool enough = true;
  for (const ProgramCoverage& each : coverage.programs()) {
    const CoverageFigures figures = figures_of(*each.map, each.tried);
    if (figures.least() >= *at_least_) continue;
    enough = false;
    print_error(fmt::format("{}: {}; --coverage-at-least {:g}% wants more of the instructions and contacts",
                            coverage_name(each.map->program()), figures_text(figures), *at_least_));
  }
  if (coverage.programs().empty()) print_error("--coverage-at-least: no program was run in simulation");
  return enough && !coverage.programs().empty();
}

}  // namespace s7200::tools

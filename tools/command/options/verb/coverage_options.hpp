// What of a program a test or a run has tried: the options of `s7200 test` and `s7200 run`, and what they print and write.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "tools/coverage/coverage_report.hpp"
#include "tools/host/files/written_files.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

class CoverageOptions {
 public:
  /// `group`: of --coverage in the help; the others are in --help-all.
  void add_to(CLI::App& app, const char* group);

  bool wanted() const { return shown_ || !page_.empty() || !lcov_.empty() || at_least_; }

  /// Throws std::invalid_argument if one cannot write to one of the files.
  void claim(WrittenFiles& files);

  /// Adds what was tried to the results of --json.
  void add_to(nlohmann::ordered_json& results, const CoverageOfPrograms& coverage) const;

  /// Prints what was tried, but with --json, and writes the files. Returns false after a message if a file cannot be
  /// written.
  bool show(const CoverageOfPrograms& coverage, bool json) const;

  /// Whether the limit is reached; if not, after a message.
  bool is_enough(const CoverageOfPrograms& coverage) const;

 private:
  bool shown_ = false;
  std::string page_, lcov_;
  std::optional<double> at_least_;  ///< percent
  std::optional<Destination> page_to_, lcov_to_;
};

}  // namespace s7200::tools

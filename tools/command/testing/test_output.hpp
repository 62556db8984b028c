// What `s7200 test` shows: each scenario as it ends, and how it all went.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "tools/command/options/verb/coverage_options.hpp"
#include "tools/command/options/verb/profile_options.hpp"
#include "tools/host/files/written_files.hpp"
#include "tools/scenario/suite.hpp"
#include "tools/views/streamed_results.hpp"

namespace s7200::tools {

class TestOutput {
 public:
  /// `all`: how many scenarios there are. `conformance`: rules of Modbus are shown together, at the end.
  TestOutput(std::size_t all, bool json, bool conformance);
  ~TestOutput() { clear_progress(); }

  /// On a terminal, from the second second on.
  void show_progress(std::size_t done);

  void show(const Report& report);
  /// Of a scenario whose report has none: with --json.
  void show(const Scenario& scenario, const Seen& seen);
  void show(const Compared& compared);

  /// `coverage`, `profile`: what is to be said of them with --json.
  void end(const SuiteResult& result, const CoverageOptions& coverage = {}, const ProfileOptions& profile = {});
  void end(const ComparisonResult& result);

 private:
  void clear_progress();
  void heading(const Scenario& scenario);

  std::size_t all_;
  bool json_, conformance_;
  bool progress_wanted_, progress_shown_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  const stl::SourceLines* file_ = nullptr;  ///< of the last heading
  /// The results and the scenario that is being printed.
  struct Streamed {
    StreamedResults results, scenario;
  };
  std::optional<Streamed> streamed_;
};

/// Names the scenarios.
void print_list(const std::vector<Scenario>& scenarios, bool json);

/// On stderr.
void print_messages(const Messages& messages);

/// After an interruption: results without a scenario. `compares`: two of what is tested.
void end_before_anything_ran(bool json, bool compares);

}  // namespace s7200::tools

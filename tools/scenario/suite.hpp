// The engine of `s7200 test`: scenarios are collected, get what they are run on, are run, and are compared.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/scenario/benches.hpp"
#include "tools/scenario/comparison.hpp"
#include "tools/scenario/reading/collection.hpp"
#include "tools/scenario/reporting/report.hpp"
#include "tools/scenario/transcripts/transcript.hpp"

namespace s7200::tools {

/// How a suite went.
struct SuiteResult {
  std::vector<Report> reports{};  ///< of those that were run, in their order; they belong to the suite
  std::size_t not_run = 0;        ///< for an interruption, --fail-fast, or a slave that went
  std::string tested{};           ///< what they were run on
  bool live = false;              ///< that is outside simulation: times are of this computer's clock
  CoverageOfPrograms coverage{};  ///< of all reports, if it was observed
  ProfileOfPrograms profile{};    ///< the same
  std::string unreachable{};      ///< why the way to the slave broke

  bool passed() const;

  /// Whether there was a program, or a slave, for any of them.
  bool any_had_a_program() const;

  /// Why nothing was checked; empty if something was.
  std::string why_nothing_was_checked() const;
};

struct ComparisonResult {
  std::vector<Compared> scenarios{};
  bool same() const;
};

class Suite {
 public:
  /// Reads what is to be run. Nothing, with messages, if that cannot be done.
  static std::optional<Suite> collect(const SuiteSettings& settings, Messages& messages);

  const std::vector<Scenario>& scenarios() const { return scenarios_; }

  /// Called in the thread of the caller, in the order of the scenarios.
  template <class Result>
  struct Watcher {
    std::function<void(const Result&)> finished{};
    std::function<void(std::size_t done)> waiting{};  ///< every 200 ms while none finishes; may be left out
    /// Each exchange when it is over, in the thread that runs the scenario: then reports have none. Left out: they have. Not
    /// with a band. Of the result there is what was tested.
    std::function<void(const SuiteResult&, const Scenario&, const Seen&)> exchange{};
  };

  /// Runs all of them. Nothing, with messages, if there is nothing to run them on; throws as make_benches() does then.
  std::optional<SuiteResult> run(const Watcher<Report>& watcher, Messages& messages);

  /// Runs them on `other` too and tells where both differ first; `colour` is that of the text. May throw SlaveUnreachable.
  std::optional<ComparisonResult> compare(const std::string& other, Time tolerance, bool ignore_timing, bool colour,
                                          const Watcher<Compared>& watcher, Messages& messages);

 private:
  Suite(const SuiteSettings& settings, std::vector<Scenario> scenarios)
      : settings_(settings), scenarios_(std::move(scenarios)) {}

  std::optional<Benches> benches_on(const std::string& target, Messages& messages);
  unsigned jobs_on(const Benches& benches) const;

  SuiteSettings settings_;
  std::vector<Scenario> scenarios_;
  Programs programs_;
};

/// By which times may differ: as it was given, or what a slave needs whose times are of this computer's clock.
Time tolerance_for(Time given, bool live);

}  // namespace s7200::tools

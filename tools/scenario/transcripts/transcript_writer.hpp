// How steps write themselves into a transcript.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/plan/plc_keys.hpp"
#include "tools/scenario/reading/memory_values.hpp"
#include "tools/scenario/reporting/report.hpp"
#include "tools/scenario/transcripts/transcript.hpp"

namespace s7200::tools {

class TranscriptWriter {
 public:
  explicit TranscriptWriter(const Transcript& transcript);

  /// A scenario and how it went.
  void write(const Report& report);

  /// The same of a scenario of one step with many exchanges, each as it comes, ...
  void begin(const Report& report);
  void write(const Seen& seen);

  /// What has been written since it was last taken.
  std::string take() { return std::exchange(text_, {}); }

  // --- for steps ---

  const Scenario& scenario() const { return *report_->scenario; }

  /// From a slave that is not a program: its instants mean nothing to a replay.
  bool live() const { return transcript_.live; }

  /// Whether what memory must hold is expected again.
  bool expects_memory() const { return transcript_.memory; }

  /// What went over the line in this step; null if it did not come to that.
  const serial::Exchange* seen() const { return seen_; }

  /// How long this step waited for what did not come; nothing if it came.
  std::optional<Time> waited_in_vain() const;

  void step(const std::string& content) { line(6, "- " + content); }
  void beside(const std::string& content) { line(8, content); }

  std::optional<Time> last_end{};  ///< of the exchange before, on the slave's clock

 private:
  bool write_step(const serial::Exchange* seen);
  void line(int indent, const std::string& content);
  std::string near(const std::string& path) const;
  void head(const Scenario& scenario);
  void plc_keys_of(const Scenario& scenario, PlcKey::Stage stage);
  void line_settings(const serial::MasterSettings& settings);

  const Transcript& transcript_;
  std::filesystem::path folder_;
  const Report* report_ = nullptr;          ///< the scenario that is written
  std::size_t step_ = 0;                    ///< of it
  const serial::Exchange* seen_ = nullptr;  ///< in this step
  std::string text_;
};

/// To the nanosecond.
std::string exact(Time time);
std::string exact(const Span& span);

/// In double quotation marks, as YAML reads it back.
std::string in_quotes(std::string_view text);

/// `{VW20: 16#1234}`: in their order, but each place once, with the last value that it is given, where it is given it.
std::string assignments_text(const std::vector<Assignment>& assignments);

/// `{"VW20": "5", "VB0:4": "01 02 .. 04"}`, as it was written.
std::string to_text(const std::vector<MemoryExpected>& expected);

/// `[VW20, VB0:4]`, as `unforce` takes them; `all` for none.
std::string unforce_text(const std::vector<MemoryRange>& places);

}  // namespace s7200::tools

// Frames of a recording, or of a line, and their summary, as they come: printed, and kept for a report if there is to be
// one.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/command/options/verb/report_option.hpp"
#include "tools/recordings/decoded.hpp"
#include "tools/views/streamed_results.hpp"

namespace s7200::tools {

class DecodeResults {
 public:
  /// Prints the heading. `head` has the keys before the frames; `report` must live as long as this.
  DecodeResults(nlohmann::ordered_json head, bool as_json, const ReportOption& report);

  /// Whether requests without an answer are shown as such.
  bool marks_unanswered() const { return colour_ || as_json_ || report_.wanted(); }

  /// Prints a frame. `unanswered`: it is known that no answer to it came.
  void add(const ReadFrame& frame, bool unanswered);

  /// Prints the summary, and writes the report. False after a message.
  bool end();

  const DecodedSummary& summary() const { return summary_; }

 private:
  const ReportOption& report_;
  nlohmann::ordered_json head_;
  bool as_json_, colour_;
  std::size_t width_;  ///< of the output: asking the terminal for each of many frames takes longer than reading them
  StreamedResults streamed_;
  DecodedSummary summary_{};
  nlohmann::ordered_json frames_;
};

}  // namespace s7200::tools

// A transcript of one scenario of many exchanges, written as they come.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "tools/host/files/written_files.hpp"
#include "tools/scenario/suite.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {

class GrowingTranscript {
 public:
  /// `tolerance`: as it was given.
  GrowingTranscript(Destination to, std::string path, Time tolerance)
      : to_(std::move(to)), transcript_{.path = std::move(path)}, tolerance_(tolerance) {}

  /// What goes wrong shows at the end.
  void add(const SuiteResult& so_far, const Scenario& scenario, const Seen& seen);

  bool any() const { return writer_.has_value(); }

  /// False after a message.
  bool complete();

 private:
  void put(const std::string& text);

  Destination to_;
  Transcript transcript_;
  Time tolerance_;
  Report report_{};
  GrowingResult file_;
  std::optional<TranscriptWriter> writer_;
  std::size_t bytes_ = 0;
  Result<> done_;
};

}  // namespace s7200::tools

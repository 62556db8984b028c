// What steps have in common that wait for something on the line: an answer, or what no one asked for.
#pragma once

#include <optional>
#include <vector>

#include "tools/scenario/expected_answer.hpp"
#include "tools/scenario/run.hpp"
#include "tools/scenario/steps/steps.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"

namespace s7200::tools {

struct Reception : StepAction {
  bool has_crc = false;              ///< a right CRC must be at its end
  std::vector<Expected> expected{};  ///< one of these; anything if empty
  bool disturbed = false;            ///< it has parity or framing errors
  std::optional<Window> latency{};
  std::optional<Window> answer_gap{};  ///< each pause between two characters
  std::optional<Span> listen{};        ///< the silence that ends it; 3.5 characters if not given
  std::optional<Time> timeout{};       ///< until it begins; the scenario's if not given

 protected:
  /// All but what is expected.
  void read_reception(const StepSource& source);

  /// What came against what was expected; `line` is its format, `timeout` how long it was waited for.
  void judge(Run& run, const serial::Exchange& exchange, const SerialFormat& line, Time timeout) const;

  void write_how_to_listen(TranscriptWriter& writer) const;
  static void write_how_it_came(TranscriptWriter& writer, const serial::Exchange& seen);

 private:
  void judge_times(Run& run, const serial::Exchange& exchange, const SerialFormat& line) const;
};

/// Of a step that waits for something on the line; null for all others.
const Reception* reception_of(const Step& step);

/// `{text: 'OK'}`, hex or silence: how a transcript expects it.
std::string what_came(const Bytes& request, const Bytes& response);
std::string in_a_map(const std::string& quoted);

}  // namespace s7200::tools

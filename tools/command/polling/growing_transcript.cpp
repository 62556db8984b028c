#include "tools/command/polling/growing_transcript.hpp"

#include <fmt/format.h>

#include "tools/command/terminal/terminal.hpp"

namespace s7200::tools {

void GrowingTranscript::add(const SuiteResult& so_far, const Scenario& scenario, const Seen& seen) {
  if (!writer_) {
    transcript_.recorded_from = so_far.tested;
    transcript_.live = so_far.live;
    transcript_.tolerance = tolerance_for(tolerance_, so_far.live);
    report_.scenario = &scenario;
    file_.begin(to_, trouble_);
    put(transcript_heading(transcript_));
    writer_.emplace(transcript_).begin(report_);
  }
  writer_->write(seen);
  put(writer_->take());
}

void GrowingTranscript::put(const std::string& text) {
  bytes_ += text.size();
  if (trouble_.empty()) file_.add(text, trouble_);
}

bool GrowingTranscript::complete() {
  if (trouble_.empty())
    if (const std::string why = why_not_replayed(bytes_); !why.empty())
      trouble_ = fmt::format("cannot write {}: {}", transcript_.path, why);
  if (trouble_.empty()) file_.complete(trouble_);
  if (!trouble_.empty()) print_error(trouble_);
  return trouble_.empty();
}

}  // namespace s7200::tools

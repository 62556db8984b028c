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
    done_ = file_.begin(to_);
    put(transcript_heading(transcript_));
    writer_.emplace(transcript_).begin(report_);
  }
  writer_->write(seen);
  put(writer_->take());
}

void GrowingTranscript::put(const std::string& text) {
  bytes_ += text.size();
  if (done_) done_ = file_.add(text);
}

bool GrowingTranscript::complete() {
  if (done_)
    if (const std::string why = why_not_replayed(bytes_); !why.empty())
      done_ = trouble("cannot write {}: {}", transcript_.path, why);
  if (done_) done_ = file_.complete();
  if (!done_) print_error(done_.why());
  return bool(done_);
}

}  // namespace s7200::tools

#include "tools/recordings/decoded.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "serial_sim/line/frame.hpp"
#include "tools/scenario/transcript_writer.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

constexpr const char *kDim = "2", *kYellow = "33";

std::string_view kind_of(const ReadFrame& frame, std::string_view unknown) {
  if (frame.echo) return "echo";
  return frame.direction == Direction::Request ? "request" : frame.direction == Direction::Answer ? "answer" : unknown;
}

std::string painted(const std::string& text, const char* paint, bool colour) {
  return colour ? fmt::format("\x1b[{}m{}\x1b[0m", paint, text) : text;
}

nlohmann::ordered_json microseconds(std::optional<Time> time) {
  if (!time) return nullptr;
  return static_cast<double>(*time) / kMicrosecond;
}

}  // namespace

void DecodedSummary::add(const ReadFrame& frame) {
  requests_ += frame.direction == Direction::Request ? 1U : 0U;
  need_no_answer_ += frame.needs_no_answer ? 1U : 0U;
  echoes_ += frame.echo ? 1U : 0U;
  strays_ += frame.direction == Direction::Unknown && frame.right && !frame.echo ? 1U : 0U;
  wrong_ += frame.right ? 0U : 1U;
  if (frame.direction != Direction::Answer || !frame.other || !frame.right) return;
  ++answered_;
  if (!frame.latency) return;
  shortest_ = std::min(shortest_.value_or(*frame.latency), *frame.latency);
  longest_ = std::max(longest_.value_or(*frame.latency), *frame.latency);
}

std::string DecodedSummary::text() const {
  const std::string times =
      shortest_ ? fmt::format(" after {} to {}", format_duration(*shortest_), format_duration(*longest_)) : "";
  const std::string none = need_no_answer_ == 0 ? "" : fmt::format(", {} need no answer", need_no_answer_);
  const std::string echoes = echoes_ == 0 ? "" : fmt::format(", echoes: {}", echoes_);
  return fmt::format("requests: {}, answered: {}{}{}; wrong frames: {}, frames of no request: {}{}\n", requests_, answered_,
                     times, none, wrong_, strays_, echoes);
}

nlohmann::ordered_json DecodedSummary::json() const {
  return {{"requests", requests_},
          {"answered", answered_},
          {"need_no_answer", need_no_answer_},
          {"wrong", wrong_},
          {"strays", strays_},
          {"echoes", echoes_},
          {"shortest_latency_us", microseconds(shortest_)},
          {"longest_latency_us", microseconds(longest_)}};
}

std::string decoded_heading(bool colour) {
  return painted(fmt::format("{:>12}  {:>10}  {:<7}  {}", "ms", "silence", "", "frame"), kDim, colour) + '\n';
}

std::string decoded_text(const ReadFrame& read, bool unanswered, bool colour) {
  const RecordedFrame& frame = read.frame;
  const std::string line = fmt::format(
      "{:>12}  {:>10}  {:<7}  {}{}", frame.at ? fmt::format("{:.3f}", static_cast<double>(*frame.at) / kMillisecond) : "",
      read.silence ? format_duration(*read.silence) : "", kind_of(read, "?"), serial::to_hex(frame.bytes),
      read.text.empty() ? "" : fmt::format("\n{:>33}{}", "", read.text));
  const bool trouble = !read.right || unanswered || (read.direction == Direction::Unknown && !read.echo);
  return (trouble ? painted(line, kYellow, colour) : line) + '\n';
}

nlohmann::ordered_json decoded_json(const ReadFrame& read) {
  return {{"place", read.frame.place},
          {"at_us", microseconds(read.frame.at)},
          {"silence_us", microseconds(read.silence)},
          {"kind", kind_of(read, "stray")},
          {"bytes", plain_hex(read.frame.bytes)},
          {"right", read.right},
          {"text", read.text},
          {"latency_us", microseconds(read.latency)}};
}

std::string decoded_text(const std::vector<ReadFrame>& frames, bool colour) {
  std::string text = decoded_heading(colour);
  DecodedSummary summary;
  for (const ReadFrame& frame : frames) {
    summary.add(frame);
    const bool unanswered = frame.direction == Direction::Request && !frame.other && !frame.needs_no_answer;
    text += decoded_text(frame, unanswered, colour);
  }
  return text + summary.text();
}

void add_decoded(nlohmann::ordered_json& results, const std::vector<ReadFrame>& frames) {
  DecodedSummary summary;
  results["frames"] = nlohmann::ordered_json::array();
  for (const ReadFrame& frame : frames) {
    summary.add(frame);
    results["frames"].push_back(decoded_json(frame));
  }
  results["summary"] = summary.json();
}

}  // namespace s7200::tools

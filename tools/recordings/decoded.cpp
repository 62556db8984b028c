#include "tools/recordings/decoded.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "serial_sim/line/frame.hpp"
#include "tools/scenario/transcripts/transcript_writer.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kKindColumn = 7, kTextColumn = 33;

constexpr const char *kDim = "2", *kYellow = "33";

std::string_view kind_of(const ReadFrame& frame, std::string_view unknown) {
  if (frame.echo) return "echo";
  if (frame.not_read) return "unread";
  return frame.direction == Direction::Request ? "request" : frame.direction == Direction::Answer ? "answer" : unknown;
}

std::string painted(const std::string& text, const char* paint, bool colour) {
  return colour ? fmt::format("\x1b[{}m{}\x1b[0m", paint, text) : text;
}

/// A time in milliseconds, to the nearest microsecond: `25.000`.
std::string milliseconds(Time time) {
  const auto magnitude = static_cast<std::uint64_t>(time < 0 ? -time : time);
  const std::uint64_t rounded = (magnitude + kMicrosecond / 2) / kMicrosecond;
  constexpr std::size_t kDecimals = 3;
  std::string text = std::to_string(rounded);
  if (text.size() <= kDecimals) text.insert(0, kDecimals + 1 - text.size(), '0');
  text.insert(text.size() - kDecimals, 1, '.');
  return time < 0 ? '-' + text : text;
}

/// Appends a text at the right of its column.
void append_column(std::string& line, std::string_view text, std::size_t width) {
  const std::size_t characters = stl::count_characters(text);
  line.append(characters < width ? width - characters : 0, ' ').append(text);
}

nlohmann::ordered_json microseconds(std::optional<Time> time) {
  if (!time) return nullptr;
  return static_cast<double>(*time) / kMicrosecond;
}

/// Of a recording that is complete.
bool is_unanswered(const ReadFrame& frame) {
  return frame.direction == Direction::Request && !frame.other && !frame.needs_no_answer;
}

}  // namespace

void DecodedSummary::add(const ReadFrame& frame) {
  ++frames_;
  not_read_ += frame.not_read ? 1U : 0U;
  may_be_answers_ += frame.may_be_answer ? 1U : 0U;
  if (frame.not_read) return;
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
  const std::string answers =
      may_be_answers_ == 0 ? "" : fmt::format(" ({} may be the answer to a request)", may_be_answers_);
  const std::string not_read = not_read_ == 0 ? "" : fmt::format(", rows not read: {}{}", not_read_, answers);
  return fmt::format("requests: {}, answered: {}{}{}; wrong frames: {}, frames of no request: {}{}{}\n", requests_,
                     answered_, times, none, wrong_, strays_, echoes, not_read);
}

nlohmann::ordered_json DecodedSummary::json() const {
  return {{"requests", requests_},
          {"answered", answered_},
          {"need_no_answer", need_no_answer_},
          {"wrong", wrong_},
          {"strays", strays_},
          {"echoes", echoes_},
          {"not_read", not_read_},
          {"possible_answers_not_read", may_be_answers_},
          {"shortest_latency_us", microseconds(shortest_)},
          {"longest_latency_us", microseconds(longest_)}};
}

std::string decoded_heading(bool colour) {
  return painted(fmt::format("{:>12}  {:>10}  {:<7}  {}", "ms", "silence", "", "frame"), kDim, colour) + '\n';
}

std::string decoded_text(const ReadFrame& read, bool unanswered, bool colour) {
  const RecordedFrame& frame = read.frame;
  std::string line;
  append_column(line, frame.at ? milliseconds(*frame.at) : "", 12);
  append_column(line, read.silence ? format_duration(*read.silence) : "", 12);
  const std::string_view kind = kind_of(read, "?");
  line.append("  ").append(kind).append(kind.size() < kKindColumn ? kKindColumn - kind.size() : 0, ' ').append("  ");
  line += serial::to_hex(frame.bytes);
  const std::string answered = read.out_of_turn ? fmt::format("; the answer to {}", read.asked_at) : "";
  if (!read.text.empty()) line.append(1, '\n').append(kTextColumn, ' ').append(read.text).append(answered);
  const bool trouble = !read.right || unanswered || (read.direction == Direction::Unknown && !read.echo);
  return (trouble ? painted(line, kYellow, colour) : std::move(line)) + '\n';
}

nlohmann::ordered_json decoded_json(const ReadFrame& read, bool unanswered) {
  return {{"place", read.frame.place},
          {"at_us", microseconds(read.frame.at)},
          {"silence_us", microseconds(read.silence)},
          {"kind", kind_of(read, "stray")},
          {"bytes", plain_hex(read.frame.bytes)},
          {"right", read.right},
          {"text", read.text},
          {"request", read.asked_at.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(read.asked_at)},
          {"latency_us", microseconds(read.latency)},
          {"unanswered", unanswered}};
}

std::string decoded_text(const std::vector<ReadFrame>& frames, bool colour) {
  std::string text = decoded_heading(colour);
  DecodedSummary summary;
  for (const ReadFrame& frame : frames) {
    summary.add(frame);
    text += decoded_text(frame, is_unanswered(frame), colour);
  }
  return text + summary.text();
}

void add_decoded(nlohmann::ordered_json& results, const std::vector<ReadFrame>& frames) {
  DecodedSummary summary;
  results["frames"] = nlohmann::ordered_json::array();
  for (const ReadFrame& frame : frames) {
    summary.add(frame);
    results["frames"].push_back(decoded_json(frame, is_unanswered(frame)));
  }
  results["summary"] = summary.json();
}

}  // namespace s7200::tools

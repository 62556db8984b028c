#include "tools/recordings/decoded.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "serial_sim/line/frame.hpp"
#include "tools/scenario/transcript_writer.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {
namespace {

constexpr const char *kDim = "2", *kYellow = "33";

std::string_view name_of(Direction direction) {
  static constexpr std::string_view kNames[] = {"?", "request", "answer"};
  return kNames[static_cast<std::size_t>(direction)];
}

std::string painted(const std::string& text, const char* paint, bool colour) {
  return colour ? fmt::format("\x1b[{}m{}\x1b[0m", paint, text) : text;
}

nlohmann::ordered_json microseconds(std::optional<Time> time) {
  if (!time) return nullptr;
  return static_cast<double>(*time) / kMicrosecond;
}

/// What keeps a request and its answer out of a scenario; empty if nothing does. `named`: the frame that is no request, if
/// the reason names one.
std::string why_left_out(const std::vector<ReadFrame>& frames, std::size_t number, const ReadFrame*& named) {
  const ReadFrame& request = frames[number];
  if (!request.frame.damaged.empty()) return "the request is damaged";
  if (request.other) {
    const ReadFrame& answer = frames[*request.other];
    return answer.right ? "" : fmt::format("its answer ({}): {}", answer.frame.place, answer.text);
  }
  if (request.needs_no_answer) return {};
  if (request.repeats) return fmt::format("it may be the late echo of {}", frames[*request.repeats].frame.place);
  if (request.frame.more_was_lost) return "the recording is cut off after it";
  const auto next = std::find_if(frames.begin() + static_cast<std::ptrdiff_t>(number) + 1, frames.end(),
                                 [&](const ReadFrame& frame) { return frame.frame.stream == request.frame.stream; });
  if (next == frames.end()) return {};
  if (next->repeats) return fmt::format("the same after it ({}) may be its late echo", next->frame.place);
  if (next->direction != Direction::Unknown) return {};
  named = &*next;
  return fmt::format("what follows it ({}) may be its answer: {}", next->frame.place, next->text);
}

}  // namespace

void DecodedSummary::add(const ReadFrame& frame) {
  requests_ += frame.direction == Direction::Request ? 1U : 0U;
  need_no_answer_ += frame.needs_no_answer ? 1U : 0U;
  strays_ += frame.direction == Direction::Unknown ? 1U : 0U;
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
  return fmt::format("requests: {}, answered: {}{}{}; wrong frames: {}, frames of no request: {}\n", requests_, answered_,
                     times, none, wrong_, strays_);
}

nlohmann::ordered_json DecodedSummary::json() const {
  return {{"requests", requests_},
          {"answered", answered_},
          {"need_no_answer", need_no_answer_},
          {"wrong", wrong_},
          {"strays", strays_},
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
      read.silence ? format_duration(*read.silence) : "", name_of(read.direction), serial::to_hex(frame.bytes),
      read.text.empty() ? "" : fmt::format("\n{:>33}{}", "", read.text));
  const bool trouble = !read.right || unanswered || read.direction == Direction::Unknown;
  return (trouble ? painted(line, kYellow, colour) : line) + '\n';
}

nlohmann::ordered_json decoded_json(const ReadFrame& read) {
  return {{"place", read.frame.place},
          {"at_us", microseconds(read.frame.at)},
          {"silence_us", microseconds(read.silence)},
          {"kind", read.direction == Direction::Unknown ? "stray" : name_of(read.direction)},
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

Playback playback(const std::vector<ReadFrame>& frames, const Stamps& stamps, const PlaybackChoices& choices) {
  constexpr Time kLongestWait = kSecond;
  Playback playback;
  std::string steps;
  bool asks = false;
  const ReadFrame* last = nullptr;
  std::vector<const ReadFrame*> strays;
  const ReadFrame* named = nullptr;  // in a note already
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const ReadFrame& request = frames[i];
    if (request.direction == Direction::Unknown && &request != named) {
      strays.push_back(&request);
      steps += fmt::format("      # {}: left out: {}\n", request.frame.place, request.text);
    }
    const bool wanted = request.direction == Direction::Request && (!choices.station || request.station == choices.station);
    if (!wanted) continue;
    const ReadFrame* answer = request.other ? &frames[*request.other] : nullptr;
    if (const std::string why = why_left_out(frames, i, named); !why.empty()) {
      playback.notes.push_back(fmt::format("{}: left out: {}", request.frame.place, why));
      steps += fmt::format("      # {}\n", playback.notes.back());
      last = nullptr;
      continue;
    }
    asks = true;
    steps += fmt::format("      - send: {}\n", serial::to_hex(request.frame.bytes));
    if (last != nullptr)
      if (const auto pause = silence(last->frame, request.frame, stamps))
        steps += fmt::format("        pause: {}\n", exact(*pause));
    if (answer == nullptr) {
      const auto next = i + 1 < frames.size() ? frames[i + 1].silence : std::nullopt;
      steps += fmt::format("        expect: silence\n        timeout: {}\n",
                           exact(std::clamp(next.value_or(kLongestWait), Time{1}, kLongestWait)));
      last = nullptr;
    } else {
      steps += fmt::format("        expect: {}\n", serial::to_hex(answer->frame.bytes));
      if (const auto took = answer->latency) steps += fmt::format("        latency: {}\n", exact(*took));
      last = answer;
    }
    steps +=
        fmt::format("        # {}: {}{}\n", request.frame.place, request.text, answer == nullptr ? "" : "; " + answer->text);
  }
  if (!strays.empty())
    playback.notes.push_back(fmt::format("{}: left out{}: {}", strays.front()->frame.place,
                                         strays.size() == 1 ? "" : fmt::format(", and {} more", strays.size() - 1),
                                         strays.front()->text));
  if (!asks) return playback;
  playback.scenario = fmt::format("scenarios:\n  - name: {}\n", in_quotes(choices.name));
  if (!choices.program.empty()) playback.scenario += fmt::format("    program: {}\n", in_quotes(choices.program));
  playback.scenario += fmt::format("    tolerance: {}\n    steps:\n{}", exact(choices.tolerance), steps);
  return playback;
}

}  // namespace s7200::tools

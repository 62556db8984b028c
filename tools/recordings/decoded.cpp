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

bool is_trouble(const ReadFrame& frame) {
  return !frame.right || (frame.direction == Direction::Request && !frame.other) || frame.direction == Direction::Unknown;
}

struct Summary {
  std::size_t requests = 0, answered = 0, wrong = 0, strays = 0;
  std::optional<Time> shortest{}, longest{};
};

Summary summary_of(const std::vector<ReadFrame>& frames, const Stamps& stamps) {
  Summary summary;
  for (const ReadFrame& frame : frames) {
    summary.requests += frame.direction == Direction::Request ? 1 : 0;
    summary.strays += frame.direction == Direction::Unknown ? 1 : 0;
    summary.wrong += frame.right ? 0 : 1;
    if (frame.direction != Direction::Request || !frame.other) continue;
    ++summary.answered;
    const auto took = silence(frame, frames[*frame.other], stamps);
    if (!took) continue;
    summary.shortest = std::min(summary.shortest.value_or(*took), *took);
    summary.longest = std::max(summary.longest.value_or(*took), *took);
  }
  return summary;
}

std::string line_of(const ReadFrame& frame, const ReadFrame* before, const Stamps& stamps) {
  const auto quiet = before == nullptr ? std::nullopt : silence(*before, frame, stamps);
  return fmt::format("{:>12}  {:>10}  {:<7}  {}{}",
                     frame.frame->at ? fmt::format("{:.3f}", static_cast<double>(*frame.frame->at) / kMillisecond) : "",
                     quiet ? format_duration(*quiet) : "", name_of(frame.direction), serial::to_hex(frame.frame->bytes),
                     frame.text.empty() ? "" : fmt::format("\n{:>33}{}", "", frame.text));
}

std::string painted(const std::string& text, const char* paint, bool colour) {
  return colour ? fmt::format("\x1b[{}m{}\x1b[0m", paint, text) : text;
}

}  // namespace

std::string decoded_text(const std::vector<ReadFrame>& frames, const Stamps& stamps, bool colour) {
  std::string text = painted(fmt::format("{:>12}  {:>10}  {:<7}  {}", "ms", "silence", "", "frame"), kDim, colour) + '\n';
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string line = line_of(frames[i], i == 0 ? nullptr : &frames[i - 1], stamps);
    text += (is_trouble(frames[i]) ? painted(line, kYellow, colour) : line) + '\n';
  }
  const Summary summary = summary_of(frames, stamps);
  std::string times;
  if (summary.shortest)
    times = fmt::format(" after {} to {}", format_duration(*summary.shortest), format_duration(*summary.longest));
  return text + fmt::format("requests: {}, answered: {}{}; wrong frames: {}, frames of no request: {}\n", summary.requests,
                            summary.answered, times, summary.wrong, summary.strays);
}

void add_decoded(nlohmann::ordered_json& results, const std::vector<ReadFrame>& frames, const Stamps& stamps) {
  const auto microseconds = [](std::optional<Time> time) -> nlohmann::ordered_json {
    if (!time) return nullptr;
    return static_cast<double>(*time) / kMicrosecond;
  };
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const ReadFrame& frame = frames[i];
    const bool answer = frame.direction == Direction::Answer;
    list.push_back({{"place", frame.frame->place},
                    {"at_us", microseconds(frame.frame->at)},
                    {"silence_us", microseconds(i == 0 ? std::nullopt : silence(frames[i - 1], frame, stamps))},
                    {"kind", frame.direction == Direction::Unknown ? "stray" : name_of(frame.direction)},
                    {"bytes", plain_hex(frame.frame->bytes)},
                    {"right", frame.right},
                    {"text", frame.text},
                    {"latency_us", microseconds(answer ? silence(frames[*frame.other], frame, stamps) : std::nullopt)}});
  }
  results["frames"] = std::move(list);
  const Summary summary = summary_of(frames, stamps);
  results["summary"] = {{"requests", summary.requests},
                        {"answered", summary.answered},
                        {"wrong", summary.wrong},
                        {"strays", summary.strays},
                        {"shortest_latency_us", microseconds(summary.shortest)},
                        {"longest_latency_us", microseconds(summary.longest)}};
}

std::string scenario_text(const std::vector<ReadFrame>& frames, const Stamps& stamps, const PlaybackChoices& choices) {
  constexpr Time kLongestWait = kSecond;
  std::string steps;
  const ReadFrame* last = nullptr;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const ReadFrame& request = frames[i];
    const bool wanted = request.direction == Direction::Request && (!choices.station || request.station == choices.station);
    if (!wanted) continue;
    const ReadFrame* answer = request.other ? &frames[*request.other] : nullptr;
    steps += fmt::format("      - send: {}\n", serial::to_hex(request.frame->bytes));
    if (last != nullptr)
      if (const auto pause = silence(*last, request, stamps)) steps += fmt::format("        pause: {}\n", exact(*pause));
    if (answer == nullptr) {
      const auto next = i + 1 < frames.size() ? silence(request, frames[i + 1], stamps) : std::nullopt;
      steps += fmt::format("        expect: silence\n        timeout: {}\n",
                           exact(std::clamp(next.value_or(kLongestWait), Time{1}, kLongestWait)));
      last = nullptr;
    } else {
      steps += fmt::format("        expect: {}\n", serial::to_hex(answer->frame->bytes));
      if (const auto took = silence(request, *answer, stamps)) steps += fmt::format("        latency: {}\n", exact(*took));
      last = answer;
    }
    steps += fmt::format("        # {}: {}{}\n", request.frame->place, request.text,
                         answer == nullptr ? "" : "; " + answer->text);
  }
  if (steps.empty()) return {};
  std::string text = fmt::format("scenarios:\n  - name: {}\n", in_quotes(choices.name));
  if (!choices.program.empty()) text += fmt::format("    program: {}\n", in_quotes(choices.program));
  return text + fmt::format("    tolerance: {}\n    steps:\n{}", exact(choices.tolerance), steps);
}

}  // namespace s7200::tools

#include "tools/command/polling/master_output.hpp"

#include <fmt/format.h>

#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/host_time.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

constexpr int kFailuresShown = 10;
constexpr const char* kEraseLine = "\r\x1b[K";  // ECMA-48

std::string title(const std::string& slave, Time every) {
  return fmt::format("{}, every {}; Ctrl-C ends", stl::printable(slave), every == kNever ? "round" : format_duration(every));
}

}  // namespace

MasterOutput::MasterOutput(const MasterOutputSettings& settings, const std::string& slave)
    : settings_(settings), slave_(slave), table_(title(slave, settings.every), can_redraw(stdout), colour_wanted(stdout)) {}

void MasterOutput::begin() const {
  if (!settings_.json) return;
  auto head = results_of("master");
  head["target"] = slave_;
  fmt::print("{{\n");
  for (const auto& [key, value] : head.items()) fmt::print("  \"{}\": {},\n", key, line_of(value));
  fmt::print("  \"exchanges\": [\n");
}

void MasterOutput::end(const ExchangeStatistics& statistics, const std::string& error, const nlohmann::ordered_json& plant) {
  clear_progress();
  if (settings_.json) {
    fmt::print("{}  ],\n  \"statistics\": {},\n", first_ ? "" : "\n", statistics.json().dump());
    for (const auto& [key, value] : plant.items()) fmt::print("  \"{}\": {},\n", key, line_of(value));
    fmt::print("  \"error\": {}\n}}\n", error.empty() ? "null" : line_of(error));
  } else if (polls() && can_redraw(stdout)) {
    table_.finish();
  } else if (settings_.rounds > 1) {
    fmt::print("{}", statistics.text(settings_.refusal));
  }
}

void MasterOutput::show(const MasterResult& result) {
  if (settings_.json) {
    fmt::print("{}    {}", std::exchange(first_, false) ? "" : ",\n", line_of(to_json(result)));
  } else if (polls() && !settings_.verbose) {
    table_.add(result, result.exchange.request_start);
  } else if (settings_.continuous && !settings_.verbose) {
    show_failure(result);
  } else {
    fmt::print("{}\n", heading(result));
    if (settings_.verbose) fmt::print("{}", frames_text(result));
    for (const std::string& line : lines(result)) fmt::print("{}\n", line);
  }
}

void MasterOutput::end_round(const ExchangeStatistics& statistics) {
  if (settings_.continuous) show_progress(statistics);
  if (polls() && !settings_.json) table_.end_round(can_redraw(stdout) ? statistics.text(settings_.refusal) : "");
}

void MasterOutput::show_failure(const MasterResult& result) {
  if (result.answer.verdict == serial::Verdict::Right || failures_shown_ > kFailuresShown) return;
  clear_progress();
  if (failures_shown_++ == kFailuresShown)
    fmt::print("further failures are only counted\n");
  else
    fmt::print("{}: {}\n", heading(result), short_text(result));
}

/// On a terminal, twice a second, in a line that the next output overwrites.
void MasterOutput::show_progress(const ExchangeStatistics& statistics) {
  constexpr Time kInterval = kSecond / 2;
  if (!can_redraw(stderr) || host_time() - progress_at_ < kInterval) return;
  progress_at_ = host_time();
  const std::string text = statistics.text(settings_.refusal);
  fmt::print(stderr, "{}{}\r", kEraseLine, text.substr(0, text.find('\n')));
}

void MasterOutput::clear_progress() {
  if (std::exchange(progress_at_, 0) != 0) fmt::print(stderr, "{}", kEraseLine);
}

}  // namespace s7200::tools

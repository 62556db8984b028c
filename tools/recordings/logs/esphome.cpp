// What ESPHome logs of a UART with `debug:`: `[10:00:00.000][D][uart_debug:114]: >>> 01:03:00`, with the bytes in hex or in
// decimal, with any separator, in binary, or as a text with escapes.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/result.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/notation.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kTag = "[uart_debug:", kSent = ">>> ", kReceived = "<<< ";

struct LoggedBytes {
  std::size_t number = 0;  ///< of the line
  std::optional<LeadingTime> time{};
  Direction direction = Direction::Unknown;
  std::string_view written{};
};

/// The line without the sequence that sets its colour: ESC [ ... m.
std::string_view after_colour(std::string_view line) {
  if (!line.starts_with("\x1b[")) return line;
  const std::size_t end = line.find('m');
  return end == std::string_view::npos ? line : line.substr(end + 1);
}

std::optional<LoggedBytes> logged_bytes(std::string_view line) {
  line = after_colour(line);
  const std::size_t tag = line.find(kTag);
  if (tag == std::string_view::npos) return {};
  const std::size_t arrow = std::min(line.find(kSent, tag), line.find(kReceived, tag));
  if (arrow == std::string_view::npos) return {};
  std::string_view written = line.substr(arrow + kSent.size());
  written = stl::trim(written.substr(0, written.find('\x1b')));
  return LoggedBytes{.time = leading_time(line),
                     .direction = line[arrow] == '>' ? Direction::Request : Direction::Answer,
                     .written = written};
}

bool is_literal(std::string_view written) {
  return written.size() >= 2 && written.starts_with('"') && written.ends_with('"');
}

/// The parts between separators, which are one sign or a blank: `01:03`, `1,3`, `0b00000001 (0x01) 0b…`.
std::vector<std::string> parts_of(std::string_view written) {
  std::vector<std::string> parts(1);
  for (std::size_t i = 0; i < written.size(); ++i) {
    const bool goes_on = written[i] == ' ' && i + 1 < written.size() && written[i + 1] == '(';
    if (goes_on || std::string_view(" :,.;-|/").find(written[i]) == std::string_view::npos)
      parts.back() += written[i];
    else
      parts.emplace_back();
  }
  std::erase(parts, "");
  return parts;
}

}  // namespace

bool looks_like_esphome(std::string_view bytes) {
  return is_text(bytes) && beginning_of(bytes).find(kTag) != std::string_view::npos;
}

Result<LineRecording> read_esphome(std::string_view bytes, const ReadingChoices& choices) {
  std::vector<LoggedBytes> all;
  LeftOut left_out;
  NotationFinder finder;
  bool has_numbers = false;
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes, choices.stop)) {
    ++number;
    auto logged = logged_bytes(line);
    if (!logged) {
      if (!stl::trim(line).empty()) left_out.without_bytes(number);
      continue;
    }
    logged->number = number;
    if (!is_literal(logged->written))
      for (const std::string& part : parts_of(logged->written)) finder.take(part, logged->number), has_numbers = true;
    all.push_back(std::move(*logged));
  }
  const auto notation = has_numbers ? finder.found() : Trouble{};
  if (has_numbers && !notation) return notation.trouble();
  LineRecording recording;
  DayCounter days;
  for (const LoggedBytes& logged : all) {
    Bytes frame;
    if (is_literal(logged.written)) {
      const auto literal = bytes_of_literal(logged.written.substr(1, logged.written.size() - 2));
      if (!literal) {
        recording.frames.push_back(row_not_read(
            logged.number, not_understood(logged.written),
            logged.time ? std::optional(days.since_first_midnight(*logged.time)) : std::nullopt, logged.direction));
        continue;
      }
      frame = *literal;
    } else {
      for (const std::string& part : parts_of(logged.written)) {
        const Bytes some = *notation->read(part);
        frame.insert(frame.end(), some.begin(), some.end());
      }
    }
    if (frame.empty()) {
      left_out.without_bytes(logged.number);
      continue;
    }
    recording.frames.push_back({.at = logged.time ? std::optional(days.since_first_midnight(*logged.time)) : std::nullopt,
                                .direction = logged.direction,
                                .bytes = std::move(frame),
                                .place = fmt::format("line {}", logged.number)});
  }
  count_from_first(recording);
  left_out.tell(recording);
  return recording;
}

}  // namespace s7200::tools

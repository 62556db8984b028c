#include "tools/recordings/logs/two_loggers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <vector>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

/// Words that say which way a frame goes or what it is, not who logged it.
constexpr std::array<std::string_view, 28> kWays{"TX",   "RX",   "IN",       "OUT",     "SEND",   "SENT",      "SENDING",
                                                 "RECV", "READ", "RECEIVED", "RECEIVE", "WRITE",  "REQUEST",   "RESPONSE",
                                                 "REQ",  "RSP",  "RESP",     "ANSWER",  "REPLY",  "RECEIVING", "AT",
                                                 "TO",   "FROM", "BYTES",    "LEN",     "LENGTH", "HEX",       "DATA"};

/// The names in a row besides its time, its way and its bytes: `[plc]`, `slave:`
std::string name_in(std::string_view line) {
  std::string names;
  for (std::size_t at = 0; at < line.size();) {
    const auto is_of_word = [](char c) { return is_word_sign(c) || c == '-' || c == '.' || c == '/'; };
    const std::size_t end = static_cast<std::size_t>(
        std::find_if_not(line.begin() + static_cast<std::ptrdiff_t>(at), line.end(), is_of_word) - line.begin());
    const std::string_view word = line.substr(at, end - at);
    const bool beyond_hex = std::ranges::any_of(word, [](char c) { return stl::is_letter(c) && !is_hex_digit(c); });
    const bool is_time = !word.empty() && stl::is_digit(word.front());
    if (beyond_hex && !is_time && std::ranges::find(kWays, stl::upper_case(word)) == kWays.end())
      names.append(names.empty() ? "" : " ").append(word);
    at = end + 1;
  }
  return names;
}

struct Logger {
  std::string name{};
  std::vector<std::size_t> frames{};  ///< their indices
};

/// Whether there are requests and answers: both directions, or two lengths for the same station and function.
bool has_both_ways(const LineRecording& recording, const Logger& logger) {
  std::set<Direction> directions;
  std::map<std::uint32_t, std::size_t> lengths;
  bool differ = false;
  for (const std::size_t i : logger.frames) {
    const RecordedFrame& frame = recording.frames[i];
    directions.insert(frame.direction);
    if (frame.bytes.size() < 2) continue;
    const auto [row, is_new] = lengths.emplace(load16(frame.bytes.data()), frame.bytes.size());
    differ |= !is_new && row->second != frame.bytes.size();
  }
  return differ || (directions.contains(Direction::Request) && directions.contains(Direction::Answer));
}

std::vector<Bytes> bytes_in(const LineRecording& recording, const Logger& logger) {
  std::vector<Bytes> bytes;
  for (const std::size_t i : logger.frames) bytes.push_back(recording.frames[i].bytes);
  std::ranges::sort(bytes);
  return bytes;
}

std::string in_quotes(const std::string& name) {
  return name.empty() ? "no name" : fmt::format("'{}'", stl::printable(stl::shortened(name)));
}

}  // namespace

void keep_one_logger(LineRecording& recording, std::string_view text) {
  constexpr std::size_t kFewest = 2, kMostNames = 2;
  constexpr std::size_t kSeen = 1000;  // rows with one name, after which no other is looked for
  std::vector<Logger> loggers;
  Lines lines(text);
  auto line = lines.begin();
  std::size_t number = 1;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const std::size_t wanted = recording.frames[i].line;
    if (wanted < number || (i == kSeen && loggers.size() == 1)) return;
    for (; number < wanted && line != lines.end(); ++number) ++line;
    if (line == lines.end()) return;
    const std::string name = name_in(*line);
    auto logger = std::ranges::find(loggers, name, &Logger::name);
    if (logger == loggers.end()) {
      if (loggers.size() == kMostNames) return;
      logger = loggers.insert(loggers.end(), Logger{.name = name});
    }
    logger->frames.push_back(i);
  }
  if (loggers.size() != kMostNames) return;
  const Logger &kept = loggers[0], &other = loggers[1];
  if (kept.frames.size() < kFewest || !has_both_ways(recording, kept) || !has_both_ways(recording, other)) return;
  if (bytes_in(recording, kept) != bytes_in(recording, other)) return;
  std::vector<RecordedFrame> frames;
  for (const std::size_t i : kept.frames) frames.push_back(std::move(recording.frames[i]));
  recording.frames = std::move(frames);
  recording.notes.push_back(fmt::format("two programs have logged the same frames, {} and {}: those of {} are shown",
                                        in_quotes(kept.name), in_quotes(other.name), in_quotes(kept.name)));
}

}  // namespace s7200::tools

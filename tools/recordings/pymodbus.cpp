// What pymodbus logs at the level DEBUG, under whatever head the program's logger gives each line:
//
//   send: 0x1 0x3 0x0 0x0 0x0 0x1 0x84 0xa
//   recv: 0x1 0x3 0x2 old_data:  addr=None             what has come; behind old_data:, later extra data:, what waits
//   already recv: 0x12 0x34 0xb5 0x33 old_data: 0x1 0x3 0x2 addr=None Processing: 0x1 0x3 0x2 0x12 0x34 0xb5 0x33        the
//   same bytes once more, as have Getting Frame - and others
#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "interpreter/base/text.hpp"
#include "tools/recordings/fields.hpp"
#include "tools/recordings/forms.hpp"

namespace s7200::tools {
namespace {

using Match = std::match_results<std::string_view::const_iterator>;

struct Moved {
  bool sent = false;
  Bytes bytes{}, waiting{};  ///< and what was there of the frame before
};

bool search(std::string_view line, Match& match, const std::regex& pattern) {
  return std::regex_search(line.begin(), line.end(), match, pattern);
}

std::optional<Moved> moved_in(std::string_view line) {
  static const std::regex kMoved(
      R"(\b(send|recv|SEND|RECV): ((?:0[xX][0-9a-fA-F]{1,2}\s*)+)(?:(?:old_data|extra data): *(.*))?)");
  Match match;
  if (!search(line, match, kMoved)) return {};
  const std::string rest = match.str(3);
  return Moved{.sent = match.str(1) == "send" || match.str(1) == "SEND",
               .bytes = bytes_of_text(match.str(2)).value_or(Bytes{}),
               .waiting = bytes_of_text(rest.substr(0, rest.find(" addr="))).value_or(Bytes{})};
}

bool says_it_again(std::string_view line) {
  static const std::regex kAgain(R"(\bProcessing: 0x|\brecv: 0x.*\b(old_data|extra data):)");
  Match match;
  return search(line, match, kAgain);
}

/// The frame that has come so far goes on with these bytes.
bool goes_on(const LineRecording& recording, const Moved& moved, Direction direction) {
  return !moved.sent && !moved.waiting.empty() && !recording.frames.empty() &&
         recording.frames.back().direction == direction && recording.frames.back().bytes == moved.waiting;
}

}  // namespace

bool looks_like_pymodbus(std::string_view bytes) {
  return is_text(bytes) && std::ranges::any_of(stl::split_lines(bytes), says_it_again);
}

/// A log that begins with what was sent is a client's. One that begins with what has come may be a server's, or begin in the
/// middle: then the frames have to say it themselves.
std::optional<LineRecording> read_pymodbus(const std::string& bytes, const ReadingChoices&, std::string&) {
  LineRecording recording;
  DayCounter days;
  std::optional<bool> is_client;
  std::size_t number = 0;
  for (const std::string& line : stl::split_lines(bytes)) {
    ++number;
    auto moved = moved_in(line);
    if (!moved) continue;
    if (!is_client) is_client = moved->sent;
    const Direction who = moved->sent ? Direction::Request : Direction::Answer;
    const Direction direction = *is_client ? who : Direction::Unknown;
    if (goes_on(recording, *moved, direction)) {
      Bytes& frame = recording.frames.back().bytes;
      frame.insert(frame.end(), moved->bytes.begin(), moved->bytes.end());
      continue;
    }
    const auto time = leading_time(line);
    recording.frames.push_back({.at = time ? std::optional(days.since_first_midnight(*time)) : std::nullopt,
                                .direction = direction,
                                .bytes = std::move(moved->bytes),
                                .place = fmt::format("line {}", number)});
  }
  count_from_first(recording);
  return recording;
}

}  // namespace s7200::tools

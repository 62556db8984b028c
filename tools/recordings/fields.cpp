#include "tools/recordings/fields.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <regex>

#include "interpreter/base/text.hpp"

namespace s7200::tools {
namespace {

using Match = std::match_results<std::string_view::const_iterator>;

constexpr Time kDay = 86'400 * kSecond, kFarthest = 36'525 * kDay;

bool search(std::string_view text, Match& match, const std::regex& pattern) {
  return std::regex_search(text.begin(), text.end(), match, pattern);
}

/// `5` of a fraction is 500 ms.
Time fraction(std::string digits) {
  digits.resize(9, '0');
  return std::stoll(digits);
}

std::optional<std::int32_t> day_number(int year, unsigned month, unsigned day) {
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
  if (!date.ok() || year < 1970 || year > 2069) return {};
  return std::chrono::sys_days(date).time_since_epoch().count();
}

/// `2026-11-22`, `22.11.2026`; with slashes either the day or the month is first.
ReadDate date_of(const std::string& text) {
  const auto number = [&](std::size_t at, std::size_t digits) { return std::stoi(text.substr(at, digits)); };
  const auto unsigned_at = [&](std::size_t at) { return static_cast<unsigned>(number(at, 2)); };
  if (text[2] != '.' && text[2] != '/') {
    const auto date = day_number(number(0, 4), unsigned_at(5), unsigned_at(8));
    return {date, date};
  }
  constexpr int kCentury = 2000;
  const int written = number(6, std::string::npos), year = written < 100 ? kCentury + written : written;
  const auto day_first = day_number(year, unsigned_at(3), unsigned_at(0));
  if (text[2] == '.') return {day_first, day_first};
  return {day_first, day_number(year, unsigned_at(0), unsigned_at(3))};
}

std::optional<LeadingTime> time_of_day(std::string_view text) {
  static const std::regex kPattern(
      R"(^[\s\[\(]*(?:(\d{4}-\d\d-\d\d|\d\d[./]\d\d[./]\d{2,4})[T ])?(\d{1,2}):(\d\d):(\d\d)(?:[.,:](\d{1,9}))?[\s\]\):,;|]*)");
  Match match;
  if (!search(text, match, kPattern)) return {};
  const auto number = [&](int i) { return std::stoll(match.str(static_cast<std::size_t>(i))); };
  const Time time =
      ((number(2) * 60 + number(3)) * 60 + number(4)) * kSecond + (match[5].matched ? fraction(match.str(5)) : 0);
  return LeadingTime{.time = time,
                     .length = static_cast<std::size_t>(match.length()),
                     .of_day = true,
                     .date = match[1].matched ? date_of(match.str(1)) : ReadDate{}};
}

std::optional<LeadingTime> time_since(std::string_view text) {
  static const std::regex kPattern(
      R"(^[\s\[\(+]*(-?)(\d{1,10})(?:[.,](\d{1,9}))?\s*(s|ms|us)?(?![0-9A-Za-z.])[\s\]\):,;|]*)");
  Match match;
  if (!search(text, match, kPattern) || !(match[3].matched || match[4].matched)) return {};
  const Time unit = match.str(4) == "ms" ? kMillisecond : match.str(4) == "us" ? kMicrosecond : kSecond;
  const Time part = match[3].matched ? fraction(match.str(3)) / (kSecond / unit) : 0;
  const Time whole = std::stoll(match.str(2));
  if (whole >= kFurthestTime / unit) return {};
  const Time time = whole * unit + part;
  return LeadingTime{.time = match.length(1) == 0 ? time : -time, .length = static_cast<std::size_t>(match.length())};
}

}  // namespace

std::optional<LeadingTime> leading_time(std::string_view text) {
  if (const auto time = time_of_day(text)) return time;
  return time_since(text);
}

Direction direction_of(std::string_view text) {
  static constexpr std::array kRequests{"TX", "SENT", "SEND", "WRITE", "REQUEST", "QUERY", "MASTER", "->", ">"};
  static constexpr std::array kAnswers{"RX", "RECV", "RECEIVED", "READ", "RESPONSE", "ANSWER", "REPLY", "SLAVE", "<-", "<"};
  const std::string words = stl::upper_case(text);
  const auto has = [&](const char* word) {
    const std::string wanted = word;
    for (std::size_t at = words.find(wanted); at != std::string::npos; at = words.find(wanted, at + 1)) {
      const auto is_letter = [&](std::size_t i) {
        return i < words.size() && std::isalpha(static_cast<unsigned char>(words[i]));
      };
      const bool alone = !is_letter(at - 1) && !is_letter(at + wanted.size());
      if (alone || !std::isalpha(static_cast<unsigned char>(wanted[0]))) return true;
    }
    return false;
  };
  const bool request = std::ranges::any_of(kRequests, has), answer = std::ranges::any_of(kAnswers, has);
  if (request == answer) return Direction::Unknown;
  return request ? Direction::Request : Direction::Answer;
}

std::optional<Bytes> bytes_of_text(std::string_view text) {
  const auto found = trailing_bytes(text);
  if (!found || text.substr(0, found->begin).find_first_not_of(" \t\"[<(") != std::string_view::npos) return {};
  return found->bytes;
}

/// Goes back from the end, two digits at a time.
std::optional<TrailingBytes> trailing_bytes(std::string_view line) {
  constexpr std::string_view kBetween = " \t,;-[]<>()\"\r";
  const auto digit = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
  Bytes bytes;
  std::size_t begin = line.size(), at = line.size(), whole = 0;
  for (;;) {
    while (at > 0 && kBetween.find(line[at - 1]) != std::string_view::npos) --at;
    if (at < 2 || !digit(line[at - 1]) || !digit(line[at - 2])) break;
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(std::string(line.substr(at - 2, 2)), nullptr, 16)));
    at -= 2;
    if (at >= 2 && (line[at - 1] == 'x' || line[at - 1] == 'X') && line[at - 2] == '0') at -= 2;
    const bool in_a_word =
        at > 0 && (std::isalnum(static_cast<unsigned char>(line[at - 1])) || line[at - 1] == '.' || line[at - 1] == '_');
    const bool goes_on = at >= 2 && digit(line[at - 1]) && digit(line[at - 2]);
    if (in_a_word && !goes_on) break;
    if (in_a_word) continue;
    begin = at;
    whole = bytes.size();
  }
  bytes.resize(whole);
  if (bytes.empty()) return {};
  std::ranges::reverse(bytes);
  return TrailingBytes{std::move(bytes), begin};
}

void join_characters(LineRecording& recording, const ReadingChoices& choices) {
  const Time gap = choices.gap == 0 ? kCharacterGap : choices.gap;
  std::vector<RecordedFrame> frames;
  std::optional<Time> last;
  for (RecordedFrame& row : recording.frames) {
    const bool joins =
        !frames.empty() && frames.back().direction == row.direction && last && row.at && *row.at - *last <= gap;
    last = row.at;
    if (!joins) frames.push_back({.at = row.at, .direction = row.direction, .place = row.place, .stream = row.stream});
    RecordedFrame& frame = frames.back();
    for (const std::size_t place : row.damaged) frame.damaged.push_back(frame.bytes.size() + place);
    frame.bytes.insert(frame.bytes.end(), row.bytes.begin(), row.bytes.end());
    if (row.at) frame.times.push_back(*row.at);
  }
  recording.frames = std::move(frames);
}

Time DayCounter::since_first_midnight(const LeadingTime& read) {
  if (!read.of_day) return read.time;
  std::optional<Time> later;
  for (std::size_t i = 0; i < read.date.size(); ++i) {
    if (!read.date[i] || !date_[i]) continue;
    const Time days = *read.date[i] - *date_[i];
    if (!later || std::abs(days) < std::abs(*later)) later = days;
  }
  if (!later) later = last_ && *last_ - (days_ + read.time) > kDay / 2 ? 1 : 0;
  days_ = std::clamp(days_ + *later * kDay, -kFarthest, kFarthest);
  date_ = read.date;
  last_ = days_ + read.time;
  return *last_;
}

void count_from_first(LineRecording& recording) {
  std::optional<Time> first;
  for (RecordedFrame& frame : recording.frames) {
    if (!frame.at) continue;
    if (!first) first = frame.at;
    *frame.at -= *first;
  }
}

}  // namespace s7200::tools

#include "tools/recordings/fields.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <regex>

#include "interpreter/base/text.hpp"

namespace s7200::tools {
namespace {

using Match = std::match_results<std::string_view::const_iterator>;

constexpr Time kDay = 86'400 * kSecond;

bool search(std::string_view text, Match& match, const std::regex& pattern) {
  return std::regex_search(text.begin(), text.end(), match, pattern);
}

/// `5` of a fraction is 500 ms.
Time fraction(std::string digits) {
  digits.resize(9, '0');
  return std::stoll(digits);
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::optional<LeadingTime> time_of_day(std::string_view text) {
  static const std::regex kPattern(
      R"(^[\s\[\(]*(?:(?:\d{4}-\d\d-\d\d|\d\d[./]\d\d[./]\d{2,4})[T ])?(\d{1,2}):(\d\d):(\d\d)(?:[.,:](\d{1,9}))?[\s\]\):,;|]*)");
  Match match;
  if (!search(text, match, kPattern)) return {};
  const auto number = [&](int i) { return std::stoll(match.str(static_cast<std::size_t>(i))); };
  const Time time =
      ((number(1) * 60 + number(2)) * 60 + number(3)) * kSecond + (match[4].matched ? fraction(match.str(4)) : 0);
  return LeadingTime{time, static_cast<std::size_t>(match.length())};
}

std::optional<LeadingTime> time_since(std::string_view text) {
  static const std::regex kPattern(R"(^[\s\[\(+]*(\d{1,9})(?:[.,](\d{1,9}))?\s*(s|ms|us)?(?![0-9A-Za-z.])[\s\]\):,;|]*)");
  Match match;
  if (!search(text, match, kPattern) || !(match[2].matched || match[3].matched)) return {};
  const Time unit = match.str(3) == "ms" ? kMillisecond : match.str(3) == "us" ? kMicrosecond : kSecond;
  const Time part = match[2].matched ? fraction(match.str(2)) / (kSecond / unit) : 0;
  return LeadingTime{std::stoll(match.str(1)) * unit + part, static_cast<std::size_t>(match.length())};
}

}  // namespace

std::optional<LeadingTime> leading_time(std::string_view text) {
  if (const auto time = time_of_day(text)) return time;
  return time_since(text);
}

Direction direction_of(std::string_view text) {
  static constexpr std::array kRequests{"tx", "sent", "send", "write", "request", "query", "master", "->", ">"};
  static constexpr std::array kAnswers{"rx", "recv", "received", "read", "response", "answer", "reply", "slave", "<-", "<"};
  const std::string words = lower(text);
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

void join_characters(LineRecording& recording, Time gap) {
  std::vector<RecordedFrame> frames;
  std::optional<Time> last;
  for (RecordedFrame& row : recording.frames) {
    const bool joins =
        !frames.empty() && frames.back().direction == row.direction && last && row.at && *row.at - *last <= gap;
    last = row.at;
    if (!joins) frames.push_back({.at = row.at, .direction = row.direction, .place = row.place, .stream = row.stream});
    frames.back().bytes.insert(frames.back().bytes.end(), row.bytes.begin(), row.bytes.end());
    if (row.at) frames.back().times.push_back(*row.at);
  }
  recording.frames = std::move(frames);
}

void count_from_first(LineRecording& recording) {
  Time days = 0;
  std::optional<Time> first, last;
  for (RecordedFrame& frame : recording.frames) {
    if (!frame.at) continue;
    Time at = *frame.at + days;
    if (last && *last - at > kDay / 2) {
      days += kDay;
      at += kDay;
    }
    last = at;
    if (!first) first = at;
    frame.at = at - *first;
  }
}

}  // namespace s7200::tools

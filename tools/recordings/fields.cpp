#include "tools/recordings/fields.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdlib>

#include "interpreter/base/text.hpp"

namespace s7200::tools {
namespace {

constexpr Time kDay = 86'400 * kSecond, kFarthest = 36'525 * kDay;

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

/// `2026-11-22`, `2026/11/22`, `22.11.2026`, `3/1/2026`; with slashes and the year last, either the day or the month is
/// first.
ReadDate date_of(const std::string& text) {
  constexpr std::string_view kSeparators = "-./";
  const std::size_t second = text.find_first_of(kSeparators) + 1, third = text.find_first_of(kSeparators, second) + 1;
  const char separator = text[second - 1];
  const int a = std::stoi(text), b = std::stoi(text.substr(second)), c = std::stoi(text.substr(third));
  const auto of = [](int year, int month, int day) {
    return day_number(year, static_cast<unsigned>(month), static_cast<unsigned>(day));
  };
  if (separator == '-' || second == 5) return {of(a, b, c), of(a, b, c)};
  constexpr int kCentury = 2000;
  const int year = c < 100 ? kCentury + c : c;
  if (separator == '.') return {of(year, b, a), of(year, b, a)};
  return {of(year, b, a), of(year, a, b)};
}

std::optional<LeadingTime> time_of_day(std::string_view text) {
  static const std::regex kPattern(
      R"([\s\[\(]*(?:(\d{4}[-/]\d\d[-/]\d\d|\d\d?[./]\d\d?[./]\d{2,4})[T ])?(\d{1,2}):(\d\d):(\d\d)(?:[.,:](\d{1,9}))?(?:\s?([AP])M)?[\s\]\):,;|]*)");
  TextMatch match;
  if (!begins_with(text, match, kPattern)) return {};
  const auto number = [&](int i) { return std::stoll(match.str(static_cast<std::size_t>(i))); };
  const Time written = number(2), hour = !match[6].matched ? written : written % 12 + (match.str(6) == "P" ? 12 : 0);
  const Time time = ((hour * 60 + number(3)) * 60 + number(4)) * kSecond + (match[5].matched ? fraction(match.str(5)) : 0);
  return LeadingTime{.time = time,
                     .length = static_cast<std::size_t>(match.length()),
                     .of_day = true,
                     .date = match[1].matched ? date_of(match.str(1)) : ReadDate{}};
}

std::optional<LeadingTime> time_since(std::string_view text) {
  static const std::regex kPattern(
      R"([\s\[\(+]*(-?)(\d{1,10})(?:[.,](\d{1,9}))?\s*(s|ms|us)?(?![0-9A-Za-z.])[\s\]\):,;|]*)");
  TextMatch match;
  if (!begins_with(text, match, kPattern) || !(match[3].matched || match[4].matched)) return {};
  const Time unit = match.str(4) == "ms" ? kMillisecond : match.str(4) == "us" ? kMicrosecond : kSecond;
  const Time part = match[3].matched ? fraction(match.str(3)) / (kSecond / unit) : 0;
  const Time whole = std::stoll(match.str(2));
  if (whole >= kFurthestTime / unit) return {};
  const Time time = whole * unit + part;
  return LeadingTime{.time = match.length(1) == 0 ? time : -time, .length = static_cast<std::size_t>(match.length())};
}

/// What stands between blanks, or the part of it that has bytes.
struct Word {
  std::string_view text;
  std::size_t begin = 0;
  Bytes bytes{};  ///< none: it is something else
};
using Words = std::span<const Word>;

bool is_digit(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }

std::vector<Word> words_of(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<Word> words;
  for (std::size_t begin = text.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    words.push_back({.text = text.substr(begin, end - begin), .begin = begin});
    begin = text.find_first_not_of(kBlanks, end);
  }
  return words;
}

/// `2026-11-22`. Few words are long enough to be searched for one.
bool has_date(std::string_view word) {
  constexpr std::size_t kDateLength = 10;
  static const std::regex kDate(R"((19|20)\d\d-[01]\d-[0-3]\d)");
  return word.size() >= kDateLength && std::regex_search(word.begin(), word.end(), kDate);
}

/// `01`, `0103`, `0x1`, `01-03`, `[01][03]`, `0x01,`; a date is none.
std::optional<Bytes> bytes_of_word(std::string_view word) {
  constexpr std::string_view kOpening = "[<(\"", kBetween = ",;-[]<>()\"";
  if (has_date(word)) return {};
  Bytes bytes;
  std::size_t at = std::min(word.find_first_not_of(kOpening), word.size());
  while (at < word.size()) {
    const bool marked = word.substr(at, 2) == "0x" || word.substr(at, 2) == "0X";
    const std::size_t begin = at + (marked ? 2 : 0);
    for (at = begin; at < word.size() && is_digit(word[at]);) ++at;
    const std::size_t digits = at - begin;
    if (digits == 0 || (digits % 2 != 0 && !(marked && digits == 1))) return {};
    for (std::size_t i = begin; i < at; i += 2)
      bytes.push_back(
          static_cast<std::uint8_t>(std::stoi(std::string(word.substr(i, std::min<std::size_t>(2, at - i))), nullptr, 16)));
    const std::size_t next = std::min(word.find_first_not_of(kBetween, at), word.size());
    if (next == at && at < word.size()) return {};
    at = next;
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

/// A comment stands after `;`, `//` or `#` after a blank, or after a `;` that closes the bytes. Where `;` divides the
/// bytes, there is one after the first.
std::string_view without_comment(std::string_view line) {
  if (line.find_first_of(";/#") == std::string_view::npos) return line;
  static const std::regex kMark(R"(\s(;|//|#))"), kClosing(R"([0-9A-Fa-f]\s(0x)?[0-9A-Fa-f]{1,4};(\s|$))");
  TextMatch match;
  if (std::regex_search(line.begin(), line.end(), match, kMark))
    line = line.substr(0, static_cast<std::size_t>(match.position()));
  if (std::regex_search(line.begin(), line.end(), match, kClosing))
    line = line.substr(0, static_cast<std::size_t>(match.position() + match.length()) - 1);
  return line;
}

/// `feed` and `added` after pairs of digits are words of a language.
bool is_of_a_language(std::string_view word) { return word.size() > 2 && std::ranges::all_of(word, is_letter); }

/// `Tx:01` is `01` after its name; `len=09` is none.
std::size_t length_of_name(std::string_view word) {
  const std::size_t end = word.find_last_of(":;>,])-|");
  if (end == std::string_view::npos || end + 1 == word.size()) return 0;
  const std::string_view name = word.substr(0, end + 1);
  const bool named = std::ranges::any_of(name, [](char c) { return is_letter(c) && !is_digit(c); });
  return named && name.find('=') == std::string_view::npos ? name.size() : 0;
}

std::vector<Word> words_of_bytes_and_others(std::string_view line) {
  std::vector<Word> words;
  bool in_pairs = false;
  for (Word word : words_of(line)) {
    auto bytes = in_pairs && is_of_a_language(word.text) ? std::nullopt : bytes_of_word(word.text);
    if (const std::size_t name = bytes ? 0 : length_of_name(word.text); name > 0)
      if ((bytes = bytes_of_word(word.text.substr(name)))) {
        words.push_back({.text = word.text.substr(0, name), .begin = word.begin});
        word = {.text = word.text.substr(name), .begin = word.begin + name};
      }
    in_pairs = bytes && bytes->size() == 1;
    if (bytes) word.bytes = std::move(*bytes);
    words.push_back(std::move(word));
  }
  return words;
}

bool names_a_direction(const Word& word) { return direction_of(word.text) != Direction::Unknown; }

/// `1`, `3G`, `??`, `123` beside bytes: one of them may be damaged.
bool may_be_a_damaged_byte(const Word& word) {
  if (names_a_direction(word)) return false;
  const auto is_sign = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '?' || c == '*'; };
  return (word.text.size() <= 2 && std::ranges::any_of(word.text, is_sign) && std::ranges::all_of(word.text, is_sign)) ||
         word.text.find_first_of("?*") != std::string_view::npos ||
         (std::ranges::all_of(word.text, is_digit) && !is_of_a_language(word.text));
}

/// `:010300C80002`, of Modbus ASCII: it ends with digits that may be bytes. A clock, a decimal and `len=09` do not.
bool ends_with_digits(const Word& word) {
  const std::size_t end = word.text.find_last_not_of("0123456789ABCDEFabcdef");
  if (end == std::string_view::npos || end + 1 == word.text.size()) return false;
  static const std::regex kNoByte(R"(\d:\d\d|\d[.,]\d{1,9}$|=)");
  return std::ispunct(static_cast<unsigned char>(word.text[end])) != 0 &&
         !std::regex_search(word.text.begin(), word.text.end(), kNoByte);
}

/// `E4 09 be` before `careful`: no tool writes capitals and small letters.
bool has_both_cases(Words run) {
  const auto any = [&](std::string_view letters) {
    return std::ranges::any_of(run, [&](const Word& w) { return w.text.find_first_of(letters) != std::string_view::npos; });
  };
  return any("ABCDEF") && any("abcdef");
}

/// Of what stands before the bytes and after them; null if all is well. Bytes before them may be a number or a date in
/// front of the direction.
const Word* what_is_doubtful(Words before, Words run, Words after) {
  if (!before.empty() && (may_be_a_damaged_byte(before.back()) || ends_with_digits(before.back()))) return &before.back();
  const auto other = std::ranges::find_if(before, [](const Word& word) { return !word.bytes.empty(); });
  if (other != before.end()) {
    const bool after_direction = std::any_of(before.begin(), other, names_a_direction);
    const bool named = names_a_direction(before.back()) ||
                       std::string_view(":>-)]|").find(before.back().text.back()) != std::string_view::npos;
    if (after_direction || !named)
      return &*std::find_if(other, before.end(), [](const Word& word) { return word.bytes.empty(); });
  }
  if (after.empty()) return nullptr;
  if (has_both_cases(run)) return &run.back();
  const std::string_view next = after.front().text;
  const bool is_comment = next.front() == '(' || (next.size() > 2 && std::all_of(next.begin(), next.begin() + 3, is_letter));
  return is_comment && (run.size() > 1 || run.front().bytes.size() > 1) ? nullptr : &after.front();
}

struct Unit {
  std::string_view word;
  Time time;
};
constexpr std::array kUnits{Unit{"S", kSecond},
                            Unit{"SEC", kSecond},
                            Unit{"SECONDS", kSecond},
                            Unit{"MS", kMillisecond},
                            Unit{"US", kMicrosecond},
                            Unit{"\u00B5S", kMicrosecond},
                            Unit{"\u03BCS", kMicrosecond},
                            Unit{"NS", 1},
                            Unit{"MILLISECONDS", kMillisecond},
                            Unit{"MICROSECONDS", kMicrosecond},
                            Unit{"NANOSECONDS", 1}};

}  // namespace

std::optional<LeadingTime> leading_time(std::string_view text) {
  if (const auto time = time_of_day(text)) return time;
  return time_since(text);
}

std::optional<Time> unit_of(std::string_view name) {
  const std::string capitals = stl::upper_case(name);
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0; };
  for (auto begin = capitals.begin(); begin != capitals.end();) {
    begin = std::find_if(begin, capitals.end(), is_letter);
    const auto end = std::find_if_not(begin, capitals.end(), is_letter);
    const auto unit = std::ranges::find(kUnits, std::string_view(begin, end), &Unit::word);
    if (unit != kUnits.end()) return unit->time;
    begin = end;
  }
  return {};
}

Direction direction_of_brackets(std::string_view bytes) {
  if (bytes.starts_with('[')) return Direction::Request;
  if (bytes.starts_with('<')) return Direction::Answer;
  return Direction::Unknown;
}

Direction direction_of(std::string_view text) {
  static constexpr std::array kRequests{"TX", "SENT", "SEND", "WRITE", "WRITTEN", "REQUEST", "QUERY", "MASTER", "->", ">"};
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
  Bytes bytes;
  for (const Word& word : words_of(text)) {
    const auto some = bytes_of_word(word.text);
    if (!some) return {};
    bytes.insert(bytes.end(), some->begin(), some->end());
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

std::optional<BytesInLine> bytes_in_line(std::string_view line) {
  const std::vector<Word> words = words_of_bytes_and_others(without_comment(line));
  const auto has_bytes = [](const Word& word) { return !word.bytes.empty(); };
  const auto last = std::find_if(words.rbegin(), words.rend(), has_bytes).base();
  if (last == words.begin()) return {};
  const auto first = std::find_if_not(std::reverse_iterator(last), words.rend(), has_bytes).base();
  BytesInLine found{.begin = first->begin, .end = (last - 1)->begin + (last - 1)->text.size()};
  if (const Word* const doubtful = what_is_doubtful({words.begin(), first}, {first, last}, {last, words.end()})) {
    found.not_understood = doubtful->text;
    return found;
  }
  for (auto word = first; word != last; ++word)
    found.bytes.insert(found.bytes.end(), word->bytes.begin(), word->bytes.end());
  return found;
}

bool is_column_of_characters(std::string_view text, std::span<const std::uint8_t> bytes) {
  if (text.size() > bytes.size()) return false;
  const auto shows = [](char shown, std::uint8_t byte) {
    const auto c = static_cast<unsigned char>(shown);
    return byte > ' ' && byte <= '~' ? c == byte : std::isalnum(c) == 0;
  };
  const bool ends_with_blanks = std::all_of(bytes.begin() + static_cast<std::ptrdiff_t>(text.size()), bytes.end(),
                                            [&](std::uint8_t byte) { return shows(' ', byte); });
  return ends_with_blanks && std::equal(text.begin(), text.end(), bytes.begin(), shows);
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

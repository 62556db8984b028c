#include "tools/recordings/rows/fields.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdlib>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/rows/number_list.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

constexpr Time kDay = 86'400 * kSecond, kFarthest = 36'525 * kDay;

constexpr std::string_view kBeforeTime = " \t\n\v\f\r[(\"@", kAfterTime = " \t\n\v\f\r]):,;|";

/// Skips what divides a time from the rest of its line, and the quotation mark of a time that one is before.
void skip_after_time(Scan& scan) {
  if (scan.since(0).find('"') != std::string_view::npos) scan.take("\"");
  scan.skip(kAfterTime);
}

/// The time of a fraction's digits in seconds: `5` is 500 ms.
Time fraction(std::string_view digits) {
  Time time = decimal_number(digits);
  for (std::size_t i = digits.size(); i < 9; ++i) time *= 10;
  return time;
}

std::optional<std::int32_t> day_number(int year, unsigned month, unsigned day) {
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
  if (!date.ok() || year < 1970 || year > 2069) return {};
  return std::chrono::sys_days(date).time_since_epoch().count();
}

/// A date: `2026-11-22`, `2026/11/22`, `22.11.2026`, `3/1/2026`; with slashes and the year last, either the day or the month
/// is first.
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

constexpr std::array<std::string_view, 12> kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                   "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
constexpr std::array<std::string_view, 7> kWeekdays{"Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun"};

/// The number of the month with that name, from 1; 0 if there is none.
unsigned month_of(std::string_view name) {
  const auto month = std::ranges::find(kMonths, name);
  return month == kMonths.end() ? 0 : static_cast<unsigned>(month - kMonths.begin()) + 1;
}

constexpr int kLeapYear = 2000;  // of a date without its year: it has all days

/// Takes a date with its day before the name of its month: `24 Mar `, `24 Mar 2021 `, `24-Mar-21 `, `24/Mar/2021 `.
std::optional<ReadDate> take_date_with_day_first(Scan& scan) {
  constexpr std::string_view kSigns = " -/.";
  const std::size_t begin = scan.at();
  const std::string_view day = scan.take_digits(2);
  const char sign = day.empty() ? '\0' : scan.take(kSigns);
  const unsigned month = sign != '\0' ? month_of(scan.take_while(stl::is_letter, 3)) : 0;
  const char after = month != 0 ? scan.take(" -/.:") : '\0';
  const std::size_t at_year = scan.at();
  const std::string_view written = after != '\0' ? scan.take_digits(4) : "";
  const bool has_year = (written.size() == 4 || (written.size() == 2 && after != ' ')) && scan.take(" :T") != '\0';
  if (!has_year) scan.go_back_to(at_year);
  const int year = !has_year ? kLeapYear : static_cast<int>(decimal_number(written)) + (written.size() == 2 ? 2000 : 0);
  const auto number = after != '\0' && (has_year || after == ' ')
                          ? day_number(year, month, static_cast<unsigned>(decimal_number(day)))
                          : std::nullopt;
  if (number) return ReadDate{number, number};
  scan.go_back_to(begin);
  return {};
}

/// Takes a date with the name of its month: `Nov 27 ` of syslog, `Fri Nov 27 ` of ctime. The year is not before the time.
std::optional<ReadDate> take_date_with_name(Scan& scan) {
  const std::size_t begin = scan.at();
  std::string_view name = scan.take_while(stl::is_letter, 3);
  if (std::ranges::find(kWeekdays, name) != kWeekdays.end()) {
    scan.skip(", ");
    name = scan.take_while(stl::is_letter, 3);
  }
  const unsigned month = month_of(name);
  const std::string_view day = month != 0 && scan.skip(" ") > 0 ? scan.take_digits(2) : "";
  const auto number = !day.empty() && scan.skip(" ") > 0
                          ? day_number(kLeapYear, month, static_cast<unsigned>(decimal_number(day)))
                          : std::nullopt;
  if (number) return ReadDate{number, number};
  scan.go_back_to(begin);
  return {};
}

/// The year that ctime writes after the time: ` 2026`.
void skip_year(Scan& scan) {
  const std::size_t before = scan.at();
  const bool is_year = scan.take(" ") != '\0' && scan.take_word("20") && scan.take_digits(2).size() == 2;
  if (!is_year || (!scan.at_end() && kAfterTime.find(scan.next()) == std::string_view::npos)) scan.go_back_to(before);
}

/// A date before a time: `2026-11-22 `, `22.11.2026T`, `2026-11-22_`.
std::optional<ReadDate> take_date(Scan& scan) {
  const std::size_t begin = scan.at();
  const std::size_t first = scan.take_digits(4).size();
  const bool year_first = first == 4;
  const bool fits = (year_first || first == 1 || first == 2) && scan.take(year_first ? "-/" : "./") != '\0';
  const std::size_t second = fits ? scan.take_digits(2).size() : 0;
  const bool goes_on = (second == 2 || (second == 1 && !year_first)) && scan.take(year_first ? "-/" : "./") != '\0';
  const std::size_t third = goes_on ? scan.take_digits(year_first ? 2 : 4).size() : 0;
  const std::string date(scan.since(begin));
  if (third >= 2 && scan.take("T _;,\t") != '\0') return date_of(date);
  scan.go_back_to(begin);
  return {};
}

/// Skips the zone after a time: `Z`, `+02:00`. All times of a log have the same.
void skip_zone(Scan& scan) {
  const std::size_t before = scan.at();
  const bool is_zone = scan.take("Z") != '\0' || (scan.take("+-") != '\0' && scan.take_digits(2).size() == 2 &&
                                                  scan.take(":") != '\0' && scan.take_digits(2).size() == 2);
  if (!is_zone || is_word_sign(scan.next())) scan.go_back_to(before);
}

/// A date and a time of day without signs between their digits: `20261122T123456.789Z`, `20261122_123456`
std::optional<LeadingTime> time_in_digits(std::string_view text) {
  constexpr std::size_t kDate = 8, kClock = 6;
  Scan scan(text);
  scan.skip(kBeforeTime);
  const std::string_view date = scan.take_digits(kDate + 1);
  if (date.size() != kDate || scan.take("T_-") == '\0') return {};
  const std::string_view clock = scan.take_digits(kClock + 1);
  if (clock.size() != kClock) return {};
  const std::size_t end = scan.at();
  const std::string_view part = scan.take(".,") != '\0' ? scan.take_digits(9) : "";
  if (part.empty()) scan.go_back_to(end);
  skip_zone(scan);
  const auto day = day_number(static_cast<int>(decimal_number(date.substr(0, 4))),
                              static_cast<unsigned>(decimal_number(date.substr(4, 2))),
                              static_cast<unsigned>(decimal_number(date.substr(6))));
  const Time hours = decimal_number(clock.substr(0, 2)), minutes = decimal_number(clock.substr(2, 2)),
             seconds = decimal_number(clock.substr(4));
  if (!day || hours > 23 || minutes > 59 || seconds > 60 || is_word_sign(scan.next())) return {};
  skip_after_time(scan);
  return LeadingTime{.time = ((hours * 60 + minutes) * 60 + seconds) * kSecond + fraction(part),
                     .length = scan.at(),
                     .of_day = true,
                     .date = {day, day}};
}

/// Takes the milliseconds that a table has in the cell after a time of day: `;100;`. Empty: there are none.
std::string_view milliseconds_in_cell(Scan& scan) {
  const std::size_t before = scan.at();
  const char separator = scan.take(";\t");
  const std::string_view digits = separator != '\0' ? scan.take_digits(4) : "";
  if (digits.size() == 3 && scan.next() == separator) return digits;
  scan.go_back_to(before);
  return {};
}

/// A time of day with a date before it or without: `12:34:56.789`, `1:02:03 PM`, `12h34m56s789`; after a date also
/// `12-34-56.789`
std::optional<LeadingTime> time_of_day(std::string_view text) {
  Scan scan(text);
  scan.skip(kBeforeTime);
  const auto named_date = take_date_with_name(scan), day_first = named_date ? std::nullopt : take_date_with_day_first(scan);
  const auto date = named_date ? named_date : day_first ? day_first : take_date(scan);
  if (!date) scan.take("+");  // since the start
  const std::string_view hours = scan.take_digits(2);
  const char sign = hours.empty() ? '\0' : scan.take(date ? ":h-." : ":h");
  if (sign == '\0') return {};
  const std::string_view minutes = scan.take_digits(2);
  if (minutes.size() != 2 || scan.take({sign == 'h' ? "m" : &sign, 1}) == '\0') return {};
  const std::string_view seconds = scan.take_digits(2);
  if (seconds.size() != 2) return {};
  std::size_t end = scan.at();
  std::string_view part;
  if (scan.take(sign == 'h' ? ".,s" : ".,:") != '\0') part = scan.take_digits(9);
  if (part.empty()) {
    scan.go_back_to(end);
    part = milliseconds_in_cell(scan);
  }
  end = scan.at();
  scan.take(kAllBlanks);
  const char half = scan.take("AP");
  const bool of_half_a_day = half != '\0' && scan.take("M") != '\0';
  if (!of_half_a_day) scan.go_back_to(end);
  if (named_date) skip_year(scan);
  skip_zone(scan);
  skip_after_time(scan);
  const Time written = decimal_number(hours), hour = !of_half_a_day ? written : written % 12 + (half == 'P' ? 12 : 0);
  const Time time = ((hour * 60 + decimal_number(minutes)) * 60 + decimal_number(seconds)) * kSecond + fraction(part);
  return LeadingTime{.time = time, .length = scan.at(), .of_day = true, .date = date.value_or(ReadDate{})};
}

struct TimeUnit {
  std::string_view word;
  Time time;
};
constexpr std::array kTimeUnits{TimeUnit{"ms", kMillisecond}, TimeUnit{"us", kMicrosecond}, TimeUnit{"s", kSecond}};

bool goes_on_as_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.'; }

/// Takes the unit after a number, if it is a word of its own; null if there is none.
const TimeUnit* take_unit(Scan& scan) {
  const std::size_t begin = scan.at();
  scan.skip(kAllBlanks);
  for (const TimeUnit& unit : kTimeUnits) {
    const std::size_t before = scan.at();
    if (scan.take_word(unit.word) && !goes_on_as_word(scan.next())) return &unit;
    scan.go_back_to(before);
  }
  scan.go_back_to(begin);
  return nullptr;
}

/// Whether the text is a list of bytes such as `01,03,00`: a time of a row has one comma with digits on both sides.
bool is_list_of_bytes(std::string_view whole, std::string_view part, std::string_view after) {
  return whole.size() == 2 && part.size() == 2 && after.size() > 2 && after[0] == ',' &&
         std::isxdigit(static_cast<unsigned char>(after[1])) != 0 &&
         std::isxdigit(static_cast<unsigned char>(after[2])) != 0;
}

/// A time since the start in minutes and seconds with a fraction: `00:12.345`. Without one it may be of a day.
std::optional<LeadingTime> minutes_since(std::string_view text) {
  constexpr std::size_t kSeconds = 2, kMostMinutes = 4;
  Scan scan(text);
  scan.skip(kBeforeTime);
  const std::string_view minutes = scan.take_digits(kMostMinutes);
  if (minutes.empty() || scan.take(":") == '\0') return {};
  const std::string_view seconds = scan.take_digits(kSeconds);
  if (seconds.size() != kSeconds || scan.take(".,") == '\0') return {};
  const std::string_view part = scan.take_digits(9);
  if (part.empty() || goes_on_as_word(scan.next())) return {};
  skip_after_time(scan);
  const Time time = (decimal_number(minutes) * 60 + decimal_number(seconds)) * kSecond + fraction(part);
  return LeadingTime{.time = time, .length = scan.at()};
}

/// A time since 1970 in milliseconds or nanoseconds: `1616595070123`. Numbers of so many digits are no pairs of digits.
std::optional<LeadingTime> time_since_1970(std::string_view text) {
  constexpr std::size_t kMilliseconds = 13, kNanoseconds = 19;
  Scan scan(text);
  scan.skip(kBeforeTime);
  if (scan.next() != '1') return {};  // from 2001 to 2033
  const std::string_view digits = scan.take_digits(kNanoseconds + 1);
  if (digits.size() != kMilliseconds && digits.size() != kNanoseconds) return {};
  if (!scan.at_end() && scan.next() != '"' && !is_any_of(scan.next(), kAfterTime)) return {};
  skip_after_time(scan);
  return LeadingTime{.time = decimal_number(digits) * (digits.size() == kMilliseconds ? kMillisecond : 1),
                     .length = scan.at()};
}

/// A time since the start: `0.123456`, `-12.3 ms`, `+7us`
std::optional<LeadingTime> time_since(std::string_view text) {
  Scan scan(text);
  scan.skip(kBeforeTime);
  const char sign = scan.take("+-");
  const bool below_zero = sign == '-';
  const std::string_view whole = scan.take_digits(10);
  if (whole.empty()) return {};
  const std::size_t end = scan.at();
  const char point = scan.take(".,");
  const std::string_view part = point != '\0' ? scan.take_digits(9) : "";
  if (part.empty()) scan.go_back_to(end);
  if (point == ',' && is_list_of_bytes(whole, part, text.substr(scan.at()))) return {};
  const TimeUnit* const unit = take_unit(scan);
  if (unit == nullptr && (part.empty() || goes_on_as_word(scan.next()))) return {};
  if (point == ',' && has_clock(text.substr(scan.at() - 1, 4))) return {};  // cells: `0,09:15:02`
  skip_after_time(scan);
  const Time of_unit = unit == nullptr ? kSecond : unit->time, number = decimal_number(whole);
  if (number >= kFurthestTime / of_unit) return {};
  const Time time = number * of_unit + fraction(part) / (kSecond / of_unit);
  return LeadingTime{.time = below_zero ? -time : time, .length = scan.at(), .has_sign = sign != '\0'};
}

using Words = std::span<const Word>;

bool is_letter(char c) { return stl::is_letter(c); }
bool is_decimal(std::string_view text) { return !text.empty() && std::ranges::all_of(text, stl::is_digit); }
bool is_marked(std::string_view text) { return text.starts_with("0x") || text.starts_with("0X"); }

bool is_word_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// The place of the first blank, or of the first other sign, from `at` on; the length of the line if there is none.
std::size_t end_of_word(std::string_view line, std::size_t at) {
  while (at < line.size() && !is_word_blank(line[at])) ++at;
  return at;
}
std::size_t begin_of_word(std::string_view line, std::size_t at) {
  while (at < line.size() && is_word_blank(line[at])) ++at;
  return at;
}

/// Whether a word begins with a date: `2026-11-22`
bool has_date(std::string_view word) {
  constexpr std::string_view kForm = "dddd-dd-dd";
  const auto is_date = [&](std::string_view text) {
    const auto fits = [](char c, char form) { return form == 'd' ? stl::is_digit(c) : c == form; };
    return std::ranges::equal(text, kForm, fits) && (text.starts_with("19") || text.starts_with("20")) && text[5] <= '1' &&
           text[8] <= '3';
  };
  for (std::size_t dash = word.find('-'); dash != std::string_view::npos; dash = word.find('-', dash + 1))
    if (dash >= 4 && is_date(word.substr(dash - 4, kForm.size()))) return true;
  return false;
}

/// Whether a word is the identifier of something: `123e4567-e89b-12d3-a456-426614174000`
bool is_uuid(std::string_view word) {
  constexpr std::string_view kForm = "xxxxxxxx-xxxx-xxxx-xxxx-xxxxxxxxxxxx";
  const std::size_t begin = word.find_first_not_of("{(\"");
  if (begin == std::string_view::npos) return false;
  const auto fits = [](char c, char form) { return form == '-' ? c == form : is_hex_digit(c); };
  return std::ranges::equal(word.substr(begin, kForm.size()), kForm, fits);
}

/// Appends pairs of digits with one sign between them: `01:03:00:0A:00`, `01_03_00_0A_00`. Fewer may be a time, a date or
/// the address of a host, and six with colons that of a network card.
bool append_pairs_with_sign(Bytes& bytes, std::string_view word) {
  constexpr std::size_t kPlace = 3, kFewest = 5, kOfNetworkCard = 6;  // two digits and a sign
  const std::size_t pairs = (word.size() + 1) / kPlace;
  if (pairs < kFewest || word.size() % kPlace != kPlace - 1 || !is_any_of(word[2], ":._|/")) return false;
  if (word[2] == ':' && pairs == kOfNetworkCard) return false;
  for (std::size_t i = 0; i < word.size(); ++i)
    if (i % kPlace == kPlace - 1 ? word[i] != word[2] : !is_hex_digit(word[i])) return false;
  for (std::size_t i = 0; i < word.size(); i += kPlace)
    bytes.push_back(static_cast<std::uint8_t>(hex_number(word.substr(i, 2))));
  return true;
}

/// Appends the bytes of `01`, `0103`, `0x1`, `01-03`, `[01][03]`, `0x01,`. Returns false and appends nothing for anything
/// else; a date is not a byte, nor is an identifier.
bool append_bytes(Bytes& bytes, std::string_view word) {
  constexpr std::string_view kOpening = "[<({\"", kBetween = ",;-[]<>(){}\"";
  if (word.size() == 2 && is_hex_digit(word[0]) && is_hex_digit(word[1])) {
    bytes.push_back(static_cast<std::uint8_t>(value_of_digit(word[0]) << 4 | value_of_digit(word[1])));
    return true;
  }
  if (append_pairs_with_sign(bytes, word)) return true;
  const std::size_t before = bytes.size();
  std::size_t at = std::min(word.find_first_not_of(kOpening), word.size());
  while (at < word.size()) {
    const bool marked = is_marked(word.substr(at));
    const std::size_t begin = at + (marked ? 2 : 0);
    for (at = begin; at < word.size() && is_hex_digit(word[at]);) ++at;
    const std::size_t digits = at - begin;
    const std::size_t next = std::min(word.find_first_not_of(kBetween, at), word.size());
    if (digits == 0 || (digits % 2 != 0 && !(marked && digits == 1)) || (next == at && at < word.size())) {
      bytes.resize(before);
      return false;
    }
    if (digits == 1) bytes.push_back(value_of_digit(word[begin]));
    for (std::size_t i = begin; i + 1 < at; i += 2)
      bytes.push_back(static_cast<std::uint8_t>(value_of_digit(word[i]) << 4 | value_of_digit(word[i + 1])));
    at = next;
  }
  if (has_date(word) || is_uuid(word)) bytes.resize(before);
  return bytes.size() > before;
}

/// The end of the bytes before a comment: at a `;` after at least two bytes, `01 0x03;`, otherwise at the end of the line.
std::size_t end_of_bytes_before_comment(std::string_view line) {
  for (std::size_t at = line.find(';'); at != std::string_view::npos; at = line.find(';', at + 1)) {
    const bool closes = at + 1 == line.size() || kAllBlanks.find(line[at + 1]) != std::string_view::npos;
    const std::size_t blank = closes ? line.find_last_of(kAllBlanks, at) : std::string_view::npos;
    if (blank == std::string_view::npos || blank == 0 || !is_hex_digit(line[blank - 1])) continue;
    Scan word(line.substr(blank + 1));
    word.take_word("0x");
    const std::size_t digits = word.take_hex(4).size();
    if (digits > 0 && blank + 1 + word.at() == at) return at;
  }
  return line.size();
}

/// A comment stands after `;`, `//` or `#` after a blank, or after a `;` that closes the bytes. Where `;` divides the
/// bytes, there is one after the first.
std::string_view without_comment(std::string_view line) {
  constexpr std::string_view kMarks = ";/#";
  if (std::ranges::none_of(line, [](char c) { return c == ';' || c == '/' || c == '#'; })) return line;
  const auto is_blank = [&](std::size_t at) {
    return at < line.size() && kAllBlanks.find(line[at]) != std::string_view::npos;
  };
  for (std::size_t at = line.find_first_of(kMarks); at != std::string_view::npos; at = line.find_first_of(kMarks, at + 1))
    if (at > 0 && is_blank(at - 1) && (line[at] != '/' || line.substr(at).starts_with("//"))) line = line.substr(0, at - 1);
  return line.substr(0, end_of_bytes_before_comment(line));
}

/// Whether a word is of a language, not hex: `feed` and `added` after pairs of digits.
bool is_of_a_language(std::string_view word) { return word.size() > 2 && std::ranges::all_of(word, is_letter); }

/// Whether the number is a TCP port: `plc:5020`, `plc.local:502`. It has no 0 in front, and a name with a dot is that of a
/// host.
bool is_port_of_host(std::string_view name, std::string_view number) {
  if (name.back() != ':' || !is_decimal(number) || direction_of(name) != Direction::Unknown) return false;
  const bool four_digits = number.size() == 4 && number.front() != '0';
  return four_digits || (number.size() <= 5 && name.find('.') != std::string_view::npos);
}

/// Whether `c` is a letter, or part of a letter that is not ASCII.
bool is_letter_of_any_language(char c) { return is_letter(c) || (c & 0x80) != 0; }

/// Whether a name may end there: `Tx:`, and after a sign that takes three bytes in UTF-8, an arrow or one of Chinese.
/// Letters that take two may go on as `de` does.
bool ends_name(std::string_view word, std::size_t end) {
  constexpr unsigned char kThreeBytes = 0xE0, kFourBytes = 0xF0;
  const auto lead = static_cast<unsigned char>(end >= 3 ? word[end - 3] : 0);
  return is_any_of(word[end - 1], ":;>,])-|{") || (lead >= kThreeBytes && lead < kFourBytes);
}

/// Whether a name and numbers are a sentence with commas, not bytes after a name: `$GPGGA,12,34`, `T;21;35`.
bool is_sentence_with_commas(std::string_view name, std::string_view numbers) {
  constexpr std::size_t kFourPairs = 11;
  if (!is_any_of(name.back(), ",;") || direction_of(name) != Direction::Unknown) return false;
  return is_any_of(name.front(), "$!+@") || numbers.size() < kFourPairs;
}

/// The length of a name before bytes: `Tx:01` is `01` after its name; `len=09` and `plc:5020` have no such name.
std::size_t length_of_name(std::string_view word) {
  const auto is_of_name = [&](std::size_t at) {
    const bool is_mark = at > 0 && word[at - 1] == '0' && (word[at] | 0x20) == 'x';
    return !is_hex_digit(word[at]) && is_letter_of_any_language(word[at]) && !is_mark;
  };
  std::size_t end = word.size();
  while (end > 0 && !is_of_name(end - 1)) --end;
  while (end > 0 && end < word.size() && !ends_name(word, end)) ++end;
  while (end > 0 && end < word.size() && is_any_of(word[end], ",;:|")) ++end;
  if (end == 0 || end >= word.size()) return 0;
  const std::string_view name = word.substr(0, end);
  const std::string_view after = word.substr(end);
  const bool names_it =
      name.find('=') == std::string_view::npos && !is_port_of_host(name, after) && !is_sentence_with_commas(name, after);
  return names_it ? name.size() : 0;
}

/// Words beside a number that say what the number is.
struct NumberName {
  std::string_view word;
  bool with_colon;  ///< `length: 12` is a length; `line: 12` is what was on a line
};
constexpr std::array kBeforeNumbers{NumberName{"LENGTH", true}, NumberName{"LEN", true},      NumberName{"SIZE", true},
                                    NumberName{"COUNT", true},  NumberName{"PORT", true},     NumberName{"BAUD", true},
                                    NumberName{"RATE", true},   NumberName{"BAUDRATE", true}, NumberName{"TIMEOUT", true},
                                    NumberName{"NUMBER", true}, NumberName{"NO", false},      NumberName{"NR", false},
                                    NumberName{"LINE", false},  NumberName{"PACKET", false},  NumberName{"SEQ", false},
                                    NumberName{"ID", false},    NumberName{"NETWORK", true}};
constexpr std::array<std::string_view, 11> kAfterNumbers{"BYTE", "BYTES", "CHARS",   "CHARACTERS", "OCTETS", "SECONDS",
                                                         "BAUD", "BAUDS", "RETRIES", "REGISTERS",  "COILS"};

/// Words before a number that is not a byte: `slave 1 01 03`
constexpr std::array<std::string_view, 8> kStations{"SLAVE", "MASTER", "STATION", "UNIT",
                                                    "NODE",  "DEVICE", "ADDRESS", "ADDR"};

bool is_name_of_station(std::string_view word) {
  return std::ranges::find(kStations, stl::upper_case(word.substr(0, word.find_last_not_of(":=#") + 1))) != kStations.end();
}

bool is_name_of_number(std::string_view word) {
  if (!is_letter(word.front())) return false;
  const bool colon = word.ends_with(':');
  const std::string name = stl::upper_case(word.substr(0, word.size() - (colon ? 1 : 0)));
  const auto row = std::ranges::find(kBeforeNumbers, name, &NumberName::word);
  return row != kBeforeNumbers.end() && (row->with_colon || !colon);
}

bool is_counted(std::string_view word) {
  const std::size_t end = word.find_last_not_of(":)],;");
  return end != std::string_view::npos && is_letter(word.front()) &&
         std::ranges::find(kAfterNumbers, stl::upper_case(word.substr(0, end + 1))) != kAfterNumbers.end();
}

/// The text in brackets: `(0X12)`. Empty: it has none.
std::string_view in_brackets(std::string_view word) {
  const bool bracketed =
      word.size() > 2 && ((word.front() == '(' && word.back() == ')') || (word.front() == '[' && word.back() == ']'));
  return bracketed ? word.substr(1, word.size() - 2) : "";
}

/// Whether two words are a byte in decimal and in hex: `18 (0X12)`, `0x12 (18)`.
bool say_the_same(std::string_view decimal, std::string_view hex) {
  const auto byte = parse_decimal<std::uint8_t>(decimal);
  const auto value = is_marked(hex) && hex.size() <= 4 ? parse_integer("16#" + std::string(hex.substr(2))) : std::nullopt;
  return byte && value && *value == *byte;
}

/// Whether a number names how many bytes follow it, in decimal or in hex.
bool counts_bytes_after(Words words, std::string_view digits) {
  std::size_t bytes = 0;
  for (const Word& word : words) {
    if (word.bytes == 0) break;
    bytes += word.bytes;
  }
  const auto decimal = parse_decimal<std::size_t>(digits);
  const auto hex = parse_integer("16#" + std::string(digits.substr(is_marked(digits) ? 2 : 0)));
  return decimal == bytes || (hex && *hex == static_cast<std::int64_t>(bytes));
}

/// Whether the number in brackets after bytes is how many they are: `01 03 … (8)`
bool counts_bytes_before(Words words, std::string_view inner) {
  std::size_t bytes = 0;
  for (auto word = words.rbegin(); word != words.rend() && word->bytes > 0; ++word) {
    if (!in_brackets(word->text).empty()) return false;
    bytes += word->bytes;
  }
  return bytes > 1 && parse_decimal<std::size_t>(inner) == bytes;
}

/// Whether the first word is where a dump of memory begins: `0x3ffb1234   01 03 …`, as ESP-IDF logs it
bool is_address_before_bytes(Words words) {
  constexpr std::size_t kAddress = 10;
  if (words.size() < 3 || words[0].text.size() != kAddress || !is_marked(words[0].text)) return false;
  const std::size_t gap = words[1].begin - (words[0].begin + kAddress);
  return words[0].bytes > 0 && gap > 1 && words[1].bytes == 1 && !is_marked(words[1].text);
}

/// Marks numbers that are not bytes, by the words beside them: `length 12`, `12 bytes`, `18 (0X12)`. A number with bytes
/// after it may be the first of them.
void take_numbers_out(std::vector<Word>& words) {
  constexpr std::string_view kAround = "()[],;:";
  const auto is_number = [](Word& word) {
    word.bytes = 0;
    word.number = Word::Number::Yes;
  };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view text = words[i].text, inner = in_brackets(text);
    if (!inner.empty() && counts_bytes_before(Words(words).first(i), inner)) {
      is_number(words[i]);
      continue;
    }
    if (text.size() == 2 && i > 0 && words[i - 1].bytes > 0) continue;  // a pair of digits after bytes is one
    if (is_address_before_bytes(Words(words).subspan(i))) {
      is_number(words[i]);
      continue;
    }
    if (i > 0 && is_decimal(inner) && say_the_same(inner, words[i - 1].text)) is_number(words[i]);
    if (i > 0 && is_marked(inner) && say_the_same(words[i - 1].text, inner)) is_number(words[i - 1]);
    const std::size_t begin = std::min(text.find_first_not_of(kAround), text.size());
    const std::string_view digits = text.substr(begin, text.find_last_not_of(kAround) + 1 - begin);
    if (i > 0 && words[i].bytes == 0 && is_decimal(digits) && is_name_of_station(words[i - 1].text)) is_number(words[i]);
    if (words[i].bytes == 0 || !(is_decimal(digits) || is_marked(digits))) continue;
    const bool named = i > 0 && is_name_of_number(words[i - 1].text);
    const bool after_bytes = i > 0 && words[i - 1].bytes > 0 && begin == 0;
    const bool counted = !after_bytes && i + 1 < words.size() && is_counted(words[i + 1].text);
    const bool before_bytes = i + 1 < words.size() && words[i + 1].bytes > 0;
    if (named && before_bytes && !counts_bytes_after(Words(words).subspan(i + 1), digits))
      words[i].number = Word::Number::Perhaps;
    else if (named || counted)
      is_number(words[i]);
  }
}

/// Whether a word beside bytes is IN or OUT, which sentences have as well.
bool is_in_or_out(std::string_view word) { return direction_beside_bytes(word) != Direction::Unknown; }

bool names_a_direction(const Word& word) { return direction_of(word.text) != Direction::Unknown; }

/// Whether a word beside bytes may be a damaged byte: `1`, `3G`, `??`, `123`
bool may_be_a_damaged_byte(const Word& word) {
  if (word.number == Word::Number::Yes || names_a_direction(word) || is_in_or_out(word.text)) return false;
  const auto is_sign = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '?' || c == '*'; };
  return (word.text.size() <= 2 && std::ranges::any_of(word.text, is_sign) && std::ranges::all_of(word.text, is_sign)) ||
         word.text.find_first_of("?*") != std::string_view::npos ||
         (std::ranges::all_of(word.text, is_hex_digit) && !is_of_a_language(word.text));
}

/// Whether a text ends with a fraction: `12.5`, `0,123`
bool ends_with_fraction(std::string_view text) {
  constexpr std::size_t kMostDigits = 9;
  std::size_t point = text.size();
  while (point > 0 && stl::is_digit(text[point - 1])) --point;
  const std::size_t digits = text.size() - point;
  return digits >= 1 && digits <= kMostDigits && point >= 2 && (text[point - 1] == '.' || text[point - 1] == ',') &&
         stl::is_digit(text[point - 2]);
}

/// Whether a word ends with digits that may be bytes: `:010300C80002`, of Modbus ASCII. A clock, a decimal and `len=09` do
/// not.
bool ends_with_digits(const Word& word) {
  const std::string_view text = word.text.substr(0, word.text.find_last_not_of(',') + 1);  // `slice{0x1,`
  const std::size_t end = text.find_last_not_of("0123456789ABCDEFabcdef");
  if (end == std::string_view::npos || end + 1 == text.size()) return false;
  if ((word.text[end] & 0x80) != 0 && !stl::is_valid_utf8(word.text)) return true;  // of another encoding
  return std::ispunct(static_cast<unsigned char>(word.text[end])) != 0 && !has_clock(word.text) &&
         !ends_with_fraction(word.text) && word.text.find('=') == std::string_view::npos &&
         word.text.find("]:") == std::string_view::npos;
}

/// Whether bytes have capitals and small letters, as no tool writes them: `E4 09 be` before `careful`.
bool has_both_cases(Words run) {
  const auto any = [&](std::string_view letters) {
    return std::ranges::any_of(run, [&](const Word& w) { return w.text.find_first_of(letters) != std::string_view::npos; });
  };
  return any("ABCDEF") && any("abcdef");
}

bool has_mark(const Word& word) {
  if (word.text.size() < 3) return false;
  return is_marked(word.text.substr(std::min(word.text.find_first_not_of("[<({\""), word.text.size())));
}

/// Whether bytes end with a number of several digits after pairs of digits: `01 03 04 12 34 81 07 4660`
bool ends_with_number(Words run) { return run.size() > 2 && run[0].bytes == 1 && run[1].bytes == 1 && run.back().bytes > 1; }

/// A word among the bytes that may be something else; null if there is none. A number before pairs of digits counts lines or
/// seconds; and no tool writes `0x` before only some of its bytes.
const Word* what_is_no_byte(Words run) {
  const auto perhaps = std::ranges::find(run, Word::Number::Perhaps, &Word::number);
  if (perhaps != run.end()) return &*perhaps;
  const auto other_mark =
      std::ranges::find_if(run, [&](const Word& word) { return has_mark(word) != has_mark(run.front()); });
  if (other_mark != run.end()) return &*other_mark;
  const bool before_pairs = run.size() > 1 && run.front().bytes > 1 &&
                            std::ranges::all_of(run.subspan(1), [](const Word& word) { return word.bytes == 1; });
  if (before_pairs) return &run.front();
  return ends_with_number(run) ? &run.back() : nullptr;  // last: all but it may be a frame
}

/// Words before bytes that say what they are: `data 0x0B`, `frame: 0103`
constexpr std::array<std::string_view, 16> kNamesOfBytes{"DATA",    "BYTE",   "BYTES",  "HEX", "FRAME", "PAYLOAD",
                                                         "RAW",     "BUFFER", "PACKET", "PDU", "ADU",   "CHAR",
                                                         "MESSAGE", "MSG",    "CHUNK",  "DUMP"};

/// Words before bytes that say on which line they were: `COM3`, `/dev/ttyUSB0`
constexpr std::array<std::string_view, 6> kNamesOfLines{"COM", "TTY", "/DEV/", "UART", "SERIAL", "RS"};

/// Whether a word is `tx`, `rx_data`, `COM3:`; a name with a number at its end is that of a line.
bool names_bytes(const Word& word) {
  if (names_a_direction(word)) return true;
  constexpr std::string_view kAround = "[]():>,;=";
  const std::string capitals = stl::upper_case(word.text);
  const std::size_t begin = std::min(capitals.find_first_not_of(kAround), capitals.size());
  const std::string_view name = std::string_view(capitals).substr(begin, capitals.find_last_not_of(kAround) + 1 - begin);
  const auto begins = [&](std::string_view line) { return name.starts_with(line) && stl::is_digit(name.back()); };
  if (std::ranges::any_of(kNamesOfLines, begins)) return true;
  for (std::size_t at = 0; at < name.size(); ++at) {
    const std::size_t first = at;
    while (at < name.size() && is_letter(name[at])) ++at;
    if (std::ranges::find(kNamesOfBytes, name.substr(first, at - first)) != kNamesOfBytes.end()) return true;
  }
  return false;
}

/// Whether a value is assigned to something that is not called as bytes are: `register 40001 = 1234`
bool is_assigned(Words before, Words run) {
  if (before.empty() || run.size() != 1 || !before.back().text.ends_with('=')) return false;
  const Word& name = before.back().text.size() <= 2 && before.size() > 1 ? before[before.size() - 2] : before.back();
  return !names_bytes(name);
}

/// Words before numbers that are values of something: `Values: 10 20`, `registers = 10, 20`
constexpr std::array<std::string_view, 16> kNamesOfValues{"VALUE",  "VALUES",  "REGISTER", "REGISTERS", "RESULT", "RESULTS",
                                                          "COILS",  "INPUTS",  "WERT",     "WERTE",     "VALOR",  "VALORES",
                                                          "VALEUR", "VALEURS", "VALORI",   "READINGS"};

/// The word that says that numbers after it are values; null if there is none.
const Word* name_of_values(Words before) {
  constexpr std::string_view kAround = "[](){}:=\"'";
  const auto bare = [&](std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(kAround), text.size());
    return stl::upper_case(text.substr(begin, text.find_last_not_of(kAround) + 1 - begin));
  };
  while (!before.empty() && bare(before.back().text).empty()) before = before.first(before.size() - 1);
  if (before.empty() || std::ranges::find(kNamesOfValues, bare(before.back().text)) == kNamesOfValues.end()) return nullptr;
  return std::ranges::none_of(before, names_bytes) ? &before.back() : nullptr;
}

/// Whether numbers after such a name are fewer than a frame has.
bool are_values(Words before, Words run) {
  constexpr std::size_t kShortestFrame = 4;
  const std::size_t bytes = run.back().first_byte + run.back().bytes - run.front().first_byte;
  return bytes < kShortestFrame && name_of_values(before) != nullptr;
}

/// Whether the last word is the name after an arrow: `CPU -> PC`
bool ends_with_name_after_arrow(Words words) {
  constexpr std::string_view kArrow = "-=<>";
  return words.size() > 1 &&
         std::ranges::all_of(words[words.size() - 2].text, [&](char c) { return is_any_of(c, kArrow); }) &&
         std::ranges::any_of(words.back().text, is_letter);
}

/// Whether two or three pairs of digits, fewer than most frames have, stand after words that do not say what they are:
/// `state AB CD`
bool is_short_after_words(Words before, Words run) {
  constexpr std::size_t kMost = 3;
  const auto is_pair = [](const Word& word) { return word.bytes == 1 && word.text.size() == 2; };
  return run.size() > 1 && run.size() <= kMost && std::ranges::all_of(run, is_pair) && !before.empty() &&
         before.back().bytes == 0 && before.back().text.size() > 2 && std::ranges::all_of(before.back().text, is_letter) &&
         std::ranges::none_of(before, names_bytes) && !is_in_or_out(before.back().text);
}

/// Whether as many pairs of digits as a frame has stand before other bytes: `01 03 … -> 01 03 …`
bool may_be_a_frame(Words words, std::size_t from) {
  constexpr std::size_t kFewest = 4;
  std::size_t pairs = 0;
  for (std::size_t i = from; i < words.size() && words[i].bytes == 1; ++i) ++pairs;
  return pairs >= kFewest;
}

/// A word before or after the bytes that makes them doubtful; null if there is none. Bytes before them may be a number or a
/// date in front of the direction.
const Word* what_is_doubtful(Words before, Words run, Words after) {
  if (!before.empty() && !ends_with_name_after_arrow(before) &&
      (may_be_a_damaged_byte(before.back()) || ends_with_digits(before.back())))
    return &before.back();
  const auto other = std::ranges::find_if(before, [](const Word& word) { return word.bytes > 0; });
  if (other != before.end()) {
    const bool after_direction = std::any_of(before.begin(), other, names_a_direction);
    const auto is_number = [](const Word& word) { return word.number == Word::Number::Yes; };
    const auto name = std::find_if_not(before.rbegin(), before.rend(), is_number);
    const bool named = name != before.rend() && (names_a_direction(*name) || is_any_of(name->text.back(), ":>-)]|"));
    if (after_direction || !named || may_be_a_frame(before, static_cast<std::size_t>(other - before.begin())))
      return &*std::find_if(other, before.end(), [](const Word& word) { return word.bytes == 0; });
  }
  if (is_assigned(before, run) || is_short_after_words(before, run)) return &before.back();
  if (const Word* const name = name_of_values(before)) return name;
  if (const Word* const no_byte = what_is_no_byte(run)) return no_byte;
  if (after.empty() || after.front().number == Word::Number::Yes) return nullptr;
  if (has_both_cases(run)) return &run.back();
  const std::string_view next = after.front().text;
  const bool ends_cell = next.front() == '|' && std::ranges::none_of(after, [](const Word& word) { return word.bytes > 0; });
  if (ends_cell) return nullptr;
  const bool is_comment = next.front() == '(' || (next.size() > 2 && std::all_of(next.begin(), next.begin() + 3, is_letter));
  return is_comment && (run.size() > 1 || run.front().bytes > 1) ? nullptr : &after.front();
}

/// Whether a word after bytes may be the rest of a damaged byte: `3`, `3G`, `7?`, `123`, but not `ok`.
bool may_be_a_damaged_byte_after(const Word& word) {
  const bool is_short = word.text.size() <= 2 && is_hex_digit(word.text.front());
  return word.text.find_first_of("?*") != std::string_view::npos ||
         (word.bytes == 0 && (is_short || std::ranges::all_of(word.text, is_hex_digit)));
}

/// Whether a word after bytes is a number in another notation: `value 4660`, `= 0x1234, 0x5678`
bool is_a_number(const Word& word, Words run) {
  const std::string_view digits = word.text.substr(0, word.text.find_last_not_of(",;)") + 1);
  return word.bytes == 0 || is_decimal(digits) || (is_marked(digits) && !has_mark(run.front()));
}

/// Whether a word is the number of bytes after it: `8 01 03`, `8B 01 03`
bool counts_bytes(const Word& word, Words after) {
  constexpr std::size_t kMostDigits = 3;
  const std::string_view number = word.text.substr(0, word.text.size() - (word.text.ends_with('B') ? 1 : 0));
  if (after.empty() || number.size() > kMostDigits || !is_decimal(number)) return false;
  const std::size_t bytes = after.back().first_byte + after.back().bytes - after.front().first_byte;
  return static_cast<std::size_t>(decimal_number(number)) == bytes;
}

/// The words of a run that are bytes for sure if any of them are: without those of another form at its end.
Words without_number(Words run) {
  if (ends_with_number(run)) {
    const auto last = std::find_if(run.rbegin(), run.rend(), [](const Word& word) { return word.bytes == 1; }).base();
    return {run.begin(), last};
  }
  return has_both_cases(run) ? run.first(run.size() - 1) : run;
}

/// The runs of words that may be all the bytes of a doubtful line, the likelier first. There are none if a byte may be
/// damaged, or if the line has several runs of bytes.
std::vector<Words> possible_runs(Words words) {
  const auto has_bytes = [](const Word& word) { return word.bytes > 0 && word.number != Word::Number::Yes; };
  const auto first = std::ranges::find_if(words, has_bytes);
  const auto last = std::find_if_not(first, words.end(), has_bytes);
  const Words before{words.begin(), first}, run{first, last}, after{last, words.end()};
  for (std::size_t i = 0; i < after.size(); ++i)
    if (may_be_a_frame(after, i)) return {};
  if (run.empty() || !std::ranges::all_of(after, [&](const Word& word) { return is_a_number(word, run); })) return {};
  const bool is_counted = !before.empty() && counts_bytes(before.back(), run);
  if (!is_counted && !before.empty() && (may_be_a_damaged_byte(before.back()) || ends_with_digits(before.back()))) return {};
  if (!after.empty() && after.front().number != Word::Number::Yes && may_be_a_damaged_byte_after(after.front())) return {};
  if (what_is_no_byte(without_number(run)) != nullptr) return {};
  std::vector<Words> runs{run};
  if (const Words surely = without_number(run); !surely.empty() && surely.size() < run.size()) runs.push_back(surely);
  if (run.size() > 1 && counts_bytes(run.front(), run.subspan(1))) runs.push_back(run.subspan(1));
  return runs;
}

/// Another reading of the bytes if all of them are not a right frame: without the number that counts them, `8 01 03 …`, or
/// without the word that begins the comment, `… be careful`.
struct OtherRun {
  Words words{};
  std::string_view without{};
};
std::optional<OtherRun> other_run(Words run, Words after) {
  if (run.size() < 2) return {};
  if (counts_bytes(run.front(), run.subspan(1))) return OtherRun{run.subspan(1), run.front().text};
  const bool begins_comment =
      !after.empty() && is_letter(after.front().text.front()) && std::ranges::all_of(run.back().text, is_letter);
  if (!begins_comment) return {};
  return OtherRun{run.first(run.size() - 1), run.back().text};
}

/// The text between the bars of hexdump -C, `|....4...|`, and the signs of od, `>....4...<`.
std::string_view without_bars(std::string_view text) {
  const bool barred = text.size() > 2 && ((text.front() == '|' && text.back() == '|') ||
                                          (text.front() == '>' && text.back() == '<'));  // of od -t x1z
  return barred ? text.substr(1, text.size() - 2) : text;
}

/// The text with one sign for each character that is not ASCII, whatever its length in UTF-8.
std::string in_single_bytes(std::string_view text) {
  std::string single;
  for (const char c : text)
    if ((c & 0xC0) != 0x80 || single.empty()) single += (c & 0x80) != 0 ? '.' : c;
  return single;
}

bool is_plain_word(const Word& word) {
  return word.bytes == 0 && word.text.size() > 1 && std::ranges::all_of(word.text, is_letter) && !names_a_direction(word);
}

/// Whether words are blocks of STEP 7, not bytes: `DB 10`, `FB 10, DB 11`, `DB10`
bool are_blocks(Words run) {
  constexpr std::array<std::string_view, 3> kBlocks{"DB", "FB", "FC"};  // those that are hex
  const auto has_number = [](std::string_view text) { return is_decimal(text.substr(0, text.find_first_of(",;)"))); };
  const auto is_block = [&](std::string_view text) {
    return std::ranges::any_of(kBlocks, [&](std::string_view block) { return text.starts_with(block); });
  };
  for (std::size_t i = 0; i < run.size(); ++i) {
    const std::string_view text = run[i].text.substr(run[i].text.front() == '(' ? 1 : 0);
    if (!is_block(text)) return false;
    if (text.size() > 2 ? !has_number(text.substr(2)) : ++i == run.size() || !has_number(run[i].text)) return false;
  }
  return !run.empty();
}

/// Whether a word is one of a sentence or of a program: `Wert`, `CALL`, `FUNCTION_BLOCK`, `(siehe`
bool is_of_prose(const Word& word) {
  const auto is_sign = [](char c) {
    return is_letter_of_any_language(c) || std::string_view("_().,;:!?").find(c) != std::string_view::npos;
  };
  return word.bytes == 0 && std::ranges::any_of(word.text, is_letter) && std::ranges::all_of(word.text, is_sign) &&
         !names_a_direction(word);
}

/// Whether a word is a name with a colon: `temp:`, `D100:`
bool is_name_with_colon(std::string_view word) {
  const auto is_of_name = [](char c) { return is_word_sign(c) || c == '.' || (c & 0x80) != 0; };
  return word.size() > 1 && word.back() == ':' && is_letter_of_any_language(word.front()) &&
         std::ranges::all_of(word.substr(0, word.size() - 1), is_of_name);
}

/// Whether bytes are the value of something in a log of other things: `counter = 12345678`, `temp: 21`, `error code 0x86`,
/// `sensor.temp 2024-01-01T10:00:00 21`
bool is_value(Words before, Words run) {
  constexpr std::size_t kLongest = 4;
  if (before.empty() || run.size() != 1 || run.front().bytes > kLongest) return false;
  if (std::ranges::any_of(before, names_bytes)) return false;
  if (is_assigned(before, run)) return true;
  const std::string_view text = run.front().text, name = before.back().text;
  const bool is_number = is_decimal(text) || is_marked(text);
  const bool numbered = before.size() > 1 && name.ends_with(':') && is_decimal(name.substr(0, name.size() - 1)) &&
                        is_plain_word(before[before.size() - 2]);  // `value 0: 4660`
  return is_number &&
         (numbered || is_plain_word(before.back()) || is_name_with_colon(name) || (before.size() > 1 && has_clock(name)));
}

/// Whether the bytes are a number at the end of words, or one of the words: `slave 10`, `waiting for 50`, `warte ab`, `de
/// facto`, or blocks among words: `CALL FB 10, DB 11`
bool is_of_a_sentence(Words before, Words run, Words after) {
  if (are_blocks(run) && std::ranges::none_of(before, names_a_direction))
    return (!before.empty() && is_of_prose(before.back())) || (!after.empty() && is_of_prose(after.front()));
  if (run.size() != 1) return false;
  const std::string_view text = run.front().text;
  const bool is_number = is_decimal(text), is_word = std::ranges::all_of(text, is_letter);
  if (before.empty()) return is_word && !after.empty() && is_plain_word(after.front());
  const std::string capitals = stl::upper_case(before.back().text);
  const bool names_a_station = capitals == "SLAVE" || capitals == "MASTER";
  const bool is_prose = is_number || (is_word && std::ranges::none_of(before, names_a_direction));
  return (is_number && names_a_station) || (is_prose && is_plain_word(before.back()));
}

/// Whether there are at least two pairs of digits: `01 03 …`
bool has_pairs(Words words) {
  const auto is_pair = [](const Word& word) { return word.bytes == 1; };
  return std::ranges::adjacent_find(words, [&](const Word& a, const Word& b) { return is_pair(a) && is_pair(b); }) !=
         words.end();
}

/// Digits at the end of a line that are not pairs: `RX 0103041234567`, `RX 001 003`
std::optional<BytesInLine> cut_off_bytes(Words words) {
  constexpr std::size_t kFewestDigits = 5;
  const auto is_hex = [](const Word& word) { return std::ranges::all_of(word.text, is_hex_digit); };
  const auto first = std::find_if_not(words.rbegin(), words.rend(), is_hex).base();
  const Words digits{first, words.end()};
  if (digits.empty() || digits.front().number == Word::Number::Yes) return {};
  const bool many = digits.size() > 2 || digits.front().text.size() >= kFewestDigits;
  const bool has_digit = std::ranges::any_of(digits.front().text, stl::is_digit);
  const bool named = first == words.begin() || names_a_direction(*std::prev(first)) || digits.size() > 2;
  if (!many || !has_digit || !named) return {};
  return BytesInLine{.begin = digits.front().begin, .not_understood = digits.front().text};
}

/// The last run of bytes among words.
struct Run {
  Words before, words;
};
std::optional<Run> last_run(Words words) {
  const auto has_bytes = [](const Word& word) { return word.bytes > 0; };
  const auto last = std::find_if(words.rbegin(), words.rend(), has_bytes).base();
  if (last == words.begin()) return {};
  const auto first = std::find_if_not(std::reverse_iterator(last), words.rend(), has_bytes).base();
  return Run{{words.begin(), first}, {first, last}};
}

/// The words for a request in English, German, French, Spanish, Italian, Portuguese, Russian and Chinese; ASCII letters in
/// capitals.
constexpr std::array<std::string_view, 40> kRequestWords{"TX",
                                                         "SENT",
                                                         "SEND",
                                                         "WRITE",
                                                         "WRITTEN",
                                                         "REQUEST",
                                                         "QUERY",
                                                         "MASTER",
                                                         "GESENDET",
                                                         "SENDEN",
                                                         "ANFRAGE",
                                                         "SENDE",
                                                         "ENVOI",
                                                         "ENVOY\u00E9",
                                                         "ENVOYE",
                                                         "\u00E9MISSION",
                                                         "EMISSION",
                                                         "REQU\u00EATE",
                                                         "REQUETE",
                                                         "ENVIADO",
                                                         "ENVIAR",
                                                         "ENVIO",
                                                         "SOLICITUD",
                                                         "INVIATO",
                                                         "INVIO",
                                                         "RICHIESTA",
                                                         "PEDIDO",
                                                         "\u041F\u0435\u0440\u0435\u0434\u0430\u0447\u0430",
                                                         "\u0417\u0430\u043F\u0440\u043E\u0441",
                                                         "\u041E\u0442\u043F\u0440\u0430\u0432\u043B\u0435\u043D\u043E",
                                                         "\u53D1",
                                                         "\u53D1\u9001",
                                                         "\u53D1\u9001\u6570\u636E",
                                                         "OUTGOING",
                                                         "TXD",
                                                         "SND",
                                                         "XMIT",
                                                         "TRANSMIT",
                                                         "TRANSMITTED",
                                                         "SENDING"};
constexpr std::array<std::string_view, 39> kAnswerWords{"RX",
                                                        "RECV",
                                                        "RECEIVED",
                                                        "READ",
                                                        "RESPONSE",
                                                        "ANSWER",
                                                        "REPLY",
                                                        "SLAVE",
                                                        "EMPFANGEN",
                                                        "EMPFANG",
                                                        "ANTWORT",
                                                        "EMPFANGE",
                                                        "RE\u00E7U",
                                                        "RECU",
                                                        "R\u00E9CEPTION",
                                                        "RECEPTION",
                                                        "R\u00E9PONSE",
                                                        "REPONSE",
                                                        "RECIBIDO",
                                                        "RECIBIR",
                                                        "RESPUESTA",
                                                        "RICEVUTO",
                                                        "RICEZIONE",
                                                        "RISPOSTA",
                                                        "RECEBIDO",
                                                        "RESPOSTA",
                                                        "\u041F\u0440\u0438\u0435\u043C",
                                                        "\u041F\u0440\u0438\u0451\u043C",
                                                        "\u041E\u0442\u0432\u0435\u0442",
                                                        "\u041F\u043E\u043B\u0443\u0447\u0435\u043D\u043E",
                                                        "\u6536",
                                                        "\u63A5\u6536",
                                                        "\u63A5\u6536\u6570\u636E",
                                                        "INCOMING",
                                                        "RXD",
                                                        "RCV",
                                                        "RCVD",
                                                        "RECEIVE",
                                                        "RECEIVING"};
constexpr std::size_t kLongestDirection = 20;  // bytes of UTF-8

/// The text with blanks in place of signs that are not letters: U+2000 to U+2FFF and the wide ones from U+FF00 on.
std::string without_signs(std::string_view text) {
  std::string letters(text);
  for (std::size_t i = 0; i + 2 < letters.size(); ++i)
    if (letters[i] == '\xE2' || letters[i] == '\xEF') letters.replace(i, 3, 3, ' ');
  return letters;
}

/// A word with its ASCII letters in capitals and its Latin letters with accents small: U+00C0 to U+00DE in UTF-8.
std::string in_form_of_lists(std::string_view word) {
  std::string form = stl::upper_case(word);
  for (std::size_t i = 0; i + 1 < form.size(); ++i) {
    const auto second = static_cast<unsigned char>(form[i + 1]);
    if (form[i] == '\xC3' && second >= 0x80 && second <= 0x9E) form[i + 1] = static_cast<char>(second + ('a' - 'A'));
  }
  return form;
}

/// Whether a word names the station of a line, not its sender: `slave 1 TX`
bool is_station_with_number(std::string_view word, std::string_view after) {
  const std::size_t next = after.find_first_not_of(kAllBlanks);
  return (word == "SLAVE" || word == "MASTER") && next != 0 && next != std::string_view::npos && stl::is_digit(after[next]);
}

struct WrittenUnit {
  std::string_view word;
  Time time;
};
constexpr std::array kWrittenUnits{WrittenUnit{"S", kSecond},
                                   WrittenUnit{"SEC", kSecond},
                                   WrittenUnit{"SECONDS", kSecond},
                                   WrittenUnit{"MS", kMillisecond},
                                   WrittenUnit{"US", kMicrosecond},
                                   WrittenUnit{"\u00B5S", kMicrosecond},
                                   WrittenUnit{"\u03BCS", kMicrosecond},
                                   WrittenUnit{"\xB5S", kMicrosecond},  // in Latin-1
                                   WrittenUnit{"NS", 1},
                                   WrittenUnit{"MILLISECONDS", kMillisecond},
                                   WrittenUnit{"MILLIS", kMillisecond},
                                   WrittenUnit{"MICROS", kMicrosecond},
                                   WrittenUnit{"MICROSECONDS", kMicrosecond},
                                   WrittenUnit{"NANOSECONDS", 1}};

}  // namespace

std::optional<LeadingTime> leading_time(std::string_view text) {
  if (const auto time = time_of_day(text)) return time;
  if (const auto time = time_in_digits(text)) return time;
  if (const auto time = minutes_since(text)) return time;
  if (const auto time = time_since(text)) return time;
  return time_since_1970(text);
}

/// The time without its zone.
std::string_view without_zone(std::string_view time) {
  constexpr std::size_t kZone = 6, kSign = 0, kColon = 3;
  if (time.find('T') == std::string_view::npos) return time;
  if (time.ends_with('Z')) return time.substr(0, time.size() - 1);
  const std::string_view zone = time.substr(time.size() - std::min(kZone, time.size()));
  const bool has_zone = zone.size() == kZone && (zone[kSign] == '+' || zone[kSign] == '-') && zone[kColon] == ':';
  return has_zone ? time.substr(0, time.size() - kZone) : time;
}

std::optional<LeadingTime> time_in_cell(std::string_view cell) {
  const std::string_view local = without_zone(cell);
  const auto time = leading_time(local);
  return time && time->length == local.size() ? time : std::nullopt;
}

std::size_t length_of_index(std::string_view text) {
  constexpr std::size_t kMostDigits = 9;
  Scan scan(text);
  scan.skip(kAllBlanks);
  scan.take("#");
  if (scan.take_digits(kMostDigits).empty()) return 0;
  const char mark = scan.take(".):;,|");
  const bool divided = mark != '\0', may_be_of_time = mark == '\0' || mark == ':' || mark == '.';
  if (scan.skip(kAllBlanks) == 0 && may_be_of_time) return 0;
  constexpr std::size_t kLongestNumber = 12;  // of a time, before the first of its signs
  const std::string_view beginning = text.substr(scan.at(), kLongestNumber);
  if (std::ranges::none_of(beginning, [](char c) { return is_any_of(c, ":.,-/"); })) return 0;
  const auto time = leading_time(text.substr(scan.at()));
  return time && (time->of_day || !divided) && !leading_time(text) ? scan.at() : 0;
}

std::optional<Time> unit_of(std::string_view name) {
  const std::string capitals = stl::upper_case(name);
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0; };
  for (auto begin = capitals.begin(); begin != capitals.end();) {
    begin = std::find_if(begin, capitals.end(), is_letter);
    const auto end = std::find_if_not(begin, capitals.end(), is_letter);
    const auto unit = std::ranges::find(kWrittenUnits, std::string_view(begin, end), &WrittenUnit::word);
    if (unit != kWrittenUnits.end()) return unit->time;
    begin = end;
  }
  return {};
}

bool is_name_of_time(std::string_view name) {
  constexpr std::array<std::string_view, 9> kTimes{"TIME",  "ZEIT",  "TEMPS", "TIEMPO", "TEMPO",
                                                   "START", "STAMP", "HORA",  "HEURE"};
  const std::string capitals = stl::upper_case(name);
  return std::ranges::any_of(kTimes, [&](std::string_view time) { return capitals.find(time) != std::string::npos; });
}

Direction direction_of_brackets(std::string_view bytes) {
  if (bytes.starts_with('[')) return Direction::Request;
  if (bytes.starts_with('<')) return Direction::Answer;
  return Direction::Unknown;
}

Direction direction_of(std::string_view written) {
  const bool ascii = stl::is_ascii(written);
  const std::string letters = ascii ? "" : without_signs(written);
  const std::string_view text = ascii ? written : std::string_view(letters);
  constexpr std::size_t kShortest = 2;
  bool request = text.find('>') != std::string_view::npos || written.find("\u2192") != std::string_view::npos;
  bool answer = text.find('<') != std::string_view::npos || written.find("\u2190") != std::string_view::npos;
  for (std::size_t end = 0; end < text.size();) {
    const auto begin = std::find_if(text.begin() + static_cast<std::ptrdiff_t>(end), text.end(), is_letter_of_any_language);
    const auto after = std::find_if_not(begin, text.end(), is_letter_of_any_language);
    end = static_cast<std::size_t>(after - text.begin());
    const auto length = static_cast<std::size_t>(after - begin);
    if (length < kShortest || length > kLongestDirection) continue;
    const std::string word = in_form_of_lists({begin, after});
    if (is_station_with_number(word, {after, text.end()})) continue;
    request = request || std::ranges::find(kRequestWords, word) != kRequestWords.end();
    answer = answer || std::ranges::find(kAnswerWords, word) != kAnswerWords.end();
  }
  if (request == answer) return Direction::Unknown;
  return request ? Direction::Request : Direction::Answer;
}

Direction direction_beside_bytes(std::string_view text) {
  const auto is_other = [](char c) { return !is_word_sign(c); };
  const auto end = std::find_if_not(text.rbegin(), text.rend(), is_other).base();
  const auto begin = std::find_if(std::reverse_iterator(end), text.rend(), is_other).base();
  const std::string word = end - begin <= 3 ? stl::upper_case({begin, end}) : std::string();
  return word == "OUT" ? Direction::Request : word == "IN" ? Direction::Answer : Direction::Unknown;
}

std::string_view time_like_word(std::string_view text) {
  constexpr std::string_view kUnits = "hmsu";
  for (std::size_t begin = begin_of_word(text, 0); begin < text.size();) {
    const std::size_t end = end_of_word(text, begin);
    const std::string_view word = text.substr(begin, end - begin);
    std::size_t run = 0;
    bool has_unit = false;  // `08h15`, `1100ms`
    for (std::size_t i = 0; i < word.size(); run = stl::is_digit(word[i]) ? run + 1 : 0, ++i)
      has_unit = has_unit || (run > 1 && is_any_of(word[i], kUnits) && !word.starts_with("0x"));
    if (has_clock(word) || (has_unit && !bytes_of_text(word))) return word;
    begin = begin_of_word(text, end);
  }
  return {};
}

std::size_t length_of_name_of_time(std::string_view text) {
  constexpr std::array<std::string_view, 6> kNames{"T", "TS", "TIME", "TIMESTAMP", "AT", "ZEIT"};
  constexpr std::size_t kLongest = 9;
  Scan scan(text);
  scan.skip(kAllBlanks);
  scan.take("[(");
  const std::string name = stl::upper_case(scan.take_while(stl::is_letter, kLongest));
  if (scan.take("=:") == '\0' || std::ranges::find(kNames, name) == kNames.end()) return 0;
  return scan.at();
}

std::optional<Bytes> bytes_of_text(std::string_view text) {
  Bytes bytes;
  for (std::size_t begin = begin_of_word(text, 0); begin < text.size();) {
    const std::size_t end = end_of_word(text, begin);
    if (!append_bytes(bytes, text.substr(begin, end - begin))) return {};
    begin = begin_of_word(text, end);
  }
  return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

bool has_clock(std::string_view text) {
  for (std::size_t at = text.find(':'); at != std::string_view::npos; at = text.find(':', at + 1))
    if (at > 0 && at + 2 < text.size() && stl::is_digit(text[at - 1]) && stl::is_digit(text[at + 1]) &&
        stl::is_digit(text[at + 2]))
      return true;
  return false;
}

/// A frame of Modbus ASCII as its characters, `:0B03006300028D`, with the CR LF that logs leave out (Modbus over Serial Line
/// V1.02, 2.5.2). Nothing if there is none, or it stands among other words and has a wrong LRC.
std::optional<BytesInLine> modbus_ascii_in(std::string_view line) {
  constexpr std::size_t kFewestDigits = 6;  // station, function, LRC
  constexpr std::string_view kBlanksAndMarks = " \t\"'";
  for (std::size_t colon = line.find(':'); colon != std::string_view::npos; colon = line.find(':', colon + 1)) {
    if (colon > 0 && !is_any_of(line[colon - 1], kBlanksAndMarks)) continue;
    std::size_t end = colon + 1;
    while (end < line.size() && is_hex_digit(line[end])) ++end;
    const std::string_view digits = line.substr(colon + 1, end - colon - 1);
    const std::string_view after = line.substr(end);
    const bool ends = after.find_first_not_of(" \t\r\"'") == std::string_view::npos || after.starts_with("\\r") ||
                      after.starts_with("<CR>");
    if (digits.size() < kFewestDigits || digits.size() % 2 != 0 || !ends) continue;
    std::uint8_t sum = 0;
    for (std::size_t i = 0; i < digits.size(); i += 2)
      sum = static_cast<std::uint8_t>(sum + hex_number(digits.substr(i, 2)));
    const std::string_view before = stl::trim(line.substr(0, colon));
    if (sum != 0 && !before.empty() && direction_of(before) == Direction::Unknown) continue;
    BytesInLine found{.begin = colon};
    for (const std::string_view part : {line.substr(colon, end - colon), std::string_view("\r\n")})
      found.bytes.insert(found.bytes.end(), part.begin(), part.end());
    return found;
  }
  return {};
}

/// Numbers that are no pairs of digits may be bytes as well, if they are a right frame.
std::optional<BytesInLine> BytesOfLines::in(std::string_view line) {
  if (auto ascii = modbus_ascii_in(line)) return ascii;
  auto found = among_words(line);
  if (found && found->not_understood.empty() && found->bytes.size() > 1) return found;
  auto list = number_list_at_end(without_comment(line));
  if (!list) return found;
  if (!found || found->not_understood.empty())
    return BytesInLine{.begin = list->begin, .not_understood = list->odd, .readings = std::move(list->readings)};
  std::ranges::move(list->readings, std::back_inserter(found->readings));
  found->begin = std::min(found->begin, list->begin);
  return found;
}

std::optional<BytesInLine> BytesOfLines::among_words(std::string_view line) {
  take_apart(without_comment(line));
  if (auto labelled = bytes_with_name_of_crc()) return labelled;
  const std::size_t end_of_row = end_of_hex(line);
  if (end_of_row < line.size()) take_apart(without_comment(line.substr(0, end_of_row)));
  const auto run = last_run(words_);
  if (!run) return bytes_in_comment(line);
  const Words after = Words(words_).subspan(run->before.size() + run->words.size());
  const bool is_sentence = is_of_a_sentence(run->before, run->words, after) || is_value(run->before, run->words) ||
                           are_values(run->before, run->words);
  if (is_sentence && !has_pairs(run->before)) return {};
  BytesInLine found{.begin = run->words.front().begin, .has_characters = end_of_row < line.size()};
  const Word* const doubtful = is_sentence ? &run->before.back() : what_is_doubtful(run->before, run->words, after);
  if (doubtful != nullptr) {
    found.not_understood = doubtful->text;
    return take_readings(found), found;
  }
  if (!after.empty() && after.front().text == "|") found.next_cell = after.front().begin + 1;
  found.bytes = bytes_of(run->words);
  if (const auto other = other_run(run->words, after)) {
    found.not_understood = other->without;
    found.readings = {{found.bytes, false}, {bytes_of(other->words), true}};
  }
  return found;
}

/// Bytes of which the last two have a name: `01 03 … CRC: E4 09`. They may be those of the frame once more.
std::optional<BytesInLine> BytesOfLines::bytes_with_name_of_crc() const {
  constexpr std::array<std::string_view, 5> kNames{"CRC", "CRC16", "LRC", "CHECKSUM", "CHK"};
  const auto is_name = [&](const Word& word) {
    const std::string_view name = word.text.substr(0, word.text.find_last_not_of(":=([") + 1);
    return word.bytes == 0 && is_any_of(word.text.front(), "CcLl") &&
           std::ranges::find(kNames, stl::upper_case(name)) != kNames.end();
  };
  const auto name = std::ranges::find_if(words_, is_name);
  if (name == words_.end() || name == words_.begin()) return {};
  const Words all(words_), before = all.first(static_cast<std::size_t>(name - words_.begin()));
  const Words sum = all.subspan(before.size() + 1);
  const auto run = last_run(before);
  const std::size_t bytes = sum.empty() ? 0 : sum.back().first_byte + sum.back().bytes - sum.front().first_byte;
  if (!run || run->before.size() + run->words.size() != before.size() || (bytes != 1 && bytes != 2)) return {};
  if (std::ranges::any_of(sum, [](const Word& word) { return word.bytes == 0; })) return {};
  Bytes whole = bytes_of(run->words), last = bytes_of(sum);
  BytesInLine found{.begin = run->words.front().begin, .not_understood = name->text};
  found.readings = {{whole, true}, {whole, true}};
  found.readings[0].bytes.insert(found.readings[0].bytes.end(), last.begin(), last.end());
  return found;
}

/// The bytes in a comment: a direction before the sign of a comment speaks for bytes after it, `RX #2 01 03`.
std::optional<BytesInLine> BytesOfLines::bytes_in_comment(std::string_view line) {
  const auto cut_off = cut_off_bytes(words_);
  const std::size_t comment = without_comment(line).size();
  if (cut_off || comment == line.size() || std::ranges::none_of(words_, names_a_direction)) return cut_off;
  take_apart(line.substr(comment));
  if (words_.empty() || !has_pairs(words_)) return {};
  return BytesInLine{.begin = comment, .not_understood = words_.front().text};
}

Bytes BytesOfLines::bytes_of(std::span<const Word> run) const {
  const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(run.front().first_byte);
  return {begin, bytes_.begin() + static_cast<std::ptrdiff_t>(run.back().first_byte + run.back().bytes)};
}

void BytesOfLines::take_readings(BytesInLine& found) const {
  const auto runs = possible_runs(words_);
  const auto has_word = [&](Words run) {
    return std::ranges::find(run, found.not_understood.data(), [](const Word& word) { return word.text.data(); }) !=
           run.end();
  };
  for (const Words run : runs) found.readings.push_back({bytes_of(run), !has_word(run)});
  if (!runs.empty()) found.begin = runs.front().front().begin;
}

void BytesOfLines::take_apart(std::string_view line) {
  words_.clear();
  bytes_.clear();
  bool in_pairs = false, has_others = false;
  for (std::size_t begin = begin_of_word(line, 0); begin < line.size();) {
    const std::size_t end = end_of_word(line, begin);
    Word word{.text = line.substr(begin, end - begin), .begin = begin, .first_byte = bytes_.size()};
    begin = begin_of_word(line, end);
    bool any = !(in_pairs && is_of_a_language(word.text)) && append_bytes(bytes_, word.text);
    if (const std::size_t name = any ? 0 : length_of_name(word.text); name > 0)
      if ((any = append_bytes(bytes_, word.text.substr(name)))) {
        words_.push_back({.text = word.text.substr(0, name), .begin = word.begin});
        word.text.remove_prefix(name);
        word.begin += name;
      }
    word.bytes = any ? bytes_.size() - word.first_byte : 0;
    in_pairs = word.bytes == 1;
    has_others = has_others || !any || is_any_of(word.text.front(), "([") || is_marked(word.text);
    words_.push_back(word);
  }
  if (has_others) take_numbers_out(words_);
}

/// The place of the characters that a tool puts beside the hex; the length of the line if there are none. The first of them
/// may be blanks.
std::size_t BytesOfLines::end_of_hex(std::string_view line) const {
  constexpr std::size_t kFullRow = 16, kShortestFullRow = 2 * kFullRow, kLongest = 1000, kBars = 2, kLongestSign = 4;
  if (line.size() > kLongest) return line.size();
  const bool ascii = stl::is_ascii(line);
  for (std::size_t count = 1; count <= words_.size(); ++count) {
    const Word& before = words_[count - 1];
    const std::size_t gap = before.begin + before.text.size();
    std::size_t last = gap;
    while (last < line.size() && line[last] == ' ') ++last;
    const std::size_t most = before.first_byte + before.bytes;  // characters: one for each byte at most
    const bool is_gap = last - gap > 1 || (last - gap == 1 && gap >= kShortestFullRow);
    if (!is_gap || last == line.size() || most == 0 || (last - gap == 1 && most < kFullRow)) continue;
    const std::size_t signs = line.size() - last;
    if (signs > most + kBars && (signs > kLongestSign * (most + kBars) || ascii || stl::is_ascii(line.substr(last))))
      continue;
    const auto run = last_run(Words(words_).first(count));
    if (!run || run->before.size() + run->words.size() != count) continue;
    const Word& first = run->words.front();
    const auto bytes = std::span(bytes_).subspan(first.first_byte, most - first.first_byte);
    for (std::size_t column = gap + (bytes.size() < kFullRow ? 2 : 1); column <= last; ++column)
      if (const std::string_view signs_at = without_bars(line.substr(column));
          ascii ? is_column_of_characters(signs_at, bytes) : is_column_of_characters(in_single_bytes(signs_at), bytes))
        return gap;
  }
  return line.size();
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

void CharacterJoiner::add(const RecordedFrame& row, std::vector<RecordedFrame>& frames) {
  if (row.doubt) {
    last_.reset();
    return frames.push_back(row);
  }
  const bool joins =
      !frames.empty() && frames.back().direction == row.direction && last_ && row.at && *row.at - *last_ <= gap_;
  last_ = row.at;
  if (!joins) frames.push_back({.at = row.at, .direction = row.direction, .place = row.place, .stream = row.stream});
  RecordedFrame& frame = frames.back();
  for (const std::size_t place : row.damaged) frame.damaged.push_back(frame.bytes.size() + place);
  frame.bytes.insert(frame.bytes.end(), row.bytes.begin(), row.bytes.end());
  if (row.at) frame.times.push_back(*row.at);
}

void join_characters(LineRecording& recording, const ReadingChoices& choices) {
  CharacterJoiner joiner(choices);
  std::vector<RecordedFrame> frames;
  for (const RecordedFrame& row : recording.frames) joiner.add(row, frames);
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
    for (Time& time : frame.times) time -= *first;
  }
}

}  // namespace s7200::tools

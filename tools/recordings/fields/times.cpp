// Times, as tools write them.
#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cstdlib>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/words.hpp"
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

/// A time since 1970 in milliseconds, microseconds or nanoseconds: `1616595070123`. Numbers of 13 and 19 digits are no pairs
/// of digits; those of 16 are a time before something else, from 2008 on.
std::optional<LeadingTime> time_since_1970(std::string_view text) {
  constexpr std::size_t kMilliseconds = 13, kMicroseconds = 16, kNanoseconds = 19;
  Scan scan(text);
  scan.skip(kBeforeTime);
  if (scan.next() != '1') return {};  // from 2001 to 2033
  const std::string_view digits = scan.take_digits(kNanoseconds + 1);
  const bool in_microseconds = digits.size() == kMicroseconds;
  if (digits.size() != kMilliseconds && digits.size() != kNanoseconds && !in_microseconds) return {};
  if (in_microseconds && (digits < "12" || stl::trim(text.substr(scan.at())).empty())) return {};
  if (!scan.at_end() && scan.next() != '"' && !is_any_of(scan.next(), kAfterTime)) return {};
  skip_after_time(scan);
  return LeadingTime{.time = decimal_number(digits) * (in_microseconds                  ? kMicrosecond
                                                       : digits.size() == kMilliseconds ? kMillisecond
                                                                                        : 1),
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

NameOfTime name_of_time(std::string_view text) {
  constexpr std::array<std::string_view, 7> kNames{"T", "TS", "TIME", "TIMESTAMP", "AT", "ZEIT", "ELAPSED"};
  constexpr std::array<std::string_view, 4> kDifferences{"\u0394t", "\u0394T", "DT", "DELTA"};
  constexpr std::size_t kLongest = 9;
  Scan scan(text);
  scan.skip(kAllBlanks);
  scan.take("[(");
  const std::string name = stl::upper_case(scan.take_while(is_letter_of_any_language, kLongest));
  const char mark = scan.take("=:+");
  const bool is_difference = std::ranges::find(kDifferences, name) != kDifferences.end();
  if (mark == '\0' || (!is_difference && std::ranges::find(kNames, name) == kNames.end())) return {};
  return {scan.at(), is_difference};
}

bool has_clock(std::string_view text) {
  for (std::size_t at = text.find(':'); at != std::string_view::npos; at = text.find(':', at + 1))
    if (at > 0 && at + 2 < text.size() && stl::is_digit(text[at - 1]) && stl::is_digit(text[at + 1]) &&
        stl::is_digit(text[at + 2]))
      return true;
  return false;
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

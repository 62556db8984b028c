// Logs of serial sniffers: a frame in each line, or in rows below a line with its time.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/dump.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/rows/marked_bytes.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

/// Whether the arrow that has its head or its tail there stands between two words: `plc --> pc`.
bool stands_between_names(std::string_view text, std::size_t arrow) {
  constexpr std::string_view kArrow = "<->", kBlanks = " \t";
  const auto is_of_arrow = [&](char c) { return kArrow.find(c) != std::string_view::npos; };
  const auto is_blank = [&](char c) { return kBlanks.find(c) != std::string_view::npos; };
  std::size_t before = arrow, after = arrow;
  while (before > 0 && is_of_arrow(text[before - 1])) --before;
  while (before > 0 && is_blank(text[before - 1])) --before;
  while (after < text.size() && is_of_arrow(text[after])) ++after;
  while (after < text.size() && is_blank(text[after])) ++after;
  return before > 0 && after < text.size() && is_word_sign(text[before - 1]) && is_word_sign(text[after]);
}

/// The place of an arrow between two names: it says who talks to whom, not which of them is the master.
std::size_t arrow_between_names(std::string_view head) {
  for (const std::string_view arrow : {"->", "<-"})
    for (std::size_t at = head.find(arrow); at != std::string_view::npos; at = head.find(arrow, at + 1))
      if (stands_between_names(head, at)) return at;
  return std::string_view::npos;
}

Direction direction_of_heading(std::string_view text) {
  const std::string_view head = text.substr(0, kLongestHead);
  return arrow_between_names(head) == std::string_view::npos ? direction_of(head) : Direction::Unknown;
}

/// The direction that the text before the bytes of a row names: `TX`, `IN`, `M->S`.
Direction direction_of_row(std::string_view text) {
  const std::size_t arrow = arrow_between_names(text.substr(0, kLongestHead));
  if (arrow == std::string_view::npos) {
    const Direction named = direction_of(text);
    return named != Direction::Unknown ? named : direction_beside_bytes(text);
  }
  const std::string before = stl::upper_case(stl::trim_end(text.substr(0, text.find_last_not_of("<-", arrow) + 1)));
  const std::string_view first = std::string_view(before).substr(before.find_last_of(" \t[(") + 1);
  const bool forward = text[arrow] == '-';
  if (first == "M" || first == "MASTER") return forward ? Direction::Request : Direction::Answer;
  if (first == "S" || first == "SLAVE") return forward ? Direction::Answer : Direction::Request;
  std::string words(text);
  std::ranges::replace_if(
      words, [](char c) { return c == '<' || c == '>'; }, ' ');
  return direction_of(words);
}

/// The length of Modbus Poll's counter, which is not a byte: `Tx:000001-`
std::size_t length_of_counter(std::string_view line) {
  Scan scan(line);
  scan.skip(kAllBlanks);
  const bool counts = scan.take("TR") != '\0' && scan.take_word("x:") && !scan.take_digits(kLongestHead).empty();
  return counts && scan.take("-") != '\0' ? scan.at() : 0;
}

/// A direction that stands before the time, and how long it is: `> 2026/11/22 10:00:00.5  length=8` of socat, `[RTU]>Tx >
/// 10:00:00:500 - 01  03` of QModMaster, and other words: `[COM1] 10:00:00.5`, `DEBUG TX 10:00:00.5`.
struct LeadingDirection {
  Direction direction = Direction::Unknown;
  std::size_t length = 0;
};

/// Words before a time of day that has a date, or is in a row that names its direction; none if a byte is among them.
LeadingDirection words_before_time(std::string_view line) {
  constexpr std::size_t kMostWords = 4, kMostAfter = 40;
  Scan scan(line);
  scan.skip(kAllBlanks);
  for (std::size_t words = 0; words < kMostWords && !scan.at_end(); ++words) {
    const std::string_view word = scan.take_while([](char c) { return !is_any_of(c, kAllBlanks); });
    if (bytes_of_text(word)) return {};
    scan.skip(kAllBlanks);
    if (!stl::is_digit(scan.next()) && !is_any_of(scan.next(), "[(@")) continue;
    const auto time = leading_time(line.substr(scan.at()));
    if (!time || !time->of_day) continue;
    const Direction before = direction_of(line.substr(0, scan.at()));
    const bool of_logger = time->date[0] && is_any_of(word.back(), ":]");  // `modbus: 2026/11/22 10:00:00`
    const bool named = before != Direction::Unknown || of_logger ||
                       direction_of(line.substr(scan.at() + time->length, kMostAfter)) != Direction::Unknown;
    return named ? LeadingDirection{before, scan.at()} : LeadingDirection{};
  }
  return {};
}

LeadingDirection leading_direction(std::string_view line) {
  Scan scan(line);
  Direction named = Direction::Unknown;
  if (scan.take("[") != '\0') {
    const bool is_named = !scan.take_while(is_word_sign).empty() && scan.take_word("]>");
    const std::string_view name = is_named ? scan.take_while(stl::is_letter, 2) : "";
    if ((name != "Tx" && name != "Rx") || scan.take(" ") == '\0') return words_before_time(line);
    named = direction_of(name);
  }
  const char arrow = scan.take("<>");
  if (arrow == '\0' || scan.take(" ") == '\0' || !leading_time(line.substr(scan.at()))) return words_before_time(line);
  if (named == Direction::Unknown) named = arrow == '>' ? Direction::Request : Direction::Answer;
  return {named, scan.at()};
}

/// The received text that is not hex: `RX: 12.5`. Empty for a remark, `RX: timeout`, and for a head, `RX 8 bytes`, `RX
/// len=8`.
std::string figure_after_direction(std::string_view line) {
  const std::vector<std::string> words = stl::split_words(line);
  const auto direction =
      std::ranges::find_if(words, [](const std::string& word) { return direction_of(word) != Direction::Unknown; });
  if (direction == words.end() || std::next(direction) == words.end()) return {};
  const std::string& figure = *std::next(direction);
  const bool is_last = std::next(direction, 2) == words.end();
  const bool has_digit = std::ranges::any_of(figure, stl::is_digit);
  return is_last && has_digit && figure.find_first_of("=:([") == std::string::npos ? figure : std::string();
}

/// The time in front of a row, and what stands before it.
struct TimeOfRow {
  LeadingDirection before{};
  std::optional<LeadingTime> time{};
};
TimeOfRow time_of_row(std::string_view line) {
  if (const auto time = leading_time(line)) return {{}, time};
  if (const NameOfTime name = name_of_time(line); name.length > 0)
    if (auto time = leading_time(line.substr(name.length))) {
      time->has_sign |= name.is_difference && !time->of_day;
      return {{Direction::Unknown, name.length}, time};
    }
  if (const std::size_t counter = length_of_counter(line); counter > 0)  // `Tx:000001-10:00:00.000-01 03`
    if (const auto time = leading_time(line.substr(counter)); time && time->of_day)
      return {{direction_of(line.substr(0, counter)), counter}, time};
  const LeadingDirection before = leading_direction(line);
  return {before, before.length > 0 ? leading_time(line.substr(before.length)) : std::nullopt};
}

/// The time at the beginning of a line, after its number and other words.
std::optional<LeadingTime> time_of_line(std::string_view line) {
  return time_of_row(line.substr(length_of_index(line))).time;
}

/// Whether all times have a sign or are called differences, and count from the row above: `+0.037`, `Δt=0.037`. Times
/// around a trigger ascend from below 0 instead.
bool has_deltas(std::string_view text) {
  std::size_t times = 0, after = 0;
  bool ascend = true;
  Time last = -kFurthestTime;
  for (const std::string_view line : Lines(beginning_of(text)))
    if (const auto time = time_of_line(line)) {
      if (!time->has_sign) return false;
      ++times;
      after += time->time >= 0;
      ascend = ascend && time->time >= last;
      last = time->time;
    }
  return times > 1 && 2 * after > times && (after == times || !ascend);
}

/// The nine digits after the seconds in a head of socat: `> 2025/12/30 14:58:36.000834907  length=8 from=0 to=7`. Empty: it
/// is none, or has six.
std::string_view nine_digits_of_socat(std::string_view line) {
  constexpr std::size_t kDigits = 9;
  const std::size_t length = line.find(" length="), point = line.substr(0, length).rfind('.');
  if (length == std::string_view::npos || point == std::string_view::npos) return {};
  if (line.find(" from=", length) == std::string_view::npos || leading_direction(line).length == 0) return {};
  const std::string_view digits = stl::trim(line.substr(point + 1, length - point - 1));
  return digits.size() == kDigits && std::ranges::all_of(digits, stl::is_digit) ? digits : std::string_view();
}

/// Whether socat wrote microseconds with nine digits, as some versions do: none of the file has more than six that count.
bool has_padded_microseconds(std::string_view text) {
  bool any = false;
  for (const std::string_view line : Lines(beginning_of(text)))
    if (const std::string_view digits = nine_digits_of_socat(line); !digits.empty()) {
      if (!digits.starts_with("000")) return false;
      any = true;
    }
  return any;
}

/// How times of a log are written, as far as one alone does not say it.
struct TimesOfLog {
  bool deltas = false;               ///< each counts from the row above
  bool named = false;                ///< and is called a difference
  bool padded_microseconds = false;  ///< socat's
  bool durations = false;            ///< Portmon's: how long each call took
};

bool calls_times_differences(std::string_view text) {
  return std::ranges::any_of(Lines(beginning_of(text)),
                             [](std::string_view line) { return name_of_time(line).is_difference; });
}

/// Whether Portmon wrote the durations of calls, not the time of day: `0  0.00000559  app.exe  IRP_MJ_WRITE  …`
bool has_durations(std::string_view text) {
  constexpr std::size_t kMostDigits = 9;
  for (const std::string_view line : Lines(beginning_of(text))) {
    Scan scan(line);
    const bool is_call = !scan.take_digits(kMostDigits).empty() && scan.skip(" \t") > 0 &&
                         !scan.take_digits(kMostDigits).empty() && scan.take(".,") != '\0' &&
                         !scan.take_digits(kMostDigits).empty() && scan.skip(" \t") > 0;
    if (is_call && line.find("IRP_MJ_") != std::string_view::npos) return true;
  }
  return false;
}

/// Whether a line is a comment. `#1 TX 01 03` has a number and a direction, and is a row.
bool is_remark_line(std::string_view line) {
  Scan scan(line);
  if (scan.take("#") == '\0') return false;
  if (scan.take_digits(kLongestHead).empty() || scan.skip(kAllBlanks) == 0) return true;
  return direction_of(scan.take_while([](char c) { return !is_any_of(c, kAllBlanks); })) == Direction::Unknown;
}

/// Whether a text has a word: three letters, one of them beyond F. A damaged byte has none.
bool is_of_words(std::string_view text) {
  constexpr std::ptrdiff_t kFewestLetters = 3;
  const auto is_beyond_f = [](char c) { return stl::is_letter(c) && !is_hex_digit(c); };
  return std::ranges::count_if(text, stl::is_letter) >= kFewestLetters && std::ranges::any_of(text, is_beyond_f);
}

constexpr std::size_t kFullRow = 16;

struct RecordedCharacter {
  Direction direction;
  std::uint8_t byte;
};

/// A line with a character and its name: `> 	0x01 (^A)`
std::optional<RecordedCharacter> character_of_interceptty(std::string_view line) {
  Scan scan(line);
  const char arrow = scan.take("<>");
  if (arrow == '\0' || line.size() > kLongestHead) return {};
  const std::string_view digits = scan.skip(kAllBlanks) > 0 && scan.take_word("0x") ? scan.take_hex(2) : "";
  const std::string_view rest = stl::trim(line.substr(scan.at()));
  const bool is_name = rest.empty() || (is_any_of(scan.next(), kAllBlanks) && rest.front() == '(' && rest.back() == ')');
  if (digits.size() != 2 || !is_name) return {};
  return RecordedCharacter{arrow == '>' ? Direction::Request : Direction::Answer,
                           static_cast<std::uint8_t>(hex_number(digits))};
}

class LogReader {
 public:
  /// `joins`: the rows have a character each, and become frames at once. Room for frames in so many `lines` costs nothing
  /// until it is used, and growing would copy all frames.
  LogReader(const ReadingChoices& choices, bool joins, std::size_t lines, TimesOfLog times)
      : times_(times), joiner_(choices), joins_(joins) {
    recording_.frames.reserve(lines);
  }

  /// A row has not just a character and its time.
  bool has_other_rows() const { return has_other_rows_; }

  void take(std::string_view line) {
    ++number_;
    if (line.empty()) return;
    if (const std::string_view rest = stl::trim(line); rest.empty() || is_remark_line(rest)) return;
    if (ends_dump(line)) return;
    if (const auto character = character_of_interceptty(line)) return take(*character);
    line.remove_prefix(length_of_index(line));
    const auto [before, time] = time_of_row(line);
    const bool tells_time = time && !(times_.durations && !time->of_day);
    const std::optional<Time> at = tells_time ? std::optional(time_of(*time, line)) : std::nullopt;
    if (time) line.remove_prefix(before.length + time->length);
    if (time && time->of_day && line.starts_with('-') && bytes_of_text(line.substr(1, 2))) line.remove_prefix(1);
    const std::string_view whole = line;
    const bool is_of_dump = !at && (has_offsets_ || is_dump(line));
    const bool may_be_row = is_of_dump || (!at && (heading_ || goes_on_));
    const Offset offset = may_be_row ? offset_of(line) : Offset{};
    if (is_of_dump && !offset.digits.empty() && hex_number(offset.digits) == 0) goes_on_ = has_offsets_ = false;
    if (!offset.digits.empty() && !is_right(offset) && is_of_dump) {
      in_dump_ = true;
      return leave_out({.not_understood = offset.digits}, {}, Direction::Unknown);
    }
    has_offset_ = !offset.digits.empty() && is_right(offset);
    if (has_offset_) line.remove_prefix(offset.length);
    const std::size_t counter = length_of_counter(line);
    in_characters_ = false;
    const std::string_view rest = stl::trim_end(line.substr(counter));
    const auto direction = [&, told = before.direction](Direction read) { return told != Direction::Unknown ? told : read; };
    auto found = bytes_of_lines_.in(rest);
    if (const auto row = has_offset_ ? dump_row(whole) : std::nullopt; row && row->digits_of_group > 2)
      found = BytesInLine{.bytes = row->bytes, .begin = rest.find_first_not_of(kAllBlanks)};
    const bool is_row_of_dump = rest.size() < whole.size() || (found && found->has_characters);
    in_dump_ = !at && (has_offset_ || (is_row_of_dump && is_dump(whole)));
    if (!found)
      take_heading(at, direction(direction_of_heading(line)), line);
    else if (found->bytes.empty())
      leave_out(*found, at, direction(direction_of_row(line.substr(0, counter + found->begin))));
    else
      take_with_cells(std::move(*found), rest, direction(direction_of_row(line.substr(0, counter + found->begin))), at);
  }

  LineRecording finish() {
    drop_heading();
    note(left_out_, "left out", "no bytes in it");
    if (without_time_.count > 0) {
      const std::string more = without_time_.count == 1 ? "" : fmt::format(", and {} more", without_time_.count - 1);
      recording_.notes.push_back(fmt::format("line {}: read without a time{}: cannot read '{}' as one", without_time_.first,
                                             more, stl::printable(stl::shortened(time_like_))));
    }
    if (times_.durations)
      recording_.notes.emplace_back(
          "no times are known: Portmon wrote how long each call took; its option Clock Time shows when it was");
    if (times_.deltas)
      recording_.notes.push_back(fmt::format("its times {}: each counts from the row above",
                                             times_.named ? "are called differences" : "have a plus sign"));
    count_from_first(recording_);
    return std::move(recording_);
  }

 private:
  /// A line with a time or a direction and no bytes: those of the rows below it.
  struct Heading {
    std::optional<Time> at{};
    Direction direction = Direction::Unknown;
    std::size_t number = 0;
    std::string not_bytes{};  ///< what it says instead of bytes; empty: a remark
  };

  Time time_of(const LeadingTime& read, std::string_view line) {
    if (times_.deltas) return last_time_ += read.time;
    const std::string_view digits = times_.padded_microseconds ? nine_digits_of_socat(line) : "";
    const Time nanoseconds = decimal_number(digits);
    return days_.since_first_midnight(read) + nanoseconds * kMicrosecond - nanoseconds;
  }

  /// Lines of which the same is to be said.
  struct Lines {
    std::size_t first = 0, count = 0;

    void add(std::size_t number) {
      if (count++ == 0) first = number;
    }
  };

  /// Adds a note: `line 3: left out, and 2 more: no bytes in it`
  void note(const Lines& lines, std::string_view what, std::string_view why) {
    if (lines.count == 0) return;
    const std::string more = lines.count == 1 ? "" : fmt::format(", and {} more", lines.count - 1);
    recording_.notes.push_back(fmt::format("line {}: {}{}: {}", lines.first, what, more, why));
  }

  /// The offset before a row: `0010  `
  struct Offset {
    std::string_view digits{};  ///< empty: there is none
    std::size_t length = 0;
  };
  static Offset offset_of(std::string_view line) {
    constexpr std::size_t kFewestBeforeColon = 2, kFewest = 4, kMost = 8, kOfOd = 7;
    Scan scan(line);
    scan.skip(kAllBlanks);
    scan.take_word("0x");
    const std::string_view digits = scan.take_hex(kMost);
    const bool colon = scan.take(":") != '\0';
    const std::size_t blanks = scan.skip(kAllBlanks);
    const std::size_t begin = scan.at();
    const bool before_pair = scan.take_hex(3).size() == 2 && (scan.at_end() || scan.skip(kAllBlanks, 1) == 1);
    const bool is_of_od = digits.size() == kOfOd && before_pair && !colon;
    const bool is_offset = digits.size() >= (colon ? kFewestBeforeColon : kFewest) && (digits.size() % 2 == 0 || is_of_od);
    return is_offset && blanks > 0 && (colon || blanks > 1 || before_pair) ? Offset{digits, begin} : Offset{};
  }

  /// Whether the offset continues the dump.
  bool is_right(const Offset& offset) const { return is_offset_of(offset.digits, bytes_above()); }

  /// The number of bytes of the frame above the row.
  std::size_t bytes_above() const { return goes_on_ || has_offsets_ ? recording_.frames.back().bytes.size() : 0; }

  /// Whether a line is a row of hexdump, eight digits, two blanks, and pairs of digits: `00000010  01 03 …`; or the first
  /// row of a packet as Wireshark writes it: `0000   01 03 …`. PuTTY has blanks before it.
  static bool is_dump(std::string_view line) {
    Scan scan(line);
    scan.skip(kAllBlanks);
    const std::string_view offset = scan.take_hex(8);
    const bool is_offset = offset.size() == 8 || offset == "0000";
    const bool has_offset = is_offset && scan.skip(kAllBlanks) >= 2;
    return has_offset && scan.take_hex(2).size() == 2 && (scan.at_end() || scan.skip(kAllBlanks, 1) == 1);
  }

  /// Whether a line ends a dump, as `00000008` does below the last row: the number of its bytes, with those of rows that
  /// were left out. Of od it has six digits or seven.
  bool ends_dump(std::string_view line) const {
    const std::string_view digits = stl::trim(line);
    return in_dump_ && digits.size() >= 6 && digits.size() <= 8 &&
           digits.find_first_not_of("0123456789abcdefABCDEF") == std::string_view::npos &&
           (row_left_out_ || is_offset_of(digits, recording_.frames.back().bytes.size()));
  }

  /// A frame that begins in the line that is being read.
  RecordedFrame frame_here(Direction direction, std::optional<Time> at = {}) const {
    return {.at = at, .direction = direction, .place = fmt::format("line {}", number_), .line = number_};
  }

  /// A character without a time: a frame lasts until the other end speaks.
  void take(const RecordedCharacter& character) {
    drop_heading();
    std::vector<RecordedFrame>& frames = recording_.frames;
    if (!in_characters_ || frames.back().direction != character.direction) frames.push_back(frame_here(character.direction));
    frames.back().bytes.push_back(character.byte);
    in_characters_ = has_other_rows_ = true;
  }

  /// Takes bytes whose direction or time may stand in the cells after them: `01 03 | TX | 10:00:00.000`.
  void take_with_cells(BytesInLine found, std::string_view line, Direction direction, std::optional<Time> at) {
    for (std::size_t begin = found.next_cell; begin != 0 && begin < line.size();) {
      const std::size_t end = std::min(line.find('|', begin), line.size());
      const std::string_view cell = stl::trim(line.substr(begin, end - begin));
      if (direction == Direction::Unknown) direction = direction_of(cell);
      if (const auto time = at ? std::nullopt : leading_time(cell); time && time->length == cell.size())
        at = days_.since_first_midnight(*time);
      begin = end + 1;
    }
    take(std::move(found), line, direction, at);
  }

  void take(BytesInLine found, std::string_view line, Direction direction, std::optional<Time> at) {
    const bool is_row = !at && line.substr(0, found.begin).find_first_not_of(" \t") == std::string_view::npos;
    lost_row_ = lost_row_ && is_row;
    row_left_out_ = lost_row_;
    if (lost_row_) return;
    if (is_row && (goes_on_ || (has_offsets_ && has_offset_))) {
      Bytes& bytes = recording_.frames.back().bytes;
      bytes.insert(bytes.end(), found.bytes.begin(), found.bytes.end());
      goes_on_ = found.bytes.size() >= kFullRow;
      return;
    }
    if (is_row && heading_) {
      at = heading_->at;
      direction = below_ = heading_->direction;
      heading_.reset();
      goes_on_ = found.bytes.size() >= kFullRow;
      has_offsets_ = has_offset_;
    } else if (is_row && below_ != Direction::Unknown) {
      direction = below_;
      goes_on_ = has_offsets_ = false;
    } else {
      if (!at && heading_ && heading_->number + 1 == number_ && heading_->direction == Direction::Unknown)
        at = std::exchange(heading_, std::nullopt)->at;  // of a logger that writes a line with the time above each
      drop_heading();
      if (const std::string_view word = at ? "" : time_like_word(line.substr(0, found.begin)); !word.empty()) {
        if (without_time_.count == 0) time_like_ = word;
        without_time_.add(number_);
      }
      goes_on_ = in_dump_ && found.bytes.size() >= kFullRow;
      has_offsets_ = in_dump_ && has_offset_;
    }
    const std::size_t bracket = line.find_first_of("[<", found.begin == 0 ? 0 : found.begin - 1);
    if (direction == Direction::Unknown && bracket != std::string_view::npos && bracket <= found.begin)
      direction = direction_of_brackets(line.substr(bracket));
    has_other_rows_ = has_other_rows_ || found.bytes.size() != 1 || !at;
    RecordedFrame frame = frame_here(direction, at);
    frame.bytes = std::move(found.bytes);
    if (joins_) return joiner_.add(frame, recording_.frames);
    recording_.frames.push_back(std::move(frame));
    if (!found.not_understood.empty()) recording_.frames.back().doubt = doubt_of(found, std::move(found.readings));
  }

  /// Leaves a row out, since a part of a frame would be a frame that nobody sent. Its place is kept: a request before it may
  /// have got it for an answer.
  void leave_out(const BytesInLine& found, std::optional<Time> at, Direction direction) {
    RecordedFrame frame = frame_here(direction, at);
    const bool goes_on = goes_on_ || has_offsets_;
    const bool is_row = !at && (goes_on || heading_ || lost_row_);
    if (is_row && goes_on) {
      frame = std::move(recording_.frames.back());
      recording_.frames.pop_back();
      frame.bytes.clear();
    } else if (is_row && heading_) {
      frame.at = heading_->at;
      frame.direction = heading_->direction;
    }
    if (!is_row || !lost_row_) {
      frame.doubt = doubt_of(found, is_row ? std::vector<Reading>{} : found.readings);
      recording_.frames.push_back(std::move(frame));
    }
    lost_row_ = is_row;
    heading_.reset();
    goes_on_ = has_offsets_ = false;
    row_left_out_ = true;
  }

  static std::shared_ptr<const Doubt> doubt_of(const BytesInLine& found, std::vector<Reading> readings) {
    const std::string word = stl::printable(stl::shortened(found.not_understood));
    return std::make_shared<Doubt>(
        Doubt{fmt::format("cannot tell what '{}' next to its bytes means", word), word, std::move(readings)});
  }

  void take_heading(std::optional<Time> at, Direction direction, std::string_view line) {
    drop_heading();
    lost_row_ = false;
    if (at)
      heading_ = {at, direction, number_, direction == Direction::Unknown ? "" : figure_after_direction(line)};
    else if (const auto time = direction == Direction::Unknown ? std::nullopt : time_within(line))
      heading_ = {days_.since_first_midnight(*time), direction, number_, ""};
    else if (direction != Direction::Unknown && is_only_direction(line))
      heading_ = {{}, direction, number_, ""};
    else
      left_out_.add(number_);
  }

  /// The date and time in a heading: `Outgoing raw data at 2021-03-24 14:11:10`, `000001: Bytes written, 2021-03-24
  /// 14:11:10.5 +0.0`; at its end also a time without a date.
  static std::optional<LeadingTime> time_within(std::string_view line) {
    for (std::size_t at = line.find(' '); at != std::string_view::npos && at < kLongestHead; at = line.find(' ', at + 1)) {
      const auto time = leading_time(line.substr(at));
      if (time && time->of_day && (time->date[0] || time->length == line.size() - at)) return time;
    }
    return {};
  }

  /// Whether a heading has words only: `Incoming packet`, `TX:`
  static bool is_only_direction(std::string_view line) {
    constexpr std::size_t kMostWords = 3;
    return stl::split_words(line).size() <= kMostWords &&
           std::ranges::none_of(line, [](char c) { return stl::is_digit(c); });
  }

  void drop_heading() {
    if (heading_ && !heading_->not_bytes.empty())
      recording_.frames.push_back(row_not_read(heading_->number, not_understood(heading_->not_bytes), heading_->at,
                                               heading_->direction, is_of_words(heading_->not_bytes)));
    else if (heading_)
      left_out_.add(heading_->number);
    heading_.reset();
    goes_on_ = has_offsets_ = false;
    below_ = Direction::Unknown;
  }

  LineRecording recording_;
  BytesOfLines bytes_of_lines_;
  DayCounter days_;
  std::size_t number_ = 0;
  Lines left_out_, without_time_;
  std::string time_like_{};  // what may be the time of the first of those lines
  TimesOfLog times_;
  Time last_time_ = 0;
  CharacterJoiner joiner_;
  bool joins_, has_other_rows_ = false;
  std::optional<Heading> heading_;
  bool in_dump_ = false;                  // the line before was a row of one
  bool row_left_out_ = false;             // and is not in the last frame
  bool in_characters_ = false;            // it was one character, as interceptty has it
  bool lost_row_ = false;                 // a row of the frame was left out, and so are those below it
  bool goes_on_ = false;                  // the row before was full, and has a heading
  bool has_offset_ = false;               // this row has one, and it is right
  bool has_offsets_ = false;              // those of the last frame have them, so that one more row has one, too
  Direction below_ = Direction::Unknown;  // of the heading above the rows; unless the file says another
};

}  // namespace

Result<LineRecording> read_text_log(std::string_view file, const ReadingChoices& choices) {
  const auto plain = in_plain_hex(file);
  const std::string_view bytes = plain ? std::string_view(*plain) : file;
  constexpr std::size_t kShortestRow = 16;  // of most logs
  const auto lines = std::min(static_cast<std::size_t>(std::ranges::count(bytes, '\n')) + 1, bytes.size() / kShortestRow);
  const TimesOfLog times{.deltas = has_deltas(bytes),
                         .named = calls_times_differences(bytes),
                         .padded_microseconds = has_padded_microseconds(bytes),
                         .durations = has_durations(bytes)};
  const auto read = [&](bool joins) -> std::optional<LineRecording> {
    LogReader reader(choices, joins, joins ? 0 : lines, times);
    for (const std::string_view line : Lines(bytes, choices.stop)) {
      reader.take(line);
      if (joins && reader.has_other_rows()) return {};
    }
    return reader.finish();
  };
  if (auto of_characters = read(true)) return *std::move(of_characters);  // only what is joined is kept of a long log
  return *read(false);
}

}  // namespace s7200::tools

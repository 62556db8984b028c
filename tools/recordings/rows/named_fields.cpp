#include "tools/recordings/rows/named_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/json/base64.hpp"
#include "tools/recordings/rows/notation.hpp"

namespace s7200::tools {
namespace {

using Holds = FieldMeaning::Holds;

struct Name {
  std::string_view word;
  Holds holds;
};
constexpr std::array kNames{
    Name{"time", Holds::Time},
    Name{"timestamp", Holds::Time},
    Name{"ts", Holds::Time},
    Name{"t", Holds::Time},
    Name{"at", Holds::Time},
    Name{"datetime", Holds::Time},
    Name{"date", Holds::Time},
    Name{"@timestamp", Holds::Time},
    Name{"uptime", Holds::Time},
    Name{"elapsed", Holds::Time},
    Name{"millis", Holds::Time},
    Name{"micros", Holds::Time},
    Name{"direction", Holds::Direction},
    Name{"dir", Holds::Direction},
    Name{"type", Holds::Direction},
    Name{"event", Holds::Direction},
    Name{"op", Holds::Direction},
    Name{"kind", Holds::Direction},
    Name{"msg", Holds::Direction},
    Name{"message", Holds::Direction},
    Name{"topic", Holds::Direction},
    Name{"data", Holds::Data},
    Name{"payload", Holds::Data},
    Name{"bytes", Holds::Data},
    Name{"hex", Holds::Data},
    Name{"raw", Holds::Data},
    Name{"frame", Holds::Data},
    Name{"buffer", Holds::Data},
    Name{"packet", Holds::Data},
    Name{"pdu", Holds::Data},
    Name{"adu", Holds::Data},
    Name{"station", Holds::Number},
    Name{"unit", Holds::Number},
    Name{"address", Holds::Number},
    Name{"function", Holds::Number},
    Name{"code", Holds::Number},
    Name{"register", Holds::Number},
    Name{"registers", Holds::Number},
    Name{"values", Holds::Number},
    Name{"length", Holds::Number},  // what follows says how many, or which: `data_length`, `frame.number`
    Name{"len", Holds::Number},
    Name{"size", Holds::Number},
    Name{"count", Holds::Number},
    Name{"number", Holds::Number},
    Name{"nr", Holds::Number},
    Name{"id", Holds::Number},
    Name{"index", Holds::Number},
    Name{"base64", Holds::Data},
    Name{"b64", Holds::Data},
};

bool says_base64(std::string_view word) { return word == "base64" || word == "b64"; }

/// The words of a name: `serial received` for `SerialReceived`, `tx data` for `tx_data`.
std::string words_of_name(std::string_view name) {
  std::string words;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool begins = i > 0 && stl::is_upper(name[i]) && stl::is_lower(name[i - 1]);
    if (begins) words += ' ';
    words += name[i] == '_' || name[i] == '-' || name[i] == '.' ? ' ' : name[i];
  }
  return stl::lower_case(words);
}

/// The meaning of a name, by its last known word: `uart data` is data.
FieldMeaning meaning_of(std::string_view name) {
  const std::string words = words_of_name(name);
  FieldMeaning meaning{.direction = direction_of(words), .unit = unit_of(words)};
  for (const std::string& word : stl::split_words(words)) {
    const auto known = std::ranges::find(kNames, word, &Name::word);
    if (known != kNames.end()) meaning.holds = known->holds;
    if (is_name_of_check_sum(word)) meaning.holds = Holds::Number;
    meaning.base64 |= says_base64(word);
  }
  return meaning;
}

/// Bytes with signs between them: `01:03:00`, `01.03.00`
std::optional<Bytes> bytes_with_signs_between(std::string_view text) {
  constexpr std::size_t kPlace = 3;  // two digits and a sign
  if (text.size() % kPlace != kPlace - 1) return {};
  std::string plain(text);
  for (std::size_t i = kPlace - 1; i < plain.size(); i += kPlace) {
    if (plain[i] != ':' && plain[i] != '.') return {};
    plain[i] = ' ';
  }
  return bytes_of_text(plain);
}

/// Whether a text can hardly be anything but base64: whole groups of which the last is filled. `/dev/tty` has whole groups.
bool is_surely_base64(std::string_view text) {
  constexpr std::size_t kShortest = 8;
  return text.size() >= kShortest && text.ends_with('=') && from_base64(text).has_value();
}

std::optional<Bytes> bytes_of(const NamedField& field) {
  if (field.bytes) return field.bytes;
  if (field.value.starts_with("\\x")) return bytes_of_literal(field.value);
  const auto bytes = bytes_of_text(field.value);
  return bytes ? bytes : bytes_with_signs_between(field.value);
}

bool may_hold_frame(const FieldMeaning& meaning) {
  return meaning.holds == Holds::Data || (meaning.holds == Holds::Nothing && meaning.direction != Direction::Unknown);
}

/// Whether a value may be a number of something as well as bytes: `data=42`, `value: 1234`. A direction beside it says that
/// it is bytes.
bool is_figure(const NamedField& field) {
  constexpr std::size_t kMostDigits = 8;
  return !field.bytes && !field.quoted && field.value.size() <= kMostDigits &&
         std::ranges::all_of(field.value, stl::is_digit);
}

/// The frame in the field `data`, or in `tx` where that is not a count, as in `tx=8`. Nothing if the field holds no frame.
/// `said`: the direction that other fields of the record give; `base64`: so do they that its texts are base64.
std::optional<Bytes> frame_in(const NamedField& field, const FieldMeaning& meaning, Direction said, bool base64) {
  if (!may_hold_frame(meaning)) return {};
  if ((base64 || meaning.base64) && !field.bytes) return bytes_of_base64(field.value);
  const bool has_direction = said != Direction::Unknown || meaning.direction != Direction::Unknown;
  return has_direction || !is_figure(field) ? bytes_of(field) : std::nullopt;
}

/// Whether a field says what the bytes beside it are written in: `encoding: base64`
bool names_base64(const NamedFields& fields) {
  return std::ranges::any_of(fields, [](const NamedField& field) { return says_base64(stl::lower_case(field.value)); });
}

Direction direction_in(const NamedFields& fields) {
  for (const NamedField& field : fields)
    if (meaning_of(field.name).holds == Holds::Direction)
      if (const Direction said = direction_of(words_of_name(field.value)); said != Direction::Unknown) return said;
  return Direction::Unknown;
}

/// Whether a text is of bytes, not for people: it has control characters other than tab and line end.
bool is_binary(std::string_view text) {
  return std::ranges::any_of(text, [](char c) {
    return static_cast<unsigned char>(c) < ' ' && std::string_view("\t\r\n").find(c) == std::string_view::npos;
  });
}

/// The text itself, of a field that is called as bytes are. Of bytes each is a character from U+0000 to U+00FF; nothing if
/// the logger has put another in place of one, U+FFFD.
std::optional<Bytes> characters_in(const NamedField& field, const FieldMeaning& meaning) {
  if (field.bytes) return field.bytes;
  if (meaning.holds != Holds::Data || field.value.empty()) return {};
  if (field.value.find("\uFFFD") != std::string::npos) return {};
  if (is_binary(field.value) && stl::is_valid_utf8(field.value)) return in_latin_1(field.value);
  return Bytes(field.value.begin(), field.value.end());
}

/// The parts of a frame that have fields of their own: `addr=01 fc=03 data=000A0002 crc=E409`
struct Parts {
  Bytes station{}, function{}, sum{};

  bool any() const { return !sum.empty() && station.empty() == function.empty(); }
  Bytes around(const Bytes& data) const {
    Bytes whole = station;
    for (const Bytes* part : {&function, &data, &sum}) whole.insert(whole.end(), part->begin(), part->end());
    return whole;
  }
};
Parts parts_in(const NamedFields& fields) {
  const auto take = [](const NamedField& field, std::size_t most, Bytes& part) {
    auto bytes = field.bytes ? field.bytes : bytes_of_text(field.value);
    if (bytes && bytes->size() <= most) part = *std::move(bytes);
  };
  Parts parts;
  for (const NamedField& field : fields) {
    const std::string name = stl::lower_case(field.name);
    if (name == "addr" || name == "address" || name == "slave" || name == "station" || name == "unit")
      take(field, 1, parts.station);
    else if (name == "fc" || name == "func" || name == "function")
      take(field, 1, parts.function);
    else if (is_name_of_check_sum(name))
      take(field, 2, parts.sum);
  }
  return parts;
}

/// A time of day with or without a date, a number in the unit of its name, or seconds since 1970; milliseconds and finer
/// units by their size.
std::optional<LeadingTime> time_of(std::string_view text, std::optional<Time> unit) {
  const auto number = unit ? parse_decimal<long double>(stl::trim(text)) : std::nullopt;
  if (number) {
    const long double time = *number * static_cast<long double>(*unit);
    if (!(std::abs(time) < static_cast<long double>(kFurthestTime))) return {};
    return LeadingTime{.time = std::llround(time)};
  }
  if (const auto time = leading_time(text)) return time;
  auto since_1970 = parse_decimal<std::int64_t>(stl::trim(text));
  constexpr std::int64_t kLeast = 100'000'000;  // of seconds: 1973
  if (!since_1970 || *since_1970 < kLeast) return {};
  Time of_one = kSecond;
  while (*since_1970 / (kFurthestTime / of_one) != 0 && of_one > 1) of_one /= 1000;
  if (*since_1970 >= kFurthestTime / of_one) return {};
  return LeadingTime{.time = *since_1970 * of_one};
}

/// A line of a log in a field, as services collect them: `"log": "TX: 01 03 …"`. It has a direction and bytes after it.
struct LineOfLog {
  Bytes bytes{};
  Direction direction = Direction::Unknown;
};
std::optional<LineOfLog> line_of_log(const NamedField& field) {
  constexpr std::array<std::string_view, 5> kLines{"log", "message", "msg", "line", "text"};
  constexpr std::size_t kFewest = 2;
  if (std::ranges::find(kLines, stl::lower_case(field.name)) == kLines.end()) return {};
  const std::string_view line = stl::trim(std::string_view(field.value).substr(0, field.value.find_first_of("\r\n")));
  auto found = BytesOfLines().in(line);
  if (!found || found->bytes.size() < kFewest || !found->not_understood.empty()) return {};
  const Direction direction = direction_of(line.substr(0, found->begin));
  return direction == Direction::Unknown ? std::nullopt : std::optional(LineOfLog{std::move(found->bytes), direction});
}

}  // namespace

bool has_frame(const NamedFields& fields) {
  const Direction said = direction_in(fields);
  const bool base64 = names_base64(fields);
  return std::ranges::any_of(fields, [&](const NamedField& field) {
    return frame_in(field, meaning_of(field.name), said, base64).has_value() || line_of_log(field).has_value();
  });
}

bool has_base64(const NamedFields& fields) {
  return std::ranges::any_of(fields, [](const NamedField& field) {
    return may_hold_frame(meaning_of(field.name)) && !field.bytes && !bytes_of(field) && is_surely_base64(field.value);
  });
}

bool has_characters(const NamedFields& fields) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' '; };
  return std::ranges::any_of(fields, [&](const NamedField& field) {
    return meaning_of(field.name).holds == Holds::Data && std::ranges::any_of(field.value, is_control) && !bytes_of(field);
  });
}

const FieldMeaning& NamedFieldsReader::meaning_of(std::size_t place, const std::string& name) {
  if (place >= known_.size()) known_.resize(place + 1);
  KnownName& known = known_[place];
  if (known.name != name) known = {name, tools::meaning_of(name)};
  return known.meaning;
}

void NamedFieldsReader::take(const NamedFields& fields, std::string_view before, std::size_t number) {
  std::optional<LeadingTime> time;
  Direction said = Direction::Unknown;
  std::string_view time_like;  // is in a field for times
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const FieldMeaning& meaning = meaning_of(i, fields[i].name);
    if (!time && meaning.holds == Holds::Time) {
      time = time_of(fields[i].value, meaning.unit);
      if (!time) time_like = fields[i].value;
    }
    if (said == Direction::Unknown && meaning.holds == Holds::Direction) said = direction_of(words_of_name(fields[i].value));
  }
  if (!time) time = leading_time(before);
  const auto at = time ? std::optional(days_.since_first_midnight(*time)) : std::nullopt;
  const bool base64 = in_base64_ || names_base64(fields);
  std::size_t frames = 0;
  bool has_data = false;
  const Parts parts = parts_in(fields);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const NamedField& field = fields[i];
    const FieldMeaning& meaning = meaning_of(i, field.name);
    auto bytes = are_characters_ ? characters_in(field, meaning) : frame_in(field, meaning, said, base64);
    const bool should_hold = meaning.holds == Holds::Data && !field.value.empty() && !says_base64(field.value);
    has_data |= should_hold;
    if (!bytes) {
      if (should_hold)
        recording_.frames.push_back(
            row_not_read(number, not_understood(fmt::format("{}: {}", field.name, field.value)), at, said));
      continue;
    }
    RecordedFrame frame{.at = frames++ == 0 ? at : std::nullopt,  // a request with its answer has one time
                        .direction = meaning.direction != Direction::Unknown ? meaning.direction : said,
                        .bytes = std::move(*bytes),
                        .place = fmt::format("line {}", number)};
    if (parts.any())
      frame.doubt = std::make_shared<Doubt>(Doubt{.why = "its CRC stands in a field of its own",
                                                  .word = "crc",
                                                  .readings = {{parts.around(frame.bytes), false}, {frame.bytes, true}}});
    recording_.frames.push_back(std::move(frame));
  }
  if (frames > 0 && !at && !time_like.empty() && without_time_++ == 0)
    first_without_time_ =
        fmt::format("line {}: cannot read '{}' as its time", number, stl::printable(stl::shortened(time_like)));
  if (frames == 0 && !has_data && !take_line_of_log(fields, at, number)) left_out_.without_bytes(number);
}

bool NamedFieldsReader::take_line_of_log(const NamedFields& fields, std::optional<Time> at, std::size_t number) {
  for (const NamedField& field : fields)
    if (auto line = line_of_log(field)) {
      recording_.frames.push_back({.at = at,
                                   .direction = line->direction,
                                   .bytes = std::move(line->bytes),
                                   .place = fmt::format("line {}", number)});
      return true;
    }
  return false;
}

LineRecording NamedFieldsReader::finish() {
  count_from_first(recording_);
  left_out_.tell(recording_);
  if (without_time_ > 0)
    recording_.notes.push_back(first_without_time_ +
                               (without_time_ == 1 ? "" : fmt::format(", and {} more like it", without_time_ - 1)));
  if (in_base64_) recording_.notes.emplace_back("its bytes are read as base64: they are not hex");
  return std::move(recording_);
}

}  // namespace s7200::tools

#include "tools/recordings/named_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"

namespace s7200::tools {
namespace {

enum class Means : std::uint8_t { Nothing, Time, Direction, Data };

struct Name {
  std::string_view word;
  Means means;
};
constexpr std::array kNames{
    Name{"time", Means::Time},
    Name{"timestamp", Means::Time},
    Name{"ts", Means::Time},
    Name{"t", Means::Time},
    Name{"at", Means::Time},
    Name{"datetime", Means::Time},
    Name{"date", Means::Time},
    Name{"@timestamp", Means::Time},
    Name{"direction", Means::Direction},
    Name{"dir", Means::Direction},
    Name{"type", Means::Direction},
    Name{"event", Means::Direction},
    Name{"op", Means::Direction},
    Name{"kind", Means::Direction},
    Name{"msg", Means::Direction},
    Name{"message", Means::Direction},
    Name{"topic", Means::Direction},
    Name{"data", Means::Data},
    Name{"payload", Means::Data},
    Name{"bytes", Means::Data},
    Name{"hex", Means::Data},
    Name{"raw", Means::Data},
    Name{"frame", Means::Data},
    Name{"buffer", Means::Data},
    Name{"packet", Means::Data},
    Name{"pdu", Means::Data},
    Name{"adu", Means::Data},
};

/// `SerialReceived` and `tx_data` in words: `serial received`, `tx data`.
std::string words_of_name(std::string_view name) {
  std::string words;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool begins = i > 0 && stl::is_upper(name[i]) && stl::is_lower(name[i - 1]);
    if (begins) words += ' ';
    words += name[i] == '_' || name[i] == '-' || name[i] == '.' ? ' ' : name[i];
  }
  return stl::lower_case(words);
}

/// By the last word that is known: `uart data` is data.
Means meaning_of(std::string_view name) {
  Means means = Means::Nothing;
  for (const std::string& word : stl::split_words(words_of_name(name))) {
    const auto known = std::ranges::find(kNames, word, &Name::word);
    if (known != kNames.end()) means = known->means;
  }
  return means;
}

/// What the name alone says: `rx`, `SerialSend`.
Direction direction_of_name(std::string_view name) { return direction_of(words_of_name(name)); }

/// `01:03:00`, `01.03.00`
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

std::optional<Bytes> bytes_of(const NamedField& field) {
  if (field.bytes) return field.bytes;
  const auto bytes = bytes_of_text(field.value);
  return bytes ? bytes : bytes_with_signs_between(field.value);
}

/// `data`, and `tx` where that is no count: `tx=8`.
bool holds_frame(const NamedField& field) {
  const Means means = meaning_of(field.name);
  if (means == Means::Data) return bytes_of(field).has_value();
  return means == Means::Nothing && direction_of_name(field.name) != Direction::Unknown && bytes_of(field).has_value();
}

bool should_hold_frame(const NamedField& field) { return meaning_of(field.name) == Means::Data && !field.value.empty(); }

/// A time of day with or without a date, or seconds since 1970; milliseconds and finer units by their size.
std::optional<LeadingTime> time_of(std::string_view text) {
  if (const auto time = leading_time(text)) return time;
  auto since_1970 = parse_decimal<std::int64_t>(stl::trim(text));
  constexpr std::int64_t kLeast = 100'000'000;  // of seconds: 1973
  if (!since_1970 || *since_1970 < kLeast) return {};
  Time unit = kSecond;
  while (*since_1970 / (kFurthestTime / unit) != 0 && unit > 1) unit /= 1000;
  if (*since_1970 >= kFurthestTime / unit) return {};
  return LeadingTime{.time = *since_1970 * unit};
}

std::optional<LeadingTime> time_in(const NamedFields& fields) {
  for (const NamedField& field : fields)
    if (meaning_of(field.name) == Means::Time)
      if (const auto time = time_of(field.value)) return time;
  return {};
}

Direction direction_in(const NamedFields& fields) {
  for (const NamedField& field : fields)
    if (meaning_of(field.name) == Means::Direction)
      if (const Direction direction = direction_of(words_of_name(field.value)); direction != Direction::Unknown)
        return direction;
  return Direction::Unknown;
}

}  // namespace

bool has_frame(const NamedFields& fields) { return std::ranges::any_of(fields, holds_frame); }

void NamedFieldsReader::take(const NamedFields& fields, std::string_view before, std::size_t number) {
  auto time = time_in(fields);
  if (!time) time = leading_time(before);
  const auto at = time ? std::optional(days_.since_first_midnight(*time)) : std::nullopt;
  const Direction said = direction_in(fields);
  std::size_t frames = 0;
  for (const NamedField& field : fields) {
    if (!holds_frame(field)) {
      if (should_hold_frame(field)) left_out_.not_understood(number, fmt::format("{}: {}", field.name, field.value));
      continue;
    }
    const Direction named = direction_of_name(field.name);
    recording_.frames.push_back({.at = frames++ == 0 ? at : std::nullopt,  // a request with its answer has one time
                                 .direction = named != Direction::Unknown ? named : said,
                                 .bytes = *bytes_of(field),
                                 .place = fmt::format("line {}", number)});
  }
  if (frames == 0 && std::ranges::none_of(fields, should_hold_frame)) left_out_.without_bytes(number);
}

LineRecording NamedFieldsReader::finish() {
  count_from_first(recording_);
  left_out_.tell(recording_);
  return std::move(recording_);
}

}  // namespace s7200::tools

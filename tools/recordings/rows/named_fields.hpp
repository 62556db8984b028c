// Frames in records whose fields have names: an object of JSON, or `key=value` pairs, in each line.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/left_out.hpp"

namespace s7200::tools {

struct NamedField {
  std::string name{};            ///< with the names around it before it: `tx data`
  std::string value{};           ///< as it is written
  std::optional<Bytes> bytes{};  ///< of a list of numbers
  bool quoted = false;           ///< a text, which is not a number of something
};
using NamedFields = std::vector<NamedField>;

/// Whether one of the fields is called as bytes are, `data`, `tx`, `SerialReceived`, and holds some.
bool has_frame(const NamedFields& fields);

/// Whether one of them holds characters of a text, with a line end or another one that cannot be printed.
bool has_characters(const NamedFields& fields);

/// Whether one of them holds bytes in base64, by the sign that fills its end.
bool has_base64(const NamedFields& fields);

/// The meaning of a field's name.
struct FieldMeaning {
  enum class Holds : std::uint8_t { Nothing, Number, Time, Direction, Data } holds = Holds::Nothing;
  Direction direction = Direction::Unknown;  ///< `rx`, `SerialSend`
  std::optional<Time> unit{};                ///< of a time: `time_ms`
  bool base64 = false;                       ///< `payload_base64`
};

/// Turns records into frames.
class NamedFieldsReader {
 public:
  /// Reads the fields' contents in that notation from now on, not as bytes in hex.
  void take_characters() { are_characters_ = true; }
  void take_base64() { in_base64_ = true; }

  /// The record of line `number`; `before`: what stands in the line before it, a time perhaps.
  void take(const NamedFields& fields, std::string_view before, std::size_t number);
  void take_other(std::size_t number) { left_out_.without_bytes(number); }
  void take_unreadable(std::size_t number, std::string why) {
    recording_.frames.push_back(row_not_read(number, std::move(why), {}, Direction::Unknown));
  }

  LineRecording finish();

 private:
  /// Most records have the same names in the same places: what they say is worked out once.
  struct KnownName {
    std::string name{};
    FieldMeaning meaning{};
  };
  const FieldMeaning& meaning_of(std::size_t place, const std::string& name);
  bool take_line_of_log(const NamedFields& fields, std::optional<Time> at, std::size_t number);

  LineRecording recording_;
  LeftOut left_out_;
  DayCounter days_;
  std::vector<KnownName> known_;
  std::string first_without_time_{};
  std::size_t without_time_ = 0;
  bool are_characters_ = false, in_base64_ = false;
};

}  // namespace s7200::tools

// Frames in records whose fields have names: an object of JSON, or `key=value` pairs, in each line.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/recordings/fields.hpp"
#include "tools/recordings/left_out.hpp"

namespace s7200::tools {

struct NamedField {
  std::string name{};            ///< with the names around it before it: `tx data`
  std::string value{};           ///< as it is written
  std::optional<Bytes> bytes{};  ///< of a list of numbers
};
using NamedFields = std::vector<NamedField>;

/// Whether one of the fields is called as bytes are, `data`, `tx`, `SerialReceived`, and holds some.
bool has_frame(const NamedFields& fields);

/// Makes frames of records.
class NamedFieldsReader {
 public:
  /// The record of line `number`; `before`: what stands in the line before it, a time perhaps.
  void take(const NamedFields& fields, std::string_view before, std::size_t number);
  void take_other(std::size_t number) { left_out_.without_bytes(number); }
  void take_unreadable(std::size_t number, std::string_view text) { left_out_.not_understood(number, text); }

  LineRecording finish();

 private:
  LineRecording recording_;
  LeftOut left_out_;
  DayCounter days_;
};

}  // namespace s7200::tools

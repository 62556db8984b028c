// What eModbus logs at its debug level: a line with what, where and how many, and rows of a dump below it.
//
//   [D] 1234| ModbusClientRTU.cpp [ 300] sendRequest: Sent packet: @3FFCED70/8:
//     | 0000: 01 03 00 0A 00 02 E4 09                          |........        |
#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

/// The heading of a dump: `Sent packet: @3FFCED70/8:`
struct Heading {
  std::string_view text{};  ///< what stands before the address
  std::size_t length = 0;   ///< bytes of the rows below it
};
std::optional<Heading> heading_of(std::string_view line) {
  constexpr std::string_view kBeforeAddress = ": @";
  const std::size_t end = line.substr(0, kLongestHead).rfind(kBeforeAddress);
  if (end == std::string_view::npos) return {};
  Scan scan(line.substr(end + kBeforeAddress.size()));
  const bool has_address = !scan.take_hex(16).empty() && scan.take("/") != '\0';
  const std::string_view length = has_address ? scan.take_digits(6) : "";
  const bool ends = scan.take(":") != '\0' && stl::trim(line.substr(end + kBeforeAddress.size() + scan.at())).empty();
  if (length.empty() || !ends) return {};
  return Heading{.text = line.substr(0, end), .length = static_cast<std::size_t>(decimal_number(length))};
}

struct EmodbusRow {
  std::size_t offset = 0;
  Bytes bytes{};
};
std::optional<EmodbusRow> emodbus_row(std::string_view line) {
  constexpr std::size_t kFullRow = 16;
  Scan scan(line);
  scan.skip(kAllBlanks);
  if (scan.take("|") == '\0' || scan.skip(kAllBlanks, 1) == 0) return {};
  const std::string_view offset = scan.take_hex(4);
  if (offset.size() != 4 || scan.take(":") == '\0') return {};
  EmodbusRow row{.offset = hex_number(offset)};
  while (row.bytes.size() < kFullRow) {
    const std::size_t before = scan.at(), blanks = scan.skip(kAllBlanks);
    const std::string_view digits = blanks == 1 || blanks == 2 ? scan.take_hex(2) : "";
    if (digits.size() != 2) {
      scan.go_back_to(before);
      break;
    }
    row.bytes.push_back(static_cast<std::uint8_t>(hex_number(digits)));
  }
  return row.bytes.empty() || scan.skip(kAllBlanks, 1) == 0 ? std::nullopt : std::optional(std::move(row));
}

/// The time of a line in milliseconds since the start: `[D] 1234|`
std::optional<LeadingTime> time_of_heading(std::string_view line) {
  Scan scan(line);
  const bool has_level = scan.take("[") != '\0' && scan.take_while(is_word_sign, 1).size() == 1 && scan.take("]") != '\0';
  const std::string_view milliseconds = has_level && scan.skip(kAllBlanks) > 0 ? scan.take_digits(10) : "";
  if (!milliseconds.empty() && scan.take("|") != '\0')
    return LeadingTime{.time = decimal_number(milliseconds) * kMillisecond};
  return leading_time(line);
}

/// The direction in a heading, by its last words, which stand next to the dump: `Received request, Sent packet`.
Direction direction_after_name(std::string_view text) {
  const std::size_t last = text.find_last_of(":,");
  return direction_of(last == std::string_view::npos ? text : text.substr(last + 1));
}

class EmodbusReader {
 public:
  void take(std::string_view line) {
    ++number_;
    if (const auto row = emodbus_row(line)) return take(*row, line);
    close();
    if (const auto heading = heading_of(line)) {
      open_ = {.direction = direction_after_name(heading->text), .place = fmt::format("line {}", number_)};
      if (const auto time = time_of_heading(line)) open_.at = days_.since_first_midnight(*time);
      length_ = heading->length;
      heading_ = number_;
    } else if (!stl::trim(line).empty()) {
      left_out_.without_bytes(number_);
    }
  }

  LineRecording finish() {
    close();
    count_from_first(recording_);
    left_out_.tell(recording_);
    return std::move(recording_);
  }

 private:
  void take(const EmodbusRow& row, std::string_view line) {
    if (heading_ == 0 || row.offset != open_.bytes.size())
      recording_.frames.push_back(row_not_read(number_, not_understood(stl::trim(line)), open_.at, open_.direction));
    else
      open_.bytes.insert(open_.bytes.end(), row.bytes.begin(), row.bytes.end());
  }

  void close() {
    if (heading_ != 0 && open_.bytes.size() == length_ && length_ != 0)
      recording_.frames.push_back(std::move(open_));
    else if (heading_ != 0)
      recording_.frames.push_back(
          row_not_read(heading_, fmt::format("it says {} bytes, and {} are below it", length_, open_.bytes.size()), open_.at,
                       open_.direction));
    heading_ = 0;
    open_ = {};
  }

  LineRecording recording_;
  LeftOut left_out_;
  DayCounter days_;
  RecordedFrame open_;
  std::size_t number_ = 0, heading_ = 0, length_ = 0;  // lines from 1; no heading: 0
};

}  // namespace

bool looks_like_emodbus(std::string_view bytes) {
  return is_text(bytes) &&
         std::ranges::any_of(Lines(beginning_of(bytes)), [](std::string_view line) { return heading_of(line).has_value(); });
}

Result<LineRecording> read_emodbus(std::string_view bytes, const ReadingChoices& choices) {
  EmodbusReader reader;
  for (const std::string_view line : Lines(bytes, choices.stop)) reader.take(line);
  return reader.finish();
}

}  // namespace s7200::tools

// What eModbus logs at its debug level: a line with what, where and how many, and rows of a dump below it.
//
//   [D] 1234| ModbusClientRTU.cpp [ 300] sendRequest: Sent packet: @3FFCED70/8:
//     | 0000: 01 03 00 0A 00 02 E4 09                          |........        |
#include <fmt/format.h>

#include <algorithm>
#include <regex>

#include "interpreter/base/text.hpp"
#include "tools/recordings/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/lines.hpp"

namespace s7200::tools {
namespace {

/// `Sent packet: @3FFCED70/8:`
struct Heading {
  std::string_view text{};  ///< what stands before the address
  std::size_t length = 0;   ///< bytes of the rows below it
};
std::optional<Heading> heading_of(std::string_view line) {
  static const std::regex kHeading(R"((.*): @[0-9A-Fa-f]{1,16}/(\d{1,6}):\s*)");
  TextMatch match;
  if (line.size() > kLongestHead || !std::regex_match(line.begin(), line.end(), match, kHeading)) return {};
  return Heading{.text = line.substr(0, static_cast<std::size_t>(match.length(1))), .length = std::stoul(match.str(2))};
}

struct DumpRow {
  std::size_t offset = 0;
  Bytes bytes{};
};
std::optional<DumpRow> row_of(std::string_view line) {
  static const std::regex kRow(R"(\s*\|\s([0-9A-Fa-f]{4}):((?:\s{1,2}[0-9A-Fa-f]{2}){1,16})\s.*)");
  TextMatch match;
  if (line.size() > kLongestHead || !std::regex_match(line.begin(), line.end(), match, kRow)) return {};
  return DumpRow{.offset = std::stoul(match.str(1), nullptr, 16), .bytes = *bytes_of_text(match.str(2))};
}

/// `[D] 1234|`: milliseconds since the start.
std::optional<LeadingTime> time_of(std::string_view line) {
  static const std::regex kMilliseconds(R"(\[\w\]\s+(\d{1,10})\|)");
  TextMatch match;
  if (begins_with(line, match, kMilliseconds)) return LeadingTime{.time = std::stoll(match.str(1)) * kMillisecond};
  return leading_time(line);
}

/// Nearest to the dump stands what it is: `Received request, Sent packet`.
Direction direction_of_heading(std::string_view text) {
  const std::size_t last = text.find_last_of(":,");
  return direction_of(last == std::string_view::npos ? text : text.substr(last + 1));
}

class Reader {
 public:
  void take(std::string_view line) {
    ++number_;
    if (const auto row = row_of(line)) return take(*row, line);
    close();
    if (const auto heading = heading_of(line)) {
      open_ = {.direction = direction_of_heading(heading->text), .place = fmt::format("line {}", number_)};
      if (const auto time = time_of(line)) open_.at = days_.since_first_midnight(*time);
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
  void take(const DumpRow& row, std::string_view line) {
    if (heading_ == 0 || row.offset != open_.bytes.size())
      left_out_.not_understood(number_, stl::trim(line));
    else
      open_.bytes.insert(open_.bytes.end(), row.bytes.begin(), row.bytes.end());
  }

  void close() {
    if (heading_ != 0 && open_.bytes.size() == length_ && length_ != 0)
      recording_.frames.push_back(std::move(open_));
    else if (heading_ != 0)
      left_out_.add(heading_, fmt::format("it says {} bytes, and {} are below it", length_, open_.bytes.size()));
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

std::optional<LineRecording> read_emodbus(std::string_view bytes, const ReadingChoices&, std::string&) {
  Reader reader;
  for (const std::string_view line : Lines(bytes)) reader.take(line);
  return reader.finish();
}

}  // namespace s7200::tools

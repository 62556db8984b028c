// What pyserial prints of a port whose address begins with spy://: rows of 16 bytes with their offset, and remarks.
//
//   000000.000 TX   0000  02 03 00 63 00 02 34 26                           ...c..4&
//   000000.045 Q-RX in_waiting: 9
//   000000.045 RX   0000  02 03 04 12 34 FF FE 4D F5                        ....4..M.
#include <fmt/format.h>

#include <algorithm>

#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/left_out.hpp"
#include "tools/recordings/rows/lines.hpp"
#include "tools/recordings/scan.hpp"

namespace s7200::tools {
namespace {

struct SpiedRow {
  Time at = 0;
  Direction direction = Direction::Unknown;
  std::size_t offset = 0;
  Bytes bytes{};
};

std::optional<SpiedRow> spied_row(std::string_view line) {
  constexpr std::size_t kFewestDigits = 6;
  Scan scan(line);
  const auto time = leading_time(line);
  if (!time || time->of_day || scan.take_digits(kLongestHead).size() < kFewestDigits) return {};
  scan.go_back_to(time->length);
  scan.skip(" ");
  const std::string_view word = scan.take_while(stl::is_upper);
  if ((word != "TX" && word != "RX") || scan.skip(" ") == 0) return {};
  SpiedRow row{.at = time->time, .direction = word == "TX" ? Direction::Request : Direction::Answer};
  const std::string_view offset = scan.take_hex(8);
  if (offset.size() < 4 || scan.skip(" ") != 2) return {};
  row.offset = hex_number(offset);
  row.bytes = take_row(scan);
  return row.bytes.empty() ? std::nullopt : std::optional(std::move(row));
}

bool goes_on(const LineRecording& recording, const SpiedRow& row) {
  return row.offset > 0 && !recording.frames.empty() && recording.frames.back().direction == row.direction &&
         recording.frames.back().bytes.size() == row.offset;
}

}  // namespace

bool looks_like_pyserial(std::string_view bytes) {
  return is_text(bytes) &&
         std::ranges::any_of(Lines(beginning_of(bytes)), [](std::string_view line) { return spied_row(line).has_value(); });
}

Result<LineRecording> read_pyserial(std::string_view bytes, const ReadingChoices& choices) {
  LineRecording recording;
  LeftOut left_out;
  std::size_t number = 0;
  for (const std::string_view line : Lines(bytes, choices.stop)) {
    ++number;
    auto row = spied_row(line);
    if (!row) {
      if (!line.empty()) left_out.without_bytes(number);
    } else if (goes_on(recording, *row)) {
      Bytes& frame = recording.frames.back().bytes;
      frame.insert(frame.end(), row->bytes.begin(), row->bytes.end());
    } else if (row->offset > 0) {
      recording.frames.push_back(row_not_read(number, "rows before it are missing", row->at, row->direction));
    } else {
      recording.frames.push_back({.at = row->at,
                                  .direction = row->direction,
                                  .bytes = std::move(row->bytes),
                                  .place = fmt::format("line {}", number)});
    }
  }
  count_from_first(recording);
  left_out.tell(recording);
  return recording;
}

}  // namespace s7200::tools

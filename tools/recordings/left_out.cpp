#include "tools/recordings/left_out.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {

RecordedFrame row_not_read(std::size_t number, std::string why, std::optional<Time> at, Direction direction, bool is_text) {
  return {.at = at,
          .direction = direction,
          .place = fmt::format("line {}", number),
          .line = number,
          .doubt = std::make_shared<Doubt>(Doubt{.why = std::move(why), .is_text = is_text})};
}

std::string not_understood(std::string_view what) {
  return fmt::format("'{}' is not understood", stl::printable(stl::shortened(what)));
}

void name_rows_not_read(LineRecording& recording) {
  NamedRows rows;
  for (const RecordedFrame& frame : recording.frames)
    if (frame.doubt && frame.doubt->readings.empty()) rows.add(frame);
  const auto notes = rows.notes();
  recording.notes.insert(recording.notes.begin(), notes.begin(), notes.end());
}

void LeftOut::without_bytes(std::size_t number) {
  if (without_bytes_++ == 0) first_without_bytes_ = number;
}

void LeftOut::tell(LineRecording& recording) const {
  if (without_bytes_ == 0) return;
  const std::string more = without_bytes_ == 1 ? "" : fmt::format(", and {} more", without_bytes_ - 1);
  recording.notes.push_back(fmt::format("line {}: left out{}: no bytes in it", first_without_bytes_, more));
}

void NamedRows::add(const RecordedFrame& row) {
  if (++count_ <= kMostNamed) named_.push_back(fmt::format("{}: left out: {}", row.place, row.doubt->why));
}

std::vector<std::string> NamedRows::notes() const {
  std::vector<std::string> notes = named_;
  if (count_ > kMostNamed)
    notes.push_back(fmt::format("{} more lines were left out for such a reason", count_ - kMostNamed));
  return notes;
}

}  // namespace s7200::tools

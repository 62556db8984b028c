// Lines of a recording that became no frame, and what is said of them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// A row whose bytes are not known, in its place among the frames: a request before it may have got it for an answer.
/// `why`: `it says 9 bytes, and 3 are below it`. `is_text`: no frame at all, but words.
RecordedFrame row_not_read(std::size_t number, std::string why, std::optional<Time> at, Direction direction,
                           bool is_text = false);

/// The reason for an unreadable text: `'0x1 0x' is not understood`
std::string not_understood(std::string_view what);

/// The notes name the rows that are not read, the first ten of them, before all else. Not those of which a reading may be
/// right: ConversationNotes names them if none is.
void name_rows_not_read(LineRecording& recording);

/// Lines that have nothing to do with frames.
class LeftOut {
 public:
  void without_bytes(std::size_t number);

  /// Adds the note after the notes of `recording`.
  void tell(LineRecording& recording) const;

 private:
  std::size_t first_without_bytes_ = 0, without_bytes_ = 0;
};

/// The first ten notes of a kind; the others are counted.
class NamedRows {
 public:
  void add(const RecordedFrame& row);
  std::vector<std::string> notes() const;

 private:
  static constexpr std::size_t kMostNamed = 10;

  std::vector<std::string> named_;
  std::size_t count_ = 0;
};

}  // namespace s7200::tools

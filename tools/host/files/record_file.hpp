// Files that record a run: a trace, the outputs, a capture.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>

#include "interpreter/base/result.hpp"
#include "tools/host/files/written_files.hpp"

namespace s7200::tools {

/// `560 KB`, `1.3 GB`: 1000 bytes are 1 KB.
std::string size_text(double bytes);

/// Reads `500MB`, `1.5 GB`, or `none` for no limit. Nothing if it is no such size.
std::optional<std::uint64_t> parse_size(std::string_view text);

/// How far a record has grown.
struct RecordSize {
  std::string path;
  std::uint64_t bytes = 0, limit = 0;
  bool full = false;  ///< it has reached its limit and takes nothing more
};

/// claim(), open(), the first line, put(), the rest of the record, close(). The rule for all files is in written_files.hpp.
class RecordFile {
 public:
  RecordFile();
  ~RecordFile();

  /// Trouble if `option` cannot write there; - is standard output, if
  /// `files` has one. The others say likewise what failed.
  Result<> claim(WrittenFiles& files, std::string_view option, const std::string& path, FileKind kind);

  /// Opens the file. Trouble if it fails, with nothing to say if it was interrupted. Waits until a pipe has a reader.
  Result<std::ostream&> open();

  /// Puts the file in its place: its first line has been written.
  Result<> put();

  /// Writes what is recorded so far, for whoever follows the file. What cannot be written close() tells.
  void flush();

  /// Nothing for a pipe, a device or standard output, and for what is not open.
  std::optional<RecordSize> size() const;

  /// Closes the file. Trouble if not everything could be written, because it has reached its limit too.
  Result<> close();

 private:
  class Buffer;
  Result<> check(int error) const;

  Destination destination_;
  std::ostream* standard_output_ = nullptr;  ///< not null: that is where it goes
  NewFile file_;
  std::uint64_t limit_ = kRecordLimit;
  std::unique_ptr<Buffer> buffer_;  ///< null: standard output, or nothing is open
  std::unique_ptr<std::ostream> stream_;
};

}  // namespace s7200::tools

// Files that record a run: a trace, the outputs, a capture.
#pragma once

#include <memory>
#include <ostream>
#include <string>
#include <string_view>

#include "tools/host/written_files.hpp"

namespace s7200::tools {

/// claim(), open(), the first line, put(), the rest of the record, close(). The rule for all files is in written_files.hpp.
class RecordFile {
 public:
  RecordFile();
  ~RecordFile();

  /// False after a message when `option` cannot write there; - is standard output.
  bool claim(WrittenFiles& files, std::string_view option, const std::string& path, FileKind kind);

  /// Null after a message. A pipe is waited for until somebody reads from it.
  std::ostream* open();

  /// Puts the file in its place: its first line has been written. False after a message.
  bool put();

  /// False after a message when not everything could be written.
  bool close();

 private:
  class Buffer;
  bool check(int error) const;

  Destination destination_;
  NewFile file_;
  std::unique_ptr<Buffer> buffer_;  ///< null: standard output, or nothing is open
  std::unique_ptr<std::ostream> stream_;
};

}  // namespace s7200::tools

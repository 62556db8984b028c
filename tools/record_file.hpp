// Files that record a run: a trace, the outputs. They are only ever written over an earlier record of the same kind.
#pragma once

#include <fstream>
#include <iosfwd>
#include <string>
#include <string_view>

namespace s7200::tools {

/// Whether what exists under `path` is an earlier record, which starts with `beginning`, or an empty file. A terminal or a
/// pipe loses nothing; reading from it would wait. What cannot be read is somebody's.
bool may_be_overwritten(const std::string& path, std::string_view beginning);

class RecordFile {
 public:
  /// Opens `path`; - is standard output. Nothing after a message: a file that exists and does not start with `beginning` is
  /// left alone, unless it is empty. `kind` says what is expected: "trace".
  std::ostream* open(const std::string& path, std::string_view beginning, std::string_view kind);

  /// False after a message when not everything could be written.
  bool close();

 private:
  std::string path_;
  std::ofstream file_;
};

}  // namespace s7200::tools

// The libraries open no files. Whoever calls them passes a source that reads a file by its name: the host's files, or those
// that were dropped on a page.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/result.hpp"

namespace s7200 {

/// Reads files by their names.
class FileSource {
 public:
  virtual ~FileSource() = default;

  /// The bytes of a file. Trouble if it cannot be read.
  virtual Result<std::string> read(const std::string& path) const = 0;

  /// Whether there is a file of this name, be it that it cannot be read.
  virtual bool exists(const std::string& path) const;

  /// A text in UTF-8, without the byte order mark that some editors put before it; UTF-16 with its mark is converted.
  /// Trouble like read().
  Result<std::string> read_text(const std::string& path) const;
};

/// Whether a path means standard input: "-" and its names in Linux. What comes through a pipe can be read only once.
bool is_standard_input(std::string_view path);

}  // namespace s7200

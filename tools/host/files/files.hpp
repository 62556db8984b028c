// The files that a user names. How files are written is in written_files.hpp.
#pragma once

#include <optional>
#include <string>

#include "interpreter/base/file_source.hpp"
#include "interpreter/base/result.hpp"

namespace s7200::tools {

/// The bytes of a file, or of a pipe up to its end. Trouble if it cannot be read, is larger than 64
/// MB or is a device: naming a serial port instead of a program fails at once.
Result<std::string> read_file(const std::string& path);

/// A text as FileSource::read_text() has it. Trouble as read_file().
Result<std::string> read_text(const std::string& path);

/// The bytes of standard input up to its end. Trouble if they are more than 64 MB or cannot be read.
Result<std::string> read_standard_input();

/// The files of this computer, as read_file() reads them, for libraries that take a source.
const FileSource& host_files();

}  // namespace s7200::tools

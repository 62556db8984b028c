// The files that a user names. How files are written is in written_files.hpp.
#pragma once

#include <optional>
#include <string>

#include "interpreter/base/file_source.hpp"

namespace s7200::tools {

/// The bytes of a file, or of a pipe up to its end. Returns nothing and sets `why` if it cannot be read, is larger than 64
/// MB or is a device: naming a serial port instead of a program fails at once.
std::optional<std::string> read_file(const std::string& path, std::string& why);

/// A text as FileSource::read_text() has it. Returns nothing and sets `why` as read_file().
std::optional<std::string> read_text(const std::string& path, std::string& why);

/// The bytes of standard input up to its end. Returns nothing and sets `why` if they are more than 64 MB or cannot be read.
std::optional<std::string> read_standard_input(std::string& why);

/// The files of this computer, as read_file() reads them, for libraries that take a source.
const FileSource& host_files();

}  // namespace s7200::tools

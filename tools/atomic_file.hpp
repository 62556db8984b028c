// Replacing a file as a whole.
#pragma once

#include <string>
#include <string_view>

namespace s7200::tools {

/// Writes `text` beside `path`, has it on the disk, and gives it the name: whoever looks finds the old file or the new one,
/// never half of one. The target of a symbolic link is replaced, not the link. False, and `why`, when it cannot be done; the
/// old file is then as it was. What is no file, such as a pipe, is not replaced.
bool write_atomically(const std::string& path, std::string_view text, std::string& why);

/// Whether write_atomically can be expected to succeed; `why` if not.
bool can_be_written(const std::string& path, std::string& why);

}  // namespace s7200::tools

// A file in which two programs on the same line have logged: each frame is in it twice, under two names.
#pragma once

#include <string_view>

#include "tools/recordings/recording.hpp"

namespace s7200::tools {

/// Keeps the frames of the program that logged first, with a note, if the rows of `text` are those of two programs.
void keep_one_logger(LineRecording& recording, std::string_view text);

}  // namespace s7200::tools

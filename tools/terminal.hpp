// What goes to the person: messages on stderr, colour only where it is wanted.
#pragma once

#include <cstdio>
#include <string_view>

namespace s7200::tools {

/// Colour on a terminal, unless NO_COLOR is set to anything but nothing.
bool colour_wanted(std::FILE* stream);

/// Whether what is on the screen can be written over: a terminal that knows control sequences.
bool can_redraw(std::FILE* stream);

/// `s7200: error: …` on stderr.
void print_error(std::string_view message);

}  // namespace s7200::tools

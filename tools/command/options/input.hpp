// The bytes of a file that a verb reads, or of standard input.
#pragma once

#include <optional>
#include <string>

#include "interpreter/program/load.hpp"

namespace s7200::tools {

/// Standard input can be read only once. Nothing after a message. `name`: what messages call it.
std::optional<std::string> read_input(const std::string& path, std::string& name);

/// The ladder drawings of a document, as STL; nothing after a message.
std::optional<SourceText> read_drawings(const std::string& path);

}  // namespace s7200::tools

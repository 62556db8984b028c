// A file of results that an option asks for, and that is written whole at the end.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tools/host/files/written_files.hpp"

namespace s7200::tools {

/// The place for it; nothing if `path` is empty. Throws std::invalid_argument if `option` cannot write there.
std::optional<Destination> claim_wanted(WrittenFiles& files, std::string_view option, const std::string& path,
                                        FileKind kind);

/// False after a message. Writes nothing where nothing was asked for.
bool write_wanted(const std::optional<Destination>& to, const std::string& text);

}  // namespace s7200::tools

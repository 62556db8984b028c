// Logs whose rows are rewritten as time, direction and hex before any form is looked for: dumps in frames of Netty, slsnif,
// caret notation as of cat -v, SQL, and MinimalModbus.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace s7200::tools {

/// The text with such rows in hex; nothing if it has none. Lines keep their numbers, but for several rows of SQL in a line.
std::optional<std::string> in_plain_rows(std::string_view text);

}  // namespace s7200::tools

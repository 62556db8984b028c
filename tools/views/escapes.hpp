// Names in files that other programs read: no character of them is a command to a terminal that shows the file.
#pragma once

#include <string>
#include <string_view>

namespace s7200::tools {

/// The text with `\u009b` for each character that stl::printable() would replace, those of ASCII apart: what JSON, and YAML
/// in double quotation marks, read as that character again. Bytes that are not UTF-8 stay as they are.
std::string with_escapes(std::string_view text);

/// The text as it stands in HTML and SVG, between tags or in a quoted attribute: never markup.
std::string as_markup(std::string_view text);

}  // namespace s7200::tools

// Code pages of Windows and DOS. The tables come from the build, not from the system, so that a text is read alike
// everywhere.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace s7200::stl {

struct CodePage;  // name, the characters of its bytes and pairs of bytes

/// "Windows-1250" to "-1254", "CP437", "GBK", "Shift-JIS"; null for any other name.
const CodePage* find_code_page(std::string_view name);

/// Converts a text in a code page to UTF-8; bytes that the code page does not have become U+FFFD.
std::string to_utf8(std::string_view bytes, const CodePage& page);

/// The bytes of a character in a code page; empty if the code page does not have it.
std::string from_character(char32_t character, const CodePage& page);

}  // namespace s7200::stl

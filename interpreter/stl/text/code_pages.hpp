// Encodings of texts that are not UTF-8: code pages of Windows and DOS, and UTF-16. The tables come from the build, not from
// the system, so that a text is read alike everywhere.
#pragma once

#include <cstdint>
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

enum class ByteOrder : std::uint8_t { Little, Big };

/// UTF-8 of a text in UTF-16 without its byte order mark; halves of surrogate pairs that stand alone become U+FFFD, as does
/// a byte left over at the end.
std::string utf16_to_utf8(std::string_view bytes, ByteOrder order);

/// A character in UTF-16, its low byte first.
std::string to_utf16(char32_t character);

}  // namespace s7200::stl

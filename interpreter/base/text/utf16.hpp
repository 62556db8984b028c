// UTF-16, as programs of Windows write text: Excel, the Editor, PowerShell where output is directed to a file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace s7200::stl {

enum class ByteOrder : std::uint8_t { Little, Big };

/// UTF-8 of a text in UTF-16 without its byte order mark; halves of surrogate pairs that stand alone become U+FFFD, as does
/// a byte left over at the end.
std::string utf16_to_utf8(std::string_view bytes, ByteOrder order);

/// A character in UTF-16, its low byte first.
std::string to_utf16(char32_t character);

/// UTF-8 of a text that begins with the byte order mark of UTF-16; nothing for any other text.
std::optional<std::string> from_marked_utf16(std::string_view bytes);

}  // namespace s7200::stl

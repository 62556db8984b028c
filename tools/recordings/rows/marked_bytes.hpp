// Bytes in a text log that are not plain hex: `02h 03h`, `$02 $03`, `H'02' H'03'`, `00000010 00000011`, `2 (0x02) 3 (0x03)`, `\x02\x03`,
// and typographic signs between them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace s7200::tools {

/// The text with its bytes in plain hex and plain blanks and dashes. Nothing if it has them already. A notation is taken for
/// one of bytes if some line at the beginning has four such words, one after the other; then it is everywhere.
std::optional<std::string> in_plain_hex(std::string_view text);

/// The byte that a word is in a notation with a mark that nothing else has: `02h`, `$02`, `H'02'`, `16#02`.
std::optional<std::uint8_t> marked_byte(std::string_view word);

}  // namespace s7200::tools

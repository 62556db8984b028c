// Frames of text: for programs whose protocol is made of characters that people can read.
//
// Written, a text is ASCII, with these escapes: \r \n \t, \\ \' \", and \xHH for any byte.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "serial_sim/modbus/request.hpp"

namespace s7200::tools {

/// Reads a frame from a text such as `HELLO\r`: one to 1024 bytes.
serial::ParsedFrame parse_text(std::string_view text);

/// Reads an expected text, in which `\?` is any byte. Trouble if it is not one.
Result<std::vector<std::optional<std::uint8_t>>> parse_text_pattern(std::string_view text);

/// Reads a frame as it is written where hex is the rule: in quotation marks, single or double, it is text.
serial::ParsedFrame parse_hex_or_quoted(std::string_view text);

/// The length of the quotation that begins a text, with both marks. 0 if none begins there, npos if the closing mark is
/// missing.
std::size_t quotation_length(std::string_view text);

/// Whether bytes are shown as text: 20 to 7E, CR, LF, TAB, STX and ETX, and at least one of the first kind.
bool is_text(std::span<const std::uint8_t> bytes);

/// A text in quotes, `'HELLO\r'`, which reads back to the same bytes in a shell, in YAML and in a file of frames; empty for
/// bytes that are not text.
std::string quoted_text(std::span<const std::uint8_t> bytes);
std::string quoted_text(std::span<const std::optional<std::uint8_t>> pattern);

/// The contents of an answer. Only a request with a right CRC makes it Modbus, with or without errors. Any other answer is
/// shown as text; empty if it is not text either.
std::string answer_text(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response);

/// The contents of a request as text; empty if it is Modbus.
std::string request_text(std::span<const std::uint8_t> request);

/// The bytes of an exchange that is not Modbus, as text; nothing if they are not text. `request` is empty for bytes that
/// were not asked for.
std::optional<std::string> plain_text(std::span<const std::uint8_t> request, std::span<const std::uint8_t> bytes);

}  // namespace s7200::tools

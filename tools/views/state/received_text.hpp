// Characters as a station has received them, as text.
#pragma once

#include <fmt/format.h>

#include <span>
#include <string>

#include "interpreter/base/serial_port.hpp"

namespace s7200::tools {

/// A byte with p after it for wrong parity, f for a stop bit at space level: `03`, `03p`, `00pf`.
inline std::string received_text(const ReceivedCharacter& character) {
  return fmt::format("{:02x}{}{}", character.byte, character.parity_error ? "p" : "", character.framing_error ? "f" : "");
}

/// Characters in hex, with their errors: `01 03p 00`
inline std::string received_text(std::span<const ReceivedCharacter> characters) {
  std::string text;
  for (const ReceivedCharacter& one : characters) text += (text.empty() ? "" : " ") + received_text(one);
  return text;
}

}  // namespace s7200::tools

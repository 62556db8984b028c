// The forms of `print`.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "interpreter/model/area.hpp"

namespace s7200::tools {

struct PrintForm {
  char letter;
  std::string_view meaning;
  std::string (*text)(std::uint32_t bits, Width width, bool real);
  bool joins_bytes = false;  ///< bytes are one text
};

std::span<const PrintForm> print_forms();

/// Of `/x`; null if there is none.
const PrintForm* find_print_form(std::string_view word);

/// `/x | /d | …`
std::string print_forms_text(std::string_view separator);

/// `/x hex, /d decimal, …`
std::string print_forms_meanings();

std::string hex_text(std::uint32_t bits, Width width, bool real = false);

/// `A`, or `\x0d`
std::string printable_character(std::uint8_t byte);

}  // namespace s7200::tools

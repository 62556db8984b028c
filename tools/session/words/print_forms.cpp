#include "tools/session/words/print_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "interpreter/base/text/text.hpp"
#include "tools/session/causes/expression.hpp"

namespace s7200::tools {
namespace {

std::string decimal_text(std::uint32_t bits, Width width, bool real) {
  if (real) return number_text(Value{.number = std::bit_cast<float>(bits), .real = true});
  if (width == Width::Word) return fmt::format("{}", static_cast<std::int16_t>(bits));
  if (width == Width::Double) return fmt::format("{}", static_cast<std::int32_t>(bits));
  return fmt::format("{}", bits);
}

std::string binary_text(std::uint32_t bits, Width width, bool /*real*/) {
  std::string text = "2#";
  for (unsigned bit = width == Width::Bit ? 1 : 8 * bytes_of(width); bit-- > 0;)
    text.append(bits >> bit & 1 ? "1" : "0").append(bit % 4 == 0 && bit != 0 ? "_" : "");
  return text;
}

std::string characters_text(std::uint32_t bits, Width width, bool /*real*/) {
  std::string text = "'";
  for (unsigned i = bytes_of(width); i-- > 0;) text += printable_character(static_cast<std::uint8_t>(bits >> 8 * i));
  return text + "'";
}

constexpr PrintForm kForms[] = {{'x', "hex", hex_text},
                                {'d', "decimal", decimal_text},
                                {'b', "binary", binary_text},
                                {'c', "characters", characters_text, true}};

}  // namespace

std::span<const PrintForm> print_forms() { return kForms; }

const PrintForm* find_print_form(std::string_view word) {
  const std::string lower = stl::lower_case(word);
  const auto found =
      std::ranges::find_if(kForms, [&](const PrintForm& form) { return lower == fmt::format("/{}", form.letter); });
  return found == std::end(kForms) ? nullptr : found;
}

std::string print_forms_text(std::string_view separator) {
  std::string text;
  for (const PrintForm& form : kForms) text += fmt::format("{}/{}", text.empty() ? "" : separator, form.letter);
  return text;
}

std::string print_forms_meanings() {
  std::string text;
  for (const PrintForm& form : kForms) text += fmt::format("{}/{} {}", text.empty() ? "" : ", ", form.letter, form.meaning);
  return text;
}

std::string hex_text(std::uint32_t bits, Width width, bool /*real*/) {
  return fmt::format("16#{:0{}X}", bits, width == Width::Bit ? 1 : 2 * bytes_of(width));
}

std::string printable_character(std::uint8_t byte) {
  return byte >= 0x20 && byte < 0x7F ? std::string(1, static_cast<char>(byte)) : fmt::format("\\x{:02x}", byte);
}

}  // namespace s7200::tools

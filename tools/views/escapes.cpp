#include "tools/views/escapes.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {

std::string with_escapes(std::string_view text) {
  constexpr char32_t kLastOfAscii = 0x7E;
  std::string escaped;
  escaped.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const stl::Character c = stl::first_character(text.substr(at));
    const std::string_view bytes = text.substr(at, c.bytes);
    const bool plain =
        c.code <= kLastOfAscii || c.code == stl::kReplacement || c.code > 0xFFFF || stl::printable(bytes) == bytes;
    escaped += plain ? std::string(bytes) : fmt::format("\\u{:04x}", static_cast<std::uint32_t>(c.code));
    at += c.bytes;
  }
  return escaped;
}

std::string as_markup(std::string_view text) {
  std::string all;
  for (const char c : text) {
    if (c == '&')
      all += "&amp;";
    else if (c == '<')
      all += "&lt;";
    else if (c == '>')
      all += "&gt;";
    else if (c == '"')
      all += "&quot;";
    else
      all += c;
  }
  return all;
}

}  // namespace s7200::tools

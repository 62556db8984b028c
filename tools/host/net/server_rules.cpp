#include "tools/host/net/server_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/host/random_bytes.hpp"

namespace s7200::tools {

bool is_web_request(std::string_view first_bytes) {
  constexpr std::string_view kMethods[] = {"GET",   "POST",    "HEAD",  "PUT",     "DELETE",
                                           "PATCH", "OPTIONS", "TRACE", "CONNECT", "PRI"};  // RFC 9110 9, RFC 9113 3.4
  const std::size_t blank = first_bytes.find(' ');
  if (blank == std::string_view::npos || blank + 1 == first_bytes.size()) return false;
  const char target = first_bytes[blank + 1];
  return std::ranges::find(kMethods, first_bytes.substr(0, blank)) != std::end(kMethods) &&
         (target == '/' || target == '*' || first_bytes.substr(blank + 1).starts_with("http"));
}

std::string new_token() {
  std::array<unsigned char, 16> bytes{};
  fill_with_random_bytes(bytes);
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool is_same_token(std::string_view given, std::string_view token) {
  std::size_t differences = given.size() ^ token.size();
  for (std::size_t i = 0; i < token.size(); ++i) {
    const char other = given.empty() ? '\0' : given[i % given.size()];
    differences |= static_cast<unsigned char>(token[i] ^ other);
  }
  return differences == 0;
}

}  // namespace s7200::tools

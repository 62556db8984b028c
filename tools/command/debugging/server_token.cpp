#include "tools/command/debugging/server_token.hpp"

#include <fmt/format.h>

#include <string_view>

#include "interpreter/base/text/text.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/files.hpp"
#include "tools/host/net/server_rules.hpp"

namespace s7200::tools {

std::string server_token(const std::string& token_file) {
  constexpr std::size_t kShortest = 16;
  if (token_file.empty()) return new_token();
  const auto text = read_text(token_file);
  const std::string token(stl::trim(std::string_view(text.value_or("")).substr(0, text.value_or("").find('\n'))));
  if (token.size() >= kShortest) return token;
  print_error(
      fmt::format("--token-file {}: {}", token_file,
                  text ? fmt::format("its first line is not a token of {} characters or more", kShortest) : text.why()));
  return {};
}

}  // namespace s7200::tools

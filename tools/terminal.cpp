#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace s7200::tools {

bool colour_wanted(std::FILE* stream) {
  const char* no_color = std::getenv("NO_COLOR");
  return isatty(fileno(stream)) && !(no_color && *no_color);
}

void print_error(std::string_view message) {
  std::fflush(stdout);
  fmt::print(stderr, "s7200: error: {}\n", message);
}

}  // namespace s7200::tools

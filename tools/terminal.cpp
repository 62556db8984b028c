#include "tools/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

namespace s7200::tools {

bool colour_wanted(std::FILE* stream) {
  const char* no_color = std::getenv("NO_COLOR");
  return isatty(fileno(stream)) && !(no_color && *no_color);
}

bool can_redraw(std::FILE* stream) {
  const char* type = std::getenv("TERM");
  return isatty(fileno(stream)) && type && *type && std::string_view(type) != "dumb";
}

void print_error(std::string_view message) {
  std::fflush(stdout);
  fmt::print(stderr, "s7200: error: {}\n", message);
}

}  // namespace s7200::tools

#include "tools/host/console.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace s7200::tools {
namespace {

/// By number: what stands in stdout and stderr may have no descriptor of its own.
int descriptor_of(Standard stream) {
  return stream == Standard::Input ? STDIN_FILENO : stream == Standard::Output ? STDOUT_FILENO : STDERR_FILENO;
}

}  // namespace

bool is_terminal(Standard stream) { return isatty(descriptor_of(stream)) != 0; }

bool knows_control_sequences(Standard stream) {
  const char* const type = std::getenv("TERM");
  return is_terminal(stream) && type && *type && std::string_view(type) != "dumb";
}

TerminalSize terminal_size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return {};
  return {size.ws_col, size.ws_row};
}

}  // namespace s7200::tools

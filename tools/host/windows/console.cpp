#include "tools/host/console.hpp"

#include "tools/host/windows/native_text.hpp"

namespace s7200::tools {
namespace {

HANDLE handle_of(Standard stream) {
  return GetStdHandle(stream == Standard::Input    ? STD_INPUT_HANDLE
                      : stream == Standard::Output ? STD_OUTPUT_HANDLE
                                                   : STD_ERROR_HANDLE);
}

}  // namespace

bool is_terminal(Standard stream) {
  DWORD mode = 0;
  return GetConsoleMode(handle_of(stream), &mode) != 0;
}

/// A console takes them once it is told so, since Windows 10.
bool knows_control_sequences(Standard stream) {
  DWORD mode = 0;
  HANDLE const console = handle_of(stream);
  return GetConsoleMode(console, &mode) != 0 &&
         SetConsoleMode(console, mode | ENABLE_PROCESSED_OUTPUT | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

TerminalSize terminal_size() {
  CONSOLE_SCREEN_BUFFER_INFO info{};
  if (GetConsoleScreenBufferInfo(handle_of(Standard::Output), &info) == 0) return {};
  return {static_cast<std::size_t>(info.srWindow.Right - info.srWindow.Left + 1),
          static_cast<std::size_t>(info.srWindow.Bottom - info.srWindow.Top + 1)};
}

}  // namespace s7200::tools

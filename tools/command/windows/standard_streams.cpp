#include "tools/command/terminal/standard_streams.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <io.h>

#include <array>
#include <cstdio>
#include <iostream>
#include <streambuf>
#include <string>

#include "tools/command/exit_code.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/console.hpp"
#include "tools/host/files/file_system.hpp"
#include "tools/host/windows/native_text.hpp"

namespace s7200::tools {
namespace {

/// What std::cout has for a console: fmt::print writes UTF-8 there as it is to be seen, and the runtime does not.
class ConsoleBuffer final : public std::streambuf {
 public:
  explicit ConsoleBuffer(std::FILE* file) : file_(file) {}

 protected:
  int_type overflow(int_type c) override {
    if (traits_type::eq_int_type(c, traits_type::eof())) return sync() == 0 ? traits_type::not_eof(c) : c;
    text_ += traits_type::to_char_type(c);
    return c == '\n' && sync() != 0 ? traits_type::eof() : c;
  }

  int sync() override {
    if (!text_.empty()) fmt::print(file_, "{}", text_);
    text_.clear();
    return 0;
  }

 private:
  std::FILE* file_;
  std::string text_;
};

/// Whether Windows has opened a console for this command alone, which it closes behind it: a double click, or files dropped
/// on the program.
bool has_console_of_its_own() {
  std::array<DWORD, 2> processes{};
  return GetConsoleProcessList(processes.data(), static_cast<DWORD>(processes.size())) == 1 &&
         is_terminal(Standard::Input) && is_terminal(Standard::Error);
}

}  // namespace

/// Lines end as they do elsewhere, also in files that output is directed to: programs of Windows read both.
void open_standard_streams() {
  _setmode(0, _O_BINARY);
  _setmode(1, _O_BINARY);
  _setmode(2, _O_BINARY);
  std::setvbuf(stderr, nullptr, _IONBF, 0);
  if (!is_terminal(Standard::Output)) std::setvbuf(stdout, nullptr, _IOFBF, 1 << 16);
  if (knows_control_sequences(Standard::Output) || is_terminal(Standard::Output)) std::cout.rdbuf(new ConsoleBuffer(stdout));
  if (knows_control_sequences(Standard::Error) || is_terminal(Standard::Error)) std::cerr.rdbuf(new ConsoleBuffer(stderr));
}

int close_standard_streams(int exit_code) {
  if (has_console_of_its_own()) {
    fmt::print(
        stderr,
        "\nThe Enter key closes this window. s7200 is a command: open a terminal in its folder and type s7200 --help\n");
    std::fflush(stdout);
    std::getchar();
  }
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  print_error(fmt::format("cannot write to standard output: {}", error_text(errno)));
  return kUnusable;
}

}  // namespace s7200::tools

#include "tools/command/terminal/screen.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string_view>

#include "interpreter/base/result.hpp"
#include "tools/host/interruption.hpp"

// Last: they define many short names as macros.
#include <curses.h>
#include <term.h>

namespace s7200::tools {
namespace {

/// How the terminal is as it was, for signal handlers too.
char restoring[256];
std::atomic<int> restoring_length = 0;

constexpr int kKilling[] = {SIGQUIT, SIGABRT, SIGSEGV, SIGTSTP};

void restore_at_once() {
  if (const int length = restoring_length; length > 0) {
    [[maybe_unused]] const ssize_t written = write(STDOUT_FILENO, restoring, static_cast<std::size_t>(length));
  }
}

void set_handler(int number, void (*handler)(int), int flags = 0) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigaction(number, &action, nullptr);
}

void restore_and_go(int number) {
  restore_at_once();
  set_handler(number, SIG_DFL);
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, number);
  raise(number);
  sigprocmask(SIG_UNBLOCK, &only, nullptr);  // it stops or ends here
  set_handler(number, restore_and_go);
}

/// A string of terminfo; nullptr if the terminal does not have it.
const char* capability(const char* name) {
  const char* text = tigetstr(name);
  return text && text != reinterpret_cast<const char*>(-1) ? text : nullptr;
}

std::string with(const char* name, long first, long second = 0) {
  const char* text = capability(name);
  const char* filled = text ? tiparm(text, static_cast<int>(first), static_cast<int>(second)) : nullptr;
  return filled ? filled : "";
}

std::string plain(const char* name) {
  const char* text = capability(name);
  return text ? text : "";
}

bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }

/// As much as fits; colours take no room.
std::string cut(std::string_view text, int width) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\x1b') {
      const std::size_t end = std::min(text.find('m', i), text.size() - 1);
      result.append(text.substr(i, end - i + 1));
      i = end;
      continue;
    }
    if (begins_character(text[i]) && width-- <= 0) break;
    result += text[i];
  }
  return result;
}

void put(const std::string& text) {
  std::cout << std::flush;
  fmt::print("{}", text);
  std::fflush(stdout);
}

}  // namespace

Result<> Screen::switch_on() {
  int error = 0;
  if (setupterm(nullptr, STDOUT_FILENO, &error) != OK || !capability("csr") || !capability("cup") || !capability("el"))
    return Trouble{"this terminal cannot keep a part of the screen in place; TERM says which one it is"};
  if (const auto done = measure(); !done) return done.trouble();
  on_ = true;
  if (const auto done = fit(); !done) return done.trouble();
  for (const int number : kKilling) set_handler(number, restore_and_go);
  before_the_kill(restore_at_once);
  return {};
}

void Screen::switch_off() {
  if (!on_) return;
  on_ = false;
  restoring_length = 0;
  before_the_kill(nullptr);
  for (const int number : kKilling) set_handler(number, SIG_DFL);
  put(std::string(restoring));
}

/// The terminal as it is now; false if it is too small.
Result<> Screen::measure() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) size = {};
  columns_ = size.ws_col;
  rows_ = size.ws_row;
  if (columns_ >= plan_.fewest_columns && rows_ >= plan_.fewest_rows) return {};
  return trouble("{} needs a terminal of {}×{}, and this one has {}×{}", plan_.name, plan_.fewest_columns, plan_.fewest_rows,
                 columns_, rows_);
}

Result<> Screen::fit() {
  if (const auto done = measure(); !done) {
    switch_off();
    return done;
  }
  view_rows_ = plan_.view(columns_, rows_);
  const std::string restore = with("csr", 0, rows_ - 1) + plain("sgr0") + with("cup", rows_ - 1, 0) + "\n";
  std::strncpy(restoring, restore.c_str(), sizeof restoring - 1);
  restoring_length = static_cast<int>(std::strlen(restoring));
  put(plain("clear") + with("csr", view_rows_, rows_ - 1) + with("cup", view_rows_, 0));
  return {};
}

void Screen::draw(const std::vector<std::string>& rows) {
  if (!on_) return;
  std::string text = plain("sc");
  for (int row = 0; row < view_rows_; ++row) {
    text += with("cup", row, 0) + plain("el");
    std::string content;
    if (row == view_rows_ - 1)
      for (int column = 0; column < columns_; ++column) content += "─";
    else if (static_cast<std::size_t>(row) < rows.size())
      content = cut(rows[static_cast<std::size_t>(row)], columns_);
    text += (row == 0 ? plain("rev") : "") + content + plain("sgr0");
  }
  put(text + plain("rc"));
}

}  // namespace s7200::tools

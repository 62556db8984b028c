#include "tools/command/terminal/screen.hpp"

#include <fmt/format.h>

namespace s7200::tools {

/// The console of Windows edits lines for itself, and would write over a view above them.
bool Screen::switch_on(std::string& why) {
  why = fmt::format("{} is not for the console of Windows; s7200 view PROGRAM shows the same in the browser", plan_.name);
  return false;
}

void Screen::switch_off() {}

bool Screen::measure(std::string&) { return false; }

bool Screen::fit(std::string&) { return false; }

void Screen::draw(const std::vector<std::string>&) {}

}  // namespace s7200::tools

#include "tools/command/terminal/screen.hpp"

#include <fmt/format.h>

#include "interpreter/base/result.hpp"

namespace s7200::tools {

/// The console of Windows edits lines for itself, and would write over a view above them.
Result<> Screen::switch_on() {
  return trouble("{} is not for the console of Windows; s7200 view PROGRAM shows the same in the browser", plan_.name);
}

void Screen::switch_off() {}

Result<> Screen::measure() { return Trouble{}; }

Result<> Screen::fit() { return Trouble{}; }

void Screen::draw(const std::vector<std::string>&) {}

}  // namespace s7200::tools

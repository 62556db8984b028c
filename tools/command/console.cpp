#include "tools/command/console.hpp"

#include <cstdio>
#include <iostream>

#include "interpreter/base/text.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {
namespace {

/// A line from the terminal; an empty one stands for `last`. Ctrl-C ends a run, and at the prompt the line being typed:
/// reading is not taken up again, and an empty prompt comes with nothing to repeat. False at the end of the input, and when
/// something else than Ctrl-C ends the command.
bool read_line(std::string& line, std::string& last) {
  while (true) {
    forget_ctrl_c();
    if (interrupted()) return false;
    std::cout << Debugger::kPrompt << std::flush;
    if (std::getline(std::cin, line)) {
      if (line.empty()) line = last;
      return true;
    }
    std::cout << '\n';
    if (!interrupted()) return false;
    last.clear();
    std::clearerr(stdin);
    std::cin.clear();
  }
}

}  // namespace

void talk(Debugger& debugger) {
  std::string last;
  for (std::string line; !debugger.quit_asked() && read_line(line, last);) {
    if (const auto error = debugger.execute(line)) std::cout << stl::printable(*error) << '\n';
    last = debugger.repeatable();
  }
}

}  // namespace s7200::tools

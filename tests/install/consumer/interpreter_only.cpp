// Checks a program text with the interpreter alone.
#include "interpreter/analysis/warnings/check.hpp"

int main() {
  using namespace s7200;
  return check_text("LD SM0.0\nMEND\n", "two_lines.stl", cpu214(), default_times(cpu214())).program ? 0 : 1;
}

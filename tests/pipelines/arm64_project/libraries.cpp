#include <fmt/format.h>
#include <histedit.h>
#include <yaml-cpp/yaml.h>
#include <zlib.h>
// Macros of the terminal's library would be in the way of the others.
#include <curses.h>
#include <term.h>

int main() {
  const bool edits = el_init("libraries", stdin, stdout, stderr) != nullptr;
  fmt::print("{} bytes a pointer, YAML of {}, zlib {}, {}, {}\n", sizeof(void*), YAML::Load("[1, 2]").size(), zlibVersion()[0],
             edits ? "lines are edited" : "no line editor", tigetnum("no_such_name") < 0 ? "terminals are known" : "no terminals");
}

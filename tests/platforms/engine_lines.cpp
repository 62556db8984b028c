// Messages for the engine of the page from standard input, a line each; prints what comes back, a line each. Module and
// native build must print the same bytes.
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif

#include <cstdio>
#include <iostream>
#include <string>

#include "tools/faces/page/engine/engine.hpp"

int main() {
#ifdef _WIN32
  _setmode(_fileno(stdin), _O_BINARY);
  _setmode(_fileno(stdout), _O_BINARY);
#endif
  s7200::tools::page::Engine engine([](const std::string& message) { std::cout << message << '\n'; });
  for (std::string line; std::getline(std::cin, line);) engine.take(line);
}

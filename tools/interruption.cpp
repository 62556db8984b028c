#include "tools/interruption.hpp"

#include <csignal>

namespace s7200::tools {
namespace {

volatile std::sig_atomic_t noted = 0;

}  // namespace

void catch_interruption() {
  const auto note = [](int) { noted = 1; };
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

bool interrupted() { return noted != 0; }

}  // namespace s7200::tools

#include "tools/interruption.hpp"

#include <atomic>
#include <csignal>

namespace s7200::tools {
namespace {

std::atomic<bool> noted = false;  // asked by several threads
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler writes it");

}  // namespace

void catch_interruption() {
  const auto note = [](int) { noted = true; };
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

bool interrupted() { return noted; }

}  // namespace s7200::tools

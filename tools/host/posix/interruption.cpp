#include "tools/host/interruption.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>

namespace s7200::tools {
namespace {

std::atomic<bool> noted = false;  // asked by several threads
std::atomic<int> noted_signal = 0;
std::atomic<bool> output_lost = false;
std::atomic<void (*)()> restoring = nullptr;
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler writes them");

constexpr unsigned kRemindEvery = 1;  // seconds

/// Sets a handler without SA_RESTART: a system call that waits ends with EINTR.
void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigaction(number, &action, nullptr);
}

bool is_ignored(int number) {
  struct sigaction now {};
  sigaction(number, nullptr, &now);
  return now.sa_handler == SIG_IGN;
}

void note(int number) {
  if (noted_signal.exchange(number) != 0 && number == SIGINT) {
    if (void (*const restore)() = restoring) restore();
    handle(SIGINT, SIG_DFL);
    raise(SIGINT);
  }
  noted = true;
  alarm(kRemindEvery);
}

void remind(int) {
  if (noted) alarm(kRemindEvery);
}

}  // namespace

void end_at_interruption(void (*end)(int number)) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP})
    if (!is_ignored(number)) handle(number, end);
}

void catch_interruption() {
  handle(SIGALRM, remind);
  handle(SIGINT, note);
  handle(SIGTERM, note);
  if (!is_ignored(SIGHUP)) handle(SIGHUP, note);
}

void interrupt_quietly() { noted = output_lost = true; }

bool interrupted() { return noted; }

StopToken interruption() { return StopToken(noted); }

bool forget_ctrl_c() {
  int ctrl_c = SIGINT;
  if (!noted_signal.compare_exchange_strong(ctrl_c, 0)) return false;
  noted = output_lost.load();
  alarm(0);
  return true;
}

void before_the_kill(void (*restore)()) { restoring = restore; }

std::string_view interruption_text() {
  switch (noted_signal) {
    case SIGTERM:
      return "interrupted by SIGTERM";
    case SIGHUP:
      return "interrupted by SIGHUP";
    default:
      return "interrupted by Ctrl-C";
  }
}

bool interrupted_by_signal() { return noted_signal != 0; }

}  // namespace s7200::tools

#include "tools/host/interruption.hpp"

#include <atomic>

#include "tools/host/windows/native_text.hpp"

namespace s7200::tools {
namespace {

constexpr DWORD kNone = ~DWORD{0};

std::atomic<bool> noted = false;  // asked by several threads
std::atomic<DWORD> noted_event = kNone;
std::atomic<bool> output_lost = false;
std::atomic<void (*)()> restoring = nullptr;
std::atomic<void (*)(int)> ending = nullptr;  // until an interruption is only noted

/// Windows ends the process some seconds after the console was closed, and at once when this returns: it waits, so that what
/// was asked for is completed meanwhile. Of a logoff and a shutdown only services are told (HandlerRoutine, Microsoft).
BOOL WINAPI note(DWORD event) {
  if (void (*const end)(int) = ending) end(static_cast<int>(event));
  const bool first = noted_event.exchange(event) == kNone;
  noted = true;
  if (event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT) {
    if (first) return TRUE;
    if (void (*const restore)() = restoring) restore();
    return FALSE;  // the system's own handler ends the process
  }
  Sleep(INFINITE);
  return TRUE;
}

}  // namespace

void end_at_interruption(void (*end)(int number)) {
  ending = end;
  SetConsoleCtrlHandler(note, TRUE);
}

void catch_interruption() {
  ending = nullptr;
  SetConsoleCtrlHandler(note, FALSE);
  SetConsoleCtrlHandler(note, TRUE);
}

void interrupt_quietly() { noted = output_lost = true; }

bool interrupted() { return noted; }

StopToken interruption() { return StopToken(noted); }

bool forget_ctrl_c() {
  DWORD ctrl_c = CTRL_C_EVENT;
  if (!noted_event.compare_exchange_strong(ctrl_c, kNone)) return false;
  noted = output_lost.load();
  return true;
}

void before_the_kill(void (*restore)()) { restoring = restore; }

std::string_view interruption_text() {
  switch (noted_event) {
    case CTRL_BREAK_EVENT:
      return "interrupted by Ctrl-Break";
    case CTRL_CLOSE_EVENT:
      return "interrupted: the console was closed";
    default:
      return "interrupted by Ctrl-C";
  }
}

bool interrupted_by_signal() { return noted_event != kNone; }

}  // namespace s7200::tools

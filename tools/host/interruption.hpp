// Ctrl-C, a polite kill and a terminal that hangs up: the command ends, and what was asked for is still written.
//
// SIGINT, SIGTERM and SIGHUP are only noted, and every wait looks at the note: the simulation after each 100 ms of simulated
// time, waits for the host when their system call ends with EINTR. A signal that comes just before such a call would be
// missed; so SIGALRM follows it every second, and no call waits on. A second Ctrl-C kills at once. A SIGHUP that is ignored
// stays ignored, as nohup wants it. Until catch_interruption() the three end the command at once: nothing has been begun
// then.
#pragma once

#include <string_view>

#include "interpreter/base/stop_token.hpp"

namespace s7200::tools {

/// Lets the signals call `end` until catch_interruption(); `end` may do what a signal handler may, and does not return.
/// Signals that are ignored stay ignored.
void end_at_interruption(void (*end)(int number));

/// Lets the signals be noted from now on.
void catch_interruption();

/// Interrupts the command as a signal does, but silently: standard output takes nothing more.
void interrupt_quietly();

bool interrupted();

/// The token that the signals set, for long runs that look at it by themselves.
StopToken interruption();

/// Takes a Ctrl-C back, which at a prompt gives a new one. False if there was none, and for all that ends the command.
bool forget_ctrl_c();

/// Called by a second Ctrl-C just before it kills: `restore` may do what a signal handler may. Null: nothing is called.
void before_the_kill(void (*restore)());

/// The reason in words: `interrupted by Ctrl-C`, or by SIGTERM or SIGHUP if that came.
std::string_view interruption_text();

/// Whether a signal was the reason, not interrupt_quietly().
bool interrupted_by_signal();

}  // namespace s7200::tools

#include "tools/scenario/steps/steps.hpp"

namespace s7200::tools {
namespace {

// clang-format off
constexpr StepKind kKinds[] = {
    {"send", read_send, "HEX or {text: ASCII}", "a frame as it stands; `p` after a byte sends it with wrong parity"},
    {"request", read_request, "HEX", "function and data; station and CRC are added"},
    {"read", read_read, "AREA FIRST or NUMBER", "function 1, 2, 3 or 4: `coils 0`, `inputs 0`, `input-registers 0`, `holding 0`, counted from 0; or `00001`, `10001`, `30001`, `40001`, `400001`"},
    {"write", read_write, "AREA FIRST or NUMBER", "coils or holding registers: function 5 or 6 with `value`, 15 or 16 with `values`"},
    {"receive", read_receive, "any, silence, HEX or {text: ASCII}", "a transmission that no one asked for: the first since the last request, or the next to come"},
    {"wait", read_wait, "SPAN, N scans or until TIME", "nothing is sent for so long, or until so long after power-up", StepKind::Of::Either},
    {"wait_until", read_wait_until, "MAP", "goes on when memory is as in `memory`, looked at now, at the end of each scan, and when the time is over"},
    {"set", read_set, "MAP", "memory and inputs: `{VW20: 16#1234, I0.3: 1}`"},
    {"force", read_force, "MAP", "values that hold until they are released, over scans and whatever the program writes: `{VW20: 5, I0.3: 1}`; points of I and Q, and up to sixteen values of V, M, AI and AQ"},
    {"unforce", read_unforce, "LIST or all", "releases what is forced there: `[VW20, I0.3]`"},
    {"set_mode", read_set_mode, "run, stop", "a programming device asks the CPU to go to RUN or to STOP, where it may end then"},
    {"memory", read_memory, "MAP", "what must be in memory: `{VW20: 16#1234, VW22: 5..10, Q0.0: 1, VD24: 1.5, VB0:4: 01 02 .. 04}`"},
    {"interrupts", read_interrupts, "MAP", "how often since the last request began: `{INT 123: 7, event 10: 1..2, lost: 0}`"},
    {"mode", read_mode, "run, stop", "what mode the CPU must be in"},
    {"fatal", read_fatal, "CODE or none", "the fatal error there must have been: `0003`"},
    {"errors", read_errors, "MAP or none", "all run-time errors there must have been: `{0092: 3, 0006: 1..}`"},
    {"fault", read_fault, "FAULT or none", "a fault of the line from now on, as of `--fault`, or of one `station` there; or none any more"},
    {"power_cycle", read_power_cycle, "memory kept, memory lost", "power off and on again, for a short or a long time; of a program"},
    {"power_off", read_event_of_system, "NAME", "one PLC or peer of a system loses power; if it is off already it stays off", StepKind::Of::System},
    {"power_on", read_event_of_system, "NAME", "its power comes back", StepKind::Of::System},
    {"cut", read_event_of_system, "LINE", "the cable is cut: both parts go on without each other", StepKind::Of::System},
    {"mend", read_event_of_system, "LINE", "the cable is whole again", StepKind::Of::System},
};
// clang-format on

}  // namespace

std::span<const StepKind> step_kinds() { return kKinds; }

}  // namespace s7200::tools

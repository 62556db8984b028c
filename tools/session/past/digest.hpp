// Digests: two things with the same one are the same, as far as a user can bring it about.
#pragma once

#include <string>

#include "interpreter/cpu/state.hpp"
#include "interpreter/program/program.hpp"
#include "serial_sim/field/field_script.hpp"

namespace s7200::tools {

/// Of a text.
std::string digest_of(std::string_view text);

/// Of the instructions with their operands, places and times: two programs with the same digest run alike.
std::string digest_of(const Program& program);

/// Of all that a CPU remembers: memory, position, clock, queues, timers, ports …
std::string digest_of(const State& state);

/// Of what drives the inputs.
std::string digest_of(const serial::FieldScript& script);

}  // namespace s7200::tools

// What memory is by itself, whatever the program does with it: inputs, timers with their resolution, special memory and who
// writes it.
#pragma once

#include <string>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/model/cpu_model.hpp"

namespace s7200::tools {

/// Of bits as programs name them (interpreter/analysis/effects/memory_names.hpp): `input`, `TON, 10 ms`, `first scan; the CPU writes
/// it`; empty for plain memory.
std::string meaning_text(const CpuModel& model, const Bits& bits);

/// `TON, 100 ms`, `TONR, 1 ms`
std::string timer_text(std::uint32_t number);

}  // namespace s7200::tools

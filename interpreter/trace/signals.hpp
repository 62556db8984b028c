// Signals: what a recording over time shows of a PLC, by name. A memory address or a symbol, or interrupt routines at work.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/program/operands/address.hpp"

namespace s7200 {

struct Signal {
  enum class Kind : std::uint8_t {
    Memory,      ///< the value at `place`
    Interrupt,   ///< 1 while the routine of number `routine` is executed
    Interrupts,  ///< each routine of the program, a signal of its own
  };
  Kind kind{};
  std::string name{};  ///< as it was written: `VW20`, `Speed`, `INT123`
  MemoryRange place{};
  std::uint8_t routine = 0;
};

/// Reads `Q0.0,VW20,VD100:real,Speed,INT123,INT`. Returns nothing and sets `why` if one of them is none.
std::optional<std::vector<Signal>> parse_signals(std::string_view text, const AddressSpace& space, std::string& why);

/// The signals with those that Interrupts stands for in their place, in the order of their numbers.
std::vector<Signal> signals_of(const std::vector<Signal>& wanted, const Program& program);

}  // namespace s7200

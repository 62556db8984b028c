// Signals: what a recording over time shows of a PLC, by name. A memory address or a symbol, interrupt routines at work, or
// the levels at a port.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/program/operands/address.hpp"

namespace s7200 {

/// The levels at a port, as the port is labelled.
enum class PortLevel : std::uint8_t {
  Rxd,   ///< what the others drive
  Txd,   ///< what the PLC drives
  Line,  ///< what both together give
};

struct Signal {
  enum class Kind : std::uint8_t {
    Memory,      ///< the value at `place`
    Interrupt,   ///< 1 while the routine of number `routine` is executed
    Interrupts,  ///< each routine of the program, a signal of its own
    Level,       ///< `level` at `port`: 1 is mark, the idle level
    Levels,      ///< all three at `port`
  };
  Kind kind{};
  std::string name{};  ///< as it was written: `VW20`, `Speed`, `INT123`, `PORT0.TXD`
  MemoryRange place{};
  std::uint8_t routine = 0;
  std::uint8_t port = 0;
  PortLevel level{};
};

/// Reads `Q0.0,VW20,VD100:real,Speed,INT123,INT,PORT0.TXD,PORT0`. Trouble if one of them is none.
Result<std::vector<Signal>> parse_signals(std::string_view text, const AddressSpace& space);

/// The signals with those that Interrupts and Levels stand for in their places, in the order of their numbers.
std::vector<Signal> signals_of(const std::vector<Signal>& wanted, const Program& program);

}  // namespace s7200

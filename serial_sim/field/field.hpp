// The field: plays a FieldScript on the inputs of a CPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interpreter/base/event_queue.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "serial_sim/field/field_script.hpp"

namespace s7200::serial {

/// Drives the inputs by a script. One event is pending at a time, however long the script is. At the same instant changes
/// come first, in the order of the script, then the edges of pulses. The owner passes events of this field's number to
/// handle().
class Field {
 public:
  struct Running {
    std::size_t train = 0;   ///< in the script
    std::uint64_t edge = 0;  ///< number of the next one
    Time next = 0;           ///< when it comes
    bool operator==(const Running&) const = default;
  };

  /// Plain, so that a snapshot is a copy.
  struct State {
    std::size_t next_change = 0, next_train = 0;  ///< in the script
    std::vector<Running> running;
    bool operator==(const State&) const = default;
  };

  /// `owner` is the field's number in the queue. Neither reference is owned.
  Field(FieldScript script, Cpu& cpu, EventQueue& queue, EventOwner owner);

  /// The CPU has been powered up at `at`: what the script says of the time until then holds before the first scan.
  void power_up(Time at = 0);

  void handle(const Event& event);

  const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

 private:
  void play(Time now);
  void next_edge(Running& running);
  void put(std::uint32_t place, std::uint8_t mask, std::uint8_t value, Time at);
  Time next_due() const;

  FieldScript script_;
  Cpu& cpu_;
  EventQueue& queue_;
  EventOwner owner_;
  State state_;
};

}  // namespace s7200::serial

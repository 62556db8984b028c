// The reference model: one CPU 214 or 224 that executes the statements of an STL source directly.
//
// Slow and plain on purpose, and written from the rulebook (facts 1, 4, 5, 6, 9), not from the interpreter: nothing is
// decoded in advance except the times. No interrupts, no Freeport, no high-speed counters, pulse outputs or clock.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/stl/ast.hpp"
#include "tests/reference_model/memory.hpp"
#include "tests/reference_model/times.hpp"

namespace s7200::reference {

struct Instruction;

/// Thrown by an instruction that ends in a run-time error (facts 5.2) before it has done anything.
struct RunTimeError {
  int code;
};

using Stack = std::array<bool, 9>;  // S0 first

/// Timers of 100 ms; the others are of 1 or 10 ms (facts 1.1).
bool is_100_ms(std::size_t timer);

class Machine {
 public:
  Machine(const stl::Source& source, const CpuKind& kind);

  /// Clears everything and goes to RUN.
  void power_up();

  /// One instruction; or the system's part of the scan, up to the start of the program. In STOP only the clock runs.
  void step();

  // --- what can be seen ---

  const CpuKind& kind;
  Memory memory;
  Stack stack{};
  std::size_t position = 0;  ///< index of the statement to execute next
  bool in_program = false;   ///< false: in the system's part of the scan
  bool running = false;
  std::int64_t time = 0;  ///< ns since power-up

  struct Error {
    int code;
    std::size_t position;
    std::int64_t first;
    std::uint64_t count;
  };
  std::vector<Error> errors;  ///< different ones, in the order of their first occurrence
  std::uint64_t error_count = 0;
  int fatal_code = 0;
  std::optional<std::size_t> fatal_position;

  bool rail = true;  ///< whether the power rail of the segment has power
  bool eno = true;   ///< of the last box (facts 10.7)

  struct Call {
    std::size_t return_to;
    Stack stack;
    bool rail;
  };
  std::vector<Call> calls;
  std::map<std::size_t, bool> edge_memory;  ///< of EU and ED, by statement
  bool interrupts_enabled = false;

  const std::vector<stl::Statement>& statements() const { return statements_; }

  /// The 1 ms timers count up to now. step() does it before an instruction.
  void count_milliseconds();

  /// Whether the instruction at `position` would be executed, not skipped.
  bool has_power() const;

  // --- for the instructions ---

  std::size_t next = 0;  ///< statement to go on with

  const stl::Statement& statement() const { return statements_[position]; }

  /// The number in operand `i` of the current statement, for a statement such as JMP.
  std::size_t number(std::size_t i) const;

  /// The value of an operand of `width` bytes: a constant, &address, direct or through a pointer.
  std::uint32_t in(std::size_t i, std::size_t width) { return value_of(statement().operands[i], width); }
  std::uint32_t value_of(const stl::Operand& operand, std::size_t width);
  Place place(std::size_t i, std::size_t width) { return place_of(statement().operands[i], width); }
  Place place_of(const stl::Operand& operand, std::size_t width);

  const stl::Address& address(std::size_t i) const;
  BitPlace bit(std::size_t i);    ///< in the image registers, and the bits of timers and counters
  BitPlace point(std::size_t i);  ///< the input or output point itself
  BitPlace flag(int n) { return {&memory.SM, 8 + static_cast<std::size_t>(n)}; }  ///< SM1.n

  void push(bool value);
  void pop();

  void spend_units(std::uint32_t units) { time += cost_[position].per_unit * static_cast<std::int64_t>(units); }

  /// The routine that runs, by how many calls are open, has local memory of its own.
  void enter_level(std::size_t calls);

  void fatal_error(int code, std::optional<std::size_t> where);
  void stop();
  void end_program();
  void restart_watchdog();
  void enable_interrupts(bool enabled);

  std::size_t find_label(std::size_t number) const;
  std::size_t find_subroutine(std::size_t number) const;
  std::size_t find_next(std::size_t for_position) const;
  std::size_t find_for(std::size_t next_position) const;
  std::size_t find_lscr(std::size_t inner_position) const;

  struct Timer {
    bool enabled = false;
    bool off_delay = false;  ///< a TOF: enabled while it times
    bool input = false;      ///< of a TOF
    std::int16_t preset = 0;
    std::int64_t enabled_at = 0;  ///< end of the execution that enabled it
  };
  std::array<Timer, 256> timers{};
  std::array<bool, 256> counter_up{}, counter_down{};  ///< inputs as the counters saw them last
  std::int64_t hundred_ms_ticks = 0;                   ///< in the scan before this one

  /// Adds to the current value of a timer, up to 32767, and compares.
  void count_timer(std::size_t timer, std::int64_t ticks);
  void compare_timer(std::size_t timer);

 private:
  Bytes& area(const std::string& name);
  Place follow_pointer(const stl::Address& pointer, std::size_t width);
  std::uint32_t pointer_to(const stl::Address& target) const;
  bool watchdog_runs_out(std::int64_t end);
  void system_part();
  void end_scan();
  void read_inputs();
  void count_ten_milliseconds();
  void execute();
  bool has_failed() const;
  void report(int code);
  std::size_t find(const std::string& mnemonic, std::size_t number) const;

  std::vector<stl::Statement> statements_;
  std::vector<const Instruction*> instruction_;
  std::vector<Cost> cost_;
  std::vector<bool> has_eno_;
  std::array<Bytes, 9> local_{};  ///< of the levels that do not run now
  std::size_t level_ = 0;
  bool uses_local_ = false;
  std::int64_t no_power_flow_ = 0, scan_overhead_ = 0;

  std::int64_t scan_begin_ = 0, inputs_read_ = 0, watchdog_ = 0;
  std::int64_t milliseconds_counted_ = 0;
  std::int64_t shortest_scan_ = 0, longest_scan_ = 0;
  bool first_scan_ = true;
  std::size_t executed_ = 0;  ///< the last statement: what the watchdog stops
};

}  // namespace s7200::reference

// What contacts let through: as the program last found them, or as memory is now.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/analysis/flow/flow.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "interpreter/cpu/local_memory.hpp"
#include "interpreter/model/contact_form.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200::tools {

/// Instructions that were executed lately, by op.
using LatelyExecuted = std::map<std::uint32_t, InstructionRecord>;

class Contacts {
 public:
  /// Whether a CALL is executed with power flow, as far as contacts decide that now.
  using Enters = std::function<bool(std::uint32_t call)>;

  /// The CPU, the flow of its program and what was executed must live as long as this. `fresh_since`: what contacts found
  /// before is not what they would find now.
  Contacts(const Cpu& cpu, const ControlFlow& flow, const LatelyExecuted& lately, Time fresh_since, Enters enters);

  /// Whether a contact lets power through that reaches it, the S bit of an LSCR is on, an interrupt routine runs whenever
  /// its event comes that comes by itself. An edge does so only in the scan in which it was found.
  bool conducts(std::uint32_t op) const;

  /// Whether it was executed lately.
  bool executed(std::uint32_t op) const { return lately_.contains(op); }

  /// Its last execution, as far as that is not long ago; null otherwise.
  const InstructionRecord* found(std::uint32_t op) const;

  /// The value of an operand; nothing for a bad pointer. Local memory is that of the routine if it has begun and not ended.
  /// Otherwise it is another one by now: then a parameter, unless it was found lately, is what the CALL hands over that
  /// the routine was entered by, and what else is there is not known.
  std::optional<std::uint32_t> value(std::uint32_t op, std::size_t operand) const;

  /// The CALL by which a subroutine was entered that has not ended; else the last that was executed with power flow; else
  /// the last that has it now; else the only one. Nothing of several. `routine`: in ControlFlow::routines.
  std::optional<std::uint32_t> entered_by(std::uint32_t routine) const;

  /// What the caller has where a CALL takes a parameter from, or puts it. Nothing if that is not known.
  std::optional<std::uint32_t> argument(std::uint32_t call, const Parameter& parameter) const {
    return value_in(flow_.nodes[call].routine, parameter.actual, parameter.width, 0);
  }

  /// What is asked of a routine from now on is meant as one CALL enters it; nothing: as it was entered. Returns what was so
  /// before.
  std::optional<std::uint32_t> look_within(std::uint32_t routine, std::optional<std::uint32_t> call);

 private:
  using OpenRoutine = local_memory::OpenRoutine;

  bool compares(std::uint32_t op, const ContactForm& form) const;
  bool is_last_entered() const;
  std::optional<std::uint32_t> last_executed_call(std::uint32_t routine) const;
  const OpenRoutine* open_of(std::uint32_t routine) const;
  std::optional<std::uint32_t> value_in(std::uint32_t routine, const Operand& operand, Width width,
                                        std::uint32_t level) const;
  std::optional<std::uint32_t> handed_over(std::uint32_t routine, const Operand& local, Width width,
                                           std::uint32_t level) const;

  const Cpu& cpu_;
  const ControlFlow& flow_;
  const LatelyExecuted& lately_;
  Time fresh_since_;
  Enters enters_;
  std::vector<OpenRoutine> open_;
  std::map<std::uint32_t, std::uint32_t> within_{};  // calls, by routine
};

/// The event that an interrupt routine is attached to; nothing if it is to none.
std::optional<std::uint8_t> event_of_routine(const State& state, std::uint32_t routine);

/// Whether an event comes again and again without anything from outside: the timed interrupts.
bool comes_by_itself(std::uint8_t event);

}  // namespace s7200::tools

// What contacts let through: as the program last found them, or as memory is now.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "interpreter/cpu/cpu.hpp"
#include "interpreter/model/contact_form.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200::tools {

/// Instructions that were executed lately, by op.
using LatelyExecuted = std::map<std::uint32_t, InstructionRecord>;

class Contacts {
 public:
  /// The CPU and what was executed must live as long as this. `fresh_since`: what contacts found before is not what they
  /// would find now.
  Contacts(const Cpu& cpu, const LatelyExecuted& lately, Time fresh_since)
      : cpu_(cpu), lately_(lately), fresh_since_(fresh_since) {}

  /// Whether a contact lets power through that reaches it, the S bit of an LSCR is on, an interrupt routine runs whenever
  /// its event comes that comes by itself. An edge does so only in the scan in which it was found.
  bool conducts(std::uint32_t op) const;

  /// Whether it was executed lately.
  bool executed(std::uint32_t op) const { return lately_.contains(op); }

  /// Its last execution, as far as that is not long ago; null otherwise.
  const InstructionRecord* found(std::uint32_t op) const;

  /// The value of an operand; nothing for a bad pointer. That of a parameter, unless it was found lately, is what the last
  /// CALL of its subroutine hands over: the local memory is another one by now.
  std::optional<std::uint32_t> value(std::uint32_t op, std::size_t operand) const;

 private:
  bool compares(std::uint32_t op, const ContactForm& form) const;
  std::optional<std::uint32_t> handed_over(std::uint32_t op, const Operand& local, Width width, std::size_t level) const;
  std::optional<std::uint32_t> value_of(std::uint32_t op, const Operand& operand, Width width, std::size_t level) const;

  const Cpu& cpu_;
  const LatelyExecuted& lately_;
  Time fresh_since_;
};

/// The event that an interrupt routine is attached to; nothing if it is to none.
std::optional<std::uint8_t> event_of_routine(const State& state, std::uint32_t routine);

/// Whether an event comes again and again without anything from outside: the timed interrupts.
bool comes_by_itself(std::uint8_t event);

}  // namespace s7200::tools

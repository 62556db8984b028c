// Which contacts of a program were seen closed and open, and whether a run has done something that none before it did.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "interpreter/cpu/cpu.hpp"
#include "tools/coverage/contacts.hpp"

namespace s7200::tools {

/// Contacts are those of tools/coverage: a contact counts as closed or open whatever reaches it from the left, and one that
/// cannot change does not count.
class ContactsSeen {
 public:
  /// The CPU is not owned.
  explicit ContactsSeen(const Cpu& cpu);

  void look_at(const InstructionRecord& record) {
    const ContactForm& form = forms_[record.op];
    bool state = record.powered;
    if (form.is_contact()) {
      const auto through = lets_through(cpu_, cpu_.program().ops[record.op], form, record);
      if (!through) return;
      state = *through;
      if (form.kind == ContactForm::Kind::Numbers) look_at_numbers(record);
    }
    std::uint16_t& count = counts_[2 * record.op + state];
    if (count == 0) touched_.push_back(2 * record.op + state);
    count = static_cast<std::uint16_t>(count + (count < 0xFFFF));
  }

  /// Ends a run: adds it to what was seen. True if it has executed an instruction in a way that no run before did, or far
  /// more often, or compared a number of another order of magnitude.
  bool add_run();
  /// Forgets what was seen of the run.
  void forget_run();

  std::size_t contacts() const { return contacts_.size(); }
  /// Seen closed and open.
  std::size_t both_ways() const { return contacts_.size() - never().size(); }
  bool all_both_ways() const { return never().empty(); }

  /// A contact that was not seen both ways.
  struct Never {
    std::uint32_t op = 0;
    bool closed = false, open = false;  ///< what was seen: neither if it was not executed
  };
  std::vector<Never> never() const;

 private:
  void look_at_numbers(const InstructionRecord& record) {
    for (std::size_t i = 0; i < 2; ++i) {
      const std::uint64_t is = std::uint64_t{1} << std::bit_width(record.value[i].value_or(0));
      std::uint64_t& seen = numbers_[2 * record.op + i];
      new_number_ |= (seen & is) == 0;
      seen |= is;
    }
  }

  const Cpu& cpu_;
  std::vector<ContactForm> forms_;       // by op
  std::vector<std::uint32_t> contacts_;  // ops
  std::vector<std::uint16_t> counts_;    // of this run: by op, twice: open or without power flow, closed or with it
  std::vector<std::uint8_t> seen_;       // the same of all runs: a bit for each order of magnitude
  std::vector<std::uint32_t> touched_;   // indices of counts_ that are not 0
  std::vector<std::uint64_t> numbers_;   // compared in all runs: by op, twice: a bit for each number of significant bits
  bool new_number_ = false;              // in this run
};

}  // namespace s7200::tools

// Which contacts of a program were seen closed and open, and whether a run has done something that none before it did.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "interpreter/cpu/cpu.hpp"

namespace s7200::tools {

/// A contact is a bit, which is 0 or 1, or a comparison, which holds or not. Of a comparison in series or in parallel with
/// others it is known only where these leave it the decision. Contacts of SM0.0 do not count: it is always 1.
class ContactsSeen {
 public:
  explicit ContactsSeen(const Program& program);

  void look_at(const InstructionRecord& record) {
    const Kind kind = kinds_[record.op];
    bool state = kind == Kind::Other ? record.powered : record.top;
    bool known = true;
    if (kind == Kind::Bit && record.value[0]) state = *record.value[0] != 0;
    if (kind == Kind::ComparisonAnd) known = top_before_;
    if (kind == Kind::ComparisonOr) known = !top_before_;
    top_before_ = record.top;
    if (!known) return;
    std::uint16_t& count = counts_[2 * record.op + state];
    if (count == 0) touched_.push_back(2 * record.op + state);
    count = static_cast<std::uint16_t>(count + (count < 0xFFFF));
  }

  /// Ends a run: adds it to what was seen. True if it has executed an instruction in a way that no run before did, or far
  /// more often.
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
  enum class Kind : std::uint8_t { Other, Bit, Comparison, ComparisonAnd, ComparisonOr };

  std::vector<Kind> kinds_;              // by op
  std::vector<std::uint32_t> contacts_;  // ops
  std::vector<std::uint16_t> counts_;    // of this run: by op, twice: open or without power flow, closed or with it
  std::vector<std::uint8_t> seen_;       // the same of all runs: a bit for each order of magnitude
  std::vector<std::uint32_t> touched_;   // indices of counts_ that are not 0
  bool top_before_ = false;
};

}  // namespace s7200::tools

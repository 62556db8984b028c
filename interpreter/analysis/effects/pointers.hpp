// Where the pointers of a program may lead.
//
// A pointer is a double word in memory. What it holds at any time is known if all that writes it are instructions which move
// an address to it (MOVD &VB100, AC1; MOVD 16#08000064, VD0), copy another known one, add and subtract constants or count it
// up and down, or change its lower bytes only; and if it is in V, M or L memory or an accumulator. Anything else, also an
// instruction that writes through a pointer which may lead to this one, may put anything into it. So may the user, a master
// or the data block: of a pointer that the program itself does not set nothing is known, and of another one it is assumed
// that nobody else sets it. Of a pointer that is counted up or down only the area is known, and it is assumed that it stays
// in it: to reach another one it has to be counted through 16 million addresses that point nowhere.
//
// What it holds when an instruction goes through it is more certain: the addresses that reach it (reaching_values.hpp).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/analysis/effects/reaching_values.hpp"
#include "interpreter/analysis/flow/flow.hpp"
#include "interpreter/program/program.hpp"

namespace s7200 {

struct MemoryAccess;

class Pointers {
 public:
  explicit Pointers(const Program& program) : Pointers(program, control_flow(program)) {}
  /// `flow` is that of the program. If `waiter` asks to end, less is known.
  Pointers(const Program& program, const ControlFlow& flow, const Waiter& waiter = {});

  /// As if nothing were known of any: for what must hold whoever sets a pointer.
  static Pointers nothing_known(const Program& program) { return Pointers(program, Nothing{}); }

  /// Where the pointer in memory at `at` leads when op number `op` goes through it, in no order; empty if all addresses that
  /// reach the op point nowhere. If nothing is known: all that a pointer can reach on the program's CPU.
  std::vector<PointerTarget> targets(std::uint32_t op, std::uint32_t at) const;

  /// Whether anything is known of what it holds at any time.
  bool is_known(std::uint32_t at) const;

  /// What a pointer in memory at `at` may hold at any time; nothing if no instruction uses it as one.
  std::optional<ValueSet> at_any_time(std::uint32_t at) const;

  /// How often a FOR runs at most; nothing if that is not known.
  std::optional<std::int64_t> passes(std::uint32_t op) const { return reaching_ ? reaching_->passes(op) : std::nullopt; }

  /// Why nothing is known of a pointer in memory at `at`.
  struct Unknown {
    enum class Reason : std::uint8_t {
      NotSet,     ///< the program does not set it
      DataBlock,  ///< the data block does, or a programming device
      Elsewhere,  ///< it is not in V, M or L memory or an accumulator
      Written,    ///< `op` puts into it what no address is known of
      Counted,    ///< `op` counts it, and nothing that is known ends that
      Length      ///< how far goes what it leads to is known only in a run
    };
    Reason reason = Reason::NotSet;
    std::uint32_t op = 0;
  };
  /// Nothing for a pointer that is_known().
  std::optional<Unknown> unknown(std::uint32_t at) const;
  /// Why it may lead anywhere when op number `op` goes through it. Nothing if it may not.
  std::optional<Unknown> unknown(std::uint32_t op, std::uint32_t at) const;

  /// What a pointer may hold.
  struct Content {
    bool anything = false;
    std::set<std::uint32_t> addresses;  ///< as the pointer holds them
    std::set<std::uint8_t> areas;       ///< any address in them: their codes, the top byte

    bool add(const Content& other);  ///< whether that is more than before
  };

 private:
  struct Nothing {};
  Pointers(const Program& program, Nothing) : program_(program) {}

  std::vector<PointerTarget> at_any_time_targets(std::uint32_t at) const;

  bool begin(std::uint32_t at);
  bool add_writes();
  bool give_up_unset();
  bool add_write(const Op& op, const MemoryAccess& access);
  bool add_parameter(const Parameter& parameter);
  Content copied(const Operand& from, bool& more);

  const Program& program_;
  std::map<std::uint32_t, Content> contents_;        // by place in the image
  std::map<std::uint32_t, std::uint32_t> given_up_;  // by place in the image: the op that put anything into it
  std::optional<ReachingValues> reaching_{};         // nothing for a program with errors
};

/// Whether the data block of the program sets some of these bits.
bool is_set_by_data_block(const Program& program, const Bits& bits);

}  // namespace s7200

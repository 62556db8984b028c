// What the ways of longest_ways.hpp know of memory: bits and numbers that contacts look at, that loops and blocks are
// counted with, and what these are made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"
#include "interpreter/analysis/effects/value_set.hpp"

namespace s7200 {

/// What each cell may hold, and which cells hold the same.
struct WayMemory {
  /// A cell that is the sum of two others.
  struct Sum {
    std::size_t total = 0, first = 0, second = 0;
    bool fits = false;              ///< without overflow
    bool shown_by_overflow = true;  ///< SM1.1 still tells whether it does

    bool is_of(std::size_t cell) const { return cell == first || cell == second; }
    bool operator==(const Sum&) const = default;
  };

  std::vector<ValueSet> value{};
  std::vector<std::size_t> like{};  ///< the first cell of those that hold the same as this one; itself if none does
  std::optional<Sum> sum{};         ///< the last one

  bool operator==(const WayMemory&) const = default;
  void join(const WayMemory& other);  ///< either of the two
};

class WayCells {
 public:
  /// `disturbing`: by routine, whether it may come between any two instructions.
  WayCells(const Facts& facts, const std::vector<bool>& disturbing);

  WayMemory nothing_known() const;

  std::optional<std::size_t> at(const Bits& bit) const;
  std::optional<std::size_t> of(const Operand& operand, Width width) const;
  ValueSet value_of(const Program& program, const Operand& operand, Width width, const WayMemory& memory) const;

  /// Keeps what is in `values` too, of a cell and of its copies; false if that is nothing.
  bool keep(WayMemory& memory, std::optional<std::size_t> cell, const ValueSet& values) const;

  /// A bit is on or off: the highest bit of a number is its sign. False if that cannot be.
  bool keep_sign(WayMemory& memory, const Bits& bit, bool on) const;
  /// SM1.1 is off: the sum that was worked out last has not overflowed.
  void note_no_overflow(WayMemory& memory) const;
  /// Two numbers of a sum that are not negative are not above it. False if what is known cannot be.
  bool apply_sum(WayMemory& memory) const;

  /// `total` becomes the sum of itself and `added`. Asked in front of the write.
  std::optional<WayMemory::Sum> sum_of(const WayMemory& memory, std::size_t total, std::size_t added) const;

  /// Bits are written, all of them with `result` if there is one: with a number, or with the same bit each.
  void write(WayMemory& memory, const Bits& bits, const std::optional<ValueSet>& result, bool each_bit) const;
  /// What stands at `bits` is a copy of what a cell holds.
  void make_copy(WayMemory& memory, std::size_t original, const Bits& bits) const;

  /// The same in parts, for a routine that counts with them and leaves it to others to compare them: such numbers are
  /// apart where it asks whether they are equal to a number, and by their size. So what is found out about them later tells
  /// how long loops took before.
  std::vector<WayMemory> split(const WayMemory& memory, std::uint32_t routine) const;

  /// Of what is not looked at any more in front of an op, and from there on, nothing is known.
  void forget_dead(WayMemory& memory, std::uint32_t op) const { forget_all_but(memory, live_[op]); }
  /// The same where a routine returns.
  void forget_dead_after(WayMemory& memory, std::uint32_t routine) const { forget_all_but(memory, live_after_[routine]); }

  bool is_written(std::uint32_t op, std::size_t cell) const;
  /// Of what a routine writes, itself or in what it calls, nothing is known.
  void forget_writes_of(std::uint32_t routine, WayMemory& memory) const;

 private:
  struct Cell {
    std::uint32_t at = 0;  ///< of a bit its byte
    Width width{};
    Bits bits{};
    bool limits = false;              ///< a loop or a block may depend on it
    bool disturbed = false;           ///< an interrupt routine or the system writes it
    bool compared = false;            ///< with anything
    std::set<std::int64_t> equals{};  ///< numbers with which it is compared for equality
    ValueSet ever{};                  ///< what it may hold at any time
  };

  void find();
  bool decides_control(std::uint32_t op) const;
  void want_of(std::uint32_t op, std::map<std::uint64_t, int>& contacts);
  void note_comparison(std::uint32_t op);
  void want(const Operand& operand, Width width, bool limits);
  void want_sources();
  void find_disturbed(const std::vector<bool>& disturbing);
  bool writes(std::uint32_t op, const Bits& bits) const;
  std::optional<std::size_t> known_at(std::uint64_t first_bit, Width width) const;
  void find_constants();
  void find_uses();
  void add_uses_of_callees(std::vector<std::set<std::size_t>>& uses) const;
  std::set<std::size_t> read_by(std::uint32_t op) const;
  void find_live();
  std::vector<bool> live_in_front_of(std::uint32_t op) const;
  std::vector<ValueSet> parts_of(const Cell& cell, const ValueSet& values) const;
  void forget_all_but(WayMemory& memory, const std::vector<bool>& live) const;
  bool is_sign(std::size_t number, const Bits& bit) const;
  void detach(WayMemory& memory, std::size_t cell) const;

  const Facts& facts_;
  std::vector<Cell> cells_{};
  std::map<std::pair<std::uint64_t, Width>, std::size_t> number_{};     // of a cell, by its first bit
  std::vector<std::set<std::size_t>> writes_{}, reads_{}, compares_{};  // cells by routine
  std::vector<std::vector<bool>> live_{}, live_after_{};                // cells by op, and by routine that returns
};

}  // namespace s7200

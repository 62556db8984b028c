// Conditions that cannot be fulfilled at once: a bit that has to be on and off, a word that has to be above 950 and at
// most 90.
//
// What two contacts look at is the same if nothing can write it between them. Interrupt routines may: they are taken not to
// come just there, and that is said.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"

namespace s7200 {

/// A contact that lets power through or does not; an LSCR whose S bit is on or off; an INT
/// that runs. Of contacts of a network that look at the same it is the first, so that they do not contradict each other.
struct Condition {
  std::uint32_t op = 0;
  bool on = false;
  std::uint32_t in_rung = op;  ///< the contact that is in the rung, and what that one lets through
  bool in_rung_on = on;
  auto operator<=>(const Condition& other) const { return std::tie(op, on) <=> std::tie(other.op, other.on); }
  bool operator==(const Condition& other) const { return op == other.op && on == other.on; }
};

/// From `least` to `most`, or all others.
struct ValuesOfContact {
  std::int64_t least = 0, most = 0;
  bool outside = false;

  bool operator==(const ValuesOfContact&) const = default;
};

struct Exclusion {
  Condition first, second;
  bool unless_interrupted = false;  ///< an interrupt routine writes what both look at
};

class Exclusions {
 public:
  /// `facts` must live as long as this.
  explicit Exclusions(const Facts& facts);

  /// Nothing if both may be fulfilled, or if it cannot be told.
  std::optional<Exclusion> between(const Condition& first, const Condition& second) const;

  /// The same of a contact that has to be open and closed, where the rung looks again at what it looks at (network_logic.hpp).
  std::optional<Exclusion> of_looking_twice(std::uint32_t op) const;

  /// Whether some two contacts from `first` until before `end` look at the same and could exclude each other.
  bool may_be_within(std::uint32_t first, std::uint32_t end) const;

 private:
  /// What a contact looks at, and the values with which it is closed.
  struct Subject {
    Bits bits{0, 0};    ///< none: it cannot be told
    bool exact = true;  ///< with all other values it is open
    ValuesOfContact closed{};
  };

  Subject subject_of(std::uint32_t op) const;
  std::optional<Exclusion> of_same_value(const Condition& first, const Condition& second, const Bits& bits) const;
  bool is_same_value(std::uint32_t first, std::uint32_t second, const Bits& bits) const;
  bool writes(std::uint32_t op, const Bits& bits) const;
  bool is_written_by_interrupt(const Bits& bits) const;

  const Facts& facts_;
  std::vector<Subject> subjects_{};  // by op
  mutable std::map<std::pair<Condition, Condition>, std::optional<Exclusion>> known_{};
  mutable std::optional<std::vector<bool>> in_interrupt_{};  // by routine
};

/// `VW2 >= 950 (line 4)`, `not I0.0 (line 2)`.
std::string condition_text(const Program& program, const Condition& condition);

/// `VW2 >= 950 (line 4) and VW2 <= 90 (line 5) exclude each other`
std::string exclusion_text(const Program& program, const Exclusion& exclusion);

}  // namespace s7200

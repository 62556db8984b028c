// The steps of a sequence: S bits with a segment (LSCR to SCRE), or to which a transition (SCRT) leads.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"

namespace s7200 {

struct Step {
  Bits bit;                                 ///< the S bit
  std::optional<std::uint32_t> segment;     ///< its LSCR; nothing: it has none
  std::vector<std::uint32_t> switched_on;   ///< by SCRT of other steps, S and coils
  std::vector<std::uint32_t> transitions;   ///< SCRT in its segment: they switch it off and another one on
  std::vector<std::uint32_t> switched_off;  ///< by R
  std::vector<std::uint32_t> written;       ///< with others: by a byte, a block, a word
  std::vector<std::uint32_t> actions;       ///< coils, boxes and calls in its segment
  std::vector<std::uint32_t> looked_at;     ///< contacts outside its segment
};

/// By the number of the bit; lists by op. Accesses through pointers are left out.
std::vector<Step> steps_of(const Facts& facts);

/// The S bit that a SCRT switches on.
Bits target_of_transition(const Op& transition);

}  // namespace s7200

// Slips of published listings: what they print, and what must have been meant.
//
// A listing is recognised by the names of its routines. Nothing is repaired unless it is asked for by its number.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/stl/ast.hpp"

namespace s7200 {

/// Places of a source where one slip is.
struct Slip {
  std::string_view id;       ///< `R1`
  std::string_view printed;  ///< an instruction
  std::string_view meant;    ///< what stands in its place; nothing: it is left out
  std::string_view reason;
  bool applied = false;
  std::vector<stl::Position> places;
};

/// The slips of a known listing that are in `source`; none in any other.
std::vector<Slip> find_slips(const stl::Source& source);

/// The slips that are to be repaired.
struct Repairs {
  bool all = false;
  std::set<std::string, std::less<>> ids{};

  bool has(std::string_view id) const { return all || ids.contains(id); }
  bool operator==(const Repairs&) const = default;
};

/// Reads `R1,R2`, `all` or `none`. Trouble if it is neither.
Result<Repairs> parse_repairs(std::string_view text);

/// Repairs what is asked for, and returns all slips of the source, the repaired ones marked. Ids that the source does not
/// have are put into `unknown`.
std::vector<Slip> repair(stl::Source& source, const Repairs& repairs, std::vector<std::string>& unknown);

/// `R4 in lines 163, 199: MOVB 26, VB174 is read as MOVB 16#26, VB174: …`
std::string to_text(const Slip& slip, const stl::Source& source);

}  // namespace s7200

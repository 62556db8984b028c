// Why a request of the simulated master got no answer, for reports: by every station that may be concerned, and which of
// many requests have the same cause.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

struct CauseOfNoAnswer {
  std::string text{};   ///< a line
  std::string power{};  ///< behind the contacts in it, as in TraceReasons::Cause
};

/// Their lines.
std::vector<std::string> texts_of(const std::vector<CauseOfNoAnswer>& causes);

/// The history stands where the master, on the line of `station`, has given the request up. One after the other, in a
/// system with the name of the station concerned in front: that which has the address in the request if the system file says
/// so, else each that may have. None: it is not known. Nothing after a stop request.
std::optional<std::vector<CauseOfNoAnswer>> causes_of_no_answer(History& history, std::size_t station,
                                                                std::span<const std::uint8_t> request, Time timeout,
                                                                StopToken stop_request);

/// Tells causes apart by what was done and by which contacts let power through, not by when it was, how many characters it
/// was about, or the values met.
class DifferentCauses {
 public:
  /// How many different causes came before the first one that is the same as this.
  std::size_t number_of(const std::vector<CauseOfNoAnswer>& causes);

 private:
  std::vector<std::string> known_{};
};

}  // namespace s7200::tools

// What decided that the program has come where it stands, and what has left a frame without an answer.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/trace/text/trace_lines.hpp"
#include "tools/session/past/history.hpp"
#include "tools/views/program/listing.hpp"

namespace s7200::tools {

struct LastDecision {
  Moment moment;  ///< in front of the jump or conditional end; or of what the contacts of this rung decide, and from there
                  ///< in front of the first of them
  std::string text;  ///< `JMP 255 in line 141 (LDW= AC0, 0: AC0=16#7B06; NOT)`
  InstructionRecord by{};
};

struct DecisionSearch {
  std::optional<LastDecision> decision;  ///< nothing: the scan, or the interrupt routine, has come by none so far
  /// Frames that have got no answer since the scan began, or since a request did that waits for an answer or has just been
  /// given up, whoever has asked; with a bridge the last one of two time-outs. First that another station was asked, then
  /// what the line has lost or damaged; then that the program has left them, or swallowed them, or that no routine got their
  /// characters. With the moment when that was decided; now for one that no routine has read so far.
  std::vector<TraceLine> unanswered{};
  /// What decided about the last of them; nothing if there is none, or if that is not known.
  std::optional<LastDecision> left{};
  /// When the line had lost or damaged the request or its answer; nothing if it did not, or if `why` was asked in an
  /// interrupt routine while somebody waits for an answer.
  std::optional<Time> lost_on_line{};
  bool interrupted = false;

  /// Where to go back to: in the main program to what left a frame, if one was; to nothing if the line alone is to blame.
  std::optional<LastDecision> origin() const { return left || lost_on_line ? left : decision; }

  /// Why there is nothing to go back to.
  std::string why_no_origin() const;
};

inline constexpr std::string_view kNothingDecided =
    "nothing has decided that it comes here: no contact, no jump, no conditional call or return so far; "
    "each scan does";

/// A line for each frame without an answer; none if nothing is known of one.
std::vector<std::string> cause_lines(const DecisionSearch& search);

/// A line for each frame without an answer and for the decision, or kNothingDecided; what was found if it was interrupted.
std::vector<std::string> to_lines(const DecisionSearch& search, const Listing& listing);

/// Of a station: the contacts of the rung so far, or the last jump, conditional end or conditional call before it. The
/// simulation stands where it stood. `host_timeout`: as of OpenRequests.
DecisionSearch find_last_decision(History& history, std::size_t station, Time host_timeout, StopToken stop_request);

}  // namespace s7200::tools

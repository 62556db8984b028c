// Upper bounds of times: of the scan, of each routine, from an event to the begin of its interrupt routine, and from a
// request to its answer.
//
// A bound is the longest way through the routine (longest_ways.hpp): each instruction with the most that it counts, each
// loop as often as it runs at most. Besides what is known on the way, that is known of FOR between constants, of FOR up to
// memory that instructions set to constants only, of FOR whose ends the instructions in front of it bound
// (reaching_values.hpp), if its passes leave its index alone; and of a FOR or a JMP backwards whose comment says so, `at
// most 8 times`, or of which the user says so. Nothing else is guessed: a loop without a bound is named, and the figure then
// holds for one pass through it.
//
// Times are those of a table, mostly estimates: the same program decoded with another table gives the bound for that one.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "interpreter/analysis/effects/facts.hpp"
#include "interpreter/analysis/flow/calls.hpp"

namespace s7200 {

/// How often loops run at most as the user says, above 0: by their FOR, or the JMP back.
using StatedLoops = std::map<std::uint32_t, std::int64_t>;

/// Whether an op is the FOR of a loop, or a JMP back.
bool is_loop(const Program& program, std::uint32_t op);

struct Bounds {
  /// A loop, and how often it runs at most; nothing if that is not known.
  struct Loop {
    enum class Open : std::uint8_t { WritesItsIndex, NoLimit, Jumps };  ///< why it is not

    std::uint32_t op = 0;  ///< its FOR, or the JMP back
    std::optional<std::int64_t> times{};
    std::optional<Open> open{};            ///< nothing: it is known, or the loop is never executed
    std::vector<std::uint32_t> copied{};   ///< if a FOR has no limit: the moves that its final value comes from
    std::vector<std::uint32_t> counted{};  ///< what counts the sources of these up
  };
  struct OfRoutine {
    Time time = 0;  ///< in ns, with the subroutines that it calls
    std::vector<std::uint32_t>
        loops;  ///< FOR and JMP without a bound, and CALLs of recursion, below it: each once in `time`
  };
  struct OfEvent {
    std::uint8_t event = 0;
    std::optional<Time> period{};        ///< the shortest time from one such event to the next; nothing: it is not known
    Time longest_routine = 0;            ///< of the routines attached to it, with the entry
    std::optional<Time> latency{};       ///< until its routine begins; nothing: there is no bound
    bool may_stay_disabled = false;      ///< because of that: a DISI or ATCH that no ENI surely follows in a known time
    std::vector<std::uint8_t> before{};  ///< or because of these, which may be served before it and come any number of times
    double load = 0;                     ///< the share of time that routines served up to then need; at 1 there is no bound
    bool may_be_lost = false;            ///< more may wait than its queue holds; `latency` is that of those that do
    std::vector<std::uint32_t> loops{};  ///< without a bound, in these routines
    std::vector<std::uint32_t> loops_before{};  ///< in those too on which `latency` depends
  };

  /// From the last character of a request at a port to the first of its answer. The one who asks waits for answers, so that
  /// no other character comes meanwhile; the program is past its first scan; and bits of the receiving routines that the
  /// main program looks at are off before.
  struct OfAnswer {
    std::uint8_t port = 0;
    std::optional<Time> time;               ///< nothing: there is no bound
    std::vector<std::uint32_t> loops;       ///< without a bound, on which it depends
    bool silence_is_known = true;           ///< how long the program waits after the last character
    std::vector<std::uint8_t> of_others{};  ///< events that are not of this answer and of which the period is not known
  };

  std::vector<OfRoutine> routines;  ///< in ControlFlow::routines
  std::vector<OfEvent> events;      ///< attached ones, in the order in which the CPU serves them
  std::vector<Loop> loops;          ///< all, by op
  std::vector<OfAnswer> answers;    ///< of ports at which the program receives and sends
  Time scan = 0;                    ///< without interrupts
  /// With as many interrupts as can come in it. As with OfEvent::latency, there is no bound if interrupts leave no time for
  /// it, if the period of an attached event is not known, or if they may stay disabled for good.
  std::optional<Time> scan_with_interrupts;
  std::vector<std::uint32_t> loops_of_interrupts;  ///< without a bound, in their routines and in the scan
  double load = 0;            ///< the share of time that all routines of events with a known period need
  bool enabled_late = false;  ///< ATCH may come before the first ENI, and nothing says how long before
  bool is_complete = true;    ///< false: whoever waited asked to end, and only the loops are known
};

/// `timed`: the program of `facts`, with the times to count with. `stated` counts before all that the program says.
Bounds bounds_of(const Facts& facts, const Calls& calls, const Program& timed, const StatedLoops& stated = {},
                 const Waiter& waiter = {});

}  // namespace s7200

// What is said when a run has come to a stop.
#pragma once

#include <cstdint>
#include <string>

#include "tools/session/commands/running.hpp"

namespace s7200::tools {

/// `errors`: how many run-time errors there were in it.
void report(Session& session, const Stop& stop, const RunTo& run, std::uint64_t errors);

/// Of breakpoints and watches: those that were hit, and those that were passed.
void report_hits(Session& session, const Stop& stop);

/// Why it has stopped, if nothing was hit and no goal met.
void report_reason(Session& session, const Stop& stop, const RunTo& run);

/// `answer   01 03 …`, as the master of `send` on the line of a station has got it.
std::string answer_text(const Session& session, std::size_t station, const serial::Exchange& exchange);

/// ` if VW2 > 8 hits 4`: what is set besides where a stop is, as it is written.
std::string option_words(const StopPoint& stop);

}  // namespace s7200::tools

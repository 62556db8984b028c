// Breakpoints and watches of a saved session.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/session/commands/session.hpp"

namespace s7200::tools {

/// Those that are set and can be set again by words; what an editor calls otherwise is its own affair.
std::vector<SessionFile::SavedStop> saved_stops(const Session& session);

/// Trouble if one of them cannot be set here.
Result<std::vector<StopPoint>> stops_of(const Session& session, const SessionFile& file);

/// Sets those that are not there already, each with its number if no other one has that. How many they are.
std::size_t add_loaded(Session& session, std::vector<StopPoint> stops);

}  // namespace s7200::tools

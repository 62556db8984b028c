// The past in words: how far it goes, moments as people write them, and names in a row.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools {

/// As parse_duration() takes them.
inline constexpr std::string_view kTimeUnits = "ns, us, ms, s, min or h";

/// `panel`, `panel and recorder`, `panel, recorder and pump`
std::string list_text(const std::vector<std::string>& names);

/// What the oldest moment is: `where this session powered the CPU up`, `before which what came over the bridge is forgotten:
/// 3 actions, more than 64 MB`.
std::string oldest_text(const History& history);

/// `since power-up`; `since 1234.500000 ms, where the past begins` if what was before is forgotten.
std::string since_oldest_text(const History& history);

/// What is said when it stands there.
std::string at_oldest_text(const History& history);

/// The moment that `15.193ms`, `-5ms`, `start` or `end` means, as its time; that of the oldest one for `start`. Trouble
/// if it is not one, or not one of this branch.
Result<Time> parse_moment(std::string_view text, const History& history);

/// To a time that parse_moment() has read: in front of the first instruction at or after it, or to the oldest moment. False
/// after a stop request; it stands where it stood then.
bool go_to_parsed(History& history, Time time);

}  // namespace s7200::tools

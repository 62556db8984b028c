// Who did it, and what decided it, as commands say it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tools/session/causes/why_not.hpp"
#include "tools/session/commands/reply.hpp"
#include "tools/session/commands/session.hpp"

namespace s7200::tools {

/// `= Q0.5 in line 12 and = Q0.5 in line 40`
std::string coils_text(const Program& program, const std::vector<std::uint32_t>& coils);

/// A line that says which instructions may still write a bit in the scan in which the CPU stands, after others did; empty if
/// there are none.
std::string to_come_text(const Session& session, const Bits& bit);

/// What is said of something that was looked for in the past.
struct FoundInPast {
  Reply reply;
  std::optional<Moment> moment{};  ///< to go back to; nothing if nothing was found
};

/// Who has written memory, which is called `name`, or attached an event: {"text": "…"}, and the instruction if it was one.
FoundInPast last_writer(Session& session, const MemoryRange& range, std::string_view name);
FoundInPast last_writer(Session& session, std::uint8_t event);

/// What decided that it has come where it stands: the same, and "whyNoMoment" where nothing is to go back to.
FoundInPast last_decider(Session& session);

/// Why memory is as it is: `Conveyor (Q0.1) is 0; last written at …`, and a line for each step further back.
Reply cause_of(Session& session, const MemoryRange& range, std::string_view name);

/// What is in the way of a wish: `Q0.3 is 0, must be 1`, and the tree of what holds it off; {"name": "Q0.3", "holds": false,
/// "whyNot": {…}}.
Reply obstacles_to(Session& session, const Wish& wish, bool all = false);

/// What came of the last change of memory before now, which is called `name`, at most for `within`; {"effect": {…}}, or
/// {"text": "…"} if nothing has changed it.
Reply effect_of(Session& session, const MemoryRange& range, std::string_view name, Time within);

/// What the CPU did since then: {"text": "…", "timeline": {…}}; `exchange` is what times are counted from.
Reply timeline_since(Session& session, Time from, const serial::Exchange& exchange);

/// What is wrong with a pointer that points nowhere, and who wrote it.
std::string bad_pointer_report(Session& session, const std::string& name, const MemoryRange& pointer);

}  // namespace s7200::tools

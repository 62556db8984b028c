// What `s7200 run` prints.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "tools/command/running/system_bridges.hpp"
#include "tools/host/pace.hpp"
#include "tools/rig/rig.hpp"

namespace s7200::tools {

/// How a run has ended; without a reason it could not begin.
struct Ending {
  std::string_view reason{};
  std::optional<Pace::Report> pace{};                               // of a run in real time
  std::map<const serial::SharedLine*, std::uint64_t> collisions{};  // of masters on bridges with what a PLC sent, by line

  std::uint64_t collisions_on(const serial::SharedLine* line) const {
    const auto found = collisions.find(line);
    return found == collisions.end() ? 0 : found->second;
  }
};

/// `bridges`: those of the plan, or the one that has joined a PROGRAM's line. `more`: further results of --json.
void print_text(const Rig& rig, const Ending& ending, Bridges bridges);
void print_json(const Rig& rig, const Ending& ending, Bridges bridges, const nlohmann::ordered_json& more);

/// The error that a run has ended with; empty if it is none.
std::string error_at_end(std::string_view reason, const Rig& rig);

/// Says that the run ended before some of the planned events.
void note_events_to_come(const Rig& rig);

}  // namespace s7200::tools

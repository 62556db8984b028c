// Races between the main program and interrupt routines (interpreter/analysis/races.hpp), each with an instant at which the
// word is lost, if one was found.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/analysis/races.hpp"
#include "tools/views/inspection/inspection.hpp"

namespace s7200::tools {

struct FoundRace {
  Race race;
  std::optional<LostWord> lost;
};

struct FoundRaces {
  std::vector<FoundRace> races;
  std::vector<NotFollowed> not_followed;
};

/// All of them, or those of memory or routines of the selection. Those that are suspected only if a run loses the word.
FoundRaces found_races(const Inspection& inspection);

/// All of them, or those of memory or routines of the selection.
std::string races_text(const Inspection& inspection);
nlohmann::ordered_json races_json(const Inspection& inspection);

/// The calls behind which no races were looked for, and why.
nlohmann::ordered_json not_followed_json(const Inspection& inspection);

}  // namespace s7200::tools

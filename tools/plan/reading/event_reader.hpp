// Reads the events that a system file or a scenario has for a running system.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "tools/plan/system_plan.hpp"
#include "tools/yaml/values.hpp"

namespace s7200::tools {

/// A word that says what is done in an event, and the keys that may stand beside it: `cut`, and `after`.
struct EventWord {
  std::string_view word;
  EventPlan::What what{};
  std::vector<std::string_view> beside{};
};
std::span<const EventWord> event_words();
const EventWord& word_of(EventPlan::What what);

/// Reads an event as it stands under `events`, but without its instant: `{power_off: slave}`. Nothing after a complaint.
std::optional<EventPlan> read_event(const YamlNode& node, const SystemPlan& plan, YamlValues& values);

/// Reads an event with its instant, as it stands under `events`.
std::optional<EventPlan> read_timed_event(const YamlNode& node, const SystemPlan& plan, YamlValues& values);

}  // namespace s7200::tools

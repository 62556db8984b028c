// What is done to a system, in words.
#pragma once

#include <string>
#include <vector>

#include "tools/plan/system_plan.hpp"

namespace s7200::tools {

/// The name of the station or line that an event happens to.
const std::string& name_of_subject(const EventPlan& event, const SystemPlan& plan);

/// An event in words: `power off`. `in_vain`: it was done to a PLC without power.
std::string event_text(const EventPlan& event, const SystemPlan& plan, bool in_vain);

/// An event in words, with whom it happens to: `slave2: power off`.
std::string named_event_text(const EventPlan& event, const SystemPlan& plan);

/// The events of a system in words, in their order: `slave2: power off`.
std::vector<std::string> event_texts(const SystemPlan& plan);

}  // namespace s7200::tools

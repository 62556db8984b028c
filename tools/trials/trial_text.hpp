// A trial for people and for machines.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/trials/trial.hpp"

namespace s7200::tools {

/// A line for each stimulus: `    1.250 s  I0.1 = 1`, `    2.000 s  sends 01 03 00 00`. Two that come again and again are in
/// three lines. `begun`: when, since power-up.
std::string trial_text(const Trial& trial, const std::vector<Time>& begun);

/// `at_ns` and `does`, as in the text.
nlohmann::ordered_json trial_json(const Trial& trial, const std::vector<Time>& begun);

}  // namespace s7200::tools

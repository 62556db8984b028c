// What is known of real CPUs, and whether it holds with a table of times: for people, and for machines.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "interpreter/model/cpu_model.hpp"
#include "tools/measuring/statements.hpp"

namespace s7200::tools {

bool any_fails(const std::vector<Statement>& statements);

std::string statements_text(const CpuModel& model, const std::string& table, const std::vector<Statement>& statements);
nlohmann::ordered_json statements_json(const std::vector<Statement>& statements);

}  // namespace s7200::tools

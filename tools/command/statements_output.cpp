#include "tools/command/statements_output.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text.hpp"

namespace s7200::tools {
namespace {

std::size_t count(const std::vector<Statement>& statements, Statement::Verdict verdict) {
  return static_cast<std::size_t>(std::ranges::count(statements, verdict, &Statement::verdict));
}

}  // namespace

bool any_fails(const std::vector<Statement>& statements) { return count(statements, Statement::Verdict::Fails) > 0; }

std::string statements_text(const CpuModel& model, const std::string& table, const std::vector<Statement>& statements) {
  std::string text = fmt::format("What is known of the times of CPU {}, with {}:\n", model.name, stl::printable(table));
  for (const Statement& each : statements) {
    static constexpr const char* kVerdicts[] = {"holds", "FAILS", "not checked"};
    text += fmt::format("  {:<11}  {}: {}   ({})\n", kVerdicts[static_cast<std::size_t>(each.verdict)], each.says,
                        each.found, each.source);
  }
  text += fmt::format("{} hold, {} fail", count(statements, Statement::Verdict::Holds),
                      count(statements, Statement::Verdict::Fails));
  if (const auto left = count(statements, Statement::Verdict::NotChecked)) text += fmt::format(", {} not checked", left);
  return text + '\n';
}

nlohmann::ordered_json statements_json(const std::vector<Statement>& statements) {
  auto json = nlohmann::ordered_json::array();
  for (const Statement& each : statements) {
    static constexpr const char* kVerdicts[] = {"holds", "fails", "not_checked"};
    json.push_back({{"statement", each.says},
                    {"source", each.source},
                    {"found", each.found},
                    {"verdict", kVerdicts[static_cast<std::size_t>(each.verdict)]}});
  }
  return json;
}

}  // namespace s7200::tools

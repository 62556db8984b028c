#include "tools/command/timing/statements_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/measuring/statements.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

/// By Verdict.
struct VerdictName {
  const char *text, *key;
};
constexpr VerdictName kVerdictNames[] = {{"holds", "holds"}, {"FAILS", "fails"}, {"not checked", "not_checked"}};

const VerdictName& name_of(Statement::Verdict verdict) { return kVerdictNames[static_cast<std::size_t>(verdict)]; }

std::size_t count(const std::vector<Statement>& statements, Statement::Verdict verdict) {
  return static_cast<std::size_t>(std::ranges::count(statements, verdict, &Statement::verdict));
}

bool any_fails(const std::vector<Statement>& statements) { return count(statements, Statement::Verdict::Fails) > 0; }

std::string statements_text(const CpuModel& model, const std::string& table, const std::vector<Statement>& statements) {
  std::string text = fmt::format("What is known of the times of CPU {}, with {}:\n", model.name, stl::printable(table));
  for (const Statement& each : statements) {
    text += fmt::format("  {:<11}  {}: {}   ({}{})\n", name_of(each.verdict).text, each.says, each.found, each.source,
                        each.fitted ? "; the table was fitted to it" : "");
  }
  text += fmt::format("{} hold, {} fail", count(statements, Statement::Verdict::Holds),
                      count(statements, Statement::Verdict::Fails));
  if (const auto left = count(statements, Statement::Verdict::NotChecked)) text += fmt::format(", {} not checked", left);
  return text + '\n';
}

nlohmann::ordered_json statements_json(const std::vector<Statement>& statements) {
  auto json = nlohmann::ordered_json::array();
  for (const Statement& each : statements) {
    json.push_back({{"statement", each.says},
                    {"source", each.source},
                    {"found", each.found},
                    {"verdict", name_of(each.verdict).key},
                    {"fitted", each.fitted}});
  }
  return json;
}

}  // namespace

std::optional<SourceText> read_tip41(const std::string& path) {
  auto text = read_program_text(path);
  if (!text || is_tip41(*text)) return text;
  print_error(fmt::format("--tip41: {} is not Application Tip 41: it has other routines", path));
  return {};
}

int check_table(const CpuModel& model, const std::string& table, const std::string& tip41_path, bool json) {
  const auto tables = load_all({table}, model);
  if (!tables) return kUnusable;
  std::optional<SourceText> tip41;
  if (!tip41_path.empty() && !(tip41 = read_tip41(tip41_path))) return kUnusable;
  const auto statements = check_statements(model, tables->front().times, tip41 ? &*tip41 : nullptr);
  if (json) {
    auto results = results_of("times");
    results["cpu"] = model.name;
    results["statements"] = statements_json(statements);
    fmt::print("{}", lines_of(results));
  } else {
    print_report(statements_text(model, table, statements));
  }
  if (statements.empty()) print_note(fmt::format("nothing is known of the times of CPU {}", model.name));
  return any_fails(statements) ? kCheckFailed : kFine;
}

}  // namespace s7200::tools

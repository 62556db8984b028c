#include "interpreter/program/ladder/networks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace s7200 {
namespace {

std::vector<std::string> routines_of(const Program& program) {
  std::vector<std::string> routines;
  std::string routine = "main";
  for (const Op& op : program.ops) {
    if (op.instruction->structure == Structure::SubroutineHead) routine = fmt::format("SBR {}", op[0].at);
    if (op.instruction->structure == Structure::InterruptHead) routine = fmt::format("INT {}", op[0].at);
    routines.push_back(routine);
  }
  return routines;
}

/// The numbers of the NETWORK lines, each for the instruction in front of which it stands.
std::vector<std::optional<std::uint32_t>> heads_of(const Program& program) {
  std::vector<std::optional<std::uint32_t>> heads;
  std::optional<std::uint32_t> number;
  for (const stl::Line& line : program.source.lines) {
    if (const auto* head = std::get_if<stl::NetworkHead>(&line)) number = head->number;
    if (std::holds_alternative<stl::Statement>(line)) heads.push_back(std::exchange(number, std::nullopt));
  }
  heads.resize(program.ops.size());
  return heads;
}

}  // namespace

bool is_box_or_coil(const Op& op) { return op.instruction->rung.needs_power_flow || op.instruction->rung.writes_output; }

bool depends_on_power_flow(const Op& op) { return is_box_or_coil(op) && op.instruction->rung.stack.needs > 0; }

bool begins_rung(const Program& program, std::uint32_t op) {
  return op > 0 && is_box_or_coil(program.ops[op - 1]) && program.ops[op].instruction->mnemonic.starts_with("LD");
}

Networks::Networks(const Program& program) : routine_(routines_of(program)) {
  const auto heads = heads_of(program);
  const bool has_heads = std::ranges::any_of(heads, [](const auto& head) { return head.has_value(); });
  std::uint32_t first = 0;
  for (std::uint32_t op = 0; op < heads.size(); ++op) {
    const bool begins = heads[op] || op == 0 || routine_[op] != routine_[op - 1] || (!has_heads && begins_rung(program, op));
    if (begins) first = op;
    first_.push_back(first);
    number_.push_back(heads[op].value_or(0));
  }
}

}  // namespace s7200

#include "tools/slave/peer_lines.hpp"

#include <fmt/format.h>

namespace s7200::tools {

PeerLines::PeerLines(const SystemPlan& plan, std::size_t first, const serial::MasterSettings& master, Time after,
                     const std::string& path, StopToken stop)
    : path_(path), here_(first) {
  RigSurroundings surroundings{.path = path, .stop = stop};
  for (std::size_t line = 0; line < plan.lines.size(); ++line)
    if (why_no_other_plc(plan, line).empty()) surroundings.lines.push_back(line);
  std::vector<std::string> problems;
  rig_ = Rig::assemble(plan, surroundings, problems);
  if (!rig_) throw SlaveUnreachable(problems.empty() ? "interrupted" : problems.front());
  for (const std::size_t line : surroundings.lines) {
    const serial::LineSettings settings = on_line(master, plan.lines[line]);
    masters_.try_emplace(line, rig_->system(), *rig_->requester(line),
                         settings.over(format_without_s7200(plan, plan.lines[line])));
  }
  rig_->power_up();
  wait(after == kNever ? pause() : after);
}

std::string PeerLines::name() const { return fmt::format("{}: line {}", path_, rig_->plan().lines[here_].name); }

}  // namespace s7200::tools

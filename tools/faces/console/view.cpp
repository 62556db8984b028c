#include "tools/faces/console/view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/session/commands/answers/status.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/session/commands/running.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr std::uint32_t kOpsInView = 7, kOpsBefore = 3;

}  // namespace

View::Shown View::around(Session& session) {
  const auto ops = static_cast<std::uint32_t>(session.program().ops.size());
  const std::uint32_t at = session.current_op().value_or(0), first = at - std::min(at, kOpsBefore);
  const std::uint32_t end = std::min(ops, first + kOpsInView);
  return {first, end, last_executions_of(session, first, end)};
}

void View::run_begins(Session& session) { live_ = around(session); }

void View::note(const Session& session, const InstructionRecord& record) {
  if (live_ && record.op >= live_->first && record.op < live_->end)
    live_->last.of[record.op] = execution_of(record, session.cpu());
}

std::vector<std::string> View::lines(Session& session, std::size_t rows) const {
  const std::size_t focus = session.focus();
  std::vector<std::string> lines{session.said_of(focus) + place_line(session, focus)};
  const Shown shown = live_ ? *live_ : around(session);
  for (std::string& line : status_lines(session, shown.first, shown.end, shown.last)) lines.push_back(std::move(line));
  lines.resize(kOpsInView + 1);
  std::string memory;
  for (const auto& [station, range] : session.displayed)
    memory += session.said_of(station) + memory_text(session, station, range);
  if (session.displayed.empty())
    memory = registers_text(session.cpu(), session.listing()) + "'display VW100' shows memory here\n";
  for (std::string& line : stl::split_lines(memory)) lines.push_back(std::move(line));
  if (lines.size() <= rows) return lines;
  const std::size_t hidden = lines.size() - rows + 1;
  lines.resize(rows - 1);
  lines.push_back(fmt::format("… {} more lines; '{}' prints all", hidden, session.displayed.empty() ? "regs" : "display"));
  return lines;
}

}  // namespace s7200::tools

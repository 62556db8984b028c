#include "tools/session/causes/last/passed_over.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/trace/text/statement_text.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kMostCallsFollowed = 4;  // of a subroutine that another one calls

bool is_jump(const Op& op) {
  return op.instruction->structure == Structure::Jump || op.instruction->structure == Structure::SegmentExit;
}

}  // namespace

std::string RungReader::at_text(const Passed& passed) {
  const std::string contacts = passed.contacts.empty() ? "" : fmt::format(" ({})", passed.contacts);
  return fmt::format("at {}{}", moment_text(passed.at), contacts);
}

void RungReader::instruction(const InstructionRecord& record) {
  const Op& op = program_.ops[record.op];
  if (!record.powered)
    without_power_[record.op] = {record.at, reasons.contacts()};
  else if (is_jump(op) || op.instruction->effect == Effect::ConditionalEnd)
    taken_[record.op] = {record.at, reasons.contacts()};
  else if (op.instruction->structure == Structure::For || op.instruction->structure == Structure::Call)
    entered_.insert(record.op);
  reasons.note(record);
}

bool RungReader::leads_past(std::uint32_t by, std::uint32_t op) const {
  const bool jumps = is_jump(program_.ops[by]);
  return by < op && flow_.nodes[by].routine == flow_.nodes[op].routine && (!jumps || program_.ops[by].target > op);
}

const RungReader::Way* RungReader::last_way_past(std::uint32_t op) const {
  const Way* last = nullptr;
  for (const Way& taken : taken_)
    if (leads_past(taken.first, op) && (!last || last->second.at <= taken.second.at)) last = &taken;
  return last;
}

std::string RungReader::what_kept(std::uint32_t op, std::size_t calls) const {
  const auto passed = without_power_.find(op);
  const bool was_passed = passed != without_power_.end();
  const Way* const way = last_way_past(op);
  if (was_passed && (!way || way->second.at < passed->second.at))
    return fmt::format("had no power flow {}", at_text(passed->second));
  const std::string when = was_passed ? "after " + moment_text(passed->second.at) : "lately";
  std::string by = way ? text_of(*way) : loop_without_pass(op);
  if (by.empty()) by = what_calls(flow_.routine_of(op).first, calls);
  return fmt::format("was not executed {}{}", when, by.empty() ? "" : ": " + by);
}

std::string RungReader::text_of(const Way& way) const {
  const bool in_main = flow_.routine_of(way.first).kind == Routine::Kind::Main;
  const std::string_view ended = in_main ? "ended the scan in front of" : "ended the routine in front of";
  return fmt::format("{} {} it {}", named_without_comment(way.first, program_),
                     is_jump(program_.ops[way.first]) ? "jumped over" : ended, at_text(way.second));
}

/// Of the loops around an op the outermost one that began.
std::string RungReader::loop_without_pass(std::uint32_t op) const {
  for (const std::uint32_t loop : entered_)
    if (program_.ops[loop].instruction->structure == Structure::For && loop < op && op < program_.ops[loop].target)
      return fmt::format("{} ran no pass", named_without_comment(loop, program_));
  return {};
}

/// Empty if one of its CALLs was made: then something else has kept its instruction from being executed.
std::string RungReader::what_calls(std::uint32_t head, std::size_t calls) const {
  const Op& routine = program_.ops[head];
  if (routine.instruction->structure == Structure::InterruptHead) return fmt::format("INT {} did not run", routine[0].at);
  if (routine.instruction->structure != Structure::SubroutineHead || calls == kMostCallsFollowed) return {};
  const auto calls_it = [&](std::uint32_t op) {
    return program_.ops[op].instruction->structure == Structure::Call && program_.ops[op].target == head;
  };
  if (std::ranges::any_of(entered_, calls_it)) return {};
  for (std::uint32_t op = 0; op < program_.ops.size(); ++op)
    if (calls_it(op))
      return fmt::format("{} {}", named_without_comment(op, program_), what_kept(op, calls + 1));
  return fmt::format("nothing calls SBR {}", routine[0].at);
}

}  // namespace s7200::tools

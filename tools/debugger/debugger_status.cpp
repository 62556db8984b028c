// The command status: the program with what each instruction last did beside it, as Micro/WIN's STL status shows it.
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "interpreter/base/text.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/session/observers/last_executions.hpp"
#include "tools/views/execution_text.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr std::uint32_t kShown = 15, kBefore = 6;

constexpr std::uint32_t kOpsInView = 7, kOpsBefore = 3;

}  // namespace

LastExecutions Debugger::last_executions_of(std::uint32_t first, std::uint32_t end) {
  return last_executions(history_, focus(), first, end, kLookedAt, options_.stop_request);
}

/// A line for each instruction of [first, end), as it was executed last.
std::vector<std::string> Debugger::status_lines(std::uint32_t first, std::uint32_t end, const LastExecutions& last) {
  const Program& program = simulation().cpu().program();
  const std::string not_found = last.interrupted
                                    ? "interrupted while it was looked for"
                                    : "not executed within " + format_duration(simulation().time() - last.since);
  std::vector<std::string> lines;
  for (std::uint32_t op = first; op < end; ++op) {
    const auto found = last.of.find(op);
    lines.push_back(fmt::format("{:>2} {}{}", mark_of(op),
                                found != last.of.end() ? execution_text(found->second, program)
                                                       : fmt::format("line {:<5} {:<28} {}", listing().line_of(op),
                                                                     stl::to_text(program.statement(op)), not_found),
                                forced_text(simulation().cpu(), operands_of(op))));
  }
  return lines;
}

Debugger::Error Debugger::status(const Arguments& arguments) {
  std::string why;
  const auto place = arguments.empty() ? current_op() : find_place(arguments, "status", why);
  if (!why.empty()) return why;
  const auto ops = static_cast<std::uint32_t>(simulation().cpu().program().ops.size());
  const std::uint32_t at = place.value_or(0);
  const std::uint32_t first = arguments.empty() ? at - std::min(at, kBefore) : at;
  const bool network = !arguments.empty() && stl::upper_case(arguments[0]).starts_with("NETWORK");
  std::uint32_t end = first;
  while (end < std::min(ops, first + kShown) && (end == first || !network || !listing().begins_network(end))) ++end;
  for (const std::string& line : status_lines(first, end, last_executions_of(first, end))) out_ << line << '\n';
  return {};
}

std::pair<std::uint32_t, std::uint32_t> Debugger::ops_in_view() const {
  const auto ops = static_cast<std::uint32_t>(simulation().cpu().program().ops.size());
  const std::uint32_t at = current_op().value_or(0), first = at - std::min(at, kOpsBefore);
  return {first, std::min(ops, first + kOpsInView)};
}

/// A run begins: what is in view then stays there.
void Debugger::begin_live_status() {
  live_status_.reset();
  if (!is_in_view()) return;
  const auto [first, end] = ops_in_view();
  live_status_ = LiveStatus{.first = first, .end = end, .last = last_executions_of(first, end)};
}

void Debugger::note_live_status(const InstructionRecord& record) {
  if (record.op >= live_status_->first && record.op < live_status_->end)
    live_status_->last.of[record.op] = execution_of(record, simulation().cpu());
}

std::vector<std::string> Debugger::view(std::size_t rows) {
  const Cpu& cpu = simulation().cpu();
  std::vector<std::string> lines{said_of(focus()) + place_line(focus())};
  const auto [op, end_op] = live_status_ ? std::pair(live_status_->first, live_status_->end) : ops_in_view();
  const LastExecutions last = live_status_ ? live_status_->last : last_executions_of(op, end_op);
  for (std::string& line : status_lines(op, end_op, last)) lines.push_back(std::move(line));
  lines.resize(kOpsInView + 1);
  std::string memory;
  for (const auto& [station, range] : displayed_) memory += said_of(station) + memory_text(station, range);
  if (displayed_.empty()) memory = registers_text(cpu, listing()) + "'display VW100' shows memory here\n";
  for (std::string& line : stl::split_lines(memory)) lines.push_back(std::move(line));
  if (lines.size() <= rows) return lines;
  const std::size_t hidden = lines.size() - rows + 1;
  lines.resize(rows - 1);
  lines.push_back(fmt::format("… {} more lines; '{}' prints all", hidden, displayed_.empty() ? "regs" : "display"));
  return lines;
}

/// The memory of the direct operands of an instruction.
std::vector<Bits> Debugger::operands_of(std::uint32_t number) const {
  const Op& op = simulation().cpu().program().ops[number];
  const auto rules = op.instruction->rules();
  std::vector<Bits> all;
  for (std::size_t i = 0; i < rules.size(); ++i) {
    if (rules[i].kind != OperandKind::Memory || op[i].pointer) continue;
    const bool point = op[i].at >= image::kInputs && op[i].at < image::kInputs + image::kPointBytes;
    const std::uint64_t at = point ? op[i].at - image::kInputs + image::kI : op[i].at;
    const bool bit = rules[i].width == Width::Bit;
    all.push_back({at * 8 + (bit ? op[i].bit : 0), bit ? 1 : std::uint64_t{8} * s7200::bytes_of(rules[i].width)});
  }
  return all;
}

}  // namespace s7200::tools

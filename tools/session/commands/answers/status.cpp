#include "tools/session/commands/answers/status.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/session/commands/memory_words.hpp"
#include "tools/views/program/execution_text.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

/// The memory of the direct operands of an instruction.
std::vector<Bits> operands_of(const Session& session, std::uint32_t number) {
  const Op& op = session.program().ops[number];
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

/// The values of an instruction's operands as it found or left them, in the types that it takes them for.
Json values_json(const InstructionRecord& record, const Op& op) {
  Json values = Json::array();
  const auto rules = op.instruction->rules();
  for (std::size_t i = 0; i < rules.size(); ++i) {
    if (!record.value[i])
      values.push_back(nullptr);
    else if (rules[i].real)
      values.push_back(real_json(std::bit_cast<float>(*record.value[i])));
    else if (rules[i].width == Width::Word)
      values.push_back(static_cast<std::int16_t>(*record.value[i]));
    else if (rules[i].width == Width::Double)
      values.push_back(static_cast<std::int32_t>(*record.value[i]));
    else
      values.push_back(*record.value[i]);
  }
  return values;
}

}  // namespace

LastExecutions last_executions_of(Session& session, std::uint32_t first, std::uint32_t end) {
  return last_executions(session.history, session.focus(), first, end, kLookedAt, session.setup.stop_request);
}

std::vector<std::string> status_lines(const Session& session, std::uint32_t first, std::uint32_t end,
                                      const LastExecutions& last) {
  const Program& program = session.program();
  const std::string not_found = last.interrupted
                                    ? "interrupted while it was looked for"
                                    : "not executed within " + format_duration(session.simulation().time() - last.since);
  std::vector<std::string> lines;
  for (std::uint32_t op = first; op < end; ++op) {
    const auto found = last.of.find(op);
    lines.push_back(fmt::format("{:>2} {}{}", mark_of(session, op),
                                found != last.of.end()
                                    ? execution_text(found->second, program)
                                    : fmt::format("{:<10} {:<28} {}", stl::printable(line_of(op, program)),
                                                  stl::to_text(program.statement(op)), not_found),
                                forced_text(session, session.cpu(), operands_of(session, op))));
  }
  return lines;
}

Json status_json(const Session& session, const LastExecutions& last) {
  Json lines = Json::array();
  for (const auto& [op, execution] : last.of) {
    const std::string text = describe(execution, session.program());
    const std::size_t values = text.find("S0=");
    lines.push_back({{"op", op},
                     {"line", session.listing().line_of(op)},
                     {"at_ns", execution.record.at},
                     {"powerFlow", execution.record.powered},
                     {"top", execution.record.top},
                     {"values", values_json(execution.record, session.program().ops[op])},
                     {"text", values == std::string::npos ? text : text.substr(values)}});
  }
  return {{"lines", lines}, {"since_ns", last.since}};
}

std::string mark_of(const Session& session, std::uint32_t op) {
  const bool breakpoint = std::ranges::any_of(session.stepper.stops(), [&](const StopPoint& s) {
    return s.on == StopPoint::On::Place && s.op == op && s.station == session.focus();
  });
  return std::string(breakpoint ? "*" : " ") + (op == session.current_op() ? session.bold(">") : " ");
}

}  // namespace s7200::tools

#include "tools/session/commands/instruction_words.hpp"

#include <fmt/format.h>

#include "interpreter/base/text/text.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "interpreter/trace/text/text_trace.hpp"

namespace s7200::tools {

std::string op_text(const Program& program, const Listing& listing, std::uint32_t op) {
  return fmt::format("{} {}: {}", listing.routine_of(op), stl::printable(line_of(op, program)), listing.text_of(op));
}

Json instruction_json(const Session& session, const InstructionRecord& record) {
  return {{"instruction", execution_text(record, session.program())},
          {"routine", session.listing().routine_of(record.op)},
          {"op", record.op}};
}

Json execution_json(const Session& session, const Execution& execution) {
  return {{"time", clock_text(execution.record.at)},
          {"routine", session.listing().routine_of(execution.record.op)},
          {"text", execution_text(execution, session.program())},
          {"op", execution.record.op}};
}

}  // namespace s7200::tools

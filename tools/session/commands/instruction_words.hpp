// Instructions of the program, by their numbers, and what they did.
#pragma once

#include <cstdint>
#include <string>

#include "interpreter/trace/trace.hpp"
#include "tools/session/commands/reply.hpp"
#include "tools/session/commands/session.hpp"
#include "tools/views/program/execution_text.hpp"

namespace s7200::tools {

/// `INT 123 line 40: MOVB SMB2, VB1 // …`
std::string op_text(const Program& program, const Listing& listing, std::uint32_t op);

/// {"instruction": "…", "routine": "INT 123", "op": 40}: one that was executed. A face that has other words for a place puts
/// them for `op`.
Json instruction_json(const Session& session, const InstructionRecord& record);

/// {"time": "15.193 ms", "routine": "INT 123", "text": "…", "op": 40}
Json execution_json(const Session& session, const Execution& execution);

}  // namespace s7200::tools

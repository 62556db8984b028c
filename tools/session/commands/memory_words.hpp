// Memory as people name it at a prompt, and what is said of it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/session/commands/reply.hpp"
#include "tools/session/commands/session.hpp"
#include "tools/session/past/actions/access.hpp"

namespace s7200::tools {

struct NamedRange {
  MemoryRange range;
  std::string name;
};

/// An address, or the one that a pointer holds now, which is said. Trouble if it is none.
Result<NamedRange> find_range(Session& session, const std::string& text);

/// The only address that a command takes.
Result<NamedRange> one_range(Session& session, const Words& arguments, std::string_view command);

/// All that a command takes. Returns what is wrong; empty if nothing is.
std::string ranges_of(Session& session, const Words& arguments, std::string_view command, std::vector<NamedRange>& ranges);

/// `VW100 (Speed)`, or as it was written.
std::string address_name(const Program& program, const MemoryRange& range, std::string_view written);

/// An instruction that a command names by its place; a line that stands for the next one is said. Trouble when
/// there is no such place.
Result<std::uint32_t> find_op(Session& session, const Words& arguments, std::string_view command);

/// Puts addresses for the names of variables of the block of an instruction (`#level`), and says which. Returns what is
/// wrong; empty if nothing is.
std::string with_local_variables(Session& session, Words& words, std::optional<std::uint32_t> op);

/// Memory of a station with its symbol, and with what of it is forced.
std::string memory_text(const Session& session, std::size_t station, const MemoryRange& range);

/// A line of what of it is forced, and of what the program has there if that differs; or nothing.
std::string forced_line(const Session& session, const Cpu& cpu, const MemoryRange& range);

/// `  forced: VW10=5`, or nothing.
std::string forced_text(const Session& session, const Cpu& cpu, const std::vector<Bits>& places);

/// `16#05 (5)`
std::string value_of(const Cpu& cpu, const MemoryRange& range);

}  // namespace s7200::tools

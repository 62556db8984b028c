// What the commands of the debugger have in common when they read their arguments.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace s7200::tools {

/// The words with a blank between them.
std::string joined(const std::vector<std::string>& words);

/// The parts of `VW10,VW20`, without the blanks around them. A comma in quotes stays; between `assignments`,
/// `VW10=4,VW12=5`, so does one that no assignment follows.
std::vector<std::string> parts_between_commas(std::string_view text, bool assignments);

/// `VW100 = 5` is written with or without blanks, `VW 100=5` with one in the address, and `VW10=4,VW12=5` with a comma.
std::vector<std::string> assignments_of(const std::vector<std::string>& arguments);

/// `break expects a line number`
std::string expects(std::string_view command, std::string_view what);

/// `regs takes no argument`
std::string no_argument(std::string_view command);

/// `pump is without power; 'power on' brings it back`
std::string without_power_text(std::string_view plc);

/// The optional `[n]` of a command: 1 when it is not there, nothing when it is not a number above 0 or more follows.
std::optional<std::uint32_t> parse_count(const std::vector<std::string>& arguments);

/// The number in `event 8`; nothing if the words are something else.
std::optional<std::uint8_t> event_of(const std::vector<std::string>& words);

/// What `who event …` says without the number of an event; the command is left out if it has no name.
std::string expects_event(std::string_view command, const std::vector<std::string>& words);

/// Of a step by interrupts: whether to its end. Its begin is meant if nothing is said; nothing for other words.
std::optional<bool> wants_end(const std::vector<std::string>& arguments);
inline constexpr std::string_view kBeginsOrEnds = "nothing, begins or ends";

}  // namespace s7200::tools

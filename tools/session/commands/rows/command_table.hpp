// The table of commands: what they are called, what they take, what they mean, and what they do.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/result.hpp"
#include "tools/session/commands/reply.hpp"
#include "tools/session/commands/session.hpp"

namespace s7200::tools {

/// What the words after a command may become.
enum class Takes : std::uint8_t {
  Nothing,
  Addresses,
  Values,   ///< addresses, of which a wrong one does not end it
  Writers,  ///< what has a last write, or an attachment
  Break,
  Watch,
  Forced,     ///< what can be forced
  ForcedNow,  ///< what is forced
  Places,
  Goals,    ///< a place, or what is to hold
  Wishes,   ///< an address, or what is to hold
  Changes,  ///< an address, and of which moment
  Files,
  Sessions,
  Faults,
  Commands,
  Moments,
  Power,
  Stations
};

struct CommandRow {
  std::string_view name, short_form, syntax, meaning, more;
  Reply (*run)(Session& session, const Words& words);
  Takes takes = Takes::Nothing;
  bool repeats = false;         ///< it makes sense to give it again
  std::string_view words = "";  ///< besides, that the first of them may be

  bool takes_words() const { return syntax != name; }
};

/// In the order of the help.
const std::vector<CommandRow>& command_table();
std::vector<std::string> command_names();

/// By its name, its short form, or the beginning of its name. Trouble if there is none or more than one.
Result<const CommandRow&> find_command(std::string_view word);

/// The list of all commands, and what is worth knowing of them, in lines of any length.
std::string commands_help();

/// The commands of a line, which `;` separates; none of a comment, which begins with `//`, or with `#` at its beginning.
std::vector<std::string> commands_in(std::string_view line);

/// The words of one.
Words command_words(std::string_view command);

/// Executes one command, `command` being its words with its name. What it says is in the reply, but for what whoever looks
/// on was told while it went on.
Reply execute(Session& session, Words command);

}  // namespace s7200::tools

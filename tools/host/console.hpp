// The terminal at which the command was started; on Windows its console.
#pragma once

#include <cstddef>
#include <cstdint>

namespace s7200::tools {

enum class Standard : std::uint8_t { Input, Output, Error };

/// Whether a standard stream is a terminal.
bool is_terminal(Standard stream);

/// Whether it is one that knows control sequences (ECMA-48).
bool knows_control_sequences(Standard stream);

struct TerminalSize {
  std::size_t columns = 0, rows = 0;  ///< 0: not known
};

/// The size of the terminal that standard output is.
TerminalSize terminal_size();

}  // namespace s7200::tools

// Programs whose symbol table cannot be read.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/operands/operands.hpp"
#include "tools/command/terminal/terminal.hpp"

namespace s7200::tools {

/// Where a file cannot be read: whether a program has names that no table defines, which is said instead of errors about
/// them.
inline bool note_unread_symbols(const std::string& path, const CheckResult& result) {
  const auto& all = result.diagnostics;
  if (std::ranges::find(all, kUndefinedSymbols, &stl::Diagnostic::cause) == all.end()) return false;
  print_note(fmt::format("{} is not checked: its symbols may be in a file that cannot be read", path));
  return true;
}

}  // namespace s7200::tools

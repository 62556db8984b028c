// What `convert` writes: the program, and the symbol table that it needs.
#pragma once

#include <string>

#include "tools/command/options/plc/program_options.hpp"

namespace s7200::tools {

struct ConvertOptions {
  ProgramOptions program;
  std::string notation, output, encoding = "UTF-8";
  bool force = false, json = false;

  bool to_file() const { return !output.empty() && output != "-"; }
};

/// Prints or writes `text`, which is `source` in the notation of the options. Returns the exit code, after a message if it is
/// not kFine.
int write_converted(const ConvertOptions& options, const SourceText& source, const std::string& text);

}  // namespace s7200::tools

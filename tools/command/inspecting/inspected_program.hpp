// A program of the command line as `s7200 inspect` looks into it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/command/options/plc/tables_by_cpu.hpp"
#include "tools/views/inspection/inspect_views.hpp"

namespace s7200::tools {

/// A view of a program, and what it is to keep to: addresses, symbols, routines and networks.
struct Question {
  const InspectView& view;
  const std::vector<std::string>& about;
};

/// What is known of a program. Its errors are printed, and what they are in is left out. Null after messages if nothing is
/// known: `exit_code` says how to end.
std::shared_ptr<const Program> known_program(const CpuOptions& options, ProgramFiles& file, TablesByCpu& tables,
                                             int& exit_code);

/// `file` and the tables must live as long as what is returned. Errors of the program are printed, and what they are in is
/// left out. Nothing after messages, if the program or what is asked for is unknown: `exit_code` says how to end.
std::optional<Inspection> inspected(const CpuOptions& options, ProgramFiles& file, const Question& question,
                                    TablesByCpu& tables, const Waiter& waiter, int& exit_code);

}  // namespace s7200::tools

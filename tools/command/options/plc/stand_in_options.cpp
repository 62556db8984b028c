#include "tools/command/options/plc/stand_in_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "interpreter/program/loading/stand_ins.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/terminal/terminal.hpp"

namespace s7200::tools {

void add_no_stand_ins_option(CLI::App& app, bool& refused) {
  app.add_flag(kNoStandIns, refused,
               "refuse a program that calls MBUS_INIT, MBUS_MSG … and does not have them, instead of using stand-ins");
}

void refuse_stand_ins(CheckResult& result) {
  for (const StandIn& stand_in : stand_ins_of(result.source)) {
    result.diagnostics.push_back(refusal(stand_in));
    result.program.reset();
  }
  stl::sort(result.diagnostics);
}

bool accept_stand_ins(const Program& program, bool refused) {
  stl::Diagnostics errors;
  for (const StandIn& stand_in : stand_ins_of(program.source)) {
    if (refused)
      errors.push_back(refusal(stand_in));
    else
      print_note(fmt::format("{}: {}", program.source.name, to_text(stand_in)));
  }
  print_diagnostics(errors, program.source);
  return errors.empty();
}

}  // namespace s7200::tools

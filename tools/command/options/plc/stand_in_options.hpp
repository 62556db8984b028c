// Stand-ins for libraries of Micro/WIN (program/loading/stand_ins.hpp): who has them is told, and who wants none gets none.
#pragma once

#include "interpreter/analysis/warnings/check.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

inline constexpr const char* kNoStandIns = "--no-stand-ins";

/// --no-stand-ins.
void add_no_stand_ins_option(CLI::App& app, bool& refused);

/// Makes errors of the stand-ins of a program.
void refuse_stand_ins(CheckResult& result);

/// Says in a note which stand-ins a program has; if they are `refused`, in errors. False after errors.
bool accept_stand_ins(const Program& program, bool refused);

}  // namespace s7200::tools

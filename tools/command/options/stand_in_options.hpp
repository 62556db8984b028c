// Stand-ins for libraries of Micro/WIN (program/stand_ins.hpp): who has them is told, and who wants none gets none.
#pragma once

#include "interpreter/program/checker.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

inline constexpr const char* kNoStandIns = "--no-stand-ins";

/// --no-stand-ins is a setting of the whole command, as its colours are: it holds for every program that is loaded.
void add_no_stand_ins_option(CLI::App& app);
bool stand_ins_refused();

/// Makes errors of the stand-ins of a program if none are wanted.
void refuse_stand_ins(CheckResult& result);

/// Says in a note which stand-ins a program has. False after errors if none are wanted.
bool accept_stand_ins(const Program& program);

}  // namespace s7200::tools

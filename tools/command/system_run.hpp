// `s7200 run` with a system file, or a simulated PLC of another make, instead of a program.
#pragma once

#include "tools/command/options/run_options.hpp"
#include "tools/rig/system_reader.hpp"

namespace s7200::tools {

/// For the end of the help.
inline constexpr const char* kAboutSystems =
    "A system file (.yaml) instead of a PROGRAM runs any number of PLCs and lines; --keys says what may stand in it, and\n"
    "--trace then has all PLCs, with the name of each beside its lines:\n"
    "s7200 run stl_programs/systems/two_masters.yaml --for 2s\n";

inline constexpr const char* kAboutOtherPlcs =
    "westinghouse:MODEL instead of a PROGRAM is a simulated PLC of that family, alone on its line, for whoever asks it over a\n"
    "bridge; `s7200 master --help` lists its settings:\n"
    "s7200 run westinghouse:pc1200 --plc HR1=1234 --pty plc\n";

/// Runs it, prints what came of it, and returns the exit code. Options about one PLC or its line are refused.
int run_system(const CLI::App& verb, const RunOptions& options);

/// The same of westinghouse:MODEL. Options about an S7-200 are refused, and it needs a bridge.
int run_other_plc(const CLI::App& verb, RunOptions& options);

}  // namespace s7200::tools

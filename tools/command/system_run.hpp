// `s7200 run` with a system file, or a simulated PLC of another make, instead of a program.
#pragma once

#include <optional>

#include "tools/command/options/run_options.hpp"
#include "tools/rig/system_reader.hpp"

namespace s7200::tools {

/// For the end of the help.
inline constexpr const char* kAboutSystems =
    "A system file (.yaml) instead of a PROGRAM runs any number of PLCs and lines; --keys says what may stand in it, and\n"
    "--trace then has all PLCs, with the name of each beside its lines:\n"
    "s7200 run stl_programs/systems/two_masters.yaml --for 2s\n";

inline constexpr const char* kAboutOtherPlcs =
    "westinghouse:MODEL instead of a PROGRAM is a simulated PLC of that family, alone on its line, for whoever asks it over "
    "a\n"
    "bridge; `s7200 master --help` lists its settings:\n"
    "s7200 run westinghouse:pc1200 --plc HR1=1234 --pty plc\n";

/// Runs a system file, or a simulated PLC of another make for whoever asks it over a bridge; prints what came of it, and
/// returns the exit code. Options that such a thing has no use for are refused. Nothing if it is a program that is to run.
std::optional<int> run_without_program(const CLI::App& verb, RunOptions& options);

}  // namespace s7200::tools

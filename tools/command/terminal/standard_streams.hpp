// Standard input, output and error, whatever state they are in: closed, full, their reader gone or asleep.
//
// - A descriptor 0, 1 or 2 that is closed is filled at the start with one that fails when it is used. No file that is opened
//   later gets its number, and with it messages or results.
// - Messages on standard error are best effort: what it does not take is lost, and nothing else happens.
// - What standard output does not take ends the command as Ctrl-C does: files that were asked for are completed. It then
//   ends by SIGPIPE if the reader has gone (`s7200 run … | head`), which is quiet, else with a message and kUnusable.
// - SIGPIPE itself is ignored until then, and so is SIGXFSZ: a write that cannot be done is an error at its place.
//
// Whoever prints needs to know nothing of it: stdout and stderr themselves, and std::cout, std::cerr and std::clog, write
// so.
#pragma once

namespace s7200::tools {

/// The first thing a command does.
void open_standard_streams();

/// The last one: writes what is left. The exit code; `exit_code` if all results could be written.
int close_standard_streams(int exit_code);

}  // namespace s7200::tools

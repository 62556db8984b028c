// The verbs. Each adds its subcommand and its options; what it does is called back with the exit code to end with.
// One file a verb: cmd_<verb>.cpp.
#pragma once

namespace CLI {
class App;
}

namespace s7200::tools {

void add_check(CLI::App& app, int& exit_code);
void add_inspect(CLI::App& app, int& exit_code);
void add_why(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_fuzz(CLI::App& app, int& exit_code);
void add_import(CLI::App& app, int& exit_code);
void add_convert(CLI::App& app, int& exit_code);
void add_run(CLI::App& app, int& exit_code);
void add_send(CLI::App& app, int& exit_code);
void add_test(CLI::App& app, int& exit_code);
void add_master(CLI::App& app, int& exit_code);
void add_decode(CLI::App& app, int& exit_code);
void add_import_capture(CLI::App& app, int& exit_code);
void add_debug(CLI::App& app, int& exit_code);
void add_view(CLI::App& app, int& exit_code);
void add_dap(CLI::App& app, int& exit_code);
void add_instructions(CLI::App& app, int& exit_code);
void add_times(CLI::App& app, int& exit_code);
void add_calibrate(CLI::App& app, int& exit_code);
void add_bench(CLI::App& app, int& exit_code);

}  // namespace s7200::tools

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/command/commands.hpp"
#include "tools/command/compared_programs.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/inspected_program.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/command/options/stand_in_options.hpp"
#include "tools/command/options/tables_by_cpu.hpp"
#include "tools/command/terminal.hpp"
#include "tools/compare/structure.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct CompareOptions {
  CpuOptions cpu;
  ComparedFiles files;
  bool json = false;
};

nlohmann::ordered_json side_json(const ProgramFiles& files, const Program& program) {
  return {{"file", files.path}, {"cpu", program.model->name}};
}

int run_compare(const CompareOptions& options) {
  auto files = read_compared(options.files);
  if (!files || !options.cpu.model()) return kUnusable;
  TablesByCpu tables(options.cpu);
  int exit_code = kFine;
  const auto old_program = known_program(options.cpu, files->older, tables, exit_code);
  const auto new_program = known_program(options.cpu, files->newer, tables, exit_code);
  if (!old_program || !new_program) return exit_code;
  const Inspection older(old_program), newer(new_program);
  const StructureDifference structure = structure_difference(older, newer);
  const bool same = structure.same_for_the_cpu();
  if (options.json) {
    auto results = results_of("compare");
    results["old"] = side_json(files->older, *old_program);
    results["new"] = side_json(files->newer, *new_program);
    results["same"] = same;
    results["structure"] = structure_json(older, newer, structure);
    fmt::print("{}", lines_of(results));
  } else {
    fmt::print("{}", structure_text(older, newer, structure));
  }
  return same ? exit_code : std::max<int>(exit_code, kCheckFailed);
}

}  // namespace

void add_compare(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* verb = app.add_subcommand("compare", "what differs between two programs");
  verb->add_option("PROGRAM", options->files.words,
                   "OLD and NEW: STL files or published documents; symbol tables and data blocks of both")
      ->required();
  verb->add_option("--with-old", options->files.old_parts, "another file of the old project alone")
      ->type_name("FILE")
      ->allow_extra_args(false);
  verb->add_option("--with-new", options->files.new_parts, "another file of the new project alone")
      ->type_name("FILE")
      ->allow_extra_args(false);
  options->cpu.add_cpu_and_times_to(*verb, fmt::format("CPU that they are to run on {}", kCpuFound));
  add_repair_option(*verb, options->cpu.repairs);
  add_no_stand_ins_option(*verb, options->cpu.no_stand_ins);
  verb->add_flag("--json", options->json, "print the results as JSON");
  verb->footer(
      "Exit code 0: the CPU gets the same; symbols, titles and comments may differ.\n"
      "Topics: models, programs, times\n"
      "Example: s7200 compare stl_programs/modbus_master_214.stl stl_programs/modbus_master.stl");
  verb->callback([options, &exit_code] { exit_code = run_compare(*options); });
}

}  // namespace s7200::tools

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/inspecting/inspect_picture.hpp"
#include "tools/command/inspecting/inspect_request.hpp"
#include "tools/command/inspecting/inspected_program.hpp"
#include "tools/command/inspecting/stated_loops.hpp"
#include "tools/command/options/choices.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/plc/stand_in_options.hpp"
#include "tools/command/options/plc/tables_by_cpu.hpp"
#include "tools/command/terminal/progress.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/host/interruption.hpp"
#include "tools/views/inspection/inspect_views.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct InspectOptions {
  CpuOptions cpu;
  std::vector<std::string> words, loops;
  std::string svg;
  bool json = false, ascii = false;
};

std::string view_names() { return stl::joined(inspect_views(), &InspectView::name); }

int run_inspect(const InspectOptions& options) {
  const InspectRequest request = inspect_request(options.words);
  if (!request.slip.empty()) {
    print_error(fmt::format("there is no view '{}'; did you mean {}? There are {}", stl::shortened(request.slip),
                            request.meant, view_names()));
    return kUnusable;
  }
  if (!options.cpu.model()) return kUnusable;
  Picture picture;
  if (!picture.claim(options.svg, *request.view, request.paths)) return kUnusable;
  catch_interruption();
  int exit_code = kFine;
  CountedProgress progress("step");
  const Waiter waiter = waiting_with(progress);
  TablesByCpu tables(options.cpu);
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  auto programs = read_programs(request.paths, exit_code);
  if (picture && programs.size() > 1) return print_error("--svg takes one program: a picture is of one"), kUnusable;
  for (ProgramFiles& file : programs) {
    if (interrupted()) break;
    auto inspection = inspected(options.cpu, file, {*request.view, request.about}, tables, waiter, exit_code);
    if (!inspection) continue;
    inspection->ascii = options.ascii;
    const auto stated = stated_loops(*inspection->program, request.view->name, options.loops);
    if (!stated) return print_error(stated.why()), kUnusable;
    inspection->stated_loops = *stated;
    if (picture) exit_code = std::max(exit_code, picture.write(*request.view, *inspection));
    if (options.json) {
      files.push_back({{"file", file.path}, {"cpu", inspection->program->model->name}});
      files.back()[std::string(request.view->name)] = request.view->json(*inspection);
      if (const auto not_followed = request.view->not_followed_json)
        files.back()["not_followed"] = not_followed(*inspection);
    } else if (!picture) {
      const std::string text = request.view->text(*inspection);
      progress.end();
      if (programs.size() > 1) fmt::print("{}\n", stl::printable(file.path));
      fmt::print("{}", text);
      std::fflush(stdout);
    }
  }
  if (options.json) {
    auto results = results_of("inspect");
    results.update({{"interrupted", interrupted()}, {"files", std::move(files)}});
    fmt::print("{}", lines_of(results));
  }
  print_interruption();
  return interrupted() ? static_cast<int>(kCheckFailed) : exit_code;
}

}  // namespace

void add_inspect(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<InspectOptions>();
  CLI::App* verb = app.add_subcommand("inspect", "what is in a program that nobody knows: who uses what, and where");
  std::vector<std::string> names;
  for (const InspectView& view : inspect_views()) names.emplace_back(view.name);
  const auto words = fmt::format(
      "STL files or published documents, with symbol tables and data blocks, then a view: {}; then "
      "addresses, symbols, routines (SBR_3) or networks (SBR_3:2) to keep to",
      view_names());
  offer_beside_files(verb->add_option("PROGRAM", options->words, words), names)->required();
  options->cpu.add_cpu_and_times_to(*verb, fmt::format("CPU that they are to run on {}", kCpuFound));
  add_repair_option(*verb, options->cpu.repairs);
  add_no_stand_ins_option(*verb, options->cpu.no_stand_ins);
  verb->add_option("--svg", options->svg, "write the view ladder as a picture instead of printing it")
      ->type_name("FILE.svg");
  verb->add_option("--loop", options->loops, "how often the loop in a line runs at most, for the view bounds (repeatable)")
      ->type_name("LINE=N")
      ->allow_extra_args(false);
  verb->add_flag("--ascii", options->ascii, "draw with characters of 7 bits");
  verb->add_flag("--json", options->json, "print the results as JSON");
  verb->footer(views_text() +
               "Topics: models, programs, times\n"
               "Example: s7200 inspect stl_programs/modbus_slave.stl xref VB1000\n"
               "Example: s7200 inspect stl_programs/modbus_slave.stl ladder SBR_52:15");
  verb->callback([options, &exit_code] { exit_code = run_inspect(*options); });
}

}  // namespace s7200::tools

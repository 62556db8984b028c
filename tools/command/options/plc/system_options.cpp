#include "tools/command/options/plc/system_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>
#include <utility>

#include "tools/command/exit_code.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/plc/rig_options.hpp"
#include "tools/command/options/plc/stand_in_options.hpp"
#include "tools/command/options/verb/band_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/files.hpp"
#include "tools/plan/reading/system_reader.hpp"

namespace s7200::tools {

namespace {

/// Those of each program once: copies of a PLC have the same.
bool accept_stand_ins_of(const SystemPlan& plan, bool refused) {
  std::set<const Program*> seen;
  bool accepted = true;
  for (const PlcPlan& plc : plan.plcs)
    if (seen.insert(plc.program.get()).second) accepted &= accept_stand_ins(*plc.program, refused);
  return accepted;
}

}  // namespace

std::optional<SystemPlan> load_system(const ProgramOptions& options, int& exit_code) {
  const std::string& path = options.path;
  exit_code = kUnusable;
  const auto text = read_text(path);
  if (!text) return print_error(fmt::format("cannot read {}: {}", path, text.why())), std::nullopt;
  SystemFile file = read_system(*text, path, host_files());
  for (const SystemFile::Text& program : file.programs) print_diagnostics(program.diagnostics, *program.source);
  print_diagnostics(file.file.diagnostics, *file.file.source);
  exit_code = file.ok() ? kFine : file.programs.empty() ? kUnusable : kCheckFailed;
  if (file.ok() && !accept_stand_ins_of(file.plan, options.no_stand_ins)) {
    exit_code = kCheckFailed;
    return {};
  }
  if (file.ok() && options.every_scan) run_every_scan(file.plan);
  if (file.ok()) return std::move(file.plan);
  print_error(fmt::format("{} has errors; nothing was run", path));
  return {};
}

bool is_about_one_plc(const std::string& option) {
  if (option == kNoSkip || option == kNoStandIns || option == kRecordLimitOption) return false;
  CLI::App of_one_plc;
  ProgramOptions programs;
  RigOptions rigs;
  BandOptions bands;
  programs.CpuOptions::add_to(of_one_plc);
  programs.add_parts_to(of_one_plc);
  rigs.add_to(of_one_plc);
  bands.add_to(of_one_plc);
  return of_one_plc.get_option_no_throw(option) != nullptr;
}

namespace {

/// Whether a system file can say it of a PLC. With which tables the whole is run, it cannot.
bool has_a_key(const std::string& option) {
  CLI::App without_key;
  BandOptions bands;
  bands.add_to(without_key);
  return without_key.get_option_no_throw(option) == nullptr;
}

}  // namespace

bool refuse_options_of_one_plc(const CLI::App& verb, const ProgramOptions& program, std::span<const std::string_view> more) {
  const auto refused = [&](const CLI::Option& option) {
    const std::string& name = option.get_name();
    if (name.starts_with("--trace")) return false;  // of all of them, in one file
    return is_about_one_plc(name) || std::ranges::find(more, name) != more.end();
  };
  for (const CLI::Option* option : verb.get_options()) {
    if (option->count() == 0 || option->get_positional() || !refused(*option)) continue;
    const std::string& name = option->get_name();
    if (is_about_the_line(name))
      print_error(fmt::format("{} is about one line: the system file says it of each, with the key {} of the line", name,
                              name == "--capture" ? "'capture: [FILE.pcap]'" : "'faults: [FAULT]'"));
    else
      print_error(fmt::format("{} is about one PLC: {}", name,
                              has_a_key(name) ? "a system file says that of each, see 's7200 run --keys'"
                                              : "name a PROGRAM instead of a system file"));
    return false;
  }
  if (program.parts.empty()) return true;
  print_error(fmt::format("{} beside a system file: it names the files of its programs itself", program.parts.front()));
  return false;
}

}  // namespace s7200::tools

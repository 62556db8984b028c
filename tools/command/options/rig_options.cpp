#include "tools/command/options/rig_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "interpreter/base/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/system_options.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/files.hpp"
#include "tools/host/interruption.hpp"
#include "tools/plan/clock_text.hpp"
#include "tools/plan/system_reader.hpp"
#include "tools/session/words/force_words.hpp"
#include "tools/slave/slave_target.hpp"
#include "tools/slave/system_slave.hpp"
#include "tools/views/faults.hpp"
#include "tools/views/memory.hpp"
#include "tools/views/report.hpp"

namespace s7200::tools {

void RigOptions::add_to(CLI::App& app) {
  app.add_option("--set", set_,
                 "memory or inputs before the first scan: VW100=5, I0.3=1; symbols too, Speed=7; SM0.7=0 (repeatable)")
      ->type_name("ADDRESS=VALUE")
      ->allow_extra_args(false)
      ->group(help_group::kMemory);
  app.add_option("--dump", settings_.dump_names,
                 "memory to show at the end: VB0:16, VW100, AC0, VD20:real; symbols too, Speed (repeatable)")
      ->type_name("ADDRESS[:COUNT]")
      ->allow_extra_args(false)
      ->group(help_group::kMemory);
  app.add_option("--input", settings_.input, "inputs over time: CSV rows such as 10ms,I0.3,1 (s7200 help files)")
      ->type_name("FILE")
      ->group(help_group::kMemory);
  app.add_option("--output", settings_.output,
                 "write each change of an output (Q, AQ): CSV, or waves in FILE.vcd; - is standard output")
      ->type_name("FILE")
      ->group(help_group::kMemory);
  MemorySettings& memory = settings_.memory;
  auto* file =
      app.add_option("--memory", memory.path,
                     "keep retentive memory and EEPROM; with the clock, read at power-up if FILE exists, written at the end")
          ->type_name("FILE")
          ->group(help_group::kMemory);
  auto* lost =
      app.add_flag("--ram-lost", memory.ram_lost, "power was off too long: only the EEPROM of --memory is left, SM0.2 is 1");
  auto* off = add_duration(app, "--power-off", memory.power_off, "how long power was off since --memory was written [0s]");
  lost->needs(file);
  off->needs(file)->excludes(lost);
  app.add_option_function<std::string>(
         "--clock",
         [this](const std::string& text) {
           settings_.clock = parse_clock(text);
           if (!settings_.clock)
             throw CLI::ValidationError("--clock",
                                        fmt::format("'{}' is not a date and time between 1990 and 2089; write for "
                                                    "example \"2026-11-21 10:00:00\"",
                                                    stl::shortened(text)));
         },
         "time of day at the start")
      ->type_name("\"YYYY-MM-DD HH:MM:SS\"");
  app.add_flag("--strict", strict_, "end with exit code 1 at the first run-time error of the program")
      ->group(help_group::kRun);
  add_whole_number(app, "--port", settings_.port, {0, 1}, "the port of the PLC that all this is about", "0");
  faults_.add_to(app);
  auto* trace =
      app.add_option("--trace", settings_.trace,
                     "write what happens in the CPU; interrupts, characters, attachments, errors and the main program's "
                     "way; - is standard output")
          ->type_name("FILE")
          ->group(help_group::kResults);
  auto* all =
      app.add_flag_callback(
             "--trace-instructions", [this] { settings_.trace_detail = TraceDetail::Instructions; },
             "trace every instruction too, with its operand values: its line has the time of its begin, below what it did")
          ->needs(trace);
  app.add_flag_callback(
         "--trace-events", [this] { settings_.trace_detail = TraceDetail::Events; },
         "leave out the way of the main program, why a frame got no answer and how long an instruction took: faster")
      ->needs(trace)
      ->excludes(all);
  app.add_option("--capture", settings_.captures,
                 "write the line to FILE.vcd (levels) or FILE.pcap (frames); for sigrok and Wireshark (repeatable)")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(help_group::kResults);
}

/// Reads what the options of a PROGRAM say into the settings. False after messages.
bool RigOptions::read_settings(const Program& program) {
  if (!faults_.prepare()) return false;
  std::string why;
  const auto assignments = parse_assignments(set_, program, why);
  if (!assignments) return print_error("--set: " + why), false;
  for (const Assignment& assignment : *assignments)
    if (const std::string refused = not_settable(assignment.place); !refused.empty())
      return print_error("--set: " + refused), false;
  const auto dumps = parse_ranges(settings_.dump_names, program, why);
  if (!dumps) return print_error("--dump: " + why), false;
  settings_.dumps = *dumps;
  settings_.set = *assignments;
  settings_.faults = faults_.faults();
  return true;
}

bool RigOptions::take(std::shared_ptr<const Program> program) {
  if (!read_settings(*program)) return false;
  std::vector<std::string> problems;
  auto plan = read_plan_of(std::move(program), settings_, host_files(), problems);
  for (const std::string& problem : problems) print_error(problem);
  if (!plan) return false;
  plan_ = std::move(*plan);
  spot_ = spots_of_plcs(plan_).front();
  return true;
}

void RigOptions::add_place_to(CLI::App& app) {
  app.add_option("--at", at_,
                 "where the master joins a system: a line, or a PLC on it, gateway.1 for its port 1 [the only line]")
      ->type_name("NAME");
  for (const char* rare : {"--strict", "--output", "--memory"}) app.get_option(rare)->group(help_group::kMore);
}

void RigOptions::add_first_station_to(CLI::App& app) {
  app.add_option("--at", at_, "of a system: the PLC to look at first, gateway.1 at its port 1, or a line [the first PLC]")
      ->type_name("NAME");
}

bool RigOptions::load(const CLI::App& verb, const ProgramOptions& program, int& exit_code) {
  if (!load_one(verb, program, exit_code)) return false;
  std::string why = without_s7200() ? why_no_other_plc(plan_, spot_.line) : why_no_room(plan_, spot_.line);
  if (!why.empty()) why = fmt::format("{}: {}", program.path, why);
  if (!plan_.bridges.empty())
    why = fmt::format("bridge '{}' of {} follows the clock, which 's7200 {}' does not: leave it out, or use 's7200 run'",
                      plan_.bridges.front().name, program.path, verb.get_name());
  if (why.empty()) return true;
  exit_code = kUnusable;
  print_error(why);
  return false;
}

bool RigOptions::load_all(const CLI::App& verb, const ProgramOptions& program, int& exit_code) {
  looks_at_all_ = true;
  if (!load_one(verb, program, exit_code)) return false;
  if (without_s7200()) {
    exit_code = kUnusable;
    print_error(
        fmt::format("{}: no S7-200 is in it: 's7200 {}' shows instructions, and simulated PLCs of another make have "
                    "none; 's7200 send', 'master' and 'test' ask them",
                    program.path, verb.get_name()));
    return false;
  }
  stations_ = spots_of_plcs(plan_);
  stations_[spot_.plc] = spot_;
  return true;
}

/// Who looks at all PLCs on several lines begins with the first one.
std::optional<Spot> RigOptions::place_in_system(std::string& why) const {
  if (without_s7200()) {
    const auto line = find_line(plan_, at_, why);
    return line ? std::optional(Spot{.line = *line}) : std::nullopt;
  }
  if (looks_at_all_ && at_.empty() && plan_.lines.size() > 1) return spots_of_plcs(plan_).front();
  return find_spot(plan_, at_, why);
}

std::string RigOptions::note_on_first_station() const {
  if (!at_.empty() || plan_.lines.size() < 2) return {};
  return fmt::format("{} is in view, the first of {} PLCs on {} lines; 'station NAME' goes over to another one",
                     stl::printable(plan_.plcs[spot_.plc].name), plan_.plcs.size(), plan_.lines.size());
}

std::vector<serial::Simulation*> RigOptions::stations(Rig& rig) const {
  std::vector<serial::Simulation*> simulations;
  for (std::size_t spot = 0; spot < stations_.size(); ++spot) simulations.push_back(&rig.simulation(1 + spot));
  return simulations;
}

std::vector<RigOptions::Station> RigOptions::named_stations(const serial::MasterSettings& master) const {
  std::vector<Station> stations;
  if (!is_system()) return stations;
  for (const Spot& spot : stations_) {
    const std::string& name = plan_.plcs[spot.plc].name;
    stations.push_back({.name = name,
                        .place = spot.port == 0 ? name : fmt::format("{}.{}", name, spot.port),
                        .master = tools::on_line(master, plan_.lines[spot.line])});
  }
  return stations;
}

bool RigOptions::load_one(const CLI::App& verb, const ProgramOptions& program, int& exit_code) {
  if (is_other_plc(program.path)) {
    exit_code = kUnusable;
    print_error(
        fmt::format("{}: 's7200 {}' is about an S7-200; 's7200 master' asks this PLC, 's7200 run' serves it to others",
                    stl::printable(program.path), verb.get_name()));
    return false;
  }
  if (is_system_file(program.path)) return load_system(verb, program, exit_code);
  if (!at_.empty()) {
    exit_code = kUnusable;
    print_error("--at names a place in a system file; a PROGRAM has --port");
    return false;
  }
  auto loaded = program.load(exit_code);
  if (!loaded) return false;
  exit_code = kUnusable;
  if (!take(std::move(loaded))) return false;
  exit_code = kFine;
  return true;
}

bool RigOptions::load_system(const CLI::App& verb, const ProgramOptions& program, int& exit_code) {
  exit_code = kUnusable;
  if (!refuse_options_of_one_plc(verb, program)) return false;
  auto plan = tools::load_system(program, exit_code);
  if (!plan) return false;
  plan_ = std::move(*plan);
  path_ = program.path;
  exit_code = kUnusable;
  std::string why;
  const auto spot = place_in_system(why);
  if (!spot) return print_error(fmt::format("{}: {} (--at NAME)", program.path, why)), false;
  spot_ = *spot;
  exit_code = kFine;
  return true;
}

/// False after a message if several want standard output.
bool RigOptions::may_have_standard_output(bool json) const {
  const bool wanted[] = {settings_.trace == "-", settings_.output == "-", json};
  if (std::ranges::count(wanted, true) < 2) return true;
  print_error(is_system()
                  ? "--trace - and --json cannot both have standard output; write one to a file"
                  : "only one of --trace -, --output - and --json can have standard output; write the others to files");
  return false;
}

std::unique_ptr<Rig> RigOptions::assemble(bool json, const std::string& link) {
  if (!may_have_standard_output(json)) return nullptr;
  std::vector<std::string> problems;
  std::vector<Spot> spots{spot_};  // beside the first one stands whoever asks on its line
  spots.insert(spots.end(), stations_.begin(), stations_.end());
  RigSurroundings surroundings = this->surroundings(path_, link, without_s7200() ? std::vector<Spot>() : std::move(spots));
  if (without_s7200()) surroundings.lines = {spot_.line};
  auto rig = Rig::assemble(plan_, surroundings, problems);
  for (const std::string& problem : problems) print_error(problem);
  only_interrupted_ = problems.empty() && interrupted();
  return rig;
}

std::unique_ptr<Rig> RigOptions::assemble_another(std::shared_ptr<const Program> program,
                                                  std::vector<std::string>& problems) const {
  SystemPlan plan = plan_;
  plan.plcs.front().program = std::move(program);
  return Rig::assemble(std::move(plan), surroundings(path_, {}, {spot_}), problems);
}

RigSurroundings RigOptions::surroundings(const std::string& path, const std::string& link, std::vector<Spot> spots) const {
  return {.path = path,
          .link = link,
          .standard_output = &std::cout,
          .trace = is_system() ? settings_.trace : "",
          .trace_detail = settings_.trace_detail,
          .spots = std::move(spots),
          .stop = interruption(),
          .begun = catch_interruption};
}

std::string RigOptions::target() const {
  if (!is_system()) return program()->source.name;
  if (without_s7200()) return fmt::format("{}: line {}", path_, plan_.lines[spot_.line].name);
  return place_text(path_, plan_, spot_);
}

void RigOptions::refuse_what_is_of_one_run(std::string_view because) const {
  const std::pair<const char*, bool> of_one_run[] = {
      {"--dump", !settings_.dump_names.empty()},    {"--output", !settings_.output.empty()},
      {"--trace", !settings_.trace.empty()},        {"--capture", !settings_.captures.empty()},
      {"--memory", !settings_.memory.path.empty()}, {"--strict", strict_}};
  for (const auto& [option, given] : of_one_run)
    if (given) throw std::invalid_argument(fmt::format("{} is about one run; {}", option, because));
}

std::optional<std::vector<serial::Fault>> RigOptions::faults() {
  if (!faults_.prepare()) return {};
  return faults_.faults();
}

int RigOptions::exit_code_without_rig() const {
  print_interruption();
  return only_interrupted_ ? kCheckFailed : kUnusable;
}

bool is_about_the_line(std::string_view option) { return option == "--fault" || option == "--capture"; }

bool finish(Rig& rig) {
  const std::vector<std::string> problems = rig.finish();
  for (const std::string& problem : problems) print_error(problem);
  return problems.empty();
}

std::string RigOptions::recorded_files() const {
  std::vector<std::string> files;
  const auto add_first = [&files](const PlcSettings& settings) {
    for (const std::string& file : {settings.output, settings.trace})
      if (!file.empty()) files.insert(files.begin(), stl::printable(file));
  };
  if (is_system()) add_first(settings_);
  for (const PlcPlan& plc : plan_.plcs) add_first(plc.settings);
  for (const LinePlan& line : plan_.lines) files.insert(files.end(), line.captures.begin(), line.captures.end());
  return fmt::format("{}", fmt::join(files, ", "));
}

nlohmann::ordered_json RigOptions::no_json() {
  return {{"mode", nullptr},
          {"errors", nlohmann::ordered_json::array()},
          {"errors_not_listed", 0},
          {"faults", nlohmann::ordered_json::array()},
          {"dump", nlohmann::ordered_json::object()}};
}

}  // namespace s7200::tools

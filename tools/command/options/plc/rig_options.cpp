#include "tools/command/options/plc/rig_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/plc/system_options.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/host/files/files.hpp"
#include "tools/host/interruption.hpp"
#include "tools/plan/reading/system_reader.hpp"
#include "tools/session/words/force_words.hpp"
#include "tools/slave/slave_in_rig.hpp"
#include "tools/slave/slave_target.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/faults.hpp"

namespace s7200::tools {

void RigOptions::add_to(CLI::App& app) {
  keys_.add_to(app, PlcKey::Stage::Program);
  app.add_flag("--strict", strict_, "end with exit code 1 at the first run-time error of the program")
      ->group(help_group::kRun);
  add_whole_number(app, "--port", settings_.port, {0, 1}, "the port of the PLC that all this is about", "0");
  faults_.add_to(app);
  app.add_option("--capture", settings_.captures,
                 "write the line to FILE.vcd (levels) or FILE.pcap (frames); for sigrok and Wireshark (repeatable)")
      ->type_name("FILE")
      ->allow_extra_args(false)
      ->group(help_group::kResults);
  app.add_option_function<std::string>(
         std::string(kRecordLimitOption),
         [this](const std::string& given) {
           const auto size = parse_size(given);
           if (!size)
             throw CLI::ValidationError(std::string(kRecordLimitOption),
                                        fmt::format("'{}' is not a size: write 500MB, 20GB or none", stl::shortened(given)));
           record_limit_ = *size;
         },
         fmt::format("how large a trace, a capture or a record of outputs may grow, 20GB; none: without limit [{}]",
                     size_text(static_cast<double>(kRecordLimit))))
      ->type_name("SIZE")
      ->group(help_group::kMore);
}

/// Reads what the options of a PROGRAM say into the settings. False after messages.
bool RigOptions::read_settings(const Program& program) {
  if (!faults_.prepare()) return false;
  const AddressSpace of_program = program;
  if (!keys_.read(settings_, &of_program)) return false;
  for (const Assignment& assignment : settings_.set)
    if (const std::string refused = not_settable(assignment.place); !refused.empty())
      return print_error("--set: " + refused), false;
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
Result<Spot> RigOptions::place_in_system() const {
  if (without_s7200()) {
    const auto line = find_line(plan_, at_);
    if (!line) return line.trouble();
    return Spot{.line = *line};
  }
  if (looks_at_all_ && at_.empty() && plan_.lines.size() > 1) return spots_of_plcs(plan_).front();
  return find_spot(plan_, at_);
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
  if (is_system_file(program.path)) return load_system(verb, program, {}, exit_code) && find_place(exit_code);
  if (at_.empty()) return load_program(program, exit_code);
  exit_code = kUnusable;
  print_error("--at names a place in a system file; a PROGRAM has --port");
  return false;
}

bool RigOptions::load_whole(const CLI::App& verb, const ProgramOptions& program, std::span<const std::string_view> more,
                            int& exit_code) {
  if (!is_system_file(program.path)) return load_program(program, exit_code);
  joins_ = false;
  return load_system(verb, program, more, exit_code);
}

bool RigOptions::load_program(const ProgramOptions& program, int& exit_code) {
  auto loaded = program.load(exit_code);
  if (!loaded) return false;
  exit_code = kUnusable;
  if (!take(std::move(loaded))) return false;
  exit_code = kFine;
  return true;
}

bool RigOptions::load_system(const CLI::App& verb, const ProgramOptions& program, std::span<const std::string_view> more,
                             int& exit_code) {
  exit_code = kUnusable;
  if (!refuse_options_of_one_plc(verb, program, more) || !keys_.read(settings_, nullptr)) return false;
  auto plan = tools::load_system(program, exit_code);
  if (!plan) return false;
  plan_ = std::move(*plan);
  path_ = program.path;
  return true;
}

/// Finds the place of the master, or of the PLC that is looked at first. False after a message.
bool RigOptions::find_place(int& exit_code) {
  const auto spot = place_in_system();
  if (spot) return spot_ = *spot, true;
  print_error(fmt::format("{}: {} (--at NAME)", path_, spot.why()));
  exit_code = kUnusable;
  return false;
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

std::unique_ptr<RecordedRig> RigOptions::assemble(bool json, const std::string& link) {
  if (!may_have_standard_output(json)) return nullptr;
  std::vector<std::string> problems;
  std::vector<Spot> spots;
  if (joins_ && !without_s7200()) {
    spots.push_back(spot_);  // beside the first one stands whoever asks on its line
    spots.insert(spots.end(), stations_.begin(), stations_.end());
  }
  RigSurroundings surroundings = this->surroundings(link, std::move(spots));
  if (joins_ && without_s7200()) surroundings.seen.lines = {spot_.line};
  auto rig = RecordedRig::assemble(plan_, surroundings, problems);
  for (const std::string& problem : problems) print_error(problem);
  only_interrupted_ = problems.empty() && interrupted();
  return rig;
}

std::unique_ptr<RecordedRig> RigOptions::assemble_another(std::shared_ptr<const Program> program,
                                                          std::vector<std::string>& problems) const {
  SystemPlan plan = plan_;
  plan.plcs.front().program = std::move(program);
  return RecordedRig::assemble(std::move(plan), surroundings({}, {spot_}), problems);
}

RigSurroundings RigOptions::surroundings(const std::string& link, std::vector<Spot> spots) const {
  return {.path = path_,
          .link = link,
          .standard_output = &std::cout,
          .trace = is_system() ? settings_.trace : "",
          .trace_detail = settings_.trace_detail,
          .record_limit = record_limit_,
          .seen = {.spots = std::move(spots), .lines = {}},
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
      {"--dump", keys_.given("dump")},     {"--output", keys_.given("output")},
      {"--trace", keys_.given("trace")},   {"--capture", !settings_.captures.empty()},
      {"--memory", keys_.given("memory")}, {"--strict", strict_}};
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

bool finish(RecordedRig& rig) {
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

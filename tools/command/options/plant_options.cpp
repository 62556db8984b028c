#include "tools/command/options/plant_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "interpreter/program/load.hpp"
#include "tools/rig/clock_text.hpp"
#include "tools/host/interruption.hpp"
#include "tools/views/report.hpp"
#include "tools/host/terminal.hpp"

namespace s7200::tools {

void PlantOptions::add_to(CLI::App& app) {
  app.add_option("--set", set_, "memory or inputs before the first scan: VW100=5, I0.3=1 (repeatable)")
      ->type_name("ADDRESS=VALUE")
      ->allow_extra_args(false);
  app.add_option("--dump", dump_, "memory to show at the end: VB0:16, VW100, AC0, VD20:real (repeatable)")
      ->type_name("ADDRESS[:COUNT]")
      ->allow_extra_args(false);
  app.add_option("--input", input_path_, "inputs over time, CSV rows such as 10ms,I0.3,1 and 1s,I0.6,pulses,5kHz,200ms")
      ->type_name("FILE");
  output_.add_to(app);
  memory_.add_to(app);
  app.add_option_function<std::string>(
         "--clock",
         [this](const std::string& text) {
           clock_ = parse_clock(text);
           if (!clock_)
             throw CLI::ValidationError("--clock",
                                        fmt::format("'{}' is not a date and time between 1990 and 2089; write for "
                                                    "example \"2026-11-21 10:00:00\"",
                                                    text));
         },
         "time of day at the start")
      ->type_name("\"YYYY-MM-DD HH:MM:SS\"");
  app.add_flag("--strict", strict_, "end with exit code 1 at the first run-time error of the program");
  faults_.add_to(app);
  trace_.add_to(app);
  captures_.add_to(app);
}

bool PlantOptions::read_field(const CpuModel& model) {
  if (input_path_.empty()) return true;
  std::string why;
  const auto csv = read_file(input_path_, why);
  if (!csv) {
    print_error(fmt::format("cannot read {}: {}", input_path_, why));
    return false;
  }
  std::vector<std::string> errors;
  field_ = serial::parse_field_script(*csv, input_path_, model, errors);
  constexpr std::size_t kShown = 10;
  for (std::size_t i = 0; i < std::min(kShown, errors.size()); ++i) print_error(errors[i]);
  if (errors.size() > kShown) print_error(fmt::format("{}: and {} more mistakes", input_path_, errors.size() - kShown));
  return errors.empty();
}

bool PlantOptions::claim_files(const Program& program, const std::string& link) {
  WrittenFiles files;
  files.reads(program.source.name);
  files.reads(input_path_);
  files.links("--pty", link);
  return memory_.claim(files) && trace_.claim(files) && output_.claim(files) && captures_.claim(files);
}

bool PlantOptions::open_records(const std::shared_ptr<const Program>& program) {
  return trace_.open(program) && output_.open() && captures_.open() && trace_.put() && output_.put() && captures_.put();
}

bool PlantOptions::prepare(const std::shared_ptr<const Program>& program, bool json, const std::string& link) {
  const CpuModel& model = *program->model;
  if (trace_.to_standard_output() + output_.to_standard_output() + json > 1) {
    print_error("only one of --trace -, --output - and --json can have standard output; write the others to files");
    return false;
  }
  if (!faults_.prepare()) return false;
  if (!parse_assignments(set_, model, assignments_) || !parse_ranges(dump_, model, dumps_) || !read_field(model))
    return false;
  if (!claim_files(*program, link) || !memory_.read(model)) return false;
  catch_interruption();
  if (!open_records(program)) return false;
  sinks_.add(trace_.sink());
  sinks_.add(output_.sink());
  return true;
}

void PlantOptions::power_up(serial::Simulation& simulation) {
  if (!sinks_.empty()) simulation.cpu().set_sink(&sinks_);
  simulation.stop_when(&interruption());
  captures_.watch(simulation);
  faults_.inject(simulation);
  simulation.power_up(memory_.memory());
  if (clock_) simulation.cpu().set_clock(*clock_);
  for (const Assignment& assignment : assignments_) assign(simulation, assignment);
}

bool PlantOptions::finish(const serial::Simulation& simulation) {
  const bool trace_written = trace_.close(), output_written = output_.close(), captured = captures_.close();
  return memory_.write(simulation.cpu()) && trace_written && output_written && captured;
}

std::string PlantOptions::dump_text(const Cpu& cpu) const {
  std::string text;
  for (const MemoryRange& range : dumps_) text += tools::dump_text(cpu, range);
  return text;
}

nlohmann::ordered_json PlantOptions::json(const serial::Simulation& simulation) const {
  const Cpu& cpu = simulation.cpu();
  nlohmann::ordered_json json{{"mode", cpu.state().mode == Mode::Run ? "RUN" : "STOP"},
                              {"errors", errors_json(cpu)},
                              {"errors_not_listed", errors_not_listed(cpu)},
                              {"faults", faults_json(simulation.faults())},
                              {"dump", nlohmann::ordered_json::object()}};
  for (std::size_t i = 0; i < dumps_.size(); ++i) json["dump"][dump_[i]] = dump_json(cpu, dumps_[i]);
  return json;
}

nlohmann::ordered_json PlantOptions::no_json() {
  return {{"mode", nullptr},
          {"errors", nlohmann::ordered_json::array()},
          {"errors_not_listed", 0},
          {"faults", nlohmann::ordered_json::array()},
          {"dump", nlohmann::ordered_json::object()}};
}

}  // namespace s7200::tools

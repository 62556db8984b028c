#include "tools/rig/rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/program/load.hpp"
#include "interpreter/trace/output_record.hpp"
#include "interpreter/trace/text_trace.hpp"
#include "tools/host/interruption.hpp"
#include "tools/views/memory.hpp"

namespace s7200::tools {
namespace {

std::optional<serial::FieldScript> read_field(const std::string& path, const CpuModel& model,
                                              std::vector<std::string>& problems) {
  if (path.empty()) return serial::FieldScript{};
  std::string why;
  const auto csv = read_text(path, why);
  if (!csv) {
    problems.push_back(fmt::format("cannot read {}: {}", path, why));
    return {};
  }
  std::vector<std::string> errors;
  auto field = serial::parse_field_script(*csv, path, model, errors);
  constexpr std::size_t kShown = 10;
  problems.insert(problems.end(), errors.begin(),
                  errors.begin() + static_cast<std::ptrdiff_t>(std::min(kShown, errors.size())));
  if (errors.size() > kShown) problems.push_back(fmt::format("{}: and {} more mistakes", path, errors.size() - kShown));
  return errors.empty() ? std::optional(std::move(field)) : std::nullopt;
}

}  // namespace

Rig::Rig(std::shared_ptr<const Program> program, const RigSettings& settings, serial::FieldScript field)
    : settings_(settings),
      files_(settings.standard_output),
      simulation_(std::move(program), std::move(field), static_cast<std::uint8_t>(settings.port)) {}

std::unique_ptr<Rig> Rig::assemble(std::shared_ptr<const Program> program, const RigSettings& settings,
                                   std::vector<std::string>& problems) {
  const CpuModel& model = *program->model;
  if (settings.port >= model.ports)
    problems.push_back(
        fmt::format("CPU {} has no port {}; a second port needs {}", model.name, settings.port, to_text(kTwoPorts)));
  auto field = read_field(settings.input, model, problems);
  if (!field || !problems.empty()) return nullptr;
  std::unique_ptr<Rig> rig(new Rig(program, settings, std::move(*field)));
  std::string why;
  bool good = rig->claim_files(program, why) && rig->memory_.read(model, why);
  if (good) {
    catch_interruption();
    good = rig->open_records(why);
  }
  if (good) return rig;
  if (!why.empty()) problems.push_back(why);
  return nullptr;
}

bool Rig::claim_files(const std::shared_ptr<const Program>& program, std::string& why) {
  WrittenFiles& files = files_;
  files.reads(program->source.name);
  for (const stl::FurtherFile& file : program->source.further_files) files.reads(file.name);
  files.reads(settings_.input);
  files.links("--pty", settings_.link);
  const auto trace = [program, detail = settings_.trace_detail](std::ostream& out) {
    return std::make_unique<TextTrace>(out, program, detail);
  };
  const auto output = [](std::ostream& out) { return std::make_unique<OutputRecord>(out); };
  return memory_.claim(files, settings_.memory, why) &&
         traces_.claim(files, "--trace", settings_.trace, {"a trace", fmt::format("{}\n", TextTrace::kFirstLine)}, trace,
                       why) &&
         traces_.claim(files, "--output", settings_.output,
                       {"a record of outputs", fmt::format("{}\n", OutputRecord::kFirstLine)}, output, why) &&
         captures_.claim(files, settings_.captures, why);
}

bool Rig::open_records(std::string& why) {
  return traces_.open(why) && captures_.open(why) && traces_.put(why) && captures_.put(why);
}

void Rig::power_up() {
  if (!sinks().empty()) simulation_.cpu().set_sink(&sinks());
  simulation_.stop_when(&interruption());
  captures_.watch(simulation_);
  for (const serial::Fault& fault : settings_.faults) simulation_.inject(fault);
  simulation_.power_up(memory_.memory());
  if (settings_.clock) simulation_.cpu().set_clock(*settings_.clock);
  for (const Assignment& assignment : settings_.set) assign(simulation_, assignment);
}

std::vector<std::string> Rig::finish() {
  std::vector<std::string> problems;
  traces_.close(problems);
  captures_.close(problems);
  std::string why;
  if (!memory_.write(cpu(), why)) problems.push_back(why);
  return problems;
}

}  // namespace s7200::tools

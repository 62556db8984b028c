#include "tools/rig/rig.hpp"

#include <fmt/format.h>

#include <utility>

#include "tools/host/interruption.hpp"

namespace s7200::tools {

Rig::Rig(std::shared_ptr<const Program> program, const RigSettings& settings, serial::FieldScript field)
    : settings_(settings),
      files_(settings.standard_output),
      plc_(program, settings),
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
  bool good = rig->claim_files(why) && rig->plc_.read_memory(why);
  if (good) {
    catch_interruption();
    good = rig->open_records(why);
  }
  if (good) return rig;
  if (!why.empty()) problems.push_back(why);
  return nullptr;
}

bool Rig::claim_files(std::string& why) {
  files_.reads(settings_.input);
  files_.links("--pty", settings_.link);
  return plc_.claim(files_, why) && captures_.claim(files_, settings_.captures, why);
}

bool Rig::open_records(std::string& why) {
  return plc_.open(why) && captures_.open(why) && plc_.put(why) && captures_.put(why);
}

void Rig::power_up() {
  simulation_.stop_when(&interruption());
  captures_.watch(simulation_.plc(), simulation_.port());
  for (const serial::Fault& fault : settings_.faults) simulation_.inject(fault);
  plc_.power_up(simulation_.plc());
}

std::vector<std::string> Rig::finish() {
  std::vector<std::string> problems;
  plc_.close(problems);
  captures_.close(problems);
  plc_.keep_memory(cpu(), problems);
  return problems;
}

}  // namespace s7200::tools

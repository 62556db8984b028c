#include "tools/rig/files/memory_file.hpp"

#include <fmt/format.h>

#include "tools/host/files/files.hpp"
#include "tools/rig/memory_json.hpp"

namespace s7200::tools {

bool MemoryFile::claim(WrittenFiles& files, const MemorySettings& settings, std::string& why) {
  settings_ = settings;
  if (settings.path.empty()) return true;
  destination_ =
      files.claim("--memory", settings.path, {"a memory", memory_beginning()}, Replace::Judged, why);  // read() judges it
  return destination_.has_value();
}

bool MemoryFile::read(const CpuModel& model, std::string& why) {
  if (settings_.path.empty()) return true;
  if (destination_->replaces_content()) {
    std::string reason;
    const auto json = read_text(settings_.path, reason);
    if (json) memory_ = memory_from_json(*json, model, reason);
    if (!memory_) {
      why = fmt::format("cannot take --memory from {}: {}; it is left alone", settings_.path, reason);
      return false;
    }
  } else if (settings_.ram_lost) {
    memory_.emplace();
  }
  if (memory_) {
    memory_->ram_lost = settings_.ram_lost;
    memory_->power_off = settings_.power_off;
  }
  return true;
}

bool MemoryFile::write(const Cpu& cpu, std::string& why) const {
  return settings_.path.empty() ||
         write_result(*destination_, memory_to_json(cpu.retentive_memory(), *cpu.program().model), why);
}

}  // namespace s7200::tools

#include "tools/rig/files/memory_file.hpp"

#include <fmt/format.h>

#include "tools/host/files/files.hpp"
#include "tools/rig/memory_json.hpp"

namespace s7200::tools {

Result<> MemoryFile::claim(WrittenFiles& files, const MemorySettings& settings) {
  settings_ = settings;
  if (settings.path.empty()) return {};
  auto claimed =
      files.claim("--memory", settings.path, {"a memory", memory_beginning()}, Replace::Judged);  // read() judges it
  if (!claimed) return claimed.trouble();
  destination_ = *std::move(claimed);
  return {};
}

Result<> MemoryFile::read(const CpuModel& model) {
  if (settings_.path.empty()) return {};
  if (destination_->replaces_content()) {
    auto memory = read_text(settings_.path).and_then([&](const std::string& json) { return memory_from_json(json, model); });
    if (!memory) return trouble("cannot take --memory from {}: {}; it is left alone", settings_.path, memory.why());
    memory_ = *std::move(memory);
  } else if (settings_.ram_lost) {
    memory_.emplace();
  }
  if (memory_) {
    memory_->ram_lost = settings_.ram_lost;
    memory_->power_off = settings_.power_off;
  }
  return {};
}

Result<> MemoryFile::write(const Cpu& cpu) const {
  if (settings_.path.empty()) return {};
  return write_result(*destination_, memory_to_json(cpu.retentive_memory(), *cpu.program().model));
}

}  // namespace s7200::tools

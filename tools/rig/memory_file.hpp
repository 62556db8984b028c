// `--memory FILE`: what the CPU keeps without power, from one run to the next.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "interpreter/cpu/cpu.hpp"
#include "tools/host/written_files.hpp"

namespace CLI {
class App;
}

namespace s7200::tools {

/// JSON: `"ram"` and `"eeprom"` have the bytes that are not 0, in hex, by the address of the first.
std::string memory_to_json(const RetentiveMemory& memory, const CpuModel& model);

/// Nothing, and `why`, for what is no such memory or that of another CPU.
std::optional<RetentiveMemory> memory_from_json(std::string_view json, const CpuModel& model, std::string& why);

class MemoryFile {
 public:
  void add_to(CLI::App& app);

  /// False after a message: a file was named and could not be written at the end.
  bool claim(WrittenFiles& files);

  /// Reads the file, if one was named and exists. False after a message: it is not a memory of this CPU.
  bool read(const CpuModel& model);

  /// What the CPU powers up with; null without a file.
  const RetentiveMemory* memory() const { return memory_ ? &*memory_ : nullptr; }

  /// Writes the file, if one was named. False after a message.
  bool write(const Cpu& cpu) const;

 private:
  std::string path_;
  std::optional<Destination> destination_;  ///< nothing without a file
  bool ram_lost_ = false;
  Time power_off_ = 0;
  std::optional<RetentiveMemory> memory_;
};

}  // namespace s7200::tools

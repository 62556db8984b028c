// `--memory FILE`: what the CPU keeps without power, from one run to the next.
#pragma once

#include <optional>
#include <string>

#include "interpreter/base/result.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "tools/host/files/written_files.hpp"
#include "tools/plan/plc_settings.hpp"

namespace s7200::tools {

/// A file of retentive memory. Each function brings trouble if the file cannot be used.
class MemoryFile {
 public:
  /// The file will be written at the end.
  Result<> claim(WrittenFiles& files, const MemorySettings& settings);

  /// Reads the file, if one was named, and exists, and is not empty.
  Result<> read(const CpuModel& model);

  /// The memory with which the CPU powers up; null without a file.
  const RetentiveMemory* memory() const { return memory_ ? &*memory_ : nullptr; }

  /// Writes the file, if one was named.
  Result<> write(const Cpu& cpu) const;

 private:
  MemorySettings settings_;
  std::optional<Destination> destination_;  ///< nothing without a file
  std::optional<RetentiveMemory> memory_;
};

}  // namespace s7200::tools

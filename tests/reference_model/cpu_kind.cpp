#include "tests/reference_model/cpu_kind.hpp"

#include <stdexcept>

namespace s7200::reference {

const CpuKind& cpu_kind(const std::string& name) {
  static const CpuKind kCpu214{.name = "214",
                               .points = 8,
                               .V = 4096,
                               .SM = 86,
                               .S = 16,
                               .analog = 32,
                               .timers = 128,
                               .L = 0,
                               .HC = 12,
                               .identification = 0x20,
                               .watchdog = 300'000'000,
                               .keeps_operands = false,
                               .times = &cpu214_times()};
  static const CpuKind kCpu224{.name = "224",
                               .points = 16,
                               .V = 8192,
                               .SM = 550,
                               .S = 32,
                               .analog = 64,
                               .timers = 256,
                               .L = 64,
                               .HC = 24,
                               .identification = 0x20,
                               .watchdog = 500'000'000,
                               .keeps_operands = true,
                               .times = &cpu224_times()};
  if (name == kCpu214.name) return kCpu214;
  if (name == kCpu224.name) return kCpu224;
  throw std::invalid_argument("the reference model cannot be a CPU " + name);
}

}  // namespace s7200::reference

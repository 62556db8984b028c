#include "tools/rig/programming_device.hpp"

#include "interpreter/cpu/scan.hpp"

namespace s7200::tools {

void change_mode(Cpu& cpu, Mode mode) {
  Core& core = cpu.core();
  core.touched = true;
  scan::change_mode(core, mode);
}

}  // namespace s7200::tools

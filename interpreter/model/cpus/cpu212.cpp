// CPU 212. Ranges: facts 1.1. Queues: S7-200 manual C230-02, 10-120. Baud rates: facts 2.1 (code 000 is 19 200 here).
// Retentive: as on the CPU 214.
// Execution times: those of the CPU 214, since no others are known.
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/embedded_times.hpp"

namespace s7200 {

const CpuModel& cpu212() {
  static const CpuModel kModel{
      .name = "212",
      .self = kCpu212,
      .size = {/*I*/ 8, /*Q*/ 8, /*M*/ 16, /*SM*/ 46, /*S*/ 8, /*AI*/ 32, /*AQ*/ 32, /*T*/ 64, /*C*/ 64, /*HC*/ 1,
               /*AC*/ 4, /*V*/ 1024},
      .labels = 64,
      .subroutines = 16,
      .interrupts = 32,
      .ports = 1,
      .program_words = 512,
      .eeprom_bytes = 200,
      .retentive = {{Area::V, 0, 1024}, {Area::M, 14, 2}, {Area::T, 0, 32}, {Area::C, 0, 64}},
      .queue_depth = {4, 4, 2},
      .baud = {19'200, 19'200, 9'600, 4'800, 2'400, 1'200, 600, 300},
      .identification = 0x00,
      .counter_modes = {kMode0},
      .pulse_control = 0xCF,
      .message_control = 0,
      .shortest_timed_interval = 5 * kMillisecond,
      .call_depth = 8,
      .for_depth = 8,
      .interrupt_call_depth = 0,
      .watchdog = 300 * kMillisecond,
      .integer_overflow = IntegerOverflow::Wrap,
      .times_csv = {embedded::kCpu214Times},
  };
  return kModel;
}

}  // namespace s7200

// CPU 215 and CPU 216. Ranges: facts 1.1. Queues: S7-200 manual C230-02, 10-120. Baud rates: facts 2.1.
// Retentive: as on the CPU 214.
// Execution times: those of the CPU 214, since no others are known, and estimates for instructions that the CPU 214 lacks.
// Not modelled: the DP port of the CPU 215.
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/embedded_times.hpp"

namespace s7200 {

const CpuModel& cpu215() {
  static const CpuModel kModel{
      .name = "215",
      .self = kCpu215,
      .size = {/*I*/ 8, /*Q*/ 8, /*M*/ 32, /*SM*/ 195, /*S*/ 32, /*AI*/ 32, /*AQ*/ 32, /*T*/ 256, /*C*/ 256, /*HC*/ 3,
               /*AC*/ 4, /*V*/ 5120},
      .labels = 256,
      .subroutines = 64,
      .interrupts = 128,
      .ports = 1,
      .program_words = 4096,
      .eeprom_bytes = 5120,
      .retentive = {{Area::V, 0, 5120}, {Area::M, 14, 18}, {Area::T, 0, 32}, {Area::T, 64, 32}, {Area::C, 0, 256}},
      .queue_depth = {4, 16, 8},
      .baud = {38'400, 19'200, 9'600, 4'800, 2'400, 1'200, 600, 300},
      .identification = 0x80,
      .counter_modes = {kMode0, kAllModes, kAllModes},
      .pulse_control = 0xCF,
      .message_control = 0xFC,
      .shortest_timed_interval = 5 * kMillisecond,
      .call_depth = 8,
      .for_depth = 8,
      .interrupt_call_depth = 0,
      .watchdog = 300 * kMillisecond,
      .integer_overflow = IntegerOverflow::Wrap,
      .times_csv = {embedded::kCpu214Times, embedded::kCpu215Times},
  };
  return kModel;
}

const CpuModel& cpu216() {
  static const CpuModel kModel = [] {
    CpuModel model = cpu215();
    model.name = "216";
    model.self = kCpu216;
    model.ports = 2;
    model.queue_depth = {8, 16, 8};
    model.identification = 0x90;
    return model;
  }();
  return kModel;
}

}  // namespace s7200

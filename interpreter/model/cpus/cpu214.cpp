// CPU 214. Ranges: facts 1.1. Queues: S7-200 manual C230-02, 10-120. Baud rates: facts 2.1. Watchdog: A5E00066097-02, 9-146.
// Not documented, modelled so:
// - The CPU has its full set of expansion modules: all 64 input and 64 output points of the image registers exist.
//   [Choices.All64InputAndOutputPointsExist]
// - All of V, MB14–MB31 and the current values of the retentive timers and of all counters are retentive. MB0–MB13 (off by
//   default in Micro/WIN 32: facts 1.6), S, the other timers, and the bits of timers and counters are not.
//   [RetentiveMemoryTest.RetentiveRangesKeepTheirValuesAndAllElseIsZero,
//   RetentiveMemoryTest.BitsOfTimersAndCountersAreNotKept]
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/embedded_times.hpp"

namespace s7200 {

const CpuModel& cpu214() {
  static const CpuModel kModel{
      .name = "214",
      .self = kCpu214,
      .size = {/*I*/ 8, /*Q*/ 8, /*M*/ 32, /*SM*/ 86, /*S*/ 16, /*AI*/ 32, /*AQ*/ 32, /*T*/ 128, /*C*/ 128, /*HC*/ 3,
               /*AC*/ 4, /*V*/ 4096},
      .labels = 256,
      .subroutines = 64,
      .interrupts = 128,
      .ports = 1,
      .program_words = 2048,
      .eeprom_bytes = 1024,
      .retentive = {{Area::V, 0, 4096}, {Area::M, 14, 18}, {Area::T, 0, 32}, {Area::T, 64, 32}, {Area::C, 0, 128}},
      .queue_depth = {4, 16, 4},
      .baud = {38'400, 19'200, 9'600, 4'800, 2'400, 1'200, 600, 300},
      .identification = 0x20,
      .counter_modes = {kMode0, kAllModes, kAllModes},
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

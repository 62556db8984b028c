// CPUs 221, 222, 224, 224XP and 226 as of 2004 (release 2: 6ES7 21x-xxx23), and those of release 1 (2000 to 2003), whose
// names end in r1, with the 226XM. Ranges, queues, identification: facts 1.2, 10.1. Baud rates: facts 2.1. Program memory:
// without editing in RUN. Execution times: two editions, most of them remembered (facts and execution_times, section 9).
// Not documented, modelled so:
// - All points of the image registers exist, as with a full set of expansion modules.
// [Choices.All64InputAndOutputPointsExist]
// - The watchdog: 300 ms on a page of 2002; 500 ms in release 2, from memory (facts 10.6).
//   [Cpu22x.TheWatchdogIs500msOnRelease2And300msBefore]
// - Retentive is what it is on the CPU 214. Micro/WIN's default leaves MB0–MB13 out there, too (facts 1.6).
//   [Cpu22x.WhatIsRetentiveOnTheCpu214IsRetentive]
// - An interrupt routine calls one level of subroutines (A5E00066097-02, 9-168).
//   [Cpu22x.AnInterruptRoutineCallsOneLevelOfSubroutines]
// - The CPUs 221 and 222 lack HSC1 and HSC2, although one extract of the manual prints HC0 to HC5 for all (facts 10.1).
//   [Cpu22x.The221And222HaveNoHsc1AndHsc2]
//
// Not modelled: linear pulse profiles, auto-tuning of PID, expansion modules that are more than
// points, a memory cartridge, a clock that has to be plugged in.
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/embedded_times.hpp"

namespace s7200 {
namespace {

struct Size {
  std::uint32_t v, sm, analog;  ///< bytes
};

/// HC1 and HC2 need inputs from I0.6 on: the CPUs 221 and 222 do not have them (facts 10.1).
std::array<CounterModes, kCounters.size()> counter_modes(CpuSet self) {
  const CounterModes of_12 = self & kHasCounters12 ? kAllModes : 0;
  const bool counts_pulses = (self & kCpu22xRelease2) != 0;
  return {counts_pulses ? CounterModes{kModesWithoutStart | kMode12} : kModesWithoutStart,
          of_12,
          of_12,
          counts_pulses ? CounterModes{kMode0 | kMode12} : kMode0,
          kModesWithoutStart,
          kMode0};
}

CpuModel release2(std::string_view name, CpuSet self, Size size, std::uint32_t ports, std::uint32_t program_words,
                  std::uint8_t identification) {
  return {
      .name = name,
      .self = self,
      .size = {/*I*/ 16, /*Q*/ 16, /*M*/ 32, /*SM*/ size.sm, /*S*/ 32, /*AI*/ size.analog, /*AQ*/ size.analog, /*T*/ 256,
               /*C*/ 256, /*HC*/ 6, /*AC*/ 4, /*V*/ size.v, /*L*/ 64},
      .labels = 256,
      .subroutines = 64,
      .interrupts = 128,
      .ports = ports,
      .program_words = program_words,
      .eeprom_bytes = size.v,
      .retentive = {{Area::V, 0, size.v}, {Area::M, 14, 18}, {Area::T, 0, 32}, {Area::T, 64, 32}, {Area::C, 0, 256}},
      .queue_depth = {static_cast<std::uint8_t>(ports == 2 ? 8 : 4), 16, 8},
      .baud = {38'400, 19'200, 9'600, 4'800, 2'400, 1'200, 115'200, 57'600},
      .identification = identification,
      .counter_modes = counter_modes(self),
      .pulse_control = 0xFF,
      .message_control = 0xFE,
      .shortest_timed_interval = kMillisecond,
      .call_depth = 8,
      .for_depth = 8,
      .interrupt_call_depth = 1,
      .watchdog = 500 * kMillisecond,
      .integer_overflow = IntegerOverflow::Keep,
      .times_csv = {embedded::kCpu22xTimes},
      .release = "0200",
  };
}

/// A CPU of the first edition: slower, with less memory, and with 600 and 300 baud in the place of the fast rates, which
/// came with release 1.2 (facts 2.1).
CpuModel release1(std::string_view name, CpuSet self, Size size, std::uint32_t ports, std::uint32_t program_words,
                  std::uint8_t identification) {
  CpuModel model = release2(name, self, size, ports, program_words, identification);
  model.baud[6] = 600;
  model.baud[7] = 300;
  model.watchdog = 300 * kMillisecond;
  model.times_csv = {embedded::kCpu22xRelease1Times};
  model.sold_as = name.substr(0, name.find("r1"));
  model.release = "0100";
  return model;
}

}  // namespace

const CpuModel& cpu221() {
  static const CpuModel kModel = release2("221", kCpu221, {2048, 180, 32}, 1, 2048, 0x60);
  return kModel;
}

const CpuModel& cpu222() {
  static const CpuModel kModel = release2("222", kCpu222, {2048, 300, 32}, 1, 2048, 0x00);
  return kModel;
}

const CpuModel& cpu224() {
  static const CpuModel kModel = release2("224", kCpu224, {8192, 550, 64}, 1, 6144, 0x20);
  return kModel;
}

const CpuModel& cpu224xp() {
  static const CpuModel kModel = release2("224XP", kCpu224xp, {10240, 550, 64}, 2, 8192, 0x20);
  return kModel;
}

const CpuModel& cpu226() {
  static const CpuModel kModel = release2("226", kCpu226, {10240, 550, 64}, 2, 12288, 0x90);
  return kModel;
}

const CpuModel& cpu221r1() {
  static const CpuModel kModel = release1("221r1", kCpu221r1, {2048, 180, 32}, 1, 2048, 0x60);
  return kModel;
}

const CpuModel& cpu222r1() {
  static const CpuModel kModel = release1("222r1", kCpu222r1, {2048, 300, 32}, 1, 2048, 0x00);
  return kModel;
}

const CpuModel& cpu224r1() {
  static const CpuModel kModel = release1("224r1", kCpu224r1, {5120, 550, 64}, 1, 4096, 0x20);
  return kModel;
}

const CpuModel& cpu226r1() {
  static const CpuModel kModel = release1("226r1", kCpu226r1, {5120, 550, 64}, 2, 4096, 0x90);
  return kModel;
}

const CpuModel& cpu226xm() {
  static const CpuModel kModel = [] {
    CpuModel model = release1("226XM", kCpu226xm, {10240, 550, 64}, 2, 8192, 0x90);
    model.subroutines = 128;
    return model;
  }();
  return kModel;
}

}  // namespace s7200

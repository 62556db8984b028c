#include "interpreter/model/cpu_model.hpp"

#include <algorithm>
#include <iterator>

#include "interpreter/base/text/text.hpp"
#include "interpreter/model/events.hpp"

namespace s7200 {

std::string to_text(CpuSet cpus) {
  static constexpr std::pair<CpuSet, std::string_view> kNames[] = {{kCpu212, "212"},
                                                                   {kCpu214, "214"},
                                                                   {kCpu215, "215"},
                                                                   {kCpu216, "216"},
                                                                   {kCpu22x, "22x"},
                                                                   {kCpu22xRelease2, "22x of release 2"},
                                                                   {kCpu22xRelease1, "22x of release 1"},
                                                                   {kCpu221, "221"},
                                                                   {kCpu222, "222"},
                                                                   {kCpu224, "224"},
                                                                   {kCpu224xp, "224XP"},
                                                                   {kCpu226, "226"},
                                                                   {kCpu221r1, "221r1"},
                                                                   {kCpu222r1, "222r1"},
                                                                   {kCpu224r1, "224r1"},
                                                                   {kCpu226r1, "226r1"},
                                                                   {kCpu226xm, "226XM"}};
  std::vector<std::string_view> names;
  for (const auto& [set, name] : kNames) {
    if ((cpus & set) != set) continue;
    names.push_back(name);
    cpus = static_cast<CpuSet>(cpus & ~set);
  }
  std::string text = "CPU ";
  for (std::size_t i = 0; i < names.size(); ++i)
    text.append(i == 0 ? "" : i + 1 == names.size() ? " or " : ", ").append(names[i]);
  return text;
}

// Facts 3.1 and 10.2. In the order of the 21x list the events that only 22x CPUs have come last.
std::span<const InterruptEvent> all_events() {
  static constexpr InterruptEvent kTable[] = {
      {event::kI00Rises, Queue::Io, 0, 2, kEveryCpu, "rising edge of I0.0"},
      {event::kI00Falls, Queue::Io, 4, 6, kEveryCpu, "falling edge of I0.0"},
      {event::kI01Rises, Queue::Io, 1, 3, kFrom214, "rising edge of I0.1"},
      {event::kI01Falls, Queue::Io, 5, 7, kFrom214, "falling edge of I0.1"},
      {event::kI02Rises, Queue::Io, 2, 4, kFrom214, "rising edge of I0.2"},
      {event::kI02Falls, Queue::Io, 6, 8, kFrom214, "falling edge of I0.2"},
      {event::kI03Rises, Queue::Io, 3, 5, kFrom214, "rising edge of I0.3"},
      {event::kI03Falls, Queue::Io, 7, 9, kFrom214, "falling edge of I0.3"},
      {event::kPort0Received, Queue::Communication, 0, 0, kEveryCpu, "port 0: character received"},
      {event::kPort0Sent, Queue::Communication, 1, 1, kEveryCpu, "port 0: transmit complete"},
      {event::kTimed0, Queue::Timed, 0, 0, kEveryCpu, "timed interrupt 0, SMB34"},
      {event::kTimed1, Queue::Timed, 1, 1, kFrom214, "timed interrupt 1, SMB35"},
      {event::kCounter0Reached, Queue::Io, 0, 10, kEveryCpu, "HSC0: current value = preset value"},
      {event::kCounter1Reached, Queue::Io, 9, 13, kHasCounters12, "HSC1: current value = preset value"},
      {event::kCounter1Turned, Queue::Io, 10, 14, kHasCounters12, "HSC1: direction changed"},
      {event::kCounter1Reset, Queue::Io, 11, 15, kHasCounters12, "HSC1: external reset"},
      {event::kCounter2Reached, Queue::Io, 12, 16, kHasCounters12, "HSC2: current value = preset value"},
      {event::kCounter2Turned, Queue::Io, 13, 17, kHasCounters12, "HSC2: direction changed"},
      {event::kCounter2Reset, Queue::Io, 14, 18, kHasCounters12, "HSC2: external reset"},
      {event::kPulses0Complete, Queue::Io, 15, 0, kFrom214, "PLS0: pulse count complete"},
      {event::kPulses1Complete, Queue::Io, 16, 1, kFrom214, "PLS1: pulse count complete"},
      {event::kT32Reached, Queue::Timed, 2, 2, kFrom215, "timer T32: current value = preset value"},
      {event::kT96Reached, Queue::Timed, 3, 3, kFrom215, "timer T96: current value = preset value"},
      {event::kPort0Message, Queue::Communication, 2, 2, kFrom215, "port 0: message received"},
      {event::kPort1Message, Queue::Communication, 3, 3, kTwoPorts, "port 1: message received"},
      {event::kPort1Received, Queue::Communication, 4, 4, kTwoPorts, "port 1: character received"},
      {event::kPort1Sent, Queue::Communication, 5, 5, kTwoPorts, "port 1: transmit complete"},
      {event::kCounter0Turned, Queue::Io, 17, 11, kCpu22x, "HSC0: direction changed"},
      {event::kCounter0Reset, Queue::Io, 18, 12, kCpu22x, "HSC0: external reset"},
      {event::kCounter4Reached, Queue::Io, 19, 20, kCpu22x, "HSC4: current value = preset value"},
      {event::kCounter4Turned, Queue::Io, 20, 21, kCpu22x, "HSC4: direction changed"},
      {event::kCounter4Reset, Queue::Io, 21, 22, kCpu22x, "HSC4: external reset"},
      {event::kCounter3Reached, Queue::Io, 22, 19, kCpu22x, "HSC3: current value = preset value"},
      {event::kCounter5Reached, Queue::Io, 23, 23, kCpu22x, "HSC5: current value = preset value"},
  };
  static_assert(std::size(kTable) == kEvents);
  return kTable;
}

std::string needs(std::string_view what, CpuSet cpus) {
  std::string text(what);
  text.append(" ").append(to_text(cpus));
  const CpuModel* usual = cpus & kCpu224   ? &cpu224()
                          : cpus & kCpu226 ? &cpu226()
                                           : smallest_cpu([&](const CpuModel& m) { return (m.self & cpus) != 0; });
  if (usual && (cpus & kCpu21x) == 0) text.append("; choose one, such as CPU ").append(usual->name);
  return text;
}

const InterruptEvent* find_event(std::int64_t number) {
  if (number < 0 || number >= static_cast<std::int64_t>(kEvents)) return nullptr;
  return &all_events()[static_cast<std::size_t>(number)];
}

std::optional<std::uint8_t> CpuModel::pointer_code(Area area) const {
  const bool reached = (self & kCpu22xRelease2) != 0 || (area != Area::SM && area != Area::AI && area != Area::AQ);
  return reached && size_of(area) != 0 ? info(area).pointer_code : std::nullopt;
}

TimerBase timer_base(std::uint32_t number) {
  if (number >= 128) return {100 * kMillisecond, false};
  const std::uint32_t n = number % 64;  // T64–T127 repeat T0–T63
  const Time base = n % 32 == 0 ? kMillisecond : n % 32 <= 4 ? 10 * kMillisecond : 100 * kMillisecond;
  return {base, n < 32};
}

// The bytes of special memory: facts 4.3–4.5, 2.1 and 10.5.
const std::vector<SpecialMemory>& special_memory() {
  using enum SpecialUse;
  constexpr std::string_view kNoExpansion = "no expansion module is simulated",
                             kNoModule = "no intelligent module is simulated";
  constexpr std::string_view kNoLinear = "a profile of several segments is: SM67.5, SM77.5";
  static const std::vector<SpecialMemory> kTable{
      {0, 0, Modelled, "scan status: always 1, first scan, clocks, mode switch"},
      {1, 1, Modelled, "result of the last instruction: zero, overflow, negative, division by zero …"},
      {2, 2, Modelled, "Freeport: character received"},
      {3, 3, Modelled, "Freeport: parity error"},
      {4, 4, Modelled, "interrupt queue overflow, run-time error, interrupts enabled, transmitter idle"},
      {5, 5, Modelled, "I/O errors (none are simulated)"},
      {6, 6, Modelled, "CPU identification"},
      {7, 7, Plain, "reserved"},
      {8, 21, Still, "identity and errors of expansion modules", kEveryCpu, kNoExpansion},
      {22, 27, Modelled, "last, shortest and longest scan time"},
      {28, 28, Modelled, "analog potentiometer 0"},
      {29, 29, Modelled, "analog potentiometer 1", kTwoPotentiometers},
      {30, 30, Modelled, "Freeport: port control"},
      {31, 33, Modelled, "saving a V value to EEPROM"},
      {34, 35, Modelled, "timed interrupts: interval in ms"},
      {36, 45, Modelled, "high-speed counter HSC0"},
      {46, 65, Modelled, "high-speed counters HSC1 and HSC2", kHasCounters12},
      {66, 85, Modelled, "pulse outputs"},
      {86, 94, Modelled, "receive message, port 0", kFrom215},
      {95, 97, Plain, "reserved"},
      {98, 99, Modelled, "parity errors on the I/O bus (none are simulated)"},
      {100, 129, Plain, "reserved"},
      {130, 130, Modelled, "Freeport: control of port 1", kTwoPorts},
      {131, 135, Plain, "reserved"},
      {136, 165, Modelled, "high-speed counters HSC3 to HSC5", kCpu22x},
      {166, 169, Modelled, "pulse output 0: profile", kCpu22x},
      {170, 175, Refused, "pulse output 0: linear profile", kCpu22xRelease2, kNoLinear},
      {176, 179, Modelled, "pulse output 1: profile", kCpu22x},
      {180, 185, Refused, "pulse output 1: linear profile", kCpu22xRelease2, kNoLinear},
      {186, 194, Modelled, "receive message, port 1", kTwoPorts},
      {195, 199, Plain, "reserved"},
      {200, 549, Still, "intelligent modules", kEveryCpu, kNoModule},
  };
  return kTable;
}

const std::vector<const CpuModel*>& all_cpus() {
  static const std::vector<const CpuModel*> kModels{&cpu212(),   &cpu214(),   &cpu215(),   &cpu216(),   &cpu221r1(),
                                                    &cpu222r1(), &cpu224r1(), &cpu226r1(), &cpu226xm(), &cpu221(),
                                                    &cpu222(),   &cpu224(),   &cpu224xp(), &cpu226()};
  return kModels;
}

const CpuModel* find_cpu(std::string_view name) {
  std::string type = stl::upper_case(name);
  if (type.starts_with("CPU")) type = stl::trim(std::string_view(type).substr(3));  // `CPU 224`
  const auto found = std::find_if(all_cpus().begin(), all_cpus().end(),
                                  [&](const CpuModel* m) { return stl::upper_case(m->name) == type; });
  return found == all_cpus().end() ? nullptr : *found;
}

}  // namespace s7200

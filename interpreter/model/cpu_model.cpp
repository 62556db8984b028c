#include "interpreter/model/cpu_model.hpp"

#include <algorithm>

namespace s7200 {

std::string to_text(CpuSet cpus) {
  static constexpr std::pair<CpuSet, std::string_view> kNames[] = {
      {kCpu212, "212"}, {kCpu214, "214"}, {kCpu215, "215"}, {kCpu216, "216"}, {kCpu22x, "22x"}};
  std::vector<std::string_view> names;
  for (const auto& [cpu, name] : kNames)
    if (cpus & cpu) names.push_back(name);
  std::string text = "CPU ";
  for (std::size_t i = 0; i < names.size(); ++i)
    text.append(i == 0 ? "" : i + 1 == names.size() ? " or " : ", ").append(names[i]);
  return text;
}

// Facts 3.1. The order inside a group is the 21x list; what only 22x CPUs have follows it.
const std::vector<InterruptEvent>& all_events() {
  static const std::vector<InterruptEvent> kTable{
      {0, Queue::Io, 0, kEveryCpu, "rising edge of I0.0"},
      {1, Queue::Io, 4, kEveryCpu, "falling edge of I0.0"},
      {2, Queue::Io, 1, kFrom214, "rising edge of I0.1"},
      {3, Queue::Io, 5, kFrom214, "falling edge of I0.1"},
      {4, Queue::Io, 2, kFrom214, "rising edge of I0.2"},
      {5, Queue::Io, 6, kFrom214, "falling edge of I0.2"},
      {6, Queue::Io, 3, kFrom214, "rising edge of I0.3"},
      {7, Queue::Io, 7, kFrom214, "falling edge of I0.3"},
      {8, Queue::Communication, 0, kEveryCpu, "port 0: character received"},
      {9, Queue::Communication, 1, kEveryCpu, "port 0: transmit complete"},
      {10, Queue::Timed, 0, kEveryCpu, "timed interrupt 0, SMB34"},
      {11, Queue::Timed, 1, kFrom214, "timed interrupt 1, SMB35"},
      {12, Queue::Io, 0, kEveryCpu, "HSC0: current value = preset value"},
      {13, Queue::Io, 9, kFrom214, "HSC1: current value = preset value"},
      {14, Queue::Io, 10, kFrom214, "HSC1: direction changed"},
      {15, Queue::Io, 11, kFrom214, "HSC1: external reset"},
      {16, Queue::Io, 12, kFrom214, "HSC2: current value = preset value"},
      {17, Queue::Io, 13, kFrom214, "HSC2: direction changed"},
      {18, Queue::Io, 14, kFrom214, "HSC2: external reset"},
      {19, Queue::Io, 15, kFrom214, "PLS0: pulse count complete"},
      {20, Queue::Io, 16, kFrom214, "PLS1: pulse count complete"},
      {21, Queue::Timed, 2, kFrom215, "timer T32: current value = preset value"},
      {22, Queue::Timed, 3, kFrom215, "timer T96: current value = preset value"},
      {23, Queue::Communication, 2, kFrom215, "port 0: message received", false},
      {24, Queue::Communication, 3, kCpu216 | kCpu22x, "port 1: message received", false},
      {25, Queue::Communication, 4, kCpu216 | kCpu22x, "port 1: character received", false},
      {26, Queue::Communication, 5, kCpu216 | kCpu22x, "port 1: transmit complete", false},
      {27, Queue::Io, 17, kCpu22x, "HSC0: direction changed", false},
      {28, Queue::Io, 18, kCpu22x, "HSC0: external reset", false},
      {29, Queue::Io, 19, kCpu22x, "HSC4: current value = preset value", false},
      {30, Queue::Io, 20, kCpu22x, "HSC4: direction changed", false},
      {31, Queue::Io, 21, kCpu22x, "HSC4: external reset", false},
      {32, Queue::Io, 22, kCpu22x, "HSC3: current value = preset value", false},
      {33, Queue::Io, 23, kCpu22x, "HSC5: current value = preset value", false},
  };
  return kTable;
}

const InterruptEvent* find_event(std::int64_t number) {
  if (number < 0 || number >= static_cast<std::int64_t>(kEvents)) return nullptr;
  return &all_events()[static_cast<std::size_t>(number)];
}

TimerBase timer_base(std::uint32_t number) {
  if (number >= 128) return {100 * kMillisecond, false};
  const std::uint32_t n = number % 64;  // T64–T127 repeat T0–T63
  const Time base = n % 32 == 0 ? kMillisecond : n % 32 <= 4 ? 10 * kMillisecond : 100 * kMillisecond;
  return {base, n < 32};
}

// Facts 4.3–4.5 and 2.1.
const std::vector<SpecialMemory>& special_memory() {
  static const std::vector<SpecialMemory> kTable{
      {0, 0, true, "scan status: always 1, first scan, clocks, mode switch"},
      {1, 1, true, "result of the last instruction: zero, overflow, negative, division by zero …"},
      {2, 2, true, "Freeport: character received"},
      {3, 3, true, "Freeport: parity error"},
      {4, 4, true, "interrupt queue overflow, run-time error, interrupts enabled, transmitter idle"},
      {5, 5, true, "I/O errors (none are simulated)"},
      {6, 6, true, "CPU identification"},
      {7, 7, true, "reserved"},
      {8, 21, false, "identity and errors of expansion modules"},
      {22, 27, true, "last, shortest and longest scan time"},
      {28, 29, true, "analog potentiometers"},
      {30, 30, true, "Freeport: port control"},
      {31, 33, true, "saving a V value to EEPROM"},
      {34, 35, true, "timed interrupts: interval in ms"},
      {36, 65, true, "high-speed counters"},
      {66, 85, true, "pulse outputs"},
      {86, 94, false, "receive message, port 0"},
      {95, 129, false, "reserved"},
      {130, 130, false, "Freeport: control of port 1"},
      {131, 185, false, "reserved"},
      {186, 194, false, "receive message, port 1"},
  };
  return kTable;
}

const std::vector<const CpuModel*>& all_cpus() {
  static const std::vector<const CpuModel*> kModels{&cpu212(), &cpu214(), &cpu215(), &cpu216()};
  return kModels;
}

const CpuModel* find_cpu(std::string_view name) {
  const auto found = std::find_if(all_cpus().begin(), all_cpus().end(), [&](const CpuModel* m) { return m->name == name; });
  return found == all_cpus().end() ? nullptr : *found;
}

}  // namespace s7200

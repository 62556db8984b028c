// What differs between the CPUs of the S7-200 family.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/time.hpp"
#include "interpreter/model/area.hpp"

namespace s7200 {

/// A set of CPU types. Each instruction has the set of CPUs that know it, so that a message can say which CPU it needs.
using CpuSet = std::uint8_t;
inline constexpr CpuSet kCpu212 = 1, kCpu214 = 2, kCpu215 = 4, kCpu216 = 8;
inline constexpr CpuSet kCpu21x = 15, kCpu22x = 16, kEveryCpu = 31;
inline constexpr CpuSet kFrom214 = kEveryCpu & ~kCpu212, kFrom215 = kCpu215 | kCpu216 | kCpu22x;

/// "CPU 214, 215, 216 or 22x"
std::string to_text(CpuSet cpus);

/// The three interrupt queues, in order of priority (S7-200 manual C230-02, 10-120).
enum class Queue : std::uint8_t { Communication, Io, Timed };
inline constexpr std::size_t kQueues = 3;

struct InterruptEvent {
  std::uint8_t number;
  Queue queue;
  std::uint8_t order;  ///< inside its queue, if several occur at the same instant
  CpuSet cpus;
  std::string_view cause;
  bool modelled = true;
};

/// All events of the family.
const std::vector<InterruptEvent>& all_events();
/// Null for a number that no CPU has.
const InterruptEvent* find_event(std::int64_t number);

inline constexpr std::size_t kEvents = 34;

/// Memory that survives power off, with the settings that the CPU is delivered with (facts 1.6).
struct RetentiveRange {
  Area area;
  std::uint32_t first, count;  ///< bytes, or elements of T and C

  std::uint32_t at() const { return info(area).base + first * info(area).step(); }  ///< in the image
  std::uint32_t bytes() const { return count * info(area).step(); }
};

/// What OUT holds after +I, -I, +D, -D or DIV if the result does not fit.
enum class IntegerOverflow : std::uint8_t {
  Wrap,  ///< the low bits of the result
  Keep   ///< what was there before (S7-200 manual from 2004 on, 140: CPU 22x)
};

struct CpuModel {
  std::string_view name;  ///< "214"
  CpuSet self;
  std::array<std::uint32_t, kAreas> size;         ///< bytes, or elements of T, C, HC and AC; by Area
  std::uint32_t labels, subroutines, interrupts;  ///< how many there are, numbered from 0
  std::uint32_t ports;
  std::uint32_t program_words;
  std::uint32_t eeprom_bytes;  ///< how much V memory the EEPROM can hold, from V0
  std::vector<RetentiveRange> retentive;
  std::array<std::uint8_t, kQueues> queue_depth;
  std::array<std::uint32_t, 8> baud;          ///< by the three bits bbb of SMB30
  std::uint8_t identification;                ///< SMB6
  Time shortest_timed_interval;               ///< of SMB34 and SMB35
  std::uint32_t call_depth, for_depth;        ///< nesting of subroutines and of FOR loops
  Time watchdog;                              ///< longest scan
  IntegerOverflow integer_overflow;           ///< of +I, -I, +D, -D and DIV
  std::array<std::string_view, 2> times_csv;  ///< execution times, in the format of model/times.hpp; the second may be empty

  std::uint32_t size_of(Area area) const { return size[static_cast<std::size_t>(area)]; }
};

/// Time base and kind of a timer, by its number (facts 1.1); the same on all CPUs.
struct TimerBase {
  Time base;       ///< 1, 10 or 100 ms
  bool retentive;  ///< TONR; otherwise TON
};
TimerBase timer_base(std::uint32_t number);

/// The bytes of special memory that a program may use, and whether the simulator does what they say.
struct SpecialMemory {
  std::uint8_t first, last;  ///< SMB numbers
  bool modelled;
  std::string_view meaning;
};
const std::vector<SpecialMemory>& special_memory();

/// SM0.0–SM29.7 are read-only for the program (facts 1.1).
inline constexpr std::uint32_t kReadOnlySpecialMemory = 30;

const CpuModel& cpu212();
const CpuModel& cpu214();
const CpuModel& cpu215();
const CpuModel& cpu216();

/// From the smallest to the largest.
const std::vector<const CpuModel*>& all_cpus();

/// Null if the simulator has no model of that name.
const CpuModel* find_cpu(std::string_view name);

}  // namespace s7200

// The differences between the CPUs of the S7-200 family.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/time.hpp"
#include "interpreter/model/area.hpp"
#include "interpreter/model/counters.hpp"

namespace s7200 {

/// A set of CPU types. Each instruction has the set of CPUs that know it, so that a message can say which CPU it needs.
using CpuSet = std::uint16_t;
inline constexpr CpuSet kCpu212 = 0x001, kCpu214 = 0x002, kCpu215 = 0x004, kCpu216 = 0x008;
// CPUs of release 1, 2000 to 2003: 6ES7 21x-xxx21 and -xxx22, and the 226XM.
inline constexpr CpuSet kCpu221r1 = 0x010, kCpu222r1 = 0x020, kCpu224r1 = 0x040, kCpu226r1 = 0x080, kCpu226xm = 0x100;
// CPUs of release 2, from 2004 on: 6ES7 21x-xxx23.
inline constexpr CpuSet kCpu221 = 0x200, kCpu222 = 0x400, kCpu224 = 0x800, kCpu224xp = 0x1000, kCpu226 = 0x2000;
inline constexpr CpuSet kCpu21x = kCpu212 | kCpu214 | kCpu215 | kCpu216;
inline constexpr CpuSet kCpu22xRelease1 = kCpu221r1 | kCpu222r1 | kCpu224r1 | kCpu226r1 | kCpu226xm;
inline constexpr CpuSet kCpu22xRelease2 = kCpu221 | kCpu222 | kCpu224 | kCpu224xp | kCpu226;
inline constexpr CpuSet kCpu22x = kCpu22xRelease1 | kCpu22xRelease2, kEveryCpu = kCpu21x | kCpu22x;
inline constexpr CpuSet kFrom214 = kEveryCpu & ~kCpu212, kFrom215 = kCpu215 | kCpu216 | kCpu22x;
inline constexpr CpuSet kFrom224 = kCpu22x & ~(kCpu221r1 | kCpu222r1 | kCpu221 | kCpu222);
/// HSC1 and HSC2: not on the CPUs 221 and 222.
inline constexpr CpuSet kHasCounters12 = (kCpu21x & ~kCpu212) | kFrom224;
inline constexpr CpuSet kTwoPotentiometers = kCpu21x | kFrom224;
inline constexpr CpuSet kTwoPorts = kCpu216 | kCpu226r1 | kCpu226xm | kCpu224xp | kCpu226;

/// "CPU 214, 215, 216 or 22x"; "CPU 22x of release 2"
std::string to_text(CpuSet cpus);

/// The advice for something that only some CPUs have: "LDW<> needs CPU 22x; choose one, such as CPU 224". `what` includes
/// the verb.
std::string needs(std::string_view what, CpuSet cpus);

/// The three interrupt queues, in order of priority (S7-200 manual C230-02, 10-120).
enum class Queue : std::uint8_t { Communication, Io, Timed };
inline constexpr std::size_t kQueues = 3;

struct InterruptEvent {
  std::uint8_t number;
  Queue queue;
  std::uint8_t order_21x, order_22x;  ///< inside its queue, if several occur at the same instant
  CpuSet cpus;
  std::string_view cause;

  std::uint8_t order(CpuSet cpu) const { return cpu & kCpu22x ? order_22x : order_21x; }
};

/// All events of the family, by number.
std::span<const InterruptEvent> all_events();
/// Returns null for a number that no CPU has.
const InterruptEvent* find_event(std::int64_t number);

inline constexpr std::size_t kEvents = 34;

/// Memory that survives power off, with the settings that the CPU is delivered with (facts 1.6).
struct RetentiveRange {
  Area area;
  std::uint32_t first, count;  ///< bytes, or elements of T and C

  std::uint32_t at() const { return info(area).base + first * info(area).step(); }  ///< in the image
  std::uint32_t bytes() const { return count * info(area).step(); }
  auto operator<=>(const RetentiveRange&) const = default;
};

/// The result in OUT of +I, -I, +D, -D or DIV if the result does not fit.
enum class IntegerOverflow : std::uint8_t {
  Wrap,  ///< the low bits of the result
  Keep   ///< what was there before (S7-200 manual from 2004 on, 140: CPU 22x)
};

/// Properties of RCV that the manuals leave open (facts 10.3). The defaults are those of the models.
struct ReceiveChoices {
  bool idle_or_break = true;                ///< il and bk together: either is enough to start; otherwise it takes both
  bool start_may_end = false;               ///< a start character that is also the end character ends the message
  bool stores_bad_character = false;        ///< the character that ends the message with a parity or framing error
  bool end_and_count = true;                ///< end character and count reached together set both bits; otherwise only e
  bool event_after_user_end = false;        ///< RCV with en = 0 that ends a receive causes event 23
  bool event_after_bad_parameters = false;  ///< so does a refused RCV, status r
  bool character_events = false;            ///< event 8 is raised even while RCV receives
};

struct CpuModel {
  std::string_view name;  ///< "214"
  CpuSet self;
  std::array<std::uint32_t, kAreas> size;         ///< bytes, or elements of T, C, HC and AC; by Area; 0: it has none
  std::uint32_t labels, subroutines, interrupts;  ///< how many there are, numbered from 0
  std::uint32_t ports;
  std::uint32_t program_words;
  std::uint32_t eeprom_bytes;  ///< how much V memory the EEPROM can hold, from V0
  std::vector<RetentiveRange> retentive;
  std::array<std::uint8_t, kQueues> queue_depth;
  std::array<std::uint32_t, 8> baud;  ///< by the three bits bbb of SMB30
  std::uint8_t identification;        ///< SMB6
  std::array<CounterModes, kCounters.size()> counter_modes;
  std::uint8_t pulse_control;                 ///< the bits of SMB67 and SMB77 that it has
  std::uint8_t message_control;               ///< the bits of SMB87 that it has
  Time shortest_timed_interval;               ///< of SMB34 and SMB35
  std::uint32_t call_depth, for_depth;        ///< nesting of subroutines and of FOR loops
  std::uint32_t interrupt_call_depth;         ///< nesting of subroutines in an interrupt routine
  Time watchdog;                              ///< longest scan
  IntegerOverflow integer_overflow;           ///< of +I, -I, +D, -D and DIV
  std::array<std::string_view, 2> times_csv;  ///< execution times, in the format of model/times/times.hpp; the second may be empty
  ReceiveChoices receive{};
  std::string_view sold_as{};         ///< if it is another than the name, which tells releases of one CPU apart
  std::string_view release = "0100";  ///< the four digits that PPI tells

  std::uint32_t size_of(Area area) const { return size[static_cast<std::size_t>(area)]; }

  /// Top byte of a pointer to an area; nothing if no pointer of this CPU reaches it.
  std::optional<std::uint8_t> pointer_code(Area area) const;
};

/// Time base and kind of a timer, by its number (facts 1.1); the same on all CPUs.
struct TimerBase {
  Time base;       ///< 1, 10 or 100 ms
  bool retentive;  ///< TONR; otherwise TON
};
TimerBase timer_base(std::uint32_t number);

/// The use of bytes of special memory, as a program sees it.
enum class SpecialUse : std::uint8_t {
  Modelled,  ///< used as in the manual
  Plain,     ///< memory that the CPU makes no use of
  Still,     ///< what they have at power-up: nothing that would change them is simulated
  Refused,   ///< refused: the CPU would do something that is not modelled
};

/// Bytes of special memory. On a CPU that has them but not what they are for, they are plain memory.
struct SpecialMemory {
  std::uint16_t first, last;  ///< SMB numbers
  SpecialUse use;
  std::string_view meaning;
  CpuSet cpus = kEveryCpu;
  std::string_view why{};  ///< for Still and Refused: what is not simulated

  SpecialUse on(const CpuModel& model) const { return cpus & model.self ? use : SpecialUse::Plain; }
};
const std::vector<SpecialMemory>& special_memory();

/// SM0.0–SM29.7 are read-only for the program (facts 1.1).
inline constexpr std::uint32_t kReadOnlySpecialMemory = 30;

const CpuModel& cpu212();
const CpuModel& cpu214();
const CpuModel& cpu215();
const CpuModel& cpu216();
const CpuModel& cpu221();
const CpuModel& cpu222();
const CpuModel& cpu224();
const CpuModel& cpu224xp();
const CpuModel& cpu226();
// CPUs of release 1.
const CpuModel& cpu221r1();
const CpuModel& cpu222r1();
const CpuModel& cpu224r1();
const CpuModel& cpu226r1();
const CpuModel& cpu226xm();

/// All CPUs, from the smallest to the largest.
const std::vector<const CpuModel*>& all_cpus();

/// The first of them that has what is needed; null if none has.
template <typename Condition>
const CpuModel* smallest_cpu(Condition has) {
  for (const CpuModel* model : all_cpus())
    if (has(*model)) return model;
  return nullptr;
}

/// The model of a name: `224XP` or `224xp`. Null if the simulator has no model of that name.
const CpuModel* find_cpu(std::string_view name);

}  // namespace s7200

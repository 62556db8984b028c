// Everything that a CPU remembers. Plain and copyable: a snapshot is a copy.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/base/serial_format.hpp"
#include "interpreter/base/time.hpp"
#include "interpreter/model/area.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/ports.hpp"

namespace s7200 {

/// Nine levels of one bit, S0 on top. The bit that enters at the bottom after a pop is unknown, 0 or 1 (S7-200 manual
/// C233-01, 9-194); here it is 0.
class LogicStack {
 public:
  static constexpr int kLevels = 9;
  static constexpr std::uint16_t kAll = (1 << kLevels) - 1;

  bool top() const { return bits_ & 1; }
  bool level(int n) const { return (bits_ >> n) & 1; }
  std::uint16_t bits() const { return bits_; }
  void push(bool value) { bits_ = static_cast<std::uint16_t>(((bits_ << 1) | (value ? 1 : 0)) & kAll); }
  void pop() { bits_ >>= 1; }
  void set_top(bool value) { bits_ = static_cast<std::uint16_t>((bits_ & ~1) | (value ? 1 : 0)); }
  static LogicStack from_bits(std::uint64_t bits) {
    LogicStack s;
    s.bits_ = static_cast<std::uint16_t>(bits);
    return s;
  }
  /// The stack at the start of a subroutine or interrupt routine: S0 = 1, all others 0.
  static LogicStack on_entry() {
    LogicStack s;
    s.push(true);
    return s;
  }

  bool operator==(const LogicStack&) const = default;

 private:
  std::uint16_t bits_ = 0;
};

enum class Mode : std::uint8_t { Stop, Run };

/// Parts of a scan, in order (S7-200 manual C230-02, 6-10). The last one only comes if the program has asked for it.
enum class Phase : std::uint8_t { ReadInputs, Program, Communication, SelfTest, WriteOutputs, SaveToEeprom };

inline constexpr std::size_t kMostCalls = 9;  ///< subroutines open at a time, with the one of an interrupt routine

/// A frame says where a subroutine returns to, and has its caller's logic stack and power rail.
struct CallFrame {
  std::uint32_t return_to = 0;
  LogicStack stack{};
  bool rail = true;
  bool operator==(const CallFrame&) const = default;
};

/// The main program, eight levels of subroutines, an interrupt routine and the one it calls each have local memory of their
/// own (facts 1.2).
inline constexpr std::size_t kLocalLevels = 11;
using LocalMemory = std::array<std::uint8_t, 64>;

struct QueuedInterrupt {
  Time at = 0;  ///< when it occurred
  std::uint8_t event = 0;
  std::uint8_t byte = 0;      ///< the character of a port's receive event, for SMB2
  bool parity_error = false;  ///< for SM3.0
  bool operator==(const QueuedInterrupt&) const = default;
};

struct InterruptQueue {
  std::array<QueuedInterrupt, 16> entry{};
  std::uint8_t count = 0;
  bool operator==(const InterruptQueue&) const = default;
};

/// The CPU saves these around an interrupt routine: logic stack, accumulators, SMB1 (facts 3.2), the power rail and ENO.
struct SavedContext {
  std::uint32_t return_to = 0;
  LogicStack stack{};
  bool rail = true;
  bool eno = true;
  std::array<std::uint8_t, 16> accumulators{};
  std::uint8_t smb1 = 0;
  std::uint8_t call_depth = 0;  ///< where an interrupt routine's own calls begin
  bool operator==(const SavedContext&) const = default;
};

inline constexpr std::uint8_t kNotAttached = 0xFF;

/// The routine of each event, by its number.
using Attachments = std::array<std::uint8_t, kEvents>;
constexpr Attachments nothing_attached() {
  Attachments attached{};
  attached.fill(kNotAttached);
  return attached;
}

/// The receive message service of a port: what it is doing, and the parameters that it works with, as RCV found them.
struct MessageReceiver {
  enum class Phase : std::uint8_t { Off, Search, Message };

  Phase phase = Phase::Off;
  bool was_idle = false;     ///< in the search: the line has been idle for as long as asked
  bool had_break = false;    ///< in the search: the last thing on the line was a break
  std::uint8_t control = 0;  ///< of sm::message::Control
  std::uint8_t start_character = 0, end_character = 0, most = 0;
  Time idle_time = 0, timeout = 0;
  std::uint32_t table = 0;  ///< place of the number of characters in the image
  std::uint8_t stored = 0;
  bool operator==(const MessageReceiver&) const = default;
};

/// The sender whose character, or break, the port is putting on the line.
enum class OnWire : std::uint8_t { Nothing, Xmt, Ppi };

struct Freeport {
  std::uint8_t control = 0;  ///< the control byte that the port last took over
  bool active = false;       ///< in Freeport mode and in RUN
  bool transmitting = false;
  bool sending_break = false;
  std::uint8_t on_line = 0;  ///< character being sent
  OnWire on_wire = OnWire::Nothing;
  std::uint32_t buffer = 0;  ///< place of the next character in the image
  std::uint16_t left = 0;    ///< characters not yet given to the line
  SerialFormat format{};
  MessageReceiver message{};
  bool operator==(const Freeport&) const = default;
};

/// A port in PPI mode, as a slave (ppi.hpp).
struct PpiPort {
  enum class Job : std::uint8_t {
    None,
    Waiting,   ///< a request waits for the communication part of the scan
    Ready,     ///< its answer waits to be fetched
    Delivered  ///< the answer has been fetched, and may be once more
  };

  std::array<std::uint8_t, ppi::kLongestFrame> frame{};  ///< being received or sent
  std::uint16_t received = 0;                            ///< characters of it
  std::uint16_t sending = 0, sent = 0;                   ///< length of what is sent, 0 for nothing, and how much has been
  bool lost = false;                                     ///< nothing is understood until there is silence
  Time heard = 0;                                        ///< end of the last character
  Job job = Job::None;
  std::uint8_t master = 0;   ///< whose job it is
  Time asked = 0;            ///< when that one last asked or polled
  bool frame_count = false;  ///< of the poll that fetched the answer
  std::array<std::uint8_t, ppi::kLongestData> message{};
  std::uint8_t length = 0;            ///< of the message: the request, then its answer
  std::optional<Mode> wanted_mode{};  ///< for when the answer has left
  bool uploads = false;               ///< the upload of a block has begun and has not been ended
  std::uint16_t uploaded = 0;         ///< bytes of it that have been asked for
  bool operator==(const PpiPort&) const = default;
};

/// A port in PPI master mode (network.hpp).
struct NetworkPort {
  static constexpr std::size_t kMostJobs = 8, kMostBytes = 16;
  struct Job {
    std::uint32_t table = 0;    ///< its place in the image
    std::uint32_t pointer = 0;  ///< to the data of the station
    std::uint8_t station = 0, length = 0;
    bool writes = false;
    bool operator==(const Job&) const = default;
  };
  enum class Phase : std::uint8_t {
    Idle,
    Asked,   ///< the request has been sent
    Polled,  ///< it was accepted, and the answer is being fetched
    Over     ///< the communication part of the scan is to hand over what has come
  };

  std::array<Job, kMostJobs> jobs{};  ///< in the order in which they were started; the first is the one under way
  std::uint8_t count = 0;             ///< of them
  Phase phase = Phase::Idle;
  std::uint8_t tries = 0;    ///< of what was sent last
  bool damaged = false;      ///< something came in that could not be read
  bool frame_count = false;  ///< of the last poll
  std::uint8_t status = 0;   ///< with which the job ends
  std::uint16_t number = 0;  ///< of the last request
  Time accepted = 0;         ///< when that was, by the station
  std::array<std::uint8_t, kMostBytes> data{};
  bool operator==(const NetworkPort&) const = default;
};

struct TimerState {
  std::int16_t preset = 0;  ///< at its last execution
  bool enabled = false;     ///< it counts: a TON or TONR whose input was on, a TOF whose input has gone off
  bool off_delay = false;   ///< a TOF
  bool input = false;       ///< of a TOF, at its last execution
  Time since = 0;           ///< end of the execution that enabled it; 0 if the last one did not leave it enabled
  bool operator==(const TimerState&) const = default;
};

struct HighSpeedCounter {
  bool defined = false, enabled = false;
  bool up = true;
  bool reset_low = false, start_low = false, single_rate = false;
  std::uint8_t mode = 0;
  std::int32_t current = 0, preset = 0;
  bool operator==(const HighSpeedCounter&) const = default;
};

struct PulseTrain {
  bool pwm = false;
  bool profile = false;  ///< its segments are in a table
  std::uint8_t segments = 0;
  std::uint32_t table = 0;   ///< place of their number in the image; they follow it
  Time unit = kMicrosecond;  ///< of the cycle time
  Time cycle = 2 * kMicrosecond, width = 0;
  std::uint32_t count = 1;
  bool operator==(const PulseTrain&) const = default;
};

struct PulseOutput {
  bool running = false, has_next = false;
  PulseTrain train{}, next{}, last{};  ///< running; queued after it; last programmed
  std::uint32_t left = 0;              ///< pulses of the train or segment, including the current one
  std::uint8_t segment = 0;            ///< of a profile: number of the current one
  Time delta = 0;                      ///< of a segment: by which each cycle is longer than the one before
  Time cycle_end = 0;
  bool operator==(const PulseOutput&) const = default;
};

/// Time of day, in plain numbers. The defaults are where a clock that was lost starts (A5E00066097-02, 9-72).
struct ClockTime {
  std::uint8_t year = 90, month = 1, day = 1, hour = 0, minute = 0, second = 0;
  std::uint8_t weekday = 1;  ///< 1 Sunday … 7 Saturday, 0 switched off
  bool operator==(const ClockTime&) const = default;
};

/// A run-time error: its code, the instruction, how often it occurred, and when first.
struct RuntimeError {
  std::uint16_t code = 0;
  std::uint32_t op = 0;
  std::uint64_t count = 0;
  Time first = 0;
  bool operator==(const RuntimeError&) const = default;
};

/// Points that a programming device has forced.
struct ForcedPoints {
  std::array<std::uint8_t, image::kPointBytes> mask{}, value{};

  std::uint8_t over(std::uint32_t byte, std::uint8_t free) const {
    return static_cast<std::uint8_t>((free & ~mask[byte]) | value[byte]);
  }
  bool any() const { return mask != decltype(mask){}; }
  bool operator==(const ForcedPoints&) const = default;
};

/// A forced value of V, M, AI or AQ: its place in the image.
struct ForcedValue {
  std::uint32_t at = 0, value = 0;
  Width width{};
  bool operator==(const ForcedValue&) const = default;
};

/// Everything that is forced (forcing.hpp).
struct Forcing {
  ForcedPoints inputs{}, outputs{};
  std::array<ForcedValue, 16> memory{};
  std::uint8_t values = 0;  ///< how many of `memory`
  bool any = false;         ///< of all this
  bool operator==(const Forcing&) const = default;
};

struct State {
  Time time = 0;         ///< the CPU's clock: start of the next instruction
  std::uint32_t pc = 0;  ///< op to execute next
  LogicStack stack{};
  bool rail = true;  ///< top of the SCR stack: the S bit as LSCR loaded it; on outside segments
  bool eno = true;   ///< of the last box; kept only in programs with AENO
  Mode mode = Mode::Stop;
  Phase phase = Phase::ReadInputs;
  Time phase_left = 0;  ///< of a phase other than Program
  bool in_interrupt = false;
  bool interrupts_enabled = false;
  bool stop_after_scan = false;    ///< STOP was executed in an interrupt routine
  bool stopped_by_master = false;  ///< in STOP, and may be told to RUN again (ppi.hpp)
  std::uint8_t call_depth = 0;
  std::uint64_t instructions = 0, scans = 0;

  Time scan_begin = 0, watchdog = kNever, next_clock = 0;
  Time shortest_scan = kNever, longest_scan = 0;

  std::array<CallFrame, kMostCalls> calls{};
  std::array<LocalMemory, kLocalLevels> local{};  ///< of the routines that do not run now, by local_memory::level()
  SavedContext saved{};
  std::uint8_t serving_event = 0, serving_routine = 0;
  Time serving_since = 0;
  Attachments attached = nothing_attached();
  std::array<InterruptQueue, kQueues> queue{};
  std::uint8_t waiting = 0;              ///< interrupts in all queues together
  std::array<Time, 2> timed_interval{};  ///< of events 10 and 11, captured by ATCH

  std::array<Freeport, kPorts.size()> port{};
  std::array<PpiPort, kPorts.size()> ppi{};
  std::array<NetworkPort, kPorts.size()> network{};

  std::array<TimerState, image::kTimers> timer{};
  Time previous_scan_begin = 0;
  Time next_tick_1ms = kNever;                                  ///< of the 1 ms timers; kNever if none is enabled
  std::int16_t ticks_100ms = 0;                                 ///< of the previous scan
  std::array<std::uint8_t, image::kCounters> counter_inputs{};  ///< at the last execution: bit 0 up, bit 1 down

  std::array<HighSpeedCounter, kCounters.size()> counter{};
  std::array<PulseOutput, 2> pulse{};
  ClockTime clock{};
  Time clock_set_at = 0;
  std::array<std::uint8_t, kPorts.size()> station{};  ///< addresses on the network
  bool diagnostic_led = false;                        ///< yellow, by DLED
  std::array<std::uint8_t, 10240> eeprom{};           ///< permanent V memory

  std::uint16_t fatal_code = 0;
  std::uint32_t fatal_op = 0;
  std::array<RuntimeError, 16> errors{};  ///< the first sixteen different ones
  std::uint64_t error_count = 0;

  Forcing forcing{};
  std::array<std::uint8_t, image::kPointBytes> terminals{};              ///< the inputs as they are wired
  std::array<std::uint8_t, image::kAQ - image::kAI> analog_terminals{};  ///< the analog inputs
  std::array<std::uint8_t, image::kPointBytes> stop_outputs{};           ///< what the output points are set to in STOP

  std::array<std::uint8_t, image::kSize> image{};

  bool operator==(const State&) const = default;
};

/// This memory survives power off: the model's retentive ranges in RAM, the EEPROM, the clock.
struct RetentiveMemory {
  std::array<std::uint8_t, image::kSize> image{};  ///< only the retentive ranges count
  std::array<std::uint8_t, 10240> eeprom{};        ///< permanent V memory
  ClockTime clock{};                               ///< when power went off
  Time clock_fraction = 0;                         ///< by how much of a second the clock was further then
  Time power_off = 0;                              ///< how long power was off
  bool ram_lost = false;                           ///< power was off too long: image and clock are lost
  Forcing forcing{};                               ///< in the EEPROM too
  bool operator==(const RetentiveMemory&) const = default;
};

/// The instruction that is executed next; nothing at power-up, in the system's part of the scan, and in STOP.
inline std::optional<std::uint32_t> standing_at(const State& state) {
  if (state.mode == Mode::Stop || !(state.in_interrupt || state.phase == Phase::Program)) return {};
  return state.pc;
}

}  // namespace s7200

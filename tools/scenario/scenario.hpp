// A scenario: what is done to a slave and what is expected of it, as plain data. reader.hpp reads it from YAML,
// runner.hpp runs it, report.hpp says how it went, transcript.hpp writes down what was seen.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/cpu/state.hpp"
#include "interpreter/program/address.hpp"
#include "serial_sim/faults/fault.hpp"
#include "serial_sim/field/field_script.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/peers/requester.hpp"

namespace s7200::tools {

/// A duration that may depend on the line: so many characters of its format, and a fixed part.
struct Span {
  Time fixed = 0;
  std::int64_t millicharacters = 0;

  Time in(const SerialFormat& format) const;
  bool operator==(const Span&) const = default;
};

/// From … to, both included.
struct Window {
  Span from{}, to{kNever};
  bool operator==(const Window&) const = default;
};

/// A byte that must be, or any.
using BytePattern = std::optional<std::uint8_t>;

/// How an exchange is to end.
struct Expected {
  enum class Kind : std::uint8_t {
    Silence,    ///< no character came
    Any,        ///< any characters came
    Frame,      ///< these bytes
    Echo,       ///< the request, byte by byte
    Exception,  ///< from that station, to that function, with that code
    Values,     ///< these registers or bits, in an answer of the right shape
    Accepted,   ///< an answer of the right shape: what was asked for, or that it was written
    Refused,    ///< an exception of any code
  };

  Kind kind{};
  std::vector<BytePattern> frame{};                    ///< of Frame; without CRC if the step's has_crc
  std::uint8_t exception = 0;                          ///< of Exception
  std::vector<std::optional<std::uint16_t>> values{};  ///< of Values
};

/// What is waited for on the line, and what it must be.
struct Reception {
  bool has_crc = false;              ///< a right CRC must be at its end
  std::vector<Expected> expected{};  ///< one of these; anything if empty
  bool disturbed = false;            ///< it has parity or framing errors
  std::optional<Window> latency{};
  std::optional<Window> answer_gap{};  ///< each pause between two characters
  std::optional<Span> listen{};        ///< the silence that ends it; 3.5 characters if not given
  std::optional<Time> timeout{};       ///< until it begins; the scenario's if not given
};

struct ExchangeStep : Reception {
  serial::Frame request{};      ///< all of it, its CRC included
  std::optional<Time> at{};     ///< when the request begins, since power-up; on other slaves since the first step
  std::optional<Span> pause{};  ///< between the exchange before and this one; the scenario's if not given
  Span gap{};                   ///< between the characters of the request
};

/// A transmission that nobody asked for, since the last request or still to come.
struct ReceiveStep : Reception {
  std::optional<Window> at{};  ///< when it begins, since power-up
};

struct WaitStep {
  Span time{};
  std::uint64_t scans = 0;  ///< instead of a time
};

struct SetStep {
  std::vector<Assignment> assignments{};
};

struct MemoryExpected {
  /// From … to, both included, as an instruction reads the value: bytes without a sign, words and double words with one,
  /// unless a limit is larger than that, and reals.
  struct Limits {
    double from = 0, to = 0;
    bool is_signed = true;
    bool operator==(const Limits&) const = default;
  };

  MemoryRange range{};
  std::vector<BytePattern> bytes{};  ///< as they lie in memory; of a bit, 0 or 1
  std::optional<Limits> limits{};    ///< instead of the bytes
  std::string address{}, written{};  ///< as they were written

  bool fits(const std::vector<std::uint8_t>& found) const;
};
struct MemoryStep {
  std::vector<MemoryExpected> expected{};
};

/// Goes on when memory is as expected, looked at now, at the end of each scan, and when the time is over.
struct WaitUntilStep {
  std::vector<MemoryExpected> expected{};
  std::optional<Time> timeout{};  ///< the scenario's if not given
};

struct Count {
  std::uint64_t from = 0, to = 0;  ///< both included
  bool operator==(const Count&) const = default;
};

/// How often something happened since the last request began, or since power-up when there was none.
struct InterruptCount {
  enum class What : std::uint8_t { Routine, Event, Lost };
  What what{};
  std::uint8_t number = 0;  ///< of the routine or event; lost events are counted all together
  Count count{};
};
struct InterruptsStep {
  std::vector<InterruptCount> counts{};
};

struct ModeStep {
  Mode mode{};
};
struct FatalStep {
  std::uint16_t code = 0;  ///< 0: none
};
/// The run-time errors since power-up: these and no others.
struct ErrorsStep {
  struct Error {
    std::uint16_t code = 0;
    Count count{};
  };
  std::vector<Error> errors{};
};

struct PowerCycleStep {
  bool memory_lost = false;  ///< power was off for longer than the retentive memory lasts
  Time power_off = 0;        ///< how long it was off: the clock goes on
};

/// A fault of the line from now on, or none any more.
struct FaultStep {
  std::optional<serial::Fault> fault{};
};

struct Step {
  std::string_view key{};  ///< of the action; empty if it was not written
  stl::Position position{};
  std::string note{};  ///< shown when it fails
  std::string loop{};  ///< `function = 3, count = 126`: which turn of its loops
  std::variant<ExchangeStep, ReceiveStep, WaitStep, WaitUntilStep, SetStep, MemoryStep, InterruptsStep, ModeStep, FatalStep,
               ErrorsStep, PowerCycleStep, FaultStep>
      action{};
};

/// What is waited for on the line, of a step that does so; null for all others.
const Reception* reception_of(const Step& step);

/// What makes a scenario a rule of a conformance suite.
struct Rule {
  enum class Severity : std::uint8_t { Must, Should };
  std::string id{};      ///< empty: it is none
  std::string source{};  ///< section of the specification
  Severity severity = Severity::Must;
};

struct Scenario {
  std::string name{};
  stl::Position position{};
  std::shared_ptr<const stl::SourceLines> source{};  ///< the file it is from

  std::string program{};        ///< path; empty if only --target names one
  bool may_be_missing = false;  ///< skip_without names it
  std::string cpu = "214";
  std::string times_file{};  ///< empty: the model's own
  std::vector<Assignment> set{};
  std::string input_file{};  ///< of `field`; empty if there is none
  serial::FieldScript field{};
  std::optional<ClockTime> clock{};
  Time after = kNever;  ///< when the first step begins; kNever: the first scan has ended and the line is quiet

  serial::MasterSettings line{};  ///< with the time-out
  Span pause{10 * kMillisecond, 7000};
  Time tolerance = 0;  ///< by which a latency given as one figure may be missed

  Rule rule{};
  std::string skipped{};  ///< the reason why it is not to be run; empty if it is
  std::vector<Step> steps{};
};

/// Looks at what only a program in simulation shows: memory, interrupts, mode, errors.
bool looks_inside(const Step& step);

/// Does what can only be done to a program in simulation: sets memory or a fault, waits for memory, switches power, counts
/// scans.
bool acts_inside(const Step& step);

}  // namespace s7200::tools

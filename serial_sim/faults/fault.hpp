// Faults of a line as plain values, and their one textual form: `KIND:PARAMETER=VALUE,…`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "serial_sim/line/interference.hpp"

namespace s7200::serial {

enum class FaultKind : std::uint8_t {
  Noise,
  Flip,
  Parity,
  Framing,
  Break,
  Glitch,
  Missing,
  Extra,
  Gap,
  Echo,
  Collision,
  Baud,
  Cut,
  Answer
};
inline constexpr std::size_t kFaultKinds = static_cast<std::size_t>(FaultKind::Answer) + 1;

/// The half of an exchange whose characters are meant: what the PLC's peers send, or what the PLC sends.
enum class Half : std::uint8_t { Request, Answer, Both };

enum class Station : std::uint8_t { Master, Plc };

/// The misbehaviour of a faulty slave that sends a whole frame with a right CRC. Nothing: the slave is only late.
enum class Misbehaviour : std::uint8_t {
  Nothing,
  Exception,  ///< it refuses the request, with an exception code
  Station,    ///< it answers as another station
  Function,   ///< it answers another function
  Stale,      ///< it sends the answer before this one
  Twice,      ///< it sends the answer twice, 3.5 characters apart
  Short,      ///< it leaves out the last two bytes of data
  Silent      ///< it sends nothing
};

/// A time, or so many bits of whoever sends.
struct Length {
  Time time = 0;
  std::int64_t microbits = 0;

  bool operator==(const Length&) const = default;
  Time at(const BitClock& clock) const;
};

/// A fault. Its kind determines which members count, see fault_kinds().
struct Fault {
  static constexpr int kStartBit = -1, kParityBit = 8, kStopBit = 9;
  static constexpr std::uint32_t kEachCharacter = 0;
  static constexpr std::int32_t kLargestClockError = 500'000;  ///< millionths; of several at once, too

  FaultKind kind{};

  // The exchanges in which the fault happens, counted from 1 since its injection.
  std::uint64_t exchange = 0;  ///< this one only; 0: in all
  std::uint64_t every = 1;     ///< in every Nth
  double probability = 1;      ///< and in each of those with this probability
  std::uint64_t seed = 1;      ///< of all that this fault leaves to chance

  // The place in an exchange.
  Half of = Half::Request;
  std::optional<std::uint32_t> character;  ///< from 1; kEachCharacter; 0 for the place before the first of Extra
  int bit = 0;                             ///< of the data, LSB first, or one of the constants above
  Length offset;                           ///< after the start edge of the character
  std::optional<Time> from;                ///< at an instant, since the injection, instead of in an exchange
  Time lasts = kNever;

  double error_rate = 0;         ///< share of the bits that are inverted
  std::int32_t clock_error = 0;  ///< millionths; positive: the station is too fast
  Station station = Station::Master;
  Length length;
  std::uint32_t count = 1;
  std::vector<std::uint8_t> bytes;  ///< empty: random
  Misbehaviour misbehaviour{};      ///< of an answer; `length` is how late it is
  std::uint8_t code = 0;            ///< the exception, station or function in it

  bool operator==(const Fault&) const = default;
};

/// Whether the fault happens at an instant (`from`, or a cut at once) and not at a place in an exchange.
bool at_an_instant(const Fault& fault);

/// Whether the fault concerns what one station sends, its clock or its adapter; neither noise nor a fault at an instant
/// does.
bool is_of_a_station(const Fault& fault);

struct FaultError {
  std::size_t column = 1;  ///< in the text, from 1
  std::size_t length = 1;
  std::string message;  ///< what is wrong, and what to write

  bool operator==(const FaultError&) const = default;
};

/// The place of a parameter in the text, with its value.
struct GivenParameter {
  std::string_view name;   ///< as in fault_parameters()
  std::size_t column = 1;  ///< from 1
  std::size_t length = 1;

  bool operator==(const GivenParameter&) const = default;
};

struct ParsedFault {
  Fault fault;  ///< of use only without an error
  std::optional<FaultError> error;
  std::vector<GivenParameter> given{};  ///< the others have their standard

  /// Returns null if the parameter was left out.
  const GivenParameter* find(std::string_view parameter) const;

  bool ok() const { return !error; }
};

/// Reads `flip:character=3,bit=5` or `echo`. Blanks may stand around every word.
ParsedFault parse_fault(std::string_view text);

/// The shortest text that parse_fault reads as this fault.
std::string to_text(const Fault& fault);

struct FaultParameter {
  std::string_view name;
  std::string_view values;  ///< what may be written
  std::string_view meaning;
};
std::span<const FaultParameter> fault_parameters();

/// A parameter as a kind of fault has it.
struct ParameterOfKind {
  std::string_view name;
  std::string_view standard;  ///< its value when it is left out; kRequired, kLeftOut
};
inline constexpr std::string_view kRequired = "";
inline constexpr std::string_view kLeftOut = "-";  ///< it may be left out and has no value then

struct FaultKindInfo {
  FaultKind kind{};
  std::string_view name;
  std::string_view meaning;
  std::string_view example;
  std::vector<ParameterOfKind> parameters;
};

/// All kinds of fault, in the order of FaultKind.
const std::array<FaultKindInfo, kFaultKinds>& fault_kinds();
const FaultKindInfo& info_of(FaultKind kind);

/// The tables of kinds and parameters as Markdown, for the README.
std::string fault_tables();

}  // namespace s7200::serial

// What happened, as plain records. Sinks only watch: tracing changes nothing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "interpreter/base/serial_port.hpp"
#include "interpreter/base/time.hpp"

namespace s7200 {

/// What a record is about. What its members mean for each kind is in the rows of trace_rows.cpp, by name.
enum class TraceKind : std::uint8_t {
  ScanBegin,
  ModeChange,
  EventOccurred,  ///< an interrupt event, with a routine attached
  EventLost,      ///< its queue was full
  EventDropped,   ///< it was queued, and then detached
  ServiceBegin,   ///< of an interrupt routine
  ServiceEnd,
  Attach,
  Detach,
  Transmit,  ///< XMT
  TransmitEnd,
  CharacterSent,
  CharacterReceived,
  CharacterIgnored,  ///< why: Ignored
  CharacterDropped,  ///< RCV still waits for the start of its message
  Receive,           ///< RCV begins its search
  ReceiveEnd,
  PortControl,  ///< SMB30 or SMB130 is written
  OutputChanged,
  AnalogChanged,
  RuntimeError,
  FatalError,
  Enable,          ///< ENI or DISI
  NetworkJob,      ///< of NETR or NETW
  PpiService,      ///< what a master asks for, besides variables: op is an s7::Kind, routine the group of user data
  PpiAccess,       ///< a variable of a master's request: byte is a PpiVerb, code an s7::ReturnCode; routine, type, op and
                   ///< count are area, type, address and count as in the request
  PpiIgnored,      ///< a frame with a wrong check sum or end
  PpiNotModelled,  ///< a right frame of which nothing comes here; why: PpiUnmodelled
};

/// What a master does with a variable.
enum class PpiVerb : std::uint8_t { Reads, Writes, Forces, Unforces, SetsInStop };

/// Why a character is ignored.
enum class Ignored : std::uint16_t {
  NotAttached,   ///< its receive event
  NoRcvWaits,    ///< in a program that receives with RCV at this port, and its receive event is not attached
  NoPpiFrame,    ///< in PPI mode; count: 1 after another
  WhileSending,  ///< the receiver is off, and at is when that was so; the byte is what others drive, not what the line has
  NoPower,       ///< at the PLC
};

/// What is not documented: of several masters on a line, of longer addresses, and of what is asked with nonsense.
enum class PpiUnmodelled : std::uint8_t {
  Token,            ///< for this station: it takes no part in passing it on
  AnotherMaster,    ///< that asks another station, while this port is a master too: nothing says whose turn it is
  Broadcast,        ///< to station 127
  ExtendedAddress,  ///< station numbers above 127
  NoRequest,        ///< for this station, but what it carries is no request of the S7 services
};

struct TraceRecord {
  Time at = 0;
  TraceKind kind{};
  std::uint8_t event = 0;
  std::uint8_t routine = 0;
  std::uint8_t byte = 0;
  bool parity_error = false;
  bool framing_error = false;
  std::uint8_t port = 0;  ///< of characters, messages and the control byte
  std::uint8_t type = 0;  ///< of PpiAccess
  std::uint16_t code = 0;
  std::uint32_t op = 0;  ///< mostly the instruction that did it, kNoRoutine for none; of some kinds a place
                         ///< or a number, as the rows of trace_rows.cpp name it
  std::uint64_t count = 0;
  Time since = 0;
  Time interval = 0;
};

/// One executed instruction and, as closely as it is watched, the values of its operands: inputs before it, outputs after
/// it.
struct InstructionRecord {
  Time at = 0;  ///< start
  Time end = 0;
  std::uint32_t op = 0;
  bool powered = true;  ///< false: skipped because it had no power flow
  bool top = false;     ///< top of the logic stack afterwards
  std::array<std::optional<std::uint32_t>, 3> value{};
};

/// How closely a sink looks at instructions. Each way includes those before it.
enum class Watch : std::uint8_t {
  Flow,    ///< which ones had power flow, and the values that contacts saw
  Values,  ///< those of all operands
  Stops    ///< it is asked before each whether the CPU stops there
};

class TraceSink {
 public:
  virtual ~TraceSink() = default;
  virtual void record(const TraceRecord&) {}
  /// Called before an instruction, of a sink that stops the CPU; returning false stops it there.
  virtual bool before(std::uint32_t /*op*/) { return true; }
  virtual void instruction(const InstructionRecord&) {}
  /// Whether before() and instruction() are to be called at all.
  virtual bool wants_instructions() const { return false; }
  /// How closely it looks at them then.
  virtual Watch watch() const { return Watch::Stops; }
  /// Who is to be told of them: it, or the only one that it would tell.
  virtual TraceSink& watcher() { return *this; }
  /// Whether each scan matters, because its beginning is recorded or something in it is looked for. Otherwise scans that
  /// are all alike may be passed over.
  virtual bool wants_scans() const { return true; }
};

}  // namespace s7200

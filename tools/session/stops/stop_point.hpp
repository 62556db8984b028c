// Where a run stops: a place, something that happens, or an access to memory.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/trace/trace.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/past/actions/plc_requests.hpp"

namespace s7200::tools {

struct StopPoint {
  enum class On : std::uint8_t {
    Place,          ///< in front of an instruction
    EventOccurs,    ///< an attached event
    EventServed,    ///< its routine begins
    FrameReceived,  ///< the line has been silent for 3.5 characters after characters came in
    FrameSent,      ///< the transmitter has sent all characters
    Transmit,       ///< XMT begins
    ReceiveEnd,     ///< RCV ends
    RuntimeError,
    QueueOverflow,
    LostCharacter,  ///< a PLC with power has ignored it, or the interrupt for it was lost or dropped
    ModeChange,
    Unanswered,   ///< a request of any master on a line of the station
    WrongAnswer,  ///< the same; an answer came that it cannot take
    Read,         ///< access to memory by an instruction
    Write,
    ReadWrite,  ///< either of them, or a change
    Change,     ///< of memory, whoever did it
    Becomes     ///< the condition holds, and did not before, whoever did it
  };

  int number = 0;
  std::size_t station = 0;  ///< that it is about
  On on{};
  std::uint32_t op = 0;                 ///< Place
  std::optional<std::uint8_t> event{};  ///< EventOccurs, EventServed; any without
  std::optional<std::uint16_t> code{};  ///< RuntimeError; any without
  std::optional<std::size_t> line{};    ///< of a request: of PlcRequests::lines(); all of the station without
  std::optional<MemoryRange> range{};   ///< Read, Write, ReadWrite, Change
  std::string name{};                   ///< as the user wrote it: `VW30`, `event 8 served`
  bool needs_power = false;             ///< Place: not in front of a box or coil without power flow
  std::optional<Expression> condition{};
  std::uint64_t from_hit = 1;  ///< the first that stops
  std::string log{};           ///< a line to print instead of stopping

  std::uint64_t hits = 0;  ///< up to where it stands

  // In the last run forwards.
  std::uint64_t skipped = 0;             ///< times that it had no power flow
  std::uint64_t unknown = 0;             ///< times that its condition could not be computed
  std::string why_unknown{};             ///< the first time
  std::vector<std::uint8_t> value{};     ///< of the memory as last seen, like bytes_of()
  bool held = false;                     ///< Becomes: the condition, as last seen
  std::optional<std::size_t> planned{};  ///< what of the system file has changed it since, its number in History::planned()

  bool is_watch() const { return range.has_value(); }
  bool is_of_requests() const { return on == On::Unanswered || on == On::WrongAnswer; }
};

/// One that is set, and all its hits.
struct SetStop : StopPoint {
  /// Instructions before it, and its time.
  using Instant = std::pair<std::uint64_t, Time>;
  /// The hits on a branch of the past: all after the moment where it was set, or where the branch began if that is later.
  struct Counted {
    Instant since{};
    std::vector<Instant> at{};  ///< in order
  };
  std::map<std::weak_ptr<const void>, Counted, std::owner_less<>> counted{};  ///< by branch
};

/// One that a run has come to.
struct Hit {
  StopPoint stop{};                       ///< with the old value
  std::vector<std::uint8_t> value{};      ///< new
  std::optional<InstructionRecord> by{};  ///< of an access; nothing: it changed between two instructions
  std::optional<std::size_t> action{};    ///< that changed it, its number in History::actions()
  std::optional<std::size_t> planned{};   ///< the same of the system file, in History::planned()
  std::optional<TraceRecord> record{};    ///< what happened
  std::vector<std::uint8_t> frame{};      ///< FrameReceived, FrameSent, and a request if it is not of the simulated
                                          ///< master; empty if it is not known
  std::optional<Asker> asker{};           ///< of a request
  std::string wrong{};                    ///< WrongAnswer: what is wrong with it
  std::vector<std::uint8_t> answer{};     ///< WrongAnswer; empty if it is not known
};

/// `{VW20} at {time}` filled in: expressions, and time, scan, line, event. What cannot be read stays as it is.
/// `now`: that of the run; the clock of a CPU without power stands still. `by`: the instruction that did it, if it is over;
/// null for the one that is next.
std::string filled_in(const std::string& text, const Cpu& cpu, Time now, const InstructionRecord* by = nullptr);

/// Whether all in braces can be read, and each is closed; trouble if not.
Result<> check_message(const std::string& text, const Program& program);

}  // namespace s7200::tools

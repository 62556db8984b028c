// Lines and the stations on them, in one time.
//
// Time. Each CPU has a clock of its own, which stands at the start of its next instruction; what an instruction does to the
// outside carries its end. CPUs know of one another only by what is on a line. The rule that keeps them in one time:
//
//   The CPU whose clock is the earliest runs; of two at the same instant, the one that was added first. It runs until
//   another may act, or an event is due. An event is due when no clock stands before it.
//
// A CPU may act whenever it executes its program, and at the end of a system's part of its scan: until then only an event
// can make it act. So whatever a CPU does comes no earlier than what was done before it, but for one instruction that begins
// before another's and ends after it: its effects lie in the future of the others, which lines and UARTs allow. An event is
// handled when nothing can happen before it any more, and before any CPU executes an instruction that starts after it. The
// order of instructions and events follows from the clocks alone: it is the same in one run or in slices, traced or not.
// There is no more lookahead than that, although a character takes its time: a program may set its port between any two
// instructions, and what others have sent until then must be known. With one PLC no other station acts, and it runs from
// event to event; several that execute their programs take turns after every instruction or two.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "serial_sim/system/dispatcher.hpp"
#include "serial_sim/system/plc.hpp"
#include "serial_sim/system/shared_line.hpp"
#include "serial_sim/system/stations.hpp"

namespace s7200::serial {

/// Why a run came back.
enum class Halt : std::uint8_t {
  Time,     ///< the end was reached
  Paused,   ///< a trace sink stopped a CPU, or a scan ended and a pause was asked for
  Stopped,  ///< the CPU of a Simulation is in STOP for good: not by a master, who may start it again. A System goes
            ///< on, for the sake of its other stations
  Request,  ///< whoever may, has asked for it: stop_when()
};

class System {
 public:
  System() = default;
  System(const System&) = delete;
  System& operator=(const System&) = delete;

  /// Lines and stations live as long as the system. A PLC comes before anything runs. Time is what the clocks of the CPUs
  /// say; without any it goes from event to event.
  SharedLine& add_line();
  Plc& add_plc(std::span<SharedLine* const> lines, std::shared_ptr<const Program> program, FieldScript field = {});
  /// With port 0 on `line`; a second port is alone on a line of its own.
  Plc& add_plc(SharedLine& line, std::shared_ptr<const Program> program, FieldScript field = {});
  RequesterStation& add_requester(SharedLine& line);
  HostStation& add_host_port(SharedLine& line);
  ResponderStation& add_responder(SharedLine& line, std::unique_ptr<Automaton> automaton);

  /// All that runs ends early once `request` is true; it is looked at every 100 ms. Not owned; null: nothing ends it.
  void stop_when(const std::atomic<bool>* request) { stop_request_ = request; }

  /// Powers up all PLCs, as new. Plc::power_up() does so for one, before anything runs.
  void power_up();

  /// The earliest clock: nothing happens before it any more.
  Time time() const;

  /// Whether a CPU was paused when it last ran.
  bool paused() const;

  /// Lets one CPU run, to `end` at most, and handles what is due then. Time means that there is more to do.
  Halt step(Time end);

  /// Runs until all clocks have reached `end`.
  Halt run_until(Time end);

  /// Runs until a started exchange, or listening, is over. It is busy still if a CPU was paused or a stop was asked for.
  const Exchange& finish_exchange(const RequesterStation& station);

  struct Snapshot {
    EventQueue queue;
    std::vector<SharedLine::State> lines;
    std::vector<Plc::State> plcs;
    std::vector<RequesterStation::State> requesters;
    std::vector<HostStation::State> host_ports;
    std::vector<ResponderStation::State> responders{};
    Time clock = 0;  ///< without CPUs
    bool operator==(const Snapshot&) const = default;
  };
  Snapshot snapshot() const;

  /// Of this system, or of one with the same lines and stations.
  void restore(const Snapshot& snapshot);

 private:
  template <class Part>
  using Parts = std::vector<std::unique_ptr<Part>>;

  struct Turn {
    Plc& plc;
    Time until;  ///< another may act then
  };
  Turn next_turn() const;
  Halt step_without_plc(Time end);
  void handle_due_events();
  void settle(Time until);
  bool stop_requested() const { return stop_request_ && *stop_request_; }

  Dispatcher events_;
  Parts<SharedLine> lines_;
  Parts<Plc> plcs_;
  Parts<RequesterStation> requesters_;
  Parts<HostStation> host_ports_;
  Parts<ResponderStation> responders_;
  Time clock_ = 0;  // of a system without CPUs
  const std::atomic<bool>* stop_request_ = nullptr;
};

}  // namespace s7200::serial

// A line that stations share.
#pragma once

#include <algorithm>
#include <vector>

#include "serial_sim/faults/faults.hpp"
#include "serial_sim/line/line.hpp"
#include "serial_sim/line/uart.hpp"
#include "serial_sim/peers/requester.hpp"
#include "serial_sim/system/dispatcher.hpp"

namespace s7200::serial {

/// A line with its levels and faults, and the instant when it was last in use.
class SharedLine final : private EventHandler {
 public:
  /// Plain, so that a snapshot is a copy.
  struct State {
    Line line;
    Faults::State faults;
    Time last_activity = 0;
    bool operator==(const State&) const = default;
  };

  /// The dispatcher `events` is not owned.
  explicit SharedLine(Dispatcher& events);
  SharedLine(const SharedLine&) = delete;
  SharedLine& operator=(const SharedLine&) = delete;

  Line& line() { return line_; }
  const Line& line() const { return line_; }
  Faults& faults() { return faults_; }
  const Faults& faults() const { return faults_; }

  /// Adds a requester that asks on this line, and lives as long as the line. Wiring, not state.
  void add_master(const Requester& master) { masters_.push_back(&master); }

  /// A PLC, whose UART lives as long as the line; as Faults has it, one of several may be their master.
  void add_plc(const Uart& plc, const FrameSender* sender) {
    faults_.add_plc(plc, sender);
    plcs_.push_back(&plc);
  }

  /// Whether a master besides `one` has its request on the line, or the PLC that is the master of the others sends.
  bool another_sends(const Requester& one) const {
    const auto is_sending_master = [&](const Uart* each) {
      return each->driver() == faults_.state().master && each->state().sending;
    };
    return std::ranges::any_of(masters_, [&](const Requester* each) { return each != &one && each->sends(); }) ||
           std::ranges::any_of(plcs_, is_sending_master);
  }

  /// The number of one more driver, at most Line::kDrivers.
  int add_driver();

  /// End of the last character that anyone sent or heard.
  Time last_activity() const { return last_activity_; }
  void note_activity(Time at) { last_activity_ = std::max(last_activity_, at); }
  void note_activity(const Uart::Report& report);

  State state() const { return {line_, faults_.state(), last_activity_}; }

  /// Restores the line; the queue is restored by its owner.
  void restore(const State& state);

 private:
  void handle(const Event& event) override { faults_.handle(event); }

  Line line_;
  Faults faults_;
  std::vector<const Requester*> masters_;
  std::vector<const Uart*> plcs_;
  int drivers_ = 0;
  Time last_activity_ = 0;
};

}  // namespace s7200::serial

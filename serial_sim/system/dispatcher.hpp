// Who handles which event, and in which order those of one instant are handled.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "interpreter/base/event_queue.hpp"

namespace s7200::serial {

/// The order of one instant: the wire settles first, then the UARTs that listen to it, then the CPUs, then the inputs from
/// the field, then whoever asks. The field comes after the CPUs, whose own events were decided earlier, so that an input of
/// that instant cannot change them; which interrupt is served first does not depend on it (interrupts::occurred).
/// Within a rank it is the order in which the owners were added.
enum class Rank : std::uint8_t { Line, Uart, Cpu, Field, Peer };

class EventHandler {
 public:
  /// An event of one of the handler's numbers is due.
  virtual void handle(const Event& event) = 0;

 protected:
  ~EventHandler() = default;
};

/// The queue of a system, and whose the numbers in it are.
class Dispatcher {
 public:
  static constexpr std::size_t kMostOfARank = 256;

  EventQueue& queue() { return queue_; }
  const EventQueue& queue() const { return queue_; }

  /// A number of its own for `handler`, which is not owned.
  EventOwner add(Rank rank, EventHandler& handler);

  static Rank rank_of(EventOwner owner) { return static_cast<Rank>(static_cast<std::size_t>(owner) / kMostOfARank); }

  /// The next event of the queue goes to its handler.
  void handle_next();

 private:
  EventQueue queue_;
  std::array<std::vector<EventHandler*>, 5> handlers_;  // by rank, then in the order in which they were added
};

}  // namespace s7200::serial

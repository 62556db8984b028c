// Passes events to their handlers, in a fixed order within each instant.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "interpreter/base/event_queue.hpp"

namespace s7200::serial {

/// The order of one instant: what CPUs have done to their ports by then comes first, then the wire settles, then the UARTs
/// that listen to it, then the CPUs, then the inputs from the field, then whoever asks. The field comes after the CPUs,
/// whose own events were decided earlier, so that an input of that instant cannot change them; which interrupt is served
/// first does not depend on it (interrupts::occurred). Within a rank it is the order in which the owners were added.
enum class Rank : std::uint8_t { Port, Line, Uart, Cpu, Field, Peer };
inline constexpr std::size_t kRanks = static_cast<std::size_t>(Rank::Peer) + 1;

class EventHandler {
 public:
  /// Handles an event of one of this handler's numbers, which is due.
  virtual void handle(const Event& event) = 0;

 protected:
  ~EventHandler() = default;
};

/// The queues of a system, and whose the numbers in them are. Each CPU has a queue of its own, because it runs up to the
/// next event in it; all others share queues, a handful in each: so neither is a search in one of them long, however many
/// stations there are, nor are there many of them where there is one PLC.
class Dispatcher {
 public:
  static constexpr std::size_t kMostOfARank = 8192;

  /// Adds the queue of a CPU, or of anything else. It lives as long as the dispatcher.
  EventQueue& add_queue() { return *queues_.emplace_back(std::make_unique<EventQueue>()); }
  EventQueue& shared_queue();

  /// A number of its own for `handler`, which is not owned. There are kMostOfARank for a rank.
  EventOwner add(Rank rank, EventHandler& handler);

  static Rank rank_of(EventOwner owner) { return static_cast<Rank>(static_cast<std::size_t>(owner) / kMostOfARank); }

  /// The instant of the next events, and where they are.
  struct Due {
    Time at = kNever;
    EventQueue* queue = nullptr;
    bool in_several_queues = false;
  };
  Due due() const {
    Due due;
    for (const auto& queue : queues_) {
      const Time next = queue->next();
      if (next > due.at) continue;
      due = {next, queue.get(), next == due.at};
    }
    return due;
  }
  /// The instant of the next events; kNever when no event is pending.
  Time next() const { return due().at; }

  /// Handles the events of the next instant, which is due(), in their order. An event scheduled for this instant meanwhile
  /// is left to the next call unless its rank is still to come in its queue.
  void handle(const Due& due);

  /// Whether the first event of the next instant is for another than `handler`. Unknown, so false, if several queues have
  /// events then.
  bool is_for_another(const Due& due, const EventHandler& handler) const {
    return due.queue && !due.in_several_queues && &handler_of(due.queue->front()) != &handler;
  }
  /// Handles just that event.
  void handle_first(const Due& due) { handle(due.queue->pop()); }

  /// The number of events so far: the cost of a run, whatever the host.
  std::uint64_t handled() const { return handled_; }

  std::vector<EventQueue> state() const;
  void restore(const std::vector<EventQueue>& state);

 private:
  static constexpr std::size_t kShareOne = 8;

  void handle_those_due(Time at);
  void handle(const Event& event);
  EventHandler& handler_of(const Event& event) const {
    const auto owner = static_cast<std::size_t>(event.owner);
    return *handlers_[owner / kMostOfARank][owner % kMostOfARank];
  }
  static std::size_t next_rank(const EventQueue& queue) { return static_cast<std::size_t>(rank_of(queue.front().owner)); }

  std::vector<std::unique_ptr<EventQueue>> queues_;
  EventQueue* shared_ = nullptr;  // the one that is handed out at present, so many times so far
  std::size_t sharing_ = 0;
  std::array<std::vector<EventHandler*>, kRanks> handlers_;  // by rank, then in the order in which they were added
  std::vector<EventQueue*> due_;                             // of the instant that is being handled
  std::uint64_t handled_ = 0;
};

}  // namespace s7200::serial

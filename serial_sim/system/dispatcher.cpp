#include "serial_sim/system/dispatcher.hpp"

#include <algorithm>
#include <cassert>

namespace s7200::serial {

EventOwner Dispatcher::add(Rank rank, EventHandler& handler) {
  auto& those = handlers_[static_cast<std::size_t>(rank)];
  assert(those.size() < kMostOfARank);
  those.push_back(&handler);
  return static_cast<EventOwner>(static_cast<std::size_t>(rank) * kMostOfARank + those.size() - 1);
}

EventQueue& Dispatcher::shared_queue() {
  if (sharing_ % kShareOne == 0) shared_ = &add_queue();
  ++sharing_;
  return *shared_;
}

void Dispatcher::handle(const Due& due) {
  if (due.in_several_queues) return handle_those_due(due.at);
  for (std::size_t rank = 0; due.queue->next() == due.at && next_rank(*due.queue) >= rank;) {
    rank = next_rank(*due.queue);
    handle(due.queue->pop());
  }
}

/// Handles the events of an instant for which several queues have events.
void Dispatcher::handle_those_due(Time at) {
  for (const auto& queue : queues_)
    if (queue->next() == at) due_.push_back(queue.get());
  for (std::size_t rank = 0; rank < kRanks; ++rank)
    for (EventQueue* const queue : due_)
      while (queue->next() == at && next_rank(*queue) == rank) handle(queue->pop());
  due_.clear();
}

void Dispatcher::handle(const Event& event) {
  ++handled_;
  handler_of(event).handle(event);
}

std::vector<EventQueue> Dispatcher::state() const {
  std::vector<EventQueue> state;
  state.reserve(queues_.size());
  for (const auto& queue : queues_) state.push_back(*queue);
  return state;
}

void Dispatcher::restore(const std::vector<EventQueue>& state) {
  assert(state.size() == queues_.size());
  for (std::size_t i = 0; i < state.size(); ++i) *queues_[i] = state[i];
}

}  // namespace s7200::serial

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

Time Dispatcher::next() const {
  Time next = kNever;
  for (const EventQueue& queue : queues_) next = std::min(next, queue.next());
  return next;
}

void Dispatcher::handle_next() {
  Time at = kNever;
  for (EventQueue& queue : queues_) {
    const Time next = queue.next();
    if (next > at || next == kNever) continue;
    if (next < at) due_.clear();
    at = next;
    due_.push_back(&queue);
  }
  for (std::size_t rank = 0; rank < kRanks; ++rank)
    for (EventQueue* const queue : due_)
      while (queue->next() == at && static_cast<std::size_t>(rank_of(queue->front().owner)) == rank) {
        const Event event = queue->pop();
        handlers_[rank][static_cast<std::size_t>(event.owner) % kMostOfARank]->handle(event);
      }
  due_.clear();
}

void Dispatcher::restore(const std::vector<EventQueue>& state) {
  assert(state.size() == queues_.size());
  std::copy(state.begin(), state.end(), queues_.begin());
}

}  // namespace s7200::serial

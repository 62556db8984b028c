#include "serial_sim/system/dispatcher.hpp"

#include <cassert>

namespace s7200::serial {

EventOwner Dispatcher::add(Rank rank, EventHandler& handler) {
  std::vector<EventHandler*>& those = handlers_[static_cast<std::size_t>(rank)];
  assert(those.size() < kMostOfARank);
  those.push_back(&handler);
  return static_cast<EventOwner>(static_cast<std::size_t>(rank) * kMostOfARank + those.size() - 1);
}

void Dispatcher::handle_next() {
  const Event event = queue_.pop();
  const auto number = static_cast<std::size_t>(event.owner);
  handlers_[number / kMostOfARank][number % kMostOfARank]->handle(event);
}

}  // namespace s7200::serial

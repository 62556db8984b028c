#include "tools/session/stops/asked_by_pollers.hpp"

#include <algorithm>

#include "tools/views/broadcast.hpp"

namespace s7200::tools {

void AskedByPollers::begin(Time now, const std::vector<HeardFrames::Frame>&) {
  polling_.assign(history().pollers().size(), {});
  look(now);
}

void AskedByPollers::look(Time) {
  for (std::size_t number = 0; number < polling_.size(); ++number) look_at(number);
}

void AskedByPollers::look_at(std::size_t number) {
  const serial::Poller& poller = *history().pollers()[number].poller;
  const serial::Poller::State& now = poller.state();
  const serial::Exchange& exchange = poller.requester().exchange();
  const bool asks = poller.requester().asks();
  Polling& polling = polling_[number];
  const bool next = now.asked != polling.asked;
  if (polling.asks && (next || !asks) && !is_broadcast(polling.frame)) {
    const bool in_vain = next ? now.answered == polling.answered : exchange.timed_out;
    const Bytes answer = next ? Bytes() : exchange.response_bytes();
    if (in_vain)
      tell_of(number, "", {});
    else if (next && now.wrong + now.refused != polling.wrong)
      tell_of(number, "a wrong answer", {});  // whose characters are gone
    else if (const std::string wrong = next ? "" : wrong_with(polling.frame, answer, exchange.damage()); !wrong.empty())
      tell_of(number, wrong, answer);
  }
  if (asks && (next || !polling.asks)) polling.frame = serial::bytes_of(exchange.request);
  polling.asks = asks;
  polling.asked = now.asked;
  polling.answered = now.answered;
  polling.wrong = now.wrong + now.refused;
}

/// On each line of a PLC that it is on.
void AskedByPollers::tell_of(std::size_t number, const std::string& wrong, const std::vector<std::uint8_t>& answer) const {
  const std::vector<const serial::SharedLine*>& lines = of_plcs().lines();
  for (std::size_t line = 0; line < lines.size(); ++line)
    if (history().pollers()[number].poller->is_on(lines[line]->line()))
      tell({line, polling_[number].frame, Asker{Asker::Kind::Poller, number}, wrong, answer});
}

Time AskedByPollers::next_timeout() const {
  Time next = kNever;
  for (const auto& [name, poller] : history().pollers()) next = std::min(next, timeout_of(poller->requester()));
  return next;
}

}  // namespace s7200::tools

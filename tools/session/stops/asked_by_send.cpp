#include "tools/session/stops/asked_by_send.hpp"

#include <algorithm>

#include "tools/session/causes/line/two_masters.hpp"
#include "tools/views/broadcast.hpp"

namespace s7200::tools {

void AskedBySend::await() {
  for (std::size_t line = 0; line < of_plcs().lines().size(); ++line)
    for (const SimulatedMaster& master : of_plcs().masters_on(line)) {
      const std::size_t station = master.asker.number;
      const bool is_new = std::ranges::find(awaited_, station) == awaited_.end();
      if (master.asker.kind == Asker::Kind::Send && master.requester->busy() && is_new) awaited_.push_back(station);
    }
}

std::vector<std::size_t> AskedBySend::take_finished() {
  std::vector<std::size_t> finished;
  std::erase_if(awaited_, [&](std::size_t station) {
    const serial::Simulation& here = history().station(station);
    if (here.master().busy()) return false;
    const serial::Exchange& exchange = here.master().exchange();
    if (!exchange.given_up) finished.push_back(station);
    const Bytes request = serial::bytes_of(exchange.request), answer = exchange.response_bytes();
    const std::string wrong = exchange.timed_out ? "" : wrong_with(request, answer, exchange.damage());
    if (!exchange.given_up && !is_broadcast(request) && (exchange.timed_out || !wrong.empty()))
      tell({.line = of_plcs().line_of(station, here.port()),
            .asker = {Asker::Kind::Send, station},
            .wrong = wrong,
            .answer = answer});
    if (!wrong.empty() && !is_broadcast(request) && took_a_request_for_its_answer(history(), station, exchange))
      tell({.line = of_plcs().line_of(station, here.port()), .asker = {Asker::Kind::Send, station}});
    return true;
  });
  return finished;
}

Time AskedBySend::next_timeout() const {
  Time next = kNever;
  for (std::size_t line = 0; line < of_plcs().lines().size(); ++line)
    for (const SimulatedMaster& master : of_plcs().masters_on(line))
      if (master.asker.kind == Asker::Kind::Send) next = std::min(next, timeout_of(*master.requester));
  return next;
}

}  // namespace s7200::tools

#include "tools/slave/master_in_simulation.hpp"

#include <stdexcept>

#include "serial_sim/peers/quiet_time.hpp"

namespace s7200::tools {

serial::Exchange MasterInSimulation::finish() {
  serial::Exchange exchange = run_exchange();
  if (requester().busy()) exchange.timed_out = exchange.response.empty();  // Ctrl-C ended the exchange
  return exchange;
}

serial::Exchange MasterInSimulation::exchange(const serial::Request& request) {
  const SerialFormat format = this->format();
  if (serial::has_wrong_parity(request.frame) && format.parity == Parity::None)
    throw std::invalid_argument("a byte with wrong parity (p) needs a format with parity");
  run_exchange();  // what Ctrl-C has left under way
  remark_ = ignored_text(serial::bytes_of(requester().heard()));
  for (const auto& told : asked_) told(format, request);
  configure(format);
  requester().start(request, now());
  serial::Exchange exchange = finish();
  if (const SerialFormat now = this->format(); now != format) configure(now);
  return exchange;
}

serial::Exchange MasterInSimulation::receive(const serial::Listening& listening) {
  remark_.clear();
  run_exchange();
  requester().listen(listening, now());
  return finish();
}

Time MasterInSimulation::pause() const { return serial::default_quiet(format()); }

}  // namespace s7200::tools

#include "tools/slave/peer_slave.hpp"

#include <stdexcept>
#include <utility>

#include "serial_sim/peers/quiet_time.hpp"
#include "tools/host/interruption.hpp"

namespace s7200::tools {

PeerSlave::PeerSlave(std::unique_ptr<serial::Automaton> station, const serial::LineSettings& line,
                     const std::vector<serial::Fault>& faults, std::string name)
    : line_(system_.add_line()),
      station_(system_.add_responder(line_, std::move(station))),
      master_(system_.add_requester(line_)),
      name_(std::move(name)) {
  master_.uart().configure(line.over(station_.responder().automaton().format()), 0);
  master_.requester().when_sync([this](bool high, Time at) { station_.responder().sync(high, at); });
  for (const serial::Fault& fault : faults) line_.faults().inject(fault, 0);
  system_.stop_when(&interruption());
  wait(pause());
}

serial::Exchange PeerSlave::finish() {
  serial::Exchange exchange = system_.finish_exchange(master_);
  if (master_.requester().busy()) exchange.timed_out = exchange.response.empty();  // after Ctrl-C
  return exchange;
}

serial::Exchange PeerSlave::exchange(const serial::Request& request) {
  if (serial::has_wrong_parity(request.frame) && format().parity == Parity::None)
    throw std::invalid_argument("a byte with wrong parity (p) needs a format with parity");
  system_.finish_exchange(master_);  // what Ctrl-C has left under way
  remark_ = ignored_text(serial::bytes_of(master_.requester().heard()));
  master_.requester().start(request, system_.time());
  return finish();
}

serial::Exchange PeerSlave::receive(const serial::Listening& listening) {
  remark_.clear();
  system_.finish_exchange(master_);
  master_.requester().listen(listening, system_.time());
  return finish();
}

Time PeerSlave::pause() const { return serial::default_quiet(format()); }

}  // namespace s7200::tools

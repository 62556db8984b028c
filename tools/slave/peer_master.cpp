#include "tools/slave/peer_master.hpp"

#include <stdexcept>

#include "serial_sim/peers/quiet_time.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

PeerMaster::PeerMaster(serial::System& system, serial::RequesterStation& station, const SerialFormat& format)
    : system_(system), station_(station) {
  station_.uart().configure(format, system_.time());
}

serial::Exchange PeerMaster::finish() {
  serial::Exchange exchange = system_.finish_exchange(station_);
  if (station_.requester().busy()) exchange.timed_out = exchange.response.empty();  // Ctrl-C ended the exchange
  return exchange;
}

serial::Exchange PeerMaster::exchange(const serial::Request& request) {
  if (serial::has_wrong_parity(request.frame) && format().parity == Parity::None)
    throw std::invalid_argument("a byte with wrong parity (p) needs a format with parity");
  system_.finish_exchange(station_);  // what Ctrl-C has left under way
  remark_ = ignored_text(serial::bytes_of(station_.requester().heard()));
  station_.requester().start(request, system_.time());
  return finish();
}

serial::Exchange PeerMaster::receive(const serial::Listening& listening) {
  remark_.clear();
  system_.finish_exchange(station_);
  station_.requester().listen(listening, system_.time());
  return finish();
}

Time PeerMaster::pause() const { return serial::default_quiet(format()); }

}  // namespace s7200::tools

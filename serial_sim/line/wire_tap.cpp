#include "serial_sim/line/wire_tap.hpp"

namespace s7200::serial {

void WireTap::watch(WireSink* sink, Time from) {
  line_.detach(*this);
  sink_ = sink;
  told_until_ = from;
  mark_ = kMark;
  if (sink_) line_.attach(*this);
}

void WireTap::tell(Time until, const SerialFormat& port) {
  for (Time at = told_until_; at < until; at = line_.next_change(at + 1)) {
    const std::array<bool, kWires> now{line_.level_without(plc_, at), line_.level_of(plc_, at), line_.level(at, plc_)};
    for (std::size_t wire = 0; wire < kWires; ++wire)
      if (now[wire] != mark_[wire])
        sink_->edge(static_cast<Wire>(wire), at, now[wire],
                    now[wire] ? Line::kNobody : driver_of(static_cast<Wire>(wire), at));
    mark_ = now;
  }
  told_until_ = until;
  sink_->settled(until, port);
}

int WireTap::driver_of(Wire wire, Time at) const {
  if (wire == Wire::Tx) return plc_;
  return wire == Wire::Rx ? line_.space_holder_besides(plc_, at) : line_.space_holder(plc_, at);
}

}  // namespace s7200::serial

#include "tools/slave/peer_slave.hpp"

#include <utility>

namespace s7200::tools {

PeerSlave::PeerSlave(std::unique_ptr<serial::Automaton> station, const serial::LineSettings& line,
                     const std::vector<serial::Fault>& faults, std::string name, StopToken stop)
    : line_(system_.add_line()),
      station_(system_.add_responder(line_, std::move(station))),
      requester_(system_.add_requester(line_)),
      master_(system_, requester_, line.over(station_.responder().automaton().format())),
      name_(std::move(name)) {
  requester_.requester().when_sync([this](bool high, Time at) { station_.responder().sync(high, at); });
  for (const serial::Fault& fault : faults) line_.faults().inject(fault, 0);
  system_.stop_when(stop);
  wait(pause());
}

}  // namespace s7200::tools

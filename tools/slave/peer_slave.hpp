// A slave that is not a program: a simulated station of another make, alone with the master on a simulated line.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "serial_sim/system/system.hpp"
#include "tools/rig/capture_files.hpp"
#include "tools/slave/peer_master.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

class PeerSlave final : public SlaveInSimulation {
 public:
  /// `line` has the master's settings, as far as they are not those of the station. `name` is the target as the user wrote
  /// it.
  PeerSlave(std::unique_ptr<serial::Automaton> station, const serial::LineSettings& line,
            const std::vector<serial::Fault>& faults, std::string name, StopToken stop);

  /// Exchanges like PeerMaster.
  serial::Exchange exchange(const serial::Request& request) override { return master_.exchange(request); }
  serial::Exchange receive(const serial::Listening& listening) override { return master_.receive(listening); }
  void wait(Time duration) override { system_.run_until(system_.time() + duration); }
  Time now() const override { return system_.time(); }
  Time pause() const override { return master_.pause(); }
  std::string remark() const override { return master_.remark(); }
  bool stop_requested() const override { return system_.stop_requested(); }
  std::string name() const override { return name_; }
  SerialFormat format() const override { return master_.format(); }

  const serial::Faults& faults() { return line_.faults(); }

  /// The line at the station's port is captured from now on. Not owned; they outlive the slave.
  void capture(CaptureFiles& captures) { captures.watch(station_, system_.time()); }

 private:
  serial::System system_;
  serial::SharedLine& line_;
  serial::ResponderStation& station_;
  serial::RequesterStation& requester_;
  PeerMaster master_;
  std::string name_;
};

}  // namespace s7200::tools

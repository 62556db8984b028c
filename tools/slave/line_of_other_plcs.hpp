// A line of a system without an S7-200, as a master sees it that has joined it.
#pragma once

#include <string>

#include "tools/rig/rig.hpp"
#include "tools/slave/peer_master.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

class LineOfOtherPlcs final : public SlaveInSimulation {
 public:
  /// The rig is not owned and has been powered up; its surroundings name the line.
  LineOfOtherPlcs(Rig& rig, std::size_t line, const serial::MasterSettings& master, std::string name);

  /// Runs until `after`, or if that is kNever for as long as a master leaves the line quiet. False after Ctrl-C.
  bool wait_until_ready(Time after);

  /// Exchanges like PeerMaster.
  serial::Exchange exchange(const serial::Request& request) override { return master_.exchange(request); }
  serial::Exchange receive(const serial::Listening& listening) override { return master_.receive(listening); }
  void wait(Time duration) override { system_.run_until(now() + duration); }
  Time now() const override { return system_.time(); }
  Time pause() const override { return master_.pause(); }
  std::string remark() const override { return master_.remark(); }
  bool stop_requested() const override { return system_.stop_requested(); }
  std::string name() const override { return name_; }
  SerialFormat format() const override { return master_.format(); }

 private:
  serial::System& system_;
  PeerMaster master_;
  std::string name_;
};

}  // namespace s7200::tools

// The lines of a system without an S7-200, as masters see them that join there, one at a time.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "tools/rig/rig.hpp"
#include "tools/slave/peer_master.hpp"
#include "tools/slave/slave.hpp"

namespace s7200::tools {

class PeerLines final : public SlaveInSimulation {
 public:
  /// Builds and powers up the plan's system; a master joins each line where why_no_other_plc() has no objection, `first`
  /// among them. It runs until `after`, or, if that is kNever, for as long as a master leaves its line quiet. The plan has
  /// no bridges and no S7-200. `master` has the format of all masters, where the line leaves it open. Throws
  /// SlaveUnreachable if a file that the plan names cannot be opened.
  PeerLines(const SystemPlan& plan, std::size_t first, const serial::MasterSettings& master, Time after,
            const std::string& path, StopToken stop);

  /// Makes this the line of further calls, if a master has joined it.
  void look_at(std::size_t line) {
    if (masters_.contains(line)) here_ = line;
  }

  /// Carries out an event in the system, now.
  void carry_out(const EventPlan& event) { rig_->carry_out(event); }

  /// Exchanges like PeerMaster.
  serial::Exchange exchange(const serial::Request& request) override { return master().exchange(request); }
  serial::Exchange receive(const serial::Listening& listening) override { return master().receive(listening); }
  void wait(Time duration) override { rig_->system().run_until(now() + duration); }
  Time now() const override { return rig_->system().time(); }
  Time pause() const override { return master().pause(); }
  std::string remark() const override { return master().remark(); }
  bool stop_requested() const override { return rig_->system().stop_requested(); }
  std::string name() const override;
  SerialFormat format() const override { return master().format(); }

 private:
  PeerMaster& master() { return masters_.at(here_); }
  const PeerMaster& master() const { return masters_.at(here_); }

  std::string path_;
  std::unique_ptr<Rig> rig_;
  std::map<std::size_t, PeerMaster> masters_;  // by line
  std::size_t here_;
};

}  // namespace s7200::tools

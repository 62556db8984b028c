// A slave that has a rig of its own: a system of PLCs and lines, as masters see it that join its lines.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>

#include "tools/rig/rig.hpp"
#include "tools/slave/master_in_simulation.hpp"

namespace s7200::tools {

/// The place of the master: `plant.yaml: line bus, beside gateway, port 1`.
std::string place_text(const std::string& path, const SystemPlan& plan, const Spot& spot);

class SlaveInRig final : public SlaveInSimulation {
 public:
  using Masters = std::map<std::size_t, std::unique_ptr<MasterInSimulation>>;

  /// `masters`: by line, those that have joined one; `first` is the line of calls until look_at() says another one.
  SlaveInRig(std::unique_ptr<Rig> rig, Masters masters, std::size_t first)
      : rig_(std::move(rig)), masters_(std::move(masters)), here_(first) {}

  /// Makes this the line of further calls, if a master has joined it.
  void look_at(std::size_t line) {
    if (masters_.contains(line)) here_ = line;
  }

  /// Carries out an event in the system, now.
  void carry_out(const EventPlan& event) { rig_->carry_out(event); }

  serial::Exchange exchange(const serial::Request& request) override { return here().exchange(request); }
  serial::Exchange receive(const serial::Listening& listening) override { return here().receive(listening); }
  void wait(Time duration) override { here().wait(duration); }
  Time now() const override { return here().now(); }
  Time pause() const override { return here().pause(); }
  std::string remark() const override { return here().remark(); }
  bool stop_requested() const override { return here().stop_requested(); }
  std::string name() const override { return here().name(); }
  SerialFormat format() const override { return here().format(); }

 private:
  MasterInSimulation& here() const { return *masters_.at(here_); }

  std::unique_ptr<Rig> rig_;
  Masters masters_;
  std::size_t here_;
};

/// Builds and powers up the plan's system with a master at the spot, and runs until all PLCs have ended their first scan and
/// the line is quiet, or until `after` if that is not kNever. The plan has no bridges. Throws SlaveUnreachable if that
/// moment never comes or a file that the plan names cannot be opened.
std::unique_ptr<SlaveInRig> join_spot(const SystemPlan& plan, const Spot& spot, const serial::MasterSettings& master,
                                      Time after, const std::string& path, StopToken stop);

/// Builds and powers up a system without an S7-200; a master joins each line where why_no_other_plc() has no objection,
/// `first` among them. It runs until `after`, or, if that is kNever, for as long as a master leaves its line quiet. The plan
/// has no bridges. `master` has the format of all masters, where the line leaves it open. Throws SlaveUnreachable if a file
/// that the plan names cannot be opened.
std::unique_ptr<SlaveInRig> join_lines(const SystemPlan& plan, std::size_t first, const serial::MasterSettings& master,
                                       Time after, const std::string& path, StopToken stop);

}  // namespace s7200::tools

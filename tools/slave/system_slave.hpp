// A slave in a system of PLCs and lines, as a master sees it that joins one of the lines.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "tools/rig/rig.hpp"
#include "tools/slave/simulated_slave.hpp"

namespace s7200::tools {

/// The place of the master: `plant.yaml: line bus, beside gateway, port 1`.
std::string place_text(const std::string& path, const SystemPlan& plan, const Spot& spot);

class SystemSlave final : public SlaveInSimulation {
 public:
  /// Builds and powers up the plan's system, and runs until all PLCs have ended their first scan and the line is quiet, or
  /// until `after` if that is not kNever. The plan has no bridges. Throws SlaveUnreachable if that moment never comes or a
  /// file that the plan names cannot be opened.
  SystemSlave(const SystemPlan& plan, const Spot& spot, const serial::MasterSettings& master, Time after,
              const std::string& path, StopToken stop);

  /// Exchanges like SimulatedSlave.
  serial::Exchange exchange(const serial::Request& request) override { return slave_->exchange(request); }
  serial::Exchange receive(const serial::Listening& listening) override { return slave_->receive(listening); }
  void wait(Time duration) override { slave_->wait(duration); }
  Time now() const override { return slave_->now(); }
  Time pause() const override { return slave_->pause(); }
  std::string remark() const override { return slave_->remark(); }
  bool stop_requested() const override { return slave_->stop_requested(); }
  std::string name() const override { return slave_->name(); }
  SerialFormat format() const override { return slave_->format(); }

 private:
  std::unique_ptr<Rig> rig_;
  std::optional<SimulatedSlave> slave_;
};

}  // namespace s7200::tools

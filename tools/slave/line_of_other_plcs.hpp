// A line of a system without an S7-200, as a master sees it that has joined it.
#pragma once

#include <string>

#include "tools/rig/rig.hpp"
#include "tools/slave/master_in_simulation.hpp"

namespace s7200::tools {

class LineOfOtherPlcs final : public MasterInSimulation {
 public:
  /// The rig is not owned and has been powered up; its surroundings name the line.
  LineOfOtherPlcs(Rig& rig, std::size_t line, const serial::MasterSettings& master, std::string name);

  /// Runs until `after`, or if that is kNever for as long as a master leaves the line quiet. False after Ctrl-C.
  bool wait_until_ready(Time after);

  void wait(Time duration) override { system_.run_until(now() + duration); }
  Time now() const override { return system_.time(); }
  bool stop_requested() const override { return system_.stop_requested(); }
  SerialFormat format() const override { return station_.uart().state().format; }

 private:
  serial::Requester& requester() override { return station_.requester(); }
  void configure(const SerialFormat& format) override { station_.uart().configure(format, now()); }
  serial::Exchange run_exchange() override { return system_.finish_exchange(station_); }

  serial::System& system_;
  serial::RequesterStation& station_;
};

}  // namespace s7200::tools

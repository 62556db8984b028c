// What a session debugs: a PLC that is powered up, or all those of a system, with everything attached and their past.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "serial_sim/peers/requester.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools::dap {

class Debuggee {
 public:
  virtual ~Debuggee() = default;

  /// The file that it was begun with: a program, or a system.
  virtual std::string source() const = 0;

  /// It has the stations.
  virtual History& history() = 0;
  virtual std::shared_ptr<const Program> program(std::size_t station) const = 0;

  /// Its name in a system; empty if there is only one PLC.
  virtual std::string name(std::size_t station) const = 0;

  /// The one that is looked at first, on whose line frames are sent.
  virtual std::size_t first_station() const = 0;

  /// How the master on a station's line talks.
  virtual const serial::MasterSettings& master(std::size_t station) const = 0;

  /// The files that are written while it runs, by their names; empty if there are none.
  virtual std::string recorded_files() const = 0;

  /// Why the last run has ended by itself, such as a bridge that has failed: said once, empty otherwise. The next one goes
  /// on.
  virtual std::string take_failure() = 0;

  /// What there is to say while it runs, a line each.
  virtual void when_saying(std::function<void(const std::string& text)> say) = 0;

  /// Completes what is recorded and kept. Returns what there is to say at the end.
  virtual std::vector<std::string> finish() = 0;
};

}  // namespace s7200::tools::dap

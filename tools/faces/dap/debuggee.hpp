// What a session debugs: a PLC that is powered up, or all those of a system, with everything attached and their past.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tools/session/commands/session.hpp"
#include "tools/session/past/history.hpp"

namespace s7200::tools::dap {

class Debuggee {
 public:
  virtual ~Debuggee() = default;

  /// The file that it was begun with: a program, or a system.
  virtual std::string source() const = 0;

  /// It has the stations.
  virtual History& history() = 0;

  /// How a session with it is begun: its PLCs, how masters talk, what commands may read and write.
  virtual SessionSetup setup() = 0;

  /// Whether a run follows the clock, because of a bridge or an option.
  virtual bool follows_clock() const { return false; }

  /// What there is to say while it runs, a line each.
  virtual void when_saying(std::function<void(const std::string& text)> say) = 0;

  /// Completes what is recorded and kept. Returns what there is to say at the end.
  virtual std::vector<std::string> finish() = 0;
};

}  // namespace s7200::tools::dap

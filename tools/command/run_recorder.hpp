// Writes down what is done to the PLC of a PROGRAM while it runs, so that a report can run it again.
#pragma once

#include <cstddef>
#include <string_view>

#include "serial_sim/peers/host_port.hpp"
#include "tools/command/options/report_option.hpp"
#include "tools/rig/rig.hpp"
#include "tools/session/past/journal.hpp"
#include "tools/slave/simulated_slave.hpp"

namespace s7200::tools {

class RunRecorder final : private serial::HostJournal {
 public:
  /// More than a day of a master that asks ten times a second.
  static constexpr std::size_t kMostActions = 1'000'000;

  /// Of a rig with one PLC that has just been powered up, which must live as long as this.
  explicit RunRecorder(Rig& rig);
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  /// Writes down what that master asks.
  void listen_to(SimulatedSlave& slave);

  /// The run so far.
  ReportedRun run(const Repairs& repairs) const;

 private:
  void host_called(const serial::HostCall& call) override { journal_.note(call, 0); }

  Rig& rig_;
  Journal journal_;
};

/// Writes the report of what was recorded; without a recorder there is nothing to do. False after a message.
bool write_report(const ReportOption& report, std::string_view verb, const RunRecorder* recorder, const Repairs& repairs);

/// The run of such a rig, of which `recording` is known.
ReportedRun reported_run(const Rig& rig, Recording recording, const Repairs& repairs);

}  // namespace s7200::tools

// Writes down what is done to a PROGRAM or a system while it runs, so that a report can run it again.
#pragma once

#include <cstddef>
#include <list>
#include <string>
#include <string_view>

#include "serial_sim/peers/host_port.hpp"
#include "tools/command/options/verb/report_option.hpp"
#include "tools/rig/rig.hpp"
#include "tools/session/past/actions/journal.hpp"
#include "tools/session/past/seen_rig.hpp"
#include "tools/slave/simulated_slave.hpp"

namespace s7200::tools {

class RunRecorder final {
 public:
  /// More than a day of a master that asks ten times a second.
  static constexpr std::size_t kMostActions = 1'000'000;

  /// Of a rig that has just been powered up, which must live as long as this. `path`: of a system its file. `spot`: where a
  /// master asks.
  RunRecorder(Rig& rig, std::string path, const Spot& spot, std::size_t most = kMostActions);
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  const Journal& journal() const { return journal_; }
  const SeenRig& seen() const { return seen_; }

  /// Writes down what that master asks.
  void listen_to(SimulatedSlave& slave);

  /// Writes the run so far, or as far as it was kept, which is said. False after a message.
  bool write(const ReportOption& report, std::string_view verb, const Repairs& repairs) const;

 private:
  /// What comes in at a host port.
  struct Host final : serial::HostJournal {
    Host(Journal& of, std::size_t at) : journal(of), number(at) {}
    void host_called(const serial::HostCall& call) override { journal.note(call, number); }
    Journal& journal;
    std::size_t number;
  };

  Rig& rig_;
  std::string path_;
  Spot spot_;
  SeenRig seen_;
  Journal journal_;
  std::list<Host> hosts_{};
};

/// Writes the report of what was recorded; without a recorder there is nothing to do. False after a message.
bool write_report(const ReportOption& report, std::string_view verb, const RunRecorder* recorder, const Repairs& repairs);

/// Writes the run of such a rig, of which `recording` is known. False after a message.
bool write_run(const ReportOption& report, std::string_view verb, const Rig& rig, const std::string& path, const Spot& spot,
               Recording recording, const Repairs& repairs);

}  // namespace s7200::tools

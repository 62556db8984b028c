// A system to be debugged, for tests: a master program that asks two slaves, one of which loses power for a while.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/source_path.hpp"
#include "tools/host/files/files.hpp"
#include "tools/plan/reading/system_reader.hpp"
#include "tools/rig/files/recorded_rig.hpp"

namespace s7200::tools {

inline constexpr std::string_view kPolled =
    "plcs:\n"
    "  master:\n"
    "    program: ../modbus_master.stl\n"
    "    cpu: 224\n"
    "    set: {I0.2: 1, VB3840: 2}\n"
    "  slave:\n"
    "    program: ../modbus_slave.stl\n"
    "    copies: 2\n"
    "    station: 1\n"
    "lines:\n"
    "  bus:\n"
    "    stations: [master, slave]\n"
    "    contention: 1\n"
    "events:\n"
    "  - {at: 250ms, power_off: slave2}\n"
    "  - {at: 330ms, power_on: slave2}\n";

enum PolledStation : std::size_t { kMaster, kSlave1, kSlave2 };

/// Seen from each of its PLCs.
struct SystemBench {
  explicit SystemBench(std::string_view text = kPolled) {
    const std::string path = test::source_path("stl_programs/systems/test.yaml");
    SystemFile file = read_system(std::string(text), path, host_files());
    for (const stl::Diagnostic& d : file.file.diagnostics)
      if (d.severity == stl::Severity::Error) ADD_FAILURE() << d.position.line << ": " << d.message;
    std::vector<std::string> problems;
    const std::vector<Spot> spots = spots_of_plcs(file.plan);
    rig = RecordedRig::assemble(std::move(file.plan), {.path = path, .seen = {.spots = spots}}, problems);
    for (const std::string& problem : problems) ADD_FAILURE() << problem;
    rig->power_up();
    rig->system().stop_when(StopToken());
    for (std::size_t spot = 0; spot < spots.size(); ++spot) stations.push_back(&rig->simulation(spot));
  }

  serial::System& system() { return rig->system(); }
  std::uint64_t executed() const {
    std::uint64_t executed = 0;
    for (const serial::Simulation* station : stations) executed += station->plc().executed();
    return executed;
  }

  std::unique_ptr<Rig> rig;
  std::vector<serial::Simulation*> stations;
};

}  // namespace s7200::tools

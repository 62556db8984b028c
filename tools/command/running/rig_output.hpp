// What there is to say of a rig at the end: of the one PLC from a command line as it stands, of a system each under its
// name.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/rig/rig.hpp"
#include "tools/views/state/faults.hpp"
#include "tools/views/timeline.hpp"

namespace s7200::tools {

/// `RUN`, `STOP`, or `off` without power.
std::string_view mode_of(const serial::Plc& plc);

/// How many scans a CPU has completed since it last went to RUN, and how long they took; null if there was none.
nlohmann::ordered_json scans_json(const State& state);

/// Each line two columns to the right.
std::string indented(const std::string& lines);

/// The memory that is to be shown.
std::string dump_text(const Rig& rig);
/// The same of one PLC. A range that is written as a symbol has the symbol beside its address.
std::string dumps_text(const PlcSettings& settings, const Cpu& cpu);

/// Run-time errors and fatal errors.
std::string errors_text(const Rig& rig);

/// Faults that found nothing to do, and which CPUs are in STOP.
std::vector<std::string> fault_notes(const Rig& rig);
std::vector<std::string> stop_notes(const Rig& rig);

/// How often a master from outside spoke on a line while its PLC was sending.
using CollisionsOn = std::function<std::uint64_t(const serial::SharedLine* line)>;
inline std::uint64_t no_collisions(const serial::SharedLine*) { return 0; }

/// Ports that have received characters with framing errors, on lines without faults, and why.
std::vector<std::string> framing_notes(const Rig& rig, const CollisionsOn& collisions);

/// Of the lines: faults, framing errors, and stations of a system that are left at another rate or format than the first one
/// there.
std::vector<std::string> line_notes(const Rig& rig, const CollisionsOn& collisions = no_collisions);

/// Of a line of a system. The rig outlives it.
StationName stations_of(const Rig& rig, std::size_t line);

/// What a master of the system has come to.
std::string poll_text(const serial::Poller::State& polls);

/// How the PLCs were left: of a system in `plcs`, `masters` and `lines`.
nlohmann::ordered_json rig_json(const Rig& rig);

/// kCpuFatal if a fatal error stopped a CPU.
int exit_code_of(const Rig& rig);

/// What the CPUs do, exchange by exchange: a Timeline for each.
class Timelines {
 public:
  /// The rig is not owned; its records go on. Nothing is seen before begin(). It lives as long as the rig runs.
  explicit Timelines(Rig& rig);
  Timelines(const Timelines&) = delete;
  Timelines& operator=(const Timelines&) = delete;

  void begin();
  void end();

  std::string text(const serial::Exchange& exchange, bool colour) const;
  nlohmann::ordered_json json(const serial::Exchange& exchange) const;

 private:
  std::vector<StationTimeline> reports() const;

  Rig& rig_;
  std::vector<std::unique_ptr<Timeline>> timelines_;  // by PLC
};

}  // namespace s7200::tools

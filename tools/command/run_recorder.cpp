#include "tools/command/run_recorder.hpp"

#include <utility>

namespace s7200::tools {

RunRecorder::RunRecorder(Rig& rig) : rig_(rig), journal_(rig.simulation(), {}, kMostActions) {
  if (rig.simulation().has_host_port()) rig.simulation().host_port().set_journal(this);
}

RunRecorder::~RunRecorder() {
  if (rig_.simulation().has_host_port()) rig_.simulation().host_port().set_journal(nullptr);
}

void RunRecorder::listen_to(SimulatedSlave& slave) {
  slave.when_asked([this](const SerialFormat& format, const serial::Request& request) {
    journal_.note(SendFrame{.format = format, .request = request});
  });
}

ReportedRun RunRecorder::run(const Repairs& repairs) const { return reported_run(rig_, journal_.recording(), repairs); }

bool write_report(const ReportOption& report, std::string_view verb, const RunRecorder* recorder, const Repairs& repairs) {
  return recorder == nullptr || report.write(verb, {recorder->run(repairs)});
}

ReportedRun reported_run(const Rig& rig, Recording recording, const Repairs& repairs) {
  ReportedRun run{.program = rig.plan().plcs.front().program, .around = surroundings_of(rig.plan()), .repairs = repairs};
  if (const RetentiveMemory* const kept = rig.kept_memory()) run.around.kept = *kept;
  run.recordings.push_back(std::move(recording));
  return run;
}

}  // namespace s7200::tools

#include "tools/command/reports/run_recorder.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "interpreter/base/time.hpp"
#include "tools/command/reports/reported_system.hpp"
#include "tools/command/terminal/terminal.hpp"

namespace s7200::tools {
namespace {

/// Where a master has joined; of a system that runs as a whole nowhere.
std::vector<Spot> asked_at(const Rig& rig, const Spot& spot) {
  return rig.has_simulation() ? std::vector{spot} : std::vector<Spot>();
}

}  // namespace

RunRecorder::RunRecorder(Rig& rig, std::string path, const Spot& spot, std::size_t most)
    : rig_(rig),
      path_(std::move(path)),
      spot_(spot),
      seen_(rig, asked_at(rig, spot)),
      journal_(*seen_.stations().front(), {}, most) {
  for (serial::HostPort* const port : hosts_of(rig)) port->set_journal(&hosts_.emplace_back(journal_, hosts_.size()));
}

RunRecorder::~RunRecorder() {
  for (serial::HostPort* const port : hosts_of(rig_)) port->set_journal(nullptr);
}

void RunRecorder::listen_to(SimulatedSlave& slave) {
  slave.when_asked([this](const SerialFormat& format, const serial::Request& request) {
    journal_.note(SendFrame{.format = format, .request = request}, spot_.plc);
  });
}

bool RunRecorder::write(const ReportOption& report, std::string_view verb, const Repairs& repairs) const {
  if (journal_.is_over() && report.wanted())
    print_note(fmt::format("--report keeps {} frames and values from outside; there were more, and it ends at {}",
                           journal_.recording().actions.size(), format_duration(journal_.recording().end.time)));
  return write_run(report, verb, rig_, path_, spot_, journal_.recording(), repairs);
}

bool write_report(const ReportOption& report, std::string_view verb, const RunRecorder* recorder, const Repairs& repairs) {
  return recorder == nullptr || recorder->write(report, verb, repairs);
}

bool write_run(const ReportOption& report, std::string_view verb, const Rig& rig, const std::string& path, const Spot& spot,
               Recording recording, const Repairs& repairs) {
  if (!report.wanted()) return true;
  ReportedRun run;
  if (is_of_one_program(rig.plan())) {
    run.program = rig.plan().plcs.front().program;
    run.around = surroundings_of(rig.plan());
    run.repairs = repairs;
  } else {
    const auto system = reported_system(path, rig.plan(), asked_at(rig, spot));
    if (!system) return print_error("--report: " + system.why()), false;
    run.system = *system;
  }
  run.recordings.push_back(std::move(recording));
  return report.write(verb, {run});
}

}  // namespace s7200::tools

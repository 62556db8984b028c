#include "tools/rig/files/recorded_rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// Messages such as `the run ends, and RCV at port 0 still waits for the end of its message: …`
std::vector<std::string> open_messages(const serial::Plc& plc) {
  std::vector<std::string> texts;
  if (!plc.powered()) return texts;
  const CpuModel& model = *plc.cpu().program().model;
  for (std::size_t port = 0; port < model.ports; ++port)
    if (const std::string awaited = awaited_text(plc.cpu().state().port[port].message, model.receive); !awaited.empty())
      texts.push_back(fmt::format("the run ends, and RCV at port {} still waits for {}", port, awaited));
  return texts;
}

}  // namespace

RecordedRig::RecordedRig(SystemPlan plan, const RigSurroundings& surroundings)
    : RigFiles{.written = WrittenFiles(surroundings.standard_output)}, Rig(std::move(plan), surroundings.seen) {
  written.limit_records(surroundings.record_limit);
  stop_when(surroundings.stop);
  if (!surroundings.trace.empty()) trace = std::make_unique<SystemTrace>(plan_, system(), surroundings.trace_detail);
  for (std::size_t number = 0; number < plan_.plcs.size(); ++number) plcs.emplace_back(plan_.plcs[number], plc(number));
  captures.resize(plan_.lines.size());
}

std::unique_ptr<RecordedRig> RecordedRig::assemble(SystemPlan plan, const RigSurroundings& surroundings,
                                                   std::vector<std::string>& problems) {
  std::unique_ptr<RecordedRig> rig(new RecordedRig(std::move(plan), surroundings));
  const auto done = rig->claim_files(surroundings).and_then([&] { return rig->read_memories(); }).and_then([&] {
    if (surroundings.begun) surroundings.begun();
    return rig->open_records();
  });
  if (!done) {
    if (!done.why().empty()) problems.push_back(done.why());
    return nullptr;
  }
  rig->watch_lines();
  rig->listen();
  return rig;
}

Result<> RecordedRig::claim_files(const RigSurroundings& surroundings) {
  if (!surroundings.path.empty()) written.reads(surroundings.path);
  for (const PlcPlan& plc : plan_.plcs) written.reads(plc.settings.input);
  written.links("--pty", surroundings.link);
  for (const BridgePlan& bridge : plan_.bridges)
    if (bridge.kind == BridgeKind::Pty) written.links("a bridge", bridge.where);
  auto line = plan_.lines.begin();
  const auto claimed = trace ? trace->claim(written, surroundings.trace) : Result<>();
  return claimed.and_then([&] { return with_each(plcs, [&](PlcFiles& plc) { return plc.claim(written); }); }).and_then([&] {
    return with_each(captures, [&](CaptureFiles& each) { return each.claim(written, (line++)->captures); });
  });
}

Result<> RecordedRig::read_memories() {
  auto plan = plan_.plcs.begin();
  return with_each(plcs, [&](PlcFiles& plc) { return plc.read_memory((plan++)->kept); });
}

Result<> RecordedRig::open_records() {
  if (trace)
    if (const auto done = trace->open().and_then([&] { return trace->put(); }); !done) return done;
  for (std::size_t plc = 0; trace && plc < plcs.size(); ++plc) sinks(plc).add(&trace->station(plc));
  std::size_t number = 0;
  return with_each(plcs, [&](PlcFiles& plc) { return plc.open(sinks(number++)); })
      .and_then([&] { return with_each(captures, [](CaptureFiles& each) { return each.open(); }); })
      .and_then([&] { return with_each(plcs, [](PlcFiles& plc) { return plc.put(); }); })
      .and_then([&] { return with_each(captures, [](CaptureFiles& each) { return each.put(); }); });
}

/// Captures each line at its first PLC, an S7-200, or one of another make if there is none; and shows traces their ports.
void RecordedRig::watch_lines() {
  auto capture = captures.begin();
  for (const LinePlan& line : plan_.lines) {
    CaptureFiles& files = *capture++;
    files.read_as(line.settings);
    const StationPlan* const other = first_plc(line) ? nullptr : first_other_plc(plan_, line);
    if (other) files.watch(*responder(other->number), time());
  }
  std::size_t number = 0;
  for (PlcFiles& each : plcs) watch_ports(number++, each);
}

void RecordedRig::watch_ports(std::size_t number, PlcFiles& files) {
  serial::Plc& watched = plc(number);
  for (std::uint8_t port = 0; port < plan_.plcs[number].program->model->ports; ++port) {
    std::vector<serial::WireSink*> sinks{files.levels_at(port)};
    auto capture = captures.begin();
    for (const LinePlan& line : plan_.lines) {
      const StationPlan* const first = first_plc(line);
      if (first && first->number == number && first->port == port) sinks.push_back(capture->sink());
      ++capture;
    }
    std::erase(sinks, nullptr);
    if (sinks.size() == 1) watched.set_wire_sink(sinks.front(), port);
    if (sinks.size() > 1) watched.set_wire_sink(&wires.emplace_back(std::move(sinks)), port);
  }
}

/// Traces have what is done to PLCs and lines from outside.
void RecordedRig::listen() {
  if (trace)
    tell_of_system([this](const EventPlan& event, Time at, const std::string& what) { trace->tell(event, at, what); });
  tell_of_events([this](std::size_t plc, Time at, const std::string& what) {
    std::next(plcs.begin(), static_cast<std::ptrdiff_t>(plc))->note(at, what);
  });
}

void RecordedRig::flush_records() {
  if (trace) trace->flush();
  for (PlcFiles& plc : plcs) plc.flush();
  for (CaptureFiles& each : captures) each.flush();
}

std::vector<RecordSize> RecordedRig::record_sizes() const {
  std::vector<RecordSize> sizes;
  if (trace)
    if (const auto size = trace->size()) sizes.push_back(*size);
  for (const PlcFiles& plc : plcs) plc.add_sizes(sizes);
  for (const CaptureFiles& each : captures) each.add_sizes(sizes);
  return sizes;
}

std::vector<std::string> RecordedRig::finish() {
  std::vector<std::string> problems;
  std::size_t number = 0;
  for (PlcFiles& each : plcs) {
    for (const std::string& open : open_messages(plc(number))) {
      each.note(time(), open);
      if (trace) trace->note(number, time(), open);
    }
    ++number;
  }
  if (trace)
    if (const auto done = trace->close(); !done) problems.push_back(done.why());
  for (PlcFiles& plc : plcs) plc.close(problems);
  for (CaptureFiles& each : captures) each.close(problems);
  number = 0;
  for (const PlcFiles& plc : plcs)
    if (has_begun(number++)) plc.keep_memory(problems);
  return problems;
}

}  // namespace s7200::tools

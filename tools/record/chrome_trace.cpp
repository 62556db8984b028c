#include "tools/record/chrome_trace.hpp"

#include <fmt/format.h>

#include <utility>

#include "interpreter/model/ports.hpp"
#include "interpreter/trace/trace_rows.hpp"
#include "tools/record/json_trace.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

/// The rows of the viewer, which the format calls threads.
enum Row : int { kProgram = 1, kInterrupts, kFirstPort };

/// The format counts in microseconds.
double microseconds(Time time) { return static_cast<double>(time) / kMicrosecond; }

ordered_json event_of(std::string_view phase, std::string_view name, Time at, int row) {
  return {{"ph", phase}, {"name", name}, {"pid", 1}, {"tid", row}, {"ts", microseconds(at)}};
}

int row_for(const TraceRecord& record) {
  if (row_of(record.kind).of_port) return kFirstPort + record.port;
  switch (record.kind) {
    case TraceKind::EventOccurred:
    case TraceKind::EventLost:
    case TraceKind::EventDropped:
    case TraceKind::Attach:
    case TraceKind::Detach:
    case TraceKind::Enable:
      return kInterrupts;
    default:
      return kProgram;
  }
}

}  // namespace

ChromeTrace::ChromeTrace(TraceWanted given) : SignalTrace(std::move(given)) {
  const auto name_row = [this](int row, const std::string& name) {
    add(0, {{"ph", "M"}, {"name", "thread_name"}, {"pid", 1}, {"tid", row}, {"args", {{"name", name}}}});
  };
  name_row(kProgram, "program");
  name_row(kInterrupts, "interrupts");
  for (int port = 0; port < static_cast<int>(kPorts.size()); ++port)
    name_row(kFirstPort + port, fmt::format("port {}", port));
}

/// Events stand in the order in which they were over; viewers sort them.
void ChromeTrace::add(Time at, ordered_json event) { put(at, ",\n" + line_of(event)); }

void ChromeTrace::record(const TraceRecord& record) {
  if (record.kind == TraceKind::ServiceEnd)
    add_service(record);
  else if (record.kind != TraceKind::ServiceBegin && has(record)) {
    ordered_json event = event_of("i", row_of(record.kind).name, record.at, row_for(record));
    event["s"] = "t";
    event["args"] = members_of(record, *wanted().program);
    add(record.at, std::move(event));
  }
  if (record.kind == TraceKind::ServiceBegin) {  // from the event, which has waited
    for (const auto& [phase, at] : {std::pair("s", record.since), std::pair("f", record.at)}) {
      ordered_json arrow = event_of(phase, "waits", at, kInterrupts);
      arrow["cat"] = "interrupt";
      arrow["id"] = arrows_;
      if (*phase == 'f') arrow["bp"] = "e";
      add(record.at, std::move(arrow));
    }
    ++arrows_;
  }
  SignalTrace::record(record);
}

void ChromeTrace::add_service(const TraceRecord& record) {
  ordered_json slice = event_of("X", fmt::format("INT {}", record.routine), record.since, kInterrupts);
  slice["cat"] = "interrupt";
  slice["dur"] = microseconds(record.at - record.since);
  slice["args"] = {{"event", record.event}};
  add(record.at, std::move(slice));
}

void ChromeTrace::note(Time at, std::string_view what) {
  ordered_json event = event_of("i", what, at, kProgram);
  event["s"] = "g";
  add(at, std::move(event));
}

void ChromeTrace::write(Time at) {
  for (const Shown& one : shown()) {
    if (!one.changed) continue;
    ordered_json event = event_of("C", one.signal.name, at, 0);
    event["args"] = {{"value", number_of(one)}};
    add(at, std::move(event));
  }
}

void ChromeTrace::finish() {
  SignalTrace::finish();
  put(kNever, "\n]\n");
}

}  // namespace s7200::tools

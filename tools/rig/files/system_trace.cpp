#include "tools/rig/files/system_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "tools/rig/event_words.hpp"

namespace s7200::tools {
namespace {

/// Lines older than this are complete: no CPU runs further ahead of the others.
constexpr Time kTold = kSecond;

constexpr std::size_t kMostWaiting = 100'000;

}  // namespace

SystemTrace::SystemTrace(const SystemPlan& plan, const serial::System& system, TraceDetail detail)
    : plan_(plan), system_(system), detail_(detail) {
  const auto make_room = [&](const auto& those) {
    for (const auto& each : those) width_ = std::max(width_, each.name.size());
  };
  make_room(plan.plcs);
  if (plan.events.empty()) return;
  make_room(plan.peers);
  make_room(plan.lines);
}

SystemTrace::~SystemTrace() = default;

Result<> SystemTrace::claim(WrittenFiles& files, const std::string& path) {
  format_ = &trace_format_of(path);
  if (!format_->note)
    return trouble("--trace {}: a trace of a whole system is text or .jsonl; the key 'trace' of one PLC takes the others",
                   path);
  return file_.claim(files, "--trace", path, {"a trace of a system", std::string(format_->first_line_of_system)});
}

Result<> SystemTrace::open() {
  const auto out = file_.open();
  if (!out) return out.trouble();
  out_ = &*out;
  *out_ << format_->first_line_of_system;
  for (std::size_t plc = 0; plc < plan_.plcs.size(); ++plc) {
    const auto take = [this, plc](Time at, std::string_view line) { add(plan_.plcs[plc].name, at, line); };
    stations_.push_back(format_->writer(
        {.take = take, .program = plan_.plcs[plc].program, .detail = detail_, .station = plan_.plcs[plc].name}));
  }
  return {};
}

Result<> SystemTrace::close() {
  write_until(kNever);
  return file_.close();
}

void SystemTrace::flush() {
  write_until(system_.time() - kTold);
  file_.flush();
}

TraceSink& SystemTrace::station(std::size_t plc) { return *stations_[plc]; }

void SystemTrace::note(std::size_t plc, Time at, std::string_view what) { stations_[plc]->note(at, what); }

void SystemTrace::tell(const EventPlan& event, Time at, std::string_view what) {
  const std::string& subject = name_of_subject(event, plan_);
  add(subject, at, format_->note(at, subject, what));
}

void SystemTrace::add(std::string_view name, Time at, std::string_view text) {
  waiting_.push_back({at, format_->station_column ? fmt::format("{:<{}}  {}", name, width_, text) : std::string(text)});
  if (waiting_.size() % kMostWaiting == 0) write_until(system_.time() - kTold);
}

void SystemTrace::write_until(Time end) {
  std::ranges::stable_sort(waiting_, {}, &Line::at);
  const auto rest = std::ranges::lower_bound(waiting_, end, {}, &Line::at);
  for (auto line = waiting_.begin(); line != rest; ++line) *out_ << line->text;
  waiting_.erase(waiting_.begin(), rest);
}

}  // namespace s7200::tools

#include "tools/rig/system_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

namespace s7200::tools {
namespace {

constexpr std::string_view kFirstLine = "# station, time in ms, what\n";

/// By then whatever a CPU has run ahead of the others has been told.
constexpr Time kTold = kSecond;

constexpr std::size_t kMostWaiting = 100'000;

}  // namespace

SystemTrace::SystemTrace(const SystemPlan& plan, const serial::System& system, TraceDetail detail)
    : plan_(plan), system_(system), detail_(detail) {
  for (const PlcPlan& plc : plan.plcs) width_ = std::max(width_, plc.name.size());
}

bool SystemTrace::claim(WrittenFiles& files, const std::string& path, std::string& why) {
  return file_.claim(files, "--trace", path, {"a trace of a system", std::string(kFirstLine)}, why);
}

bool SystemTrace::open(std::string& why) {
  out_ = file_.open(why);
  if (!out_) return false;
  *out_ << kFirstLine;
  for (std::size_t plc = 0; plc < plan_.plcs.size(); ++plc)
    traces_.push_back(std::make_unique<TextTrace>([this, plc](Time at, std::string_view line) { add(plc, at, line); },
                                                  plan_.plcs[plc].program, detail_));
  return true;
}

bool SystemTrace::close(std::string& why) {
  write_until(kNever);
  return file_.close(why);
}

void SystemTrace::add(std::size_t plc, Time at, std::string_view text) {
  waiting_.push_back({at, fmt::format("{:<{}}  {}", plan_.plcs[plc].name, width_, text)});
  if (waiting_.size() % kMostWaiting == 0) write_until(system_.time() - kTold);
}

void SystemTrace::write_until(Time end) {
  std::ranges::stable_sort(waiting_, {}, &Line::at);
  const auto rest = std::ranges::lower_bound(waiting_, end, {}, &Line::at);
  for (auto line = waiting_.begin(); line != rest; ++line) *out_ << line->text;
  waiting_.erase(waiting_.begin(), rest);
}

}  // namespace s7200::tools

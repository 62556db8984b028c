#include "tools/rig/system_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "interpreter/trace/line_parts.hpp"
#include "tools/views/memory.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kFirstLine = "# station, time in ms, what\n";

/// By then whatever a CPU has run ahead of the others has been told.
constexpr Time kTold = kSecond;

constexpr std::size_t kMostWaiting = 100'000;

/// Whose event it is: a station's or a line's.
const std::string& owner_of(const EventPlan& event, const SystemPlan& plan) {
  using What = EventPlan::What;
  if (event.what == What::PowerOff || event.what == What::PowerOn) return name_of(plan, event.station);
  return event.what == What::Set ? plan.plcs[event.plc].name : plan.lines[event.line].name;
}

std::string to_text(const EventPlan& event, const SystemPlan& plan) {
  using What = EventPlan::What;
  const auto station = [&](std::size_t place) { return name_of(plan, plan.lines[event.line].stations[place]); };
  switch (event.what) {
    case What::PowerOff:
      return "power off";
    case What::PowerOn:
      return "power on";
    case What::Cut:
      return fmt::format("cable cut after {}", station(event.near - 1));
    case What::Mend:
      return "cable whole again";
    case What::Set: {
      std::string places;
      for (const Assignment& each : event.set)
        places += fmt::format("{}{} to {}", places.empty() ? "" : ", ", each.place.name_of(0), hex_text(each));
      return fmt::format("a programming device sets {}", places);
    }
    case What::Fault:
      return fmt::format("fault {}{}", serial::to_text(event.fault.fault),
                         event.fault.station ? " of " + station(*event.fault.station) : "");
    case What::ClearFaults:
      return "no fault any more";
  }
  return {};
}

}  // namespace

/// What a CPU does while it has power: characters that pass it by before and after that are no business of its program.
class SystemTrace::Station final : public TraceSink {
 public:
  Station(TextTrace::TakeLine take, std::shared_ptr<const Program> program, TraceDetail detail, const serial::Plc& plc)
      : text_(std::move(take), std::move(program), detail), plc_(plc) {}

  void record(const TraceRecord& record) override {
    if (plc_.powered()) text_.record(record);
  }
  bool before(std::uint32_t op) override { return text_.before(op); }
  void instruction(const InstructionRecord& record) override { text_.instruction(record); }
  bool wants_instructions() const override { return text_.wants_instructions(); }
  bool wants_scans() const override { return text_.wants_scans(); }

 private:
  TextTrace text_;
  const serial::Plc& plc_;
};

SystemTrace::SystemTrace(const SystemPlan& plan, const serial::System& system, const std::vector<serial::Plc*>& plcs,
                         TraceDetail detail)
    : plan_(plan), system_(system), plcs_(plcs), detail_(detail) {
  const auto make_room = [&](const auto& those) {
    for (const auto& each : those) width_ = std::max(width_, each.name.size());
  };
  make_room(plan.plcs);
  if (plan.events.empty()) return;
  make_room(plan.peers);
  make_room(plan.lines);
}

SystemTrace::~SystemTrace() = default;

bool SystemTrace::claim(WrittenFiles& files, const std::string& path, std::string& why) {
  return file_.claim(files, "--trace", path, {"a trace of a system", std::string(kFirstLine)}, why);
}

bool SystemTrace::open(std::string& why) {
  out_ = file_.open(why);
  if (!out_) return false;
  *out_ << kFirstLine;
  for (std::size_t plc = 0; plc < plan_.plcs.size(); ++plc) {
    const auto take = [this, plc](Time at, std::string_view line) { add(plan_.plcs[plc].name, at, line); };
    stations_.push_back(std::make_unique<Station>(take, plan_.plcs[plc].program, detail_, *plcs_[plc]));
  }
  return true;
}

bool SystemTrace::close(std::string& why) {
  write_until(kNever);
  return file_.close(why);
}

TraceSink& SystemTrace::station(std::size_t plc) { return *stations_[plc]; }

void SystemTrace::tell(const EventPlan& event, Time at) {
  if (!told_.emplace(at, &event).second) return;
  fmt::memory_buffer line;
  append_clock(line, at);
  const bool in_vain = event.what == EventPlan::What::Set && !plcs_[event.plc]->powered();
  append(line, "  ", to_text(event, plan_), in_vain ? ": nothing, for there is no power\n" : "\n");
  add(owner_of(event, plan_), at, {line.data(), line.size()});
}

void SystemTrace::add(std::string_view name, Time at, std::string_view text) {
  waiting_.push_back({at, fmt::format("{:<{}}  {}", name, width_, text)});
  if (waiting_.size() % kMostWaiting == 0) write_until(system_.time() - kTold);
}

void SystemTrace::write_until(Time end) {
  std::ranges::stable_sort(waiting_, {}, &Line::at);
  const auto rest = std::ranges::lower_bound(waiting_, end, {}, &Line::at);
  for (auto line = waiting_.begin(); line != rest; ++line) *out_ << line->text;
  waiting_.erase(waiting_.begin(), rest);
}

}  // namespace s7200::tools

#include "tools/scenario/plant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tools/rig/event_words.hpp"
#include "tools/rig/files/recorded_rig.hpp"
#include "tools/rig/first_scans.hpp"
#include "tools/views/report.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {
namespace {

constexpr Time kSlice = 10 * kSecond;  // Ctrl-C is heard in between

SystemPlan plan_to_run(const Scenario& scenario, std::shared_ptr<const Program> program) {
  if (scenario.plan) return *scenario.plan;
  SystemPlan plan = plan_of(std::move(program), {scenario.plc, {}, scenario.port}, scenario.field);
  forget_files(plan);
  return plan;
}

/// Those of the steps; the master stands beside the first of a line.
std::vector<Spot> spots_of(const Scenario& scenario, const SystemPlan& plan) {
  std::vector<Spot> spots;
  const auto add = [&](const std::optional<Spot>& spot) {
    if (spot && std::ranges::find(spots, *spot) == spots.end()) spots.push_back(*spot);
  };
  add(find_spot(plan, scenario.on).if_any());
  for (const Step& step : scenario.steps) {
    if (step.spot) add(find_spot(plan, plan.lines[step.spot->line].name).if_any());
    add(step.spot);
  }
  for (const LinePlan& line : plan.lines)
    if (spots.empty()) add(find_spot(plan, line.name).if_any());
  return spots;
}

}  // namespace

void InterruptCounter::record(const TraceRecord& record) {
  if (record.kind == TraceKind::ServiceBegin) ++routine_[record.routine];
  if (record.kind == TraceKind::EventOccurred) ++event_[record.event];
  if (record.kind == TraceKind::EventLost) ++lost_;
}

Plant::Plant(const Scenario& scenario, std::shared_ptr<const Program> program, StopToken stop, const Observed& observed)
    : scenario_(scenario), stop_(stop), plan_(plan_to_run(scenario, std::move(program))), spots_(spots_of(scenario, plan_)) {
  for (const PlcPlan& plc : plan_.plcs) watches_.push_back(std::make_unique<Watch>(plc.program, observed));
  power_up();
}

void Plant::power_up() {
  slaves_.clear();
  seen_.reset();
  journal_.reset();
  std::vector<std::string> problems;
  rig_ = RecordedRig::assemble(plan_, {.path = scenario_.system, .seen = {.spots = spots_}, .stop = stop_}, problems);
  if (!rig_) throw std::logic_error(problems.empty() ? "interrupted" : problems.front());
  for (std::size_t plc = 0; plc < plan_.plcs.size(); ++plc) {
    rig_->sinks(plc).add(&watches_[plc]->sinks);
    watches_[plc]->observers.begin(rig_->plc(plc).cpu());
  }
  rig_->tell_of_events(
      [this](std::size_t plc, Time at, const std::string& what) { watches_[plc]->timeline.note(at, what); });
  rig_->power_up();
  const std::string& name = is_of_one_program(plan_) ? plan_.plcs.front().program->source.name : scenario_.system;
  for (std::size_t spot = 0; spot < spots_.size(); ++spot)
    slaves_.push_back(std::make_unique<SimulatedSlave>(rig_->simulation(spot), master_of(spots_[spot]), name));
  begin_journal();
}

/// Unless a line is seen from no PLC: a recording has a station for each action.
void Plant::begin_journal() {
  seen_.emplace(*rig_, spots_);
  for (const Spot& spot : spots_)
    if (!seen_->station_on(spot.line)) return;
  std::vector<RetentiveMemory> kept;
  if (const auto& memory = plan_.plcs.front().kept) kept.push_back(*memory);
  journal_.emplace(rig_->simulation(), std::move(kept));
  for (std::size_t spot = 0; spot < spots_.size(); ++spot)
    slaves_[spot]->when_asked(
        [this, station = *seen_->station_on(spots_[spot].line)](const SerialFormat& format, const serial::Request& request) {
          journal_->note(SendFrame{.format = format, .request = request}, station);
        });
}

void Plant::carry_out(const EventPlan& event) {
  note(SystemEvent{event, named_event_text(event, rig_->plan())});
  rig_->carry_out(event);
}

void Plant::look_at(const Spot& spot) { here_ = static_cast<std::size_t>(std::ranges::find(spots_, spot) - spots_.begin()); }

serial::MasterSettings Plant::master_of(const Spot& spot) const { return on_line(scenario_.line, plan_.lines[spot.line]); }

void Plant::act(Action action) {
  note(action);
  perform(action, simulation());
}

std::vector<Recording> Plant::recordings() const {
  std::vector<Recording> all = recordings_;
  if (journal_) all.push_back(journal_->recording());
  return all;
}

std::optional<PlaceInRun> Plant::place() const {
  return journal_ && !journal_->is_over() ? std::optional(PlaceInRun{recordings_.size(), journal_->now()}) : std::nullopt;
}

void Plant::power_cycle(bool memory_lost, Time power_off) {
  RetentiveMemory memory = cpu().retentive_memory();
  memory.ram_lost = memory_lost;
  memory.power_off = power_off;
  before_ += simulation().time();
  recordings_.push_back(journal_->recording());
  const State before = cpu().state();
  plan_.plcs.front().kept = memory;
  plan_.plcs.front().settings = {};
  power_up();
  act(SetMemory{inputs_as_before(cpu(), before)});
}

bool Plant::get_ready() {
  if (scenario_.after != kNever) {
    slave().wait(scenario_.after - simulation().time());
    return true;
  }
  if (!run_first_scans(*rig_, kReadyWithin)) return false;
  const bool ready = slaves_[here_]->get_ready(kReadyWithin);
  return ready || cpu().state().mode == Mode::Stop;
}

void Plant::begin_exchange() {
  begin_reception();
  for (const auto& watch : watches_) watch->interrupts.begin();
}

void Plant::begin_reception() {
  for (const auto& watch : watches_) watch->timeline.begin();
}

void Plant::end_exchange() {
  for (const auto& watch : watches_) watch->timeline.end();
}

bool Plant::wait_scans(std::uint64_t count) {
  cpu().pause_at_scan_end(true);
  const Time limit = simulation().time() + kReadyWithin;
  for (; count > 0 && simulation().run_until(limit) == serial::Halt::Paused; --count) {
  }
  leave_pause();
  return count == 0;
}

void Plant::leave_pause() {
  cpu().pause_at_scan_end(false);
  cpu().run(cpu().time());
}

bool Plant::wait_until(const std::function<bool()>& holds, Time timeout) {
  const Time limit = simulation().time() + timeout;
  bool held = holds();
  cpu().pause_at_scan_end(true);
  while (!held && !stop_.stop_requested() && simulation().time() < limit) {
    const serial::Halt halt = simulation().run_until(std::min(limit, simulation().time() + kSlice));
    held = holds();
    if (halt == serial::Halt::Stopped) break;
  }
  leave_pause();
  return held;
}

std::string Plant::timeline(const serial::Exchange& exchange) const {
  std::vector<StationTimeline> stations;
  for (std::size_t plc = 0; plc < plcs(); ++plc)
    if (is_on(spots_[here_].line, plc)) stations.push_back({name_of(plc), watches_[plc]->timeline.report()});
  return to_text(stations, exchange, false);
}

bool Plant::is_on(std::size_t line, std::size_t plc) const {
  return std::ranges::any_of(plan_.lines[line].stations, [&](const StationPlan& station) {
    return station.kind == StationPlan::Kind::Plc && station.number == plc;
  });
}

std::string Plant::of_plc(const std::string& what) const {
  return is_of_one_program(plan_) ? what : fmt::format("{} of {}", what, name_of(plc_number()));
}

void Plant::report(CoverageOfPrograms& coverage, ProfileOfPrograms& profile) const {
  for (std::size_t plc = 0; plc < watches_.size(); ++plc) {
    const std::string name = is_of_one_program(plan_) ? "" : plan_.plcs[plc].name;
    watches_[plc]->observers.report(coverage);
    watches_[plc]->observers.report(profile, name);
  }
}

bool Plant::is_in_stop(std::size_t plc) const { return is_powered(plc) && cpu_of(plc).state().mode == Mode::Stop; }

std::string Plant::why_stopped(std::size_t plc) const {
  const std::string why = errors_text(cpu_of(plc));
  return why.empty() ? "" : "\n" + why;
}

}  // namespace s7200::tools

#include "tools/session/past/history.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {
namespace {

std::size_t bytes_of(const serial::Exchange& exchange) {
  return exchange.request.size() * sizeof(exchange.request[0]) +
         (exchange.echo.size() + exchange.response.size()) * sizeof(ReceivedCharacter);
}

std::size_t bytes_of(const serial::HostCall& call) {
  return sizeof(Action) + sizeof(Moment) + call.characters.size() * sizeof call.characters[0];
}

std::size_t bytes_of(const Action& action) {
  const auto* call = std::get_if<serial::HostCall>(&action);
  return call ? bytes_of(*call) : 0;
}

std::size_t bytes_of(const std::vector<Action>& actions) {
  std::size_t bytes = 0;
  for (const Action& action : actions) bytes += bytes_of(action);
  return bytes;
}

/// About what a snapshot takes; the CPUs are nearly all of it.
std::size_t bytes_of(const serial::Simulation::Snapshot& state) {
  std::size_t bytes = sizeof state + state.plcs.size() * sizeof state.plcs[0];
  for (const auto& line : state.lines) bytes += sizeof line + line.faults.injected.size() * sizeof line.faults.injected[0];
  for (const auto& requester : state.requesters)
    bytes += sizeof requester + bytes_of(requester.requester.exchange) +
             requester.requester.heard.size() * sizeof(ReceivedCharacter);
  for (const auto& host : state.host_ports)
    bytes += sizeof host + host.port.to_send.size() * sizeof(serial::HostCharacter) +
             host.port.received.size() * sizeof(ReceivedCharacter);
  return bytes;
}

/// A programming device writes, or what it has asked for clears memory.
bool writes_memory(TraceKind kind) {
  return kind == TraceKind::ModeChange || kind == TraceKind::PpiService || kind == TraceKind::PpiAccess;
}

bool changes_memory(const Action& action) {
  return std::holds_alternative<SetMemory>(action) || std::holds_alternative<Force>(action) ||
         std::holds_alternative<Unforce>(action) || std::holds_alternative<SetMode>(action) ||
         std::holds_alternative<SetPower>(action) || std::holds_alternative<SystemEvent>(action);
}

constexpr Time kCheckpointsOfAPart = 60;       // between two that came with a recording: what is near is soon there, too
constexpr Time kLongestFrame = 3 * kSecond;    // 256 characters of 11 bits at 1200 baud
constexpr Time kSlice = 100 * kMillisecond;    // a stop request is heard in between
constexpr std::uint32_t kTellEvery = 1 << 10;  // instructions

bool comes_before(const Moment& one, const Moment& other) {
  if (one.is_counted() && other.is_counted()) return one < other;
  return std::tie(one.time, one.actions) < std::tie(other.time, other.actions);
}

/// Comes to the first instruction, before what was done in front of it.
class StopAtOnce final : public Observer {
 public:
  explicit StopAtOnce(const History& history) : history_(history) {}
  bool before(std::uint32_t) override { return false; }
  bool before_action() override { return !history_.now().settled; }
  bool wants_instructions() const override { return true; }
  Time idles_until(Time now) override { return now; }  // it goes to STOP instead

 private:
  const History& history_;
};

}  // namespace

History::History(serial::Simulation& simulation, Settings settings)
    : History(std::vector{&simulation}, std::move(settings)) {}

History::History(std::vector<serial::Simulation*> stations, Settings settings)
    : stations_(std::move(stations)),
      settings_(std::move(settings)),
      requests_(others()),
      alone_(stations_.size() == 1 && !system().has_schedule()),
      bytes_(std::make_shared<std::size_t>(0)) {
  if (stations_.size() == 1 && settings_.hosts.empty() && station(0).has_host_port())
    settings_.hosts.push_back(&station(0).host_port());
  for (const serial::Simulation* station : stations_) markers_.emplace_back(station->cpu());
  for (std::size_t number = 0; number < stations_.size(); ++number)
    station(number).cpu().set_sink(taps_.emplace_back(std::make_unique<Tap>(*this, number)).get());
  for (std::size_t number = 0; number < settings_.hosts.size(); ++number)
    settings_.hosts[number]->set_journal(journals_.emplace_back(std::make_unique<Journal>(*this, number)).get());
  system().watch_schedule([this](std::size_t number, bool done) { planned(number, done); });
  begin_branch(system().snapshot());
  origin_ = branch_->checkpoints.front();
}

PlcRequests::Others History::others() {
  PlcRequests::Others others{.stations = stations_, .host_has_sent = {}};
  for (const PollingMaster& master : settings_.pollers) others.pollers.push_back(master.poller);
  others.host_has_sent = [this](const serial::Line& line, Time after, const auto& is) {
    return std::ranges::any_of(hosts_on(line), [&](std::size_t number) {
      return settings_.hosts[number]->sent_until() > after && has_sent(number, is);
    });
  };
  return others;
}

History::~History() {
  system().watch_schedule({});
  for (serial::Simulation* station : stations_) station->cpu().set_sink(nullptr);
  for (serial::HostPort* host : settings_.hosts) host->set_journal(nullptr);
}

std::string History::name_of(std::size_t station) const {
  const bool named = station < settings_.plcs.size() && !settings_.plcs[station].name.empty();
  return named ? stl::printable(settings_.plcs[station].name) : "the PLC";
}

std::string History::name_of(const Asker& asker) const {
  switch (asker.kind) {
    case Asker::Kind::Send:
      return "the master";
    case Asker::Kind::Poller:
      return stl::printable(settings_.pollers[asker.number].name);
    case Asker::Kind::Plc:
      return name_of(asker.number);
    case Asker::Kind::Bridge:
      break;
  }
  const std::string bridge = bridge_of(asker.number);
  return bridge.empty() ? "the bridge" : bridge;
}

std::string History::name_at(const serial::SharedLine& line, int driver) const {
  const auto number = std::ranges::find(requests_.lines(), &line) - requests_.lines().begin();
  for (std::size_t plc = 0; plc < stations_.size(); ++plc)
    if (const auto port = requests_.port_on(static_cast<std::size_t>(number), plc);
        port && station(plc).plc().driver(*port) == driver)
      return name_of(plc);
  for (const SimulatedMaster& master : requests_.masters_on(static_cast<std::size_t>(number)))
    if (master.driver == driver) return name_of(master.asker);
  for (const std::size_t host : hosts_on(line.line()))
    if (settings_.hosts[host]->driver() == driver) return name_of({Asker::Kind::Bridge, host});
  return "a peer";
}

std::string History::bridge_of(std::size_t host) const {
  const serial::HostPort& port = *settings_.hosts[host];
  const auto is_it = [&](const LineStation& one) {
    return one.kind == LineStation::Kind::Bridge && port.is_on(one.line->line()) && port.driver() == one.driver;
  };
  const auto bridge = std::ranges::find_if(settings_.line_stations, is_it);
  return bridge == settings_.line_stations.end() ? "" : stl::printable(bridge->name);
}

std::vector<std::size_t> History::hosts_on(const serial::Line& line) const {
  std::vector<std::size_t> hosts;
  for (std::size_t number = 0; number < settings_.hosts.size(); ++number)
    if (settings_.hosts[number]->state().attached && settings_.hosts[number]->is_on(line)) hosts.push_back(number);
  return hosts;
}

std::optional<std::uint8_t> History::address_of(std::size_t station) const {
  return station < settings_.plcs.size() ? settings_.plcs[station].address : std::nullopt;
}

std::uint64_t History::executed() const {
  std::uint64_t executed = 0;
  for (const serial::Simulation* station : stations_) executed += station->plc().executed();
  return executed;
}

std::optional<std::size_t> History::next_station() const {
  std::optional<std::size_t> next;
  for (std::size_t number = 0; number < stations_.size(); ++number)
    if (station(number).plc().executes() &&
        (!next || station(number).cpu().next_action() < station(*next).cpu().next_action()))
      next = number;
  return next;
}

bool History::stopped() const { return alone_ && station(0).cpu().state().mode == Mode::Stop; }

Time History::latest_clock() const {
  Time latest = 0;
  for (const serial::Simulation* station : stations_) latest = std::max(latest, station->cpu().time());
  return latest;
}

Moment History::now() const { return {executed(), actions_, settled_, time(), stopped()}; }

Moment History::in_front() const { return {executed(), actions_, true, station(told_of_).cpu().time(), false}; }

// --- running ---

serial::Halt History::run(Observer& observer) {
  observer_ = &observer;
  serial::Halt halt = serial::Halt::Paused;
  if (!in_the_past() || advance(branch_->end))
    halt = run_live();
  else if (!stopped_by_observer_)
    halt = serial::Halt::Time;
  observer_ = nullptr;
  return halt;
}

/// Whose instructions nobody looks at may write anything.
serial::Halt History::run_live() {
  live_ = true;
  for (std::size_t station = 0; station < stations_.size(); ++station)
    if (!wants_instructions(station)) note_unknown_writes(station);
  serial::Halt halt = serial::Halt::Time;
  while (halt == serial::Halt::Time) {
    const Time last = branch_->checkpoints.back()->moment.time;
    const Time next = last < kNever - branch_->interval ? last + branch_->interval : kNever;
    const Time idle = executes() ? kNever : observer_->idles_until(time());
    if (idle <= time()) break;
    checkpoint_due_ = passes_over() ? next : kNever;
    // A run that wants scans now may want none soon, and then goes over as many as it may at once.
    const Time over = observer_->passes_over_until();
    const Time end = passes_over() ? over : over > time() ? std::min(next, over) : next;
    halt = run_live_until(executes() ? end : std::min({next, idle, time() + kSlice}));
    if (halt == serial::Halt::Time && time() >= next) keep_checkpoint(branch_->checkpoints.size());
  }
  checkpoint_due_ = kNever;
  live_ = false;
  return halt;
}

/// Halt::Time too where a checkpoint is due.
serial::Halt History::run_live_until(Time end) {
  stopped_for_checkpoint_ = false;
  const serial::Halt halt = drive(end);
  settled_ = halt == serial::Halt::Paused;
  branch_->end = now();
  return stopped_for_checkpoint_ ? serial::Halt::Time : halt;
}

/// Whether scans that are all alike may be passed over. Then a run goes as far as it may at once: looking for them pays only
/// if many may come. It stops for a checkpoint in front of an instruction, as there are none where it passes over.
bool History::passes_over() const { return alone_ && !settings_.drive && wants_instructions(0) && !wants_scans(0); }

serial::Halt History::drive(Time end) {
  if (!settings_.drive) return run_until(end);
  system().run_in_step(true);
  return settings_.drive(end, [this] { tell_progress(); });
}

/// A run that is observed ends early when the last CPU that executed a program does so no more, and all clocks are at the
/// same instant: the observer is asked then. The only one, in STOP, goes from event to event: each may end the run.
serial::Halt History::run_until(Time end) {
  system().run_in_step(observer_ != nullptr || goal_.has_value());
  const bool executed = executes();
  serial::Halt halt = serial::Halt::Time;
  while (halt == serial::Halt::Time && time() < end) {
    halt = system().step(end);
    if (observer_ && executed && !executes()) end = std::min(end, latest_clock());
    if (observer_ && !executed && alone_) break;
  }
  return halt;
}

bool History::play(Observer& observer, const Moment& end) {
  observer_ = &observer;
  const bool arrived = advance(end);
  observer_ = nullptr;
  return arrived;
}

/// Instructions are other ones there: what was done from outside has its place by its time.
bool History::play_beside(Observer& observer, Time end) {
  auto beside = std::make_shared<Branch>(*branch_);
  beside->unexplored = false;
  std::size_t until = actions_;
  for (std::size_t number = actions_ - beside->forgotten; number < beside->moments.size(); ++number) {
    Moment& moment = beside->moments[number];
    moment = {Moment::kNotCounted, number + beside->forgotten, false, moment.time, false};
    if (moment.time <= end) until = number + beside->forgotten + 1;
  }
  branch_ = std::move(beside);
  beside_ = true;
  const bool stopped = end >= branch_->end.time && branch_->end.stopped;
  const bool arrived = play(observer, {Moment::kNotCounted, until, false, end, stopped});
  beside_ = false;
  return arrived;
}

/// A request whose answer takes longer there is given up for the next one; and there may be none to be given up.
bool History::can_be_done_beside(const Action& action, std::size_t station) {
  serial::Simulation& plc = this->station(station);
  const bool sends = std::holds_alternative<SendFrame>(action), cancels = std::holds_alternative<CancelRequest>(action);
  if (!sends && !cancels) return true;
  const bool busy = plc.master().busy();
  if (sends && busy) plc.master().give_up(plc.time());
  return sends || busy;
}

bool History::advance(const Moment& target) {
  while (actions_ < target.actions) {
    if (!reach(next_action()) || !do_next_action()) return false;
  }
  return reach(target);
}

bool History::has_next_action() const { return actions_ - branch_->forgotten < branch_->actions.size(); }

const Moment& History::next_action() const { return branch_->moments[actions_ - branch_->forgotten]; }

/// Null if it is no fault, or one of anyone on the line.
const LineStation* History::station_of_fault(const Action& action, std::size_t station) const {
  const auto* const inject = std::get_if<InjectFault>(&action);
  if (!inject || inject->of.empty()) return nullptr;
  return find_station(line_stations(), this->station(station).line(), inject->of);
}

/// False if the observer has stopped before it.
bool History::do_next_action() {
  told_of_ = next_station().value_or(told_of_);
  stopped_by_observer_ = observer_ && !observer_->before_action();
  if (stopped_by_observer_) return false;
  const Moment here = now();
  const std::size_t number = actions_++ - branch_->forgotten;
  if (!branch_->moments[number].is_counted()) branch_->moments[number] = here;
  const Action& action = branch_->actions[number];
  const std::size_t where = branch_->stations[number];
  if (beside_ && !can_be_done_beside(action, where))
    settled_ = false;
  else if (std::holds_alternative<serial::HostCall>(action))
    perform(action, station(0), settings_.hosts[where]);
  else if (const auto* const event = std::get_if<SystemEvent>(&action))
    settings_.carry_out(event->event);
  else
    perform(action, station(where), nullptr, station_of_fault(action, where));
  settled_ = false;
  if (live_ && changes_memory(action)) note_unknown_writes(where);
  if (observer_) observer_->acted();
  return true;
}

/// To what is written since the last checkpoint.
void History::note_unknown_writes(std::size_t station) { branch_->written.back()[station].unknown = true; }

/// Plays until a moment that has as many actions before it as have been done.
bool History::reach(const Moment& moment) {
  stopped_by_observer_ = false;
  if (now() == moment) return true;
  settled_ = false;
  bool arrived = false;
  if (!moment.settled) {
    arrived = pass(moment.time) && come_to_stop(moment);
  } else {
    if (!observer_) run_until(moment.time);
    goal_ = moment.instructions;
    arrived = pass(moment.time + 1);
    goal_.reset();
  }
  settled_ = stopped_by_observer_ || (arrived && moment.settled);
  return arrived;
}

/// Plays until `end`, or the goal; false if the observer has ended it, who is asked again and again while no CPU executes.
/// Scans are passed over no further than the observer lets them be.
bool History::pass(Time end) {
  serial::Halt halt = serial::Halt::Time;
  while (halt == serial::Halt::Time && time() < end) {
    Time until = end;
    if (observer_ && !executes())
      until = std::min({end, observer_->idles_until(time()), time() + kSlice});
    else if (const Time over = observer_ ? observer_->passes_over_until() : kNever; over > time() || !wants_scans(0))
      until = std::min(end, over);
    if (until <= time()) return false;
    halt = run_until(until);
  }
  return !stopped_by_observer_;
}

/// At the time of `moment` a CPU that has used up its time is in RUN still, and goes to STOP in no time.
bool History::come_to_stop(const Moment& moment) {
  serial::Halt halt = serial::Halt::Time;
  while (halt == serial::Halt::Time && moment.stopped && !stopped() && time() <= moment.time)
    halt = system().step(moment.time + 1);
  return !stopped_by_observer_;
}

/// Of a live run; null if there are none.
TraceSink* History::records_of(std::size_t station) const {
  return live_ && station < settings_.records.size() ? settings_.records[station] : nullptr;
}

bool History::wants_instructions(std::size_t station) const {
  const TraceSink* const records = records_of(station);
  return goal_ || (observer_ && observer_->watches(station)) || (records && records->wants_instructions());
}

bool History::wants_scans(std::size_t station) const {
  const TraceSink* const records = records_of(station);
  return goal_ || (observer_ && observer_->watches(station) && observer_->wants_scans()) ||
         (records && records->wants_scans());
}

void History::record(std::size_t station, const TraceRecord& record) {
  told_of_ = station;
  if (TraceSink* const records = records_of(station)) records->record(record);
  if (observer_ && observer_->watches(station)) observer_->record(record);
  if (live_ && writes_memory(record.kind)) note_unknown_writes(station);
  requests_.note(station, record);
}

bool History::before(std::size_t station, std::uint32_t op) {
  told_of_ = station;
  if (++looked_ % kTellEvery == 0) tell_progress();
  stopped_for_checkpoint_ = this->station(station).cpu().time() >= checkpoint_due_;
  if (stopped_for_checkpoint_) return false;
  if (goal_ && executed() == *goal_) return false;
  bool goes_on = true;
  if (TraceSink* const records = records_of(station); records && records->wants_instructions())
    goes_on = records->before(op);
  if (observer_ && observer_->watches(station)) goes_on &= observer_->before(op);
  if (live_) markers_[station].before(op);
  stopped_by_observer_ = !goes_on;
  return goes_on;
}

void History::instruction(std::size_t station, const InstructionRecord& record) {
  told_of_ = station;
  if (live_) markers_[station].executed(record, branch_->written.back()[station]);
  if (TraceSink* const records = records_of(station); records && records->wants_instructions()) records->instruction(record);
  if (observer_ && observer_->watches(station)) observer_->instruction(record);
}

void History::planned(std::size_t number, bool done) {
  for (std::size_t station = 0; live_ && station < stations_.size(); ++station) note_unknown_writes(station);
  if (!observer_) return;
  done ? observer_->planned_done(number) : observer_->before_planned(number);
}

// --- going elsewhere ---

bool History::stands_at(const Moment& moment) const {
  const Moment here = now();
  return moment.is_counted() ? here == moment : here.time == moment.time && here.actions == moment.actions;
}

/// The last checkpoint at that moment or before it, and so on, by its number.
std::size_t History::part_of(const Moment& moment) const {
  const auto& all = branch_->checkpoints;
  const auto after = std::upper_bound(all.begin() + 1, all.end(), moment,
                                      [](const Moment& m, const CheckpointPtr& c) { return comes_before(m, c->moment); });
  return static_cast<std::size_t>(after - all.begin()) - 1;
}

std::size_t History::part_of(Time time) const {
  const auto& all = branch_->checkpoints;
  const auto after =
      std::upper_bound(all.begin() + 1, all.end(), time, [](Time t, const CheckpointPtr& c) { return t < c->moment.time; });
  return static_cast<std::size_t>(after - all.begin()) - 1;
}

std::size_t History::part_before(const Moment& moment) const {
  const auto& all = branch_->checkpoints;
  const auto after = std::lower_bound(all.begin() + 1, all.end(), moment,
                                      [](const CheckpointPtr& c, const Moment& m) { return c->moment < m; });
  return static_cast<std::size_t>(after - all.begin()) - 1;
}

void History::restore(const Checkpoint& checkpoint) {
  system().restore(checkpoint.state);
  for (std::size_t number = 0; number < stations_.size(); ++number)
    station(number).cpu().core().loop.op = checkpoint.ops[number];
  requests_.restore(checkpoint.requests);
  actions_ = checkpoint.moment.actions;
  settled_ = checkpoint.moment.settled;
}

void History::go_to(const Moment& moment) {
  if (!explore(moment.time)) return;
  const Checkpoint& checkpoint = *branch_->checkpoints[part_of(moment)];
  if (const Moment here = now(); comes_before(moment, here) || comes_before(here, checkpoint.moment)) restore(checkpoint);
  advance(moment);
}

bool History::go_to(Time time) {
  const Moment start = now();
  if (time >= newest().time) {
    go_to(newest());
    return true;
  }
  const bool explored = explore(time);
  restore(*branch_->checkpoints[part_of(time)]);
  if (!explored || !play_to(time)) {
    go_to(start);
    return false;
  }
  StopAtOnce here(*this);
  if (executes()) play(here, newest());
  return true;
}

/// Plays all that has run before `time`, and what was done until then. False after a stop request, which is heard ever more
/// rarely: between two checkpoints there is either little to execute, or much to pass over at once.
bool History::play_to(Time time) {
  while (has_next_action() && next_action().time <= time) {
    if (stop_requested()) return false;
    reach(next_action());
    do_next_action();
  }
  for (Time slice = kSlice; this->time() < time; slice = std::min(slice, kNever / 4) * 2) {
    if (stop_requested()) return false;
    tell_progress();
    run_until(this->time() < time - slice ? this->time() + slice : time);
    settled_ = false;
  }
  return true;
}

/// Plays what was recorded elsewhere on from the last checkpoint before `time`, and keeps checkpoints up to there. False
/// after a stop request. What is written there is unknown.
bool History::explore(Time time) {
  if (!branch_->unexplored) return true;
  const Time end = std::min(time, branch_->end.time);
  const auto next = [this](std::size_t part) { return branch_->checkpoints[part]->moment.time + branch_->interval; };
  for (std::size_t part = part_of(end); next(part) < end; part = part_of(end)) {
    if (const Checkpoint& checkpoint = *branch_->checkpoints[part]; now() != checkpoint.moment) restore(checkpoint);
    if (!play_to(next(part))) return false;
    keep_checkpoint(part + 1);
  }
  return true;
}

/// To the moment `ahead` of `end`, or to the checkpoint before `end` if that is later.
Moment History::go_to_before(const Moment& end, Time ahead) {
  const Time time = end.time - std::min(ahead, end.time);
  explore(end.time);
  const CheckpointPtr checkpoint = branch_->checkpoints[part_before(end)];
  restore(*checkpoint);
  if (checkpoint->moment.time >= time) return now();
  play_to(time);
  return now();
}

History::Search History::search_back(Observer& observer, Moment end, const std::function<void()>& begin,
                                     const std::function<bool()>& found, const MayHold& may_hold) {
  constexpr Time kFirstPart = 5 * kMillisecond;
  for (Time ahead = kFirstPart;; ahead = std::min(ahead, kNever / 8) * 4) {
    end = passed_over(end, may_hold);
    const Moment from = go_to_before(end, ahead);
    begin();
    if (!play(observer, end)) return Search::Interrupted;
    if (found()) return Search::Found;
    if (from == branch_->checkpoints.front()->moment) {
      go_to(from);
      return Search::Oldest;
    }
    end = from;
  }
}

/// The end of the last part that may hold it, or of the first.
Moment History::passed_over(Moment end, const MayHold& may_hold) const {
  for (std::size_t part = part_before(end); part > 0 && !may_hold(part); --part) end = branch_->checkpoints[part]->moment;
  return end;
}

/// Scans that were passed over at the beginning of a part were executed in the one before, and a subroutine gives back what
/// it was called for in the one before.
History::MayHold History::may_have_written(std::size_t station, const MemoryRange& range) const {
  const WriteMarker& marker = markers_[station];
  if (!marker.knows(range)) return [](std::size_t) { return true; };
  const Bits bits = bits_of(range);
  const auto may_hold = [this, station, bits, writers = marker.writers_of(bits)](std::size_t part) {
    return WriteMarker::may_hold(branch_->written[part][station], bits, writers);
  };
  return [may_hold](std::size_t part) { return may_hold(part) || (part > 0 && may_hold(part - 1)); };
}

void History::return_to(const Place& place) {
  if (branch_ != place.branch) {
    branch_ = place.branch;
    restore(*branch_->checkpoints.front());
  }
  go_to(place.moment);
}

// --- doing something ---

void History::act(Action action, std::size_t station, Observer* told) {
  if (in_the_past()) fork();
  branch_->actions.push_back(std::move(action));
  branch_->stations.push_back(station);
  branch_->moments.push_back(now());
  live_ = true;
  observer_ = told;
  do_next_action();
  observer_ = nullptr;
  live_ = false;
  branch_->end = now();
}

void History::host_called(std::size_t host, const serial::HostCall& call) {
  if (!live_) return;
  Moment moment = now();
  const Moment* const last = branch_->moments.empty() ? nullptr : &branch_->moments.back();
  const bool just_acted = last && last->instructions == moment.instructions && last->time == moment.time;
  moment.settled = system().paused() && !just_acted;
  branch_->log_bytes += bytes_of(call);
  branch_->actions.emplace_back(call);
  branch_->stations.push_back(host);
  branch_->moments.push_back(moment);
  ++actions_;
}

bool History::has_sent(std::size_t host, const std::function<bool(std::span<const std::uint8_t>)>& are) const {
  std::vector<std::uint8_t> sent;
  for (std::size_t number = actions_; number > 0 && sent.size() < modbus::kLongestRtuFrame;) {
    const Action* const action = this->action(--number);
    if (!action) return false;
    const auto* const call = std::get_if<serial::HostCall>(action);
    if (!call || call->what != serial::HostCall::What::Send || station_of_action(number) != host) continue;
    std::vector<std::uint8_t> bytes;
    for (const serial::HostCharacter& character : call->characters) bytes.push_back(character.byte);
    sent.insert(sent.begin(), bytes.begin(), bytes.end());
    if (are(sent)) return true;
  }
  return false;
}

std::vector<SentByHost> History::sent_by_host(std::size_t host, Time since) const {
  std::size_t first = actions_;
  while (first > branch_->forgotten && moment_of_action(first - 1).time + kLongestFrame >= since) --first;
  HostFrames sent;
  for (std::size_t number = first; number < actions_; ++number)
    if (const auto* const call = std::get_if<serial::HostCall>(action(number)); call && station_of_action(number) == host)
      sent.note(*call, moment_of_action(number).time);
  return sent.frames();
}

void History::fork() {
  auto branch = std::make_shared<Branch>(*branch_);
  const Moment here = now();
  std::erase_if(branch->checkpoints, [&](const CheckpointPtr& checkpoint) { return here < checkpoint->moment; });
  branch->written.resize(branch->checkpoints.size());
  branch->actions.resize(actions_ - branch->forgotten);
  branch->stations.resize(actions_ - branch->forgotten);
  branch->moments.resize(actions_ - branch->forgotten);
  branch->log_bytes = bytes_of(branch->actions);
  branch->end = here;
  branch->unexplored = false;
  branches_.push_back(branch);
  branch_ = std::move(branch);
}

void History::restart() { begin_with(origin_->state); }

void History::power_cycle(bool ram_lost, Time off) {
  std::vector<RetentiveMemory> memory;
  for (const serial::Simulation* station : stations_) {
    memory.push_back(station->cpu().retentive_memory());
    memory.back().ram_lost = ram_lost;
    memory.back().power_off = off;
  }
  auto cycle = std::make_shared<const PowerCycle>(PowerCycle{recording(), ram_lost, off});
  std::vector<State> before;
  for (const serial::Simulation* station : stations_) before.push_back(station->cpu().state());
  system().restore(origin_->state);
  power_up_stations(memory);
  begin_branch(system().snapshot());
  branch_->memory = std::move(memory);
  branch_->power = std::move(cycle);
  for (std::size_t number = 0; number < stations_.size(); ++number)
    if (auto inputs = inputs_as_before(station(number).cpu(), before[number]); !inputs.empty())
      act(SetMemory{std::move(inputs)}, number);
}

void History::power_up_stations(const std::vector<RetentiveMemory>& memory) {
  for (std::size_t number = 0; number < memory.size(); ++number) station(number).power_up(&memory[number]);
}

bool History::has_hosts_of(const Recording& recording) const {
  for (std::size_t i = 0; i < recording.actions.size(); ++i)
    if (std::holds_alternative<serial::HostCall>(recording.actions[i]) && recording.stations[i] >= settings_.hosts.size())
      return false;
  return true;
}

/// A bridge attaches its port before the past begins, which is no action then. In which format it listens changes nothing
/// for the PLCs.
void History::attach_hosts_of(const Recording& recording) {
  std::vector<bool> seen(settings_.hosts.size());
  for (std::size_t i = 0; i < recording.actions.size(); ++i) {
    const auto* const call = std::get_if<serial::HostCall>(&recording.actions[i]);
    if (!call || seen[recording.stations[i]]) continue;
    seen[recording.stations[i]] = true;
    serial::HostPort& host = *settings_.hosts[recording.stations[i]];
    if (call->what != serial::HostCall::What::Attach && !host.state().attached)
      host.attach(station(0).port_format(), time());
  }
}

Recording History::recording() const {
  return {branch_->memory, branch_->actions,        branch_->stations, branch_->moments, branch_->end,
          now(),           branch_->forgotten == 0, branch_->power};
}

bool History::replay(Recording recording) {
  const Moment end = recording.end, then = recording.now;
  adopt(std::move(recording));
  if (!explore(end.time)) return false;
  branch_->unexplored = false;
  go_to(end);
  if (!stands_at(end)) return false;
  branch_->end = now();
  branch_->log_bytes = bytes_of(branch_->actions);  // not before: where it stood must not be forgotten on the way
  go_to(then);
  return stands_at(then);
}

bool History::adopt(Recording recording) {
  system().restore(origin_->state);
  power_up_stations(recording.memory);
  attach_hosts_of(recording);
  begin_branch(system().snapshot());
  const bool taken = take_checkpoints_of(recording);
  branch_->memory = std::move(recording.memory);
  branch_->actions = std::move(recording.actions);
  branch_->stations = std::move(recording.stations);
  branch_->moments = std::move(recording.moments);
  branch_->end = recording.end;
  branch_->unexplored = true;
  for (std::vector<WrittenMemory>& written : branch_->written)
    for (WrittenMemory& of_station : written) of_station.unknown = true;
  return taken;
}

/// All of them, or none.
bool History::take_checkpoints_of(const Recording& recording) {
  std::vector<CheckpointPtr> all{branch_->checkpoints.front()};
  for (const std::string& bytes : recording.checkpoints) {
    auto checkpoint = unpacked(bytes, *all.front());
    if (!checkpoint || !comes_before(all.back()->moment, checkpoint->moment) || recording.end < checkpoint->moment)
      return false;
    checkpoint->lasts = true;
    all.push_back(counted(std::move(*checkpoint)));
  }
  const Time part = recording.end.time / static_cast<Time>(all.size());
  branch_->interval = std::max(branch_->interval, part / kCheckpointsOfAPart);
  branch_->checkpoints = std::move(all);
  branch_->written.resize(branch_->checkpoints.size(), nothing_written());
  return true;
}

std::vector<std::string> History::packed_checkpoints(std::size_t most) {
  const Place start = here();
  const Time end = newest().time, part = end / static_cast<Time>(most + 1);
  std::vector<std::string> all;
  for (std::size_t number = 0; part > 0 && number < most; ++number)
    if (const Time time = part * static_cast<Time>(number + 1); go_to(time) && come_to_quiet(time + part))
      all.push_back(packed(*checkpoint_of(system().snapshot())));
  return_to(start);
  return all;
}

/// Goes on to a moment that can be packed. False if there is none before `end`, or not so soon.
bool History::come_to_quiet(Time end) {
  constexpr Time kStep = 7 * kMillisecond;  // a master that asks in round numbers is not met in the same place each time
  for (int tries = 200; tries > 0; --tries) {
    if (can_be_packed(system().snapshot(), time())) return true;
    if (time() + kStep >= end || !go_to(time() + kStep)) return false;
  }
  return false;
}

void History::begin_with(serial::Simulation::Snapshot state) {
  system().restore(state);
  begin_branch(std::move(state));
}

void History::begin_branch(serial::Simulation::Snapshot state) {
  actions_ = 0;
  settled_ = false;
  requests_.forget();
  branch_ = std::make_shared<Branch>();
  branch_->interval = settings_.interval;
  branch_->end = now();
  branch_->checkpoints.push_back(checkpoint_of(std::move(state)));
  branch_->written.push_back(nothing_written());
  branches_.push_back(branch_);
}

const Moment& History::newest() const { return branch_->end; }
const std::vector<Action>& History::actions() const { return branch_->actions; }
const Action* History::action(std::size_t number) const {
  return number < branch_->forgotten ? nullptr : &branch_->actions.at(number - branch_->forgotten);
}
std::size_t History::station_of_action(std::size_t number) const {
  return branch_->stations.at(number - branch_->forgotten);
}
const Moment& History::moment_of_action(std::size_t number) const {
  return branch_->moments.at(number - branch_->forgotten);
}
const std::vector<Moment>& History::action_moments() const { return branch_->moments; }

// --- checkpoints ---

History::CheckpointPtr History::checkpoint_of(serial::Simulation::Snapshot state) {
  std::vector<std::uint32_t> ops;
  for (serial::Simulation* station : stations_) ops.push_back(station->cpu().core().loop.op);
  return counted({now(), std::move(state), std::move(ops), requests_.state()});
}

/// Its bytes count as long as there is anyone who has it.
History::CheckpointPtr History::counted(Checkpoint checkpoint) {
  const std::size_t size = sizeof checkpoint + bytes_of(checkpoint.state);
  *bytes_ += size;
  return {new Checkpoint(std::move(checkpoint)), [total = bytes_, size](const Checkpoint* one) {
            *total -= size;
            delete one;
          }};
}

std::vector<WrittenMemory> History::nothing_written() const {
  std::vector<WrittenMemory> written;
  for (const WriteMarker& marker : markers_) written.push_back(marker.nothing());
  return written;
}

/// As the beginning of the part with that number. What is written in a part that is computed again is unknown.
void History::keep_checkpoint(std::size_t part) {
  std::vector<WrittenMemory> written = nothing_written();
  for (WrittenMemory& of_station : written) of_station.unknown = !live_;
  const auto place = static_cast<std::ptrdiff_t>(part);
  branch_->checkpoints.insert(branch_->checkpoints.begin() + place, checkpoint_of(system().snapshot()));
  branch_->written.insert(branch_->written.begin() + place, std::move(written));
  if (*bytes_ > settings_.bound) thin();
  if (branch_->log_bytes > settings_.log_bound) forget();
}

/// The older half of what came in over a bridge, and all that was before a checkpoint that is then the oldest.
void History::forget() {
  Branch& branch = *branch_;
  std::size_t bytes = 0, actions = branch.forgotten;
  for (const Action& action : branch.actions) {
    if (bytes > branch.log_bytes / 2) break;
    bytes += bytes_of(action);
    ++actions;
  }
  const auto oldest = std::find_if(branch.checkpoints.begin(), branch.checkpoints.end() - 1,
                                   [&](const CheckpointPtr& checkpoint) { return checkpoint->moment.actions >= actions; });
  const std::size_t gone = (*oldest)->moment.actions - branch.forgotten;
  branch.written.erase(branch.written.begin(), branch.written.begin() + (oldest - branch.checkpoints.begin()));
  branch.checkpoints.erase(branch.checkpoints.begin(), oldest);
  for (std::size_t i = 0; i < gone; ++i) branch.log_bytes -= bytes_of(branch.actions[i]);
  branch.actions.erase(branch.actions.begin(), branch.actions.begin() + static_cast<std::ptrdiff_t>(gone));
  branch.stations.erase(branch.stations.begin(), branch.stations.begin() + static_cast<std::ptrdiff_t>(gone));
  branch.moments.erase(branch.moments.begin(), branch.moments.begin() + static_cast<std::ptrdiff_t>(gone));
  branch.forgotten += gone;
}

/// Every second checkpoint of every branch goes, but not its beginning, nor what was given with a recording.
void History::thin() {
  std::erase_if(branches_, [](const auto& branch) { return branch.expired(); });
  for (const auto& weak : branches_) {
    const BranchPtr branch = weak.lock();
    std::vector<CheckpointPtr> kept;
    std::vector<std::vector<WrittenMemory>> written;
    for (std::size_t i = 0; i < branch->checkpoints.size(); ++i) {
      if (i % 2 == 0 || branch->checkpoints[i]->lasts) {
        kept.push_back(branch->checkpoints[i]);
        written.push_back(std::move(branch->written[i]));
      } else {
        for (std::size_t station = 0; station < stations_.size(); ++station)
          written.back()[station].add(branch->written[i][station]);
      }
    }
    branch->checkpoints = std::move(kept);
    branch->written = std::move(written);
    branch->interval = std::min(branch->interval, kNever / 4) * 2;
  }
}

History::Usage History::usage() const {
  return {.checkpoints = branch_->checkpoints.size(),
          .bytes = *bytes_,
          .interval = branch_->interval,
          .oldest = branch_->checkpoints.front()->moment,
          .forgotten = branch_->forgotten,
          .log_bound = settings_.log_bound};
}

}  // namespace s7200::tools

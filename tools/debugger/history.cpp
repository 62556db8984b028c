#include "tools/debugger/history.hpp"

#include <algorithm>
#include <utility>

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

constexpr Time kSlice = 100 * kMillisecond;    // a stop request is heard in between
constexpr std::uint32_t kTellEvery = 1 << 10;  // instructions

/// Comes to the first instruction.
struct StopAtOnce final : Observer {
  bool before(std::uint32_t) override { return false; }
  bool wants_instructions() const override { return true; }
};

}  // namespace

History::History(serial::Simulation& simulation, Settings settings)
    : simulation_(simulation), settings_(std::move(settings)), bytes_(std::make_shared<std::size_t>(0)) {
  simulation_.cpu().set_sink(this);
  simulation_.host_port().set_journal(this);
  begin_branch(simulation_.snapshot());
  origin_ = branch_->checkpoints.front();
}

History::~History() {
  simulation_.cpu().set_sink(nullptr);
  simulation_.host_port().set_journal(nullptr);
}

Moment History::now() const {
  const State& state = simulation_.cpu().state();
  return {state.instructions, actions_, settled_, state.mode == Mode::Stop, state.time};
}

Moment History::in_front() const {
  const State& state = simulation_.cpu().state();
  return {state.instructions, actions_, true, false, state.time};
}

// --- running ---

serial::Halt History::run(Observer& observer) {
  observer_ = &observer;
  serial::Halt halt = serial::Halt::Paused;
  if (!in_the_past() || advance(branch_->end)) halt = run_live();
  observer_ = nullptr;
  return halt;
}

serial::Halt History::run_live() {
  if (simulation_.cpu().state().mode == Mode::Stop) return serial::Halt::Stopped;
  live_ = true;
  serial::Halt halt = serial::Halt::Time;
  while (halt == serial::Halt::Time) {
    const Time last = branch_->checkpoints.back()->moment.time;
    halt = drive(last < kNever - branch_->interval ? last + branch_->interval : kNever);
    settled_ = halt == serial::Halt::Paused;
    branch_->end = now();
    if (halt == serial::Halt::Time) keep_checkpoint();
  }
  live_ = false;
  return halt;
}

serial::Halt History::drive(Time end) { return settings_.drive ? settings_.drive(end) : simulation_.run_until(end); }

bool History::play(Observer& observer, const Moment& end) {
  observer_ = &observer;
  const bool arrived = advance(end);
  observer_ = nullptr;
  return arrived;
}

bool History::advance(const Moment& target) {
  while (actions_ < target.actions) {
    if (!reach(next_action())) return false;
    do_next_action();
  }
  return reach(target);
}

bool History::has_next_action() const { return actions_ - branch_->forgotten < branch_->actions.size(); }

const Moment& History::next_action() const { return branch_->moments[actions_ - branch_->forgotten]; }

void History::do_next_action() {
  perform(branch_->actions[actions_++ - branch_->forgotten], simulation_);
  settled_ = false;
  if (observer_) observer_->acted();
}

/// Plays until a moment that has as many actions before it as have been done.
bool History::reach(const Moment& moment) {
  const State& state = simulation_.cpu().state();
  stopped_by_observer_ = false;
  if (now() == moment || state.mode == Mode::Stop) return true;
  settled_ = false;
  if (moment.stopped || !moment.settled) {
    simulation_.run_until(moment.time + (moment.stopped ? 1 : 0));
  } else {
    if (!observer_) simulation_.run_until(moment.time);
    goal_ = moment.instructions;
    simulation_.run_until(moment.time + 1);
    goal_.reset();
    settled_ = true;
  }
  settled_ |= stopped_by_observer_;
  return !stopped_by_observer_;
}

bool History::wants_instructions() const {
  return goal_ || observer_ || (live_ && settings_.records && settings_.records->wants_instructions());
}

bool History::wants_scans() const {
  return goal_ || (observer_ && observer_->wants_scans()) ||
         (live_ && settings_.records && settings_.records->wants_scans());
}

void History::record(const TraceRecord& record) {
  if (live_ && settings_.records) settings_.records->record(record);
  if (observer_) observer_->record(record);
}

bool History::before(std::uint32_t op) {
  if (++looked_ % kTellEvery == 0) tell_progress();
  if (goal_ && simulation_.cpu().state().instructions == *goal_) return false;
  bool goes_on = true;
  if (live_ && settings_.records && settings_.records->wants_instructions()) goes_on = settings_.records->before(op);
  if (observer_) goes_on &= observer_->before(op);
  stopped_by_observer_ = !goes_on;
  return goes_on;
}

void History::instruction(const InstructionRecord& record) {
  if (live_ && settings_.records && settings_.records->wants_instructions()) settings_.records->instruction(record);
  if (observer_) observer_->instruction(record);
}

// --- going elsewhere ---

const History::Checkpoint& History::checkpoint_before(const Moment& moment) const {
  const auto& all = branch_->checkpoints;
  const auto after = std::upper_bound(all.begin() + 1, all.end(), moment,
                                      [](const Moment& m, const CheckpointPtr& c) { return m < c->moment; });
  return **(after - 1);
}

void History::restore(const Checkpoint& checkpoint) {
  simulation_.restore(checkpoint.state);
  simulation_.cpu().core().loop.op = checkpoint.op;
  actions_ = checkpoint.moment.actions;
  settled_ = checkpoint.moment.settled;
}

void History::go_to(const Moment& moment) {
  const Checkpoint& checkpoint = checkpoint_before(moment);
  if (const Moment here = now(); moment < here || here < checkpoint.moment) restore(checkpoint);
  advance(moment);
}

bool History::go_to(Time time) {
  const Moment start = now();
  if (time >= newest().time) {
    go_to(newest());
    return true;
  }
  const auto& all = branch_->checkpoints;
  const auto after =
      std::upper_bound(all.begin() + 1, all.end(), time, [](Time t, const CheckpointPtr& c) { return t < c->moment.time; });
  restore(**(after - 1));
  if (!play_to(time)) {
    go_to(start);
    return false;
  }
  StopAtOnce here;
  play(here, newest());
  return true;
}

/// Plays all that has run before `time`, and what was done until then. False after a stop request.
bool History::play_to(Time time) {
  while (has_next_action() && next_action().time <= time) {
    if (stop_requested()) return false;
    reach(next_action());
    do_next_action();
  }
  while (simulation_.time() < time && simulation_.cpu().state().mode != Mode::Stop) {
    if (stop_requested()) return false;
    tell_progress();
    simulation_.run_until(std::min(time, simulation_.time() + kSlice));
    settled_ = false;
  }
  return true;
}

/// To the moment `ahead` of `end`, or to the checkpoint before `end` if that is later.
Moment History::go_to_before(const Moment& end, Time ahead) {
  const Time time = end.time - std::min(ahead, end.time);
  const auto& all = branch_->checkpoints;
  const auto after = std::lower_bound(all.begin() + 1, all.end(), end,
                                      [](const CheckpointPtr& c, const Moment& m) { return c->moment < m; });
  const CheckpointPtr checkpoint = *(after - 1);
  restore(*checkpoint);
  if (checkpoint->moment.time >= time) return now();
  play_to(time);
  return now();
}

History::Search History::search_back(Observer& observer, Moment end, const std::function<void()>& begin,
                                     const std::function<bool()>& found) {
  constexpr Time kFirstPart = 5 * kMillisecond;
  for (Time ahead = kFirstPart;; ahead = std::min(ahead, kNever / 8) * 4) {
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

void History::return_to(const Place& place) {
  if (branch_ != place.branch) {
    branch_ = place.branch;
    restore(*branch_->checkpoints.front());
  }
  go_to(place.moment);
}

// --- doing something ---

void History::act(Action action) {
  if (in_the_past()) fork();
  branch_->actions.push_back(std::move(action));
  branch_->moments.push_back(now());
  do_next_action();
  branch_->end = now();
}

void History::host_called(const serial::HostCall& call) {
  if (!live_) return;
  Moment moment = now();
  const Moment* const last = branch_->moments.empty() ? nullptr : &branch_->moments.back();
  const bool just_acted = last && last->instructions == moment.instructions && last->time == moment.time;
  moment.settled = simulation_.cpu().paused() && !just_acted;
  branch_->log_bytes += bytes_of(call);
  branch_->actions.emplace_back(call);
  branch_->moments.push_back(moment);
  ++actions_;
}

void History::fork() {
  auto branch = std::make_shared<Branch>(*branch_);
  const Moment here = now();
  std::erase_if(branch->checkpoints, [&](const CheckpointPtr& checkpoint) { return here < checkpoint->moment; });
  branch->actions.resize(actions_ - branch->forgotten);
  branch->moments.resize(actions_ - branch->forgotten);
  branch->end = here;
  branches_.push_back(branch);
  branch_ = std::move(branch);
}

void History::restart() { begin_with(origin_->state); }

void History::power_up(const RetentiveMemory& memory) {
  simulation_.restore(origin_->state);
  simulation_.power_up(&memory);
  begin_branch(simulation_.snapshot());
  branch_->memory = memory;
}

Recording History::recording() const {
  return {branch_->memory, branch_->actions, branch_->moments, branch_->end, now(), branch_->forgotten == 0};
}

bool History::replay(Recording recording) {
  if (recording.memory)
    power_up(*recording.memory);
  else
    restart();
  branch_->actions = std::move(recording.actions);
  branch_->moments = std::move(recording.moments);
  branch_->end = recording.end;
  for (Time time = branch_->interval; time < recording.end.time; time += branch_->interval) {
    if (!play_to(time)) return false;
    if (simulation_.cpu().state().mode == Mode::Run) keep_checkpoint();
  }
  go_to(recording.end);
  if (now() != recording.end) return false;
  go_to(recording.now);
  return now() == recording.now;
}

void History::begin_with(serial::Simulation::Snapshot state) {
  simulation_.restore(state);
  begin_branch(std::move(state));
}

void History::begin_branch(serial::Simulation::Snapshot state) {
  actions_ = 0;
  settled_ = false;
  branch_ = std::make_shared<Branch>();
  branch_->interval = settings_.interval;
  branch_->end = now();
  branch_->checkpoints.push_back(checkpoint_of(std::move(state)));
  branches_.push_back(branch_);
}

const Moment& History::newest() const { return branch_->end; }
Time History::interval() const { return branch_->interval; }
const std::vector<Action>& History::actions() const { return branch_->actions; }
const Action* History::action(std::size_t number) const {
  return number < branch_->forgotten ? nullptr : &branch_->actions.at(number - branch_->forgotten);
}
const std::vector<Moment>& History::action_moments() const { return branch_->moments; }

// --- checkpoints ---

History::CheckpointPtr History::checkpoint_of(serial::Simulation::Snapshot state) {
  const std::size_t size = sizeof(Checkpoint) + bytes_of(state);
  *bytes_ += size;
  return {new Checkpoint{now(), std::move(state), simulation_.cpu().core().loop.op},
          [total = bytes_, size](const Checkpoint* checkpoint) {
            *total -= size;
            delete checkpoint;
          }};
}

void History::keep_checkpoint() {
  branch_->checkpoints.push_back(checkpoint_of(simulation_.snapshot()));
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
  branch.checkpoints.erase(branch.checkpoints.begin(), oldest);
  for (std::size_t i = 0; i < gone; ++i) branch.log_bytes -= bytes_of(branch.actions[i]);
  branch.actions.erase(branch.actions.begin(), branch.actions.begin() + static_cast<std::ptrdiff_t>(gone));
  branch.moments.erase(branch.moments.begin(), branch.moments.begin() + static_cast<std::ptrdiff_t>(gone));
  branch.forgotten += gone;
}

/// Every second checkpoint of every branch goes, but not its beginning.
void History::thin() {
  std::erase_if(branches_, [](const auto& branch) { return branch.expired(); });
  for (const auto& weak : branches_) {
    const BranchPtr branch = weak.lock();
    std::vector<CheckpointPtr> kept;
    for (std::size_t i = 0; i < branch->checkpoints.size(); i += 2) kept.push_back(branch->checkpoints[i]);
    branch->checkpoints = std::move(kept);
    branch->interval = std::min(branch->interval, kNever / 4) * 2;
  }
}

History::Usage History::usage() const {
  return {branch_->checkpoints.size(), *bytes_, branch_->interval, branch_->checkpoints.front()->moment, branch_->forgotten};
}

}  // namespace s7200::tools

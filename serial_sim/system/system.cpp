#include "serial_sim/system/system.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace s7200::serial {
namespace {

/// The simulated time that a CPU runs between two looks at the stop request: a moment of the host, even when every
/// instruction is traced. The results do not depend on it.
constexpr Time kLookEvery = 100 * kMillisecond;

/// The furthest that scans are passed over between two looks at the stop request; passing over takes a moment, however many
/// scans there are.
constexpr Time kFurthestAtOnce = 3600 * kSecond;

/// The earlier of `end` and `now` + `most`.
Time at_most(Time now, Time most, Time end) { return now + std::min(most, end - now); }

template <class Part, class... Arguments>
Part& add(std::vector<std::unique_ptr<Part>>& to, Arguments&&... arguments) {
  return *to.emplace_back(std::make_unique<Part>(std::forward<Arguments>(arguments)...));
}

template <class Part>
std::vector<typename Part::State> states_of(const std::vector<std::unique_ptr<Part>>& parts) {
  std::vector<typename Part::State> states;
  states.reserve(parts.size());
  for (const auto& part : parts) states.push_back(part->state());
  return states;
}

template <class Part, class... Arguments>
void restore_all(const std::vector<std::unique_ptr<Part>>& parts, const std::vector<typename Part::State>& states,
                 Arguments... arguments) {
  assert(parts.size() == states.size());
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i]->restore(states[i], arguments...);
}

}  // namespace

SharedLine& System::add_line() { return add(lines_, events_); }

Plc& System::add_plc(std::span<SharedLine* const> lines, std::shared_ptr<const Program> program, FieldScript field) {
  assert(plcs_.empty() || time() == 0);
  return add(plcs_, events_, lines, std::move(program), std::move(field));
}

Plc& System::add_plc(SharedLine& line, std::shared_ptr<const Program> program, FieldScript field) {
  std::vector<SharedLine*> lines{&line};
  while (lines.size() < program->model->ports) lines.push_back(&add_line());
  return add_plc(lines, std::move(program), std::move(field));
}

RequesterStation& System::add_requester(SharedLine& line) { return add(requesters_, events_, line); }

HostStation& System::add_host_port(SharedLine& line) { return add(host_ports_, events_, line); }

PollerStation& System::add_poller(SharedLine& line, PollPlan plan, Poller::Wiring wiring) {
  return add(pollers_, events_, line, std::move(plan), std::move(wiring));
}

ResponderStation& System::add_responder(SharedLine& line, std::unique_ptr<Automaton> automaton) {
  return add(responders_, events_, line, std::move(automaton));
}

void System::wire_sync(Plc& from, const OutputPoint& output, ResponderStation& to) {
  from.wire_output(events_, output, [&to](bool on, Time at) { to.responder().sync(on, at); });
}

void System::power_up() {
  for (const auto& plc : plcs_) plc->power_up();
}

void System::power_off(Plc& plc) {
  clock_ = now();
  plc.power_off(clock_);
}

void System::power_on(Plc& plc) { plc.power_on(std::max(now(), plc.cpu().time())); }

void System::schedule(Time at, std::function<void()> deed) {
  assert(schedule_.empty() || schedule_.back().at <= at);
  schedule_.push_back({at, std::move(deed)});
  look_at_next_scheduled();
}

void System::do_scheduled() {
  const std::size_t number = done_++;
  look_at_next_scheduled();
  doing_at_ = schedule_[number].at;
  if (watcher_) watcher_(number, false);
  schedule_[number].deed();
  if (watcher_) watcher_(number, true);
  doing_at_ = kNever;
}

bool System::any_powered() const {
  return std::any_of(plcs_.begin(), plcs_.end(), [](const auto& plc) { return plc->powered(); });
}

bool System::paused() const {
  return std::any_of(plcs_.begin(), plcs_.end(), [](const auto& plc) { return plc->powered() && plc->cpu().paused(); });
}

/// The next event, or the next thing that a CPU can do to the system.
Time System::horizon() const {
  Time earliest = events_.next();
  for (const auto& plc : plcs_)
    if (plc->powered()) earliest = std::min(earliest, plc->cpu().next_action());
  return earliest;
}

Halt System::step(Time end) {
  Time next = events_.next();
  return step(end, next);
}

Halt System::step(Time end, Time& next_event) {
  if (stop_requested()) return Halt::Request;
  const Time until = std::min(end, next_scheduled_);
  const bool alone = plcs_.size() == 1 && plcs_.front()->powered();
  const Cpu* const stopped = alone ? run_one(std::min(until, next_event)) : run_cpus(until);
  next_event = handle_due_events(alone ? plcs_.front()->cpu().time() : time());
  return stopped && stopped->paused() ? Halt::Paused : Halt::Time;
}

/// Back with the one that may have been paused, or null.
const Cpu* System::run_cpus(Time end) {
  if (any_powered()) return in_step_ ? run_next(end) : run_each(end);
  clock_ = at_most(clock_, kLookEvery, std::min(end, std::max(clock_, events_.next())));
  return nullptr;
}

/// Runs the only CPU to the next event at most; `end` is not after that event.
const Cpu* System::run_one(Time end) {
  Cpu& cpu = plcs_.front()->cpu();
  const Time until = at_most(cpu.time(), kFurthestAtOnce, end);
  if (cpu.time() >= until) return nullptr;
  cpu.run(until, kLookEvery);
  return &cpu;
}

const Cpu* System::run_each(Time end) {
  const Time horizon = this->horizon();
  for (const auto& plc : plcs_) {
    Cpu& cpu = plc->cpu();
    const Time until = at_most(cpu.time(), kFurthestAtOnce, std::min(end, plc->may_run_until(horizon)));
    if (!plc->powered() || cpu.time() >= until) continue;
    cpu.run(until, kLookEvery);
    if (cpu.paused()) return &cpu;
  }
  return nullptr;
}

/// Runs all CPUs to the instant when one of them may act next, or lets that CPU act until another may act, or until the next
/// event. At the same instant the CPU with the lower number is first.
const Cpu* System::run_next(Time end) {
  Plc* first = nullptr;
  for (const auto& plc : plcs_)
    if (plc->powered() && (!first || plc->cpu().next_action() < first->cpu().next_action())) first = plc.get();
  Cpu& cpu = first->cpu();
  const Time most = at_most(time(), kFurthestAtOnce, std::min(end, events_.next()));
  const Time acts = std::min(most, cpu.next_action());
  if (time() < acts) return come_to(acts);
  if (cpu.time() >= most) return nullptr;
  cpu.run(std::min(most, std::max(next_action_besides(*first), cpu.time() + 1)), kLookEvery);
  if (cpu.paused()) come_to(cpu.time());
  return &cpu;
}

/// Runs the CPUs that are behind `now`; they do not act before it, but a scan may end. Returns a CPU that was paused, or
/// null.
const Cpu* System::come_to(Time now) {
  const Cpu* paused = nullptr;
  for (const auto& plc : plcs_) {
    Cpu& cpu = plc->cpu();
    if (!plc->powered() || cpu.time() >= now) continue;
    cpu.run(now, kLookEvery);
    if (!paused && cpu.paused()) paused = &cpu;
  }
  return paused;
}

/// The instant when one of the other PLCs may act next.
Time System::next_action_besides(const Plc& plc) const {
  Time next = kNever;
  for (const auto& other : plcs_)
    if (other.get() != &plc && other->powered()) next = std::min(next, other->cpu().next_action());
  return next;
}

Halt System::run_until(Time end) {
  Halt halt = Halt::Time;
  Time next_event = events_.next();
  while (halt == Halt::Time && time() < end)
    if (!handle_ahead(end, next_event)) halt = step(end, next_event);
  return halt;
}

/// Handles the next event if the only CPU is known to do nothing before it, or at it, that anyone could notice: it stays
/// behind. Whether it was so.
bool System::handle_ahead(Time end, Time& next_event) {
  const bool alone = plcs_.size() == 1 && plcs_.front()->powered();
  if (!alone || next_event >= std::min(end, next_scheduled_) || watched()) return false;
  const Dispatcher::Due next = events_.due();
  if (!events_.is_for_another(next, plcs_.front()->handler()) || next_event >= plcs_.front()->cpu().look_ahead())
    return false;
  events_.handle_first(next);
  next_event = events_.next();
  return true;
}

/// Completes the exchange. No CPU has run ahead of an event, so that the caller can act exactly at the exchange's end.
const Exchange& System::finish_exchange(const RequesterStation& station) {
  const Requester& requester = station.requester();
  Halt halt = paused() ? Halt::Paused : Halt::Time;
  Time next_event = events_.next();
  Time ahead = 0;  // the instant of an event that the CPU has still to come to
  while (requester.busy() && halt == Halt::Time) {
    const Time next = next_event;
    ahead = handle_ahead(kNever, next_event) ? next : 0;
    if (ahead == 0) halt = step(plcs_.size() == 1 ? kNever : next, next_event);
  }
  for (bool behind = ahead != 0; behind && halt == Halt::Time; behind = time() < ahead) halt = step(ahead, next_event);
  return requester.exchange();
}

/// Handles events and does what is scheduled in the order of time, the events of an instant first. Returns the instant of
/// the next events.
Time System::handle_due_events(Time now) {
  bool watched = this->watched();
  Dispatcher::Due next = events_.due();
  for (; std::min(next.at, next_scheduled_) <= now; next = events_.due()) {
    if (watched) settle(std::min(next.at, next_scheduled_));  // whatever is sent from now on begins no earlier
    if (next.at <= next_scheduled_) {
      events_.handle(next);
    } else {
      do_scheduled();
      now = time();
      watched = this->watched();
    }
  }
  if (!watched) return next.at;
  settle(now);
  return events_.next();
}

/// Whether a listener of any line waits for settled levels.
bool System::watched() const {
  for (const auto& line : lines_)
    if (line->line().watched()) return true;
  return false;
}

void System::settle(Time until) {
  for (const auto& plc : plcs_) plc->settle(until);
  for (const auto& responder : responders_) responder->settle(until);
}

System::Snapshot System::snapshot() const {
  return {events_.state(),
          states_of(lines_),
          states_of(plcs_),
          states_of(requesters_),
          states_of(host_ports_),
          states_of(responders_),
          states_of(pollers_),
          clock_,
          done_};
}

void System::restore(const Snapshot& snapshot) {
  Time now = kNever;
  for (const Plc::State& plc : snapshot.plcs)
    if (plc.powered) now = std::min(now, plc.cpu.time);
  if (now == kNever) now = snapshot.clock;
  events_.restore(snapshot.queues);
  restore_all(lines_, snapshot.lines);
  restore_all(plcs_, snapshot.plcs, now);
  restore_all(requesters_, snapshot.requesters);
  restore_all(host_ports_, snapshot.host_ports);
  restore_all(responders_, snapshot.responders, now);
  restore_all(pollers_, snapshot.pollers);
  clock_ = snapshot.clock;
  done_ = snapshot.done;
  look_at_next_scheduled();
}

}  // namespace s7200::serial

#include "serial_sim/system/system.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace s7200::serial {
namespace {

/// So far a CPU runs without a look at a stop request: a moment of the host, even when every instruction is traced. What is
/// computed does not depend on it.
constexpr Time kLookEvery = 100 * kMillisecond;

/// The same while scans are passed over, which takes a moment however many they are.
constexpr Time kFurthestAtOnce = 3600 * kSecond;

Time after(Time now, Time time) { return now < kNever - time ? now + time : kNever; }

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
  clock_ = time();
  plc.power_off(std::max(clock_, plc.cpu().time()));
}

void System::power_on(Plc& plc) { plc.power_on(std::max(time(), plc.cpu().time())); }

void System::schedule(Time at, std::function<void()> act) {
  assert(acts_.empty() || acts_.back().at <= at);
  acts_.push_back({at, std::move(act)});
  look_at_next_act();
}

void System::act(Time now) {
  for (; next_act_ <= now; now = time()) {
    const Act& next = acts_[acted_++];
    look_at_next_act();
    next.act();
  }
}

bool System::any_powered() const {
  return std::any_of(plcs_.begin(), plcs_.end(), [](const auto& plc) { return plc->powered(); });
}

Time System::time() const {
  Time earliest = kNever;
  for (const auto& plc : plcs_)
    if (plc->powered()) earliest = std::min(earliest, plc->cpu().time());
  return earliest == kNever ? clock_ : earliest;
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
  if (stop_requested()) return Halt::Request;
  end = std::min(end, next_act_);
  if (plcs_.size() == 1 && plcs_.front()->powered()) return step_one_plc(plcs_.front()->cpu(), end);
  if (!any_powered()) return step_without_plc(end);
  if (in_step_) return step_in_step(end);
  const Time horizon = this->horizon();
  Halt halt = Halt::Time;
  for (const auto& plc : plcs_) {
    Cpu& cpu = plc->cpu();
    const Time until = std::min({end, plc->may_run_until(horizon), after(cpu.time(), kFurthestAtOnce)});
    if (!plc->powered() || cpu.time() >= until) continue;
    cpu.run(until, kLookEvery);
    if (cpu.paused()) halt = Halt::Paused;
    if (cpu.paused()) break;
  }
  handle_due_events(time());
  act(time());
  return halt;
}

/// One runs from event to event.
Halt System::step_one_plc(Cpu& cpu, Time end) {
  const Time until = std::min({end, events_.next(), after(cpu.time(), kFurthestAtOnce)});
  const bool runs = cpu.time() < until;
  if (runs) cpu.run(until, kLookEvery);
  handle_due_events(cpu.time());
  act(cpu.time());
  return runs && cpu.paused() ? Halt::Paused : Halt::Time;
}

/// Either all come to the instant when one of them may act next, or that one acts: until another one may, or to the next
/// event. At the same instant the one with the lower number is first.
Halt System::step_in_step(Time end) {
  Plc* first = nullptr;
  for (const auto& plc : plcs_)
    if (plc->powered() && (!first || plc->cpu().next_action() < first->cpu().next_action())) first = plc.get();
  Cpu& cpu = first->cpu();
  const Time most = std::min({end, events_.next(), after(time(), kFurthestAtOnce)});
  const Time acts = std::min(most, cpu.next_action());
  Halt halt = Halt::Time;
  if (time() < acts) {
    come_to(acts);
  } else if (cpu.time() < most) {
    cpu.run(std::min(most, std::max(next_action_besides(*first), cpu.time() + 1)), kLookEvery);
    if (cpu.paused()) come_to(cpu.time());
    if (cpu.paused()) halt = Halt::Paused;
  }
  handle_due_events(time());
  act(time());
  return halt;
}

/// Those that are behind, which do not act until then.
void System::come_to(Time now) {
  for (const auto& plc : plcs_)
    if (plc->powered() && plc->cpu().time() < now) plc->cpu().run(now, kLookEvery);
}

/// When one of the others may act next.
Time System::next_action_besides(const Plc& plc) const {
  Time next = kNever;
  for (const auto& other : plcs_)
    if (other.get() != &plc && other->powered()) next = std::min(next, other->cpu().next_action());
  return next;
}

Halt System::step_without_plc(Time end) {
  clock_ = std::min({end, std::max(clock_, events_.next()), after(clock_, kLookEvery)});
  handle_due_events(time());
  act(time());
  return Halt::Time;
}

Halt System::run_until(Time end) {
  Halt halt = Halt::Time;
  while (halt == Halt::Time && time() < end) halt = step(end);
  return halt;
}

const Exchange& System::finish_exchange(const RequesterStation& station) {
  const Requester& requester = station.requester();
  Halt halt = paused() ? Halt::Paused : Halt::Time;
  while (requester.busy() && halt == Halt::Time) halt = step(kNever);
  return requester.exchange();
}

void System::handle_due_events(Time now) {
  for (Dispatcher::Due next = events_.due(); next.at <= now; next = events_.due()) {
    settle(next.at);  // whatever is sent from now on begins no earlier
    events_.handle(next);
  }
  settle(now);
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
          acted_};
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
  acted_ = snapshot.acted;
  look_at_next_act();
}

}  // namespace s7200::serial

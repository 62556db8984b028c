#include "tools/session/stops/stepper.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

#include "interpreter/program/ladder/networks.hpp"
#include "tools/session/past/actions/access.hpp"

namespace s7200::tools {
namespace {

using On = StopPoint::On;

/// Not a character that a fault has made of what the port sends itself.
bool is_of_others(const serial::Plc& plc, const TraceRecord& record) {
  if (record.kind != TraceKind::CharacterIgnored || Ignored{record.code} != Ignored::WhileSending) return true;
  const serial::Line& line = plc.line(record.port).line();
  return line.space_holder_besides(plc.driver(record.port), record.since) != serial::Line::kNobody;
}

}  // namespace

Stepper::Stepper(History& history, StopToken stop_request)
    : on_record([](std::size_t, const TraceRecord&) {}),
      on_instruction([](std::size_t, const InstructionRecord&, bool) {}),
      on_answer([](std::size_t, const serial::Exchange&) {}),
      on_message([](const StopPoint&, const Hit&) {}),
      on_unasked([](const SentByPlc&) {}),
      on_search([](Time) {}),
      history_(history),
      stop_request_(stop_request),
      frames_(history),
      requests_(history) {
  frames_.on_frame = [this](const HeardFrames::Frame& frame) { note_frame(frame); };
  requests_.when_ended([this](const EndedRequest& request) { note_ended(request); });
}

Stop Stepper::run(const Goal& goal, Time limit, bool stop_at_answer) {
  count_hits();
  goal_ = goal;
  limit_ = limit;
  stop_at_answer_ = stop_at_answer;
  const State& state = station(focus_).cpu().state();
  start_ = instruction_of(focus_, standing_at(state).value_or(0));
  progress_ = {.executed = 0, .left = !standing_at(state)};
  next_.reset();
  if (const auto at = history_.next_station())
    if (const auto op = standing_at(station(*at).cpu().state())) next_ = instruction_of(*at, *op);
  executing_start_ = false;
  cpu_stopped_.reset();
  begin_watching();
  const serial::Halt halt = history_.run(*this);
  listened_to_ = history_.now();
  look_at_conditions();
  if (halt == serial::Halt::Stopped) stop_.reason = StopReason::CpuStopped;
  if (halt == serial::Halt::Request) stop_.reason = StopReason::Request;
  if (halt == serial::Halt::Time) end_idle();
  return stop_;
}

Time Stepper::idles_until(Time now) {
  if (asked_to_stop()) return now;
  look_at_lines(0, now);
  const Time timeout = std::min(frames_.next_end(), requests_.next_timeout());
  if (backwards_) {
    note_found_here();
    return timeout > now ? timeout : kNever;
  }
  const bool ends = answer_complete() || !stop_.hits.empty() || cpu_stopped_;
  return ends ? now : std::max(now, timeout > now ? std::min(limit_, timeout) : limit_);
}

void Stepper::end_idle() {
  stop_.reason = asked_to_stop() ? StopReason::Request : StopReason::Limit;
  if (const auto reason = reason_to_stop_here()) stop_.reason = *reason;
  if (!stop_.answered.empty() && !cpu_stopped_) stop_.reason = StopReason::Answer;
}

Stop Stepper::run_back(const Goal& goal, std::uint64_t count, bool stop_at_answer) {
  const Moment start = history_.now();
  begin_search(goal, count, stop_at_answer);
  backwards_ = true;
  const History::Search result = history_.search_back(
      *this, start, [this] { begin_part(); }, [this] { return end_part(); });
  backwards_ = false;
  return arrive(result, start);
}

Stop Stepper::run_back_past_stops(const Goal& goal) {
  std::vector<SetStop> stops = std::exchange(stops_, {});
  const Stop stop = run_back(goal, 1, false);
  stops_ = std::move(stops);
  return stop;
}

void Stepper::begin_search(const Goal& goal, std::uint64_t count, bool stop_at_answer) {
  count_hits();
  held_at_.reset();
  for (StopPoint& stop : stops_) stop.skipped = stop.unknown = 0;
  goal_ = goal;
  limit_ = kNever;
  stop_at_answer_ = stop_at_answer;
  cpu_stopped_.reset();
  progress_ = {.executed = 1, .left = true};
  const Places nowhere(history_.stations());
  search_ = {.start = history_.now(), .count = count, .first = nowhere, .after = nowhere};
}

/// An earlier part of the past is going to be played: what it begins with is what comes after the next one.
void Stepper::begin_part() {
  for (std::size_t number = 0; number < search_.first.size(); ++number)
    if (const auto first = std::exchange(search_.first[number], {})) search_.after[number] = first;
  search_.found.clear();
  search_.skipped.clear();
  on_search(history_.now().time);
  begin_watching();
  looked_ = looked_before();
}

/// Takes the last place of the part; the goal only if it is met for the last time to be counted. It stands at the place in
/// front of which something was done last.
bool Stepper::end_part() {
  std::erase_if(search_.found, [this](const Found& found) {
    return found.before_action && found.moment.instructions == search_.start.instructions;
  });
  search_.there = found_after_part();
  for (auto last = search_.found.rbegin(); last != search_.found.rend() && !search_.there; ++last)
    if (last->stop || --search_.count == 0) search_.there = std::move(*last);
  const std::size_t before = search_.there ? search_.there->skipped : 0;
  for (std::size_t i = before; i < search_.skipped.size(); ++i) ++stops_[search_.skipped[i]].skipped;
  return search_.there.has_value();
}

/// To the place that was found.
Stop Stepper::arrive(History::Search result, const Moment& start) {
  const std::optional<Found> there = std::exchange(search_, {}).there;
  if (result == History::Search::Interrupted) {
    history_.go_to(start);
    return {.reason = StopReason::Request, .station = focus_};
  }
  if (!there) return {.reason = StopReason::Oldest, .station = focus_};
  history_.go_to(there->moment);
  return there->stop.value_or(Stop{.reason = StopReason::Goal, .station = focus_});
}

/// What has come up between the last instructions of the part that was played and the first ones after it.
std::optional<Stepper::Found> Stepper::found_after_part() {
  std::optional<Moment> earliest;
  for (const auto& after : search_.after) {
    if (!after) continue;
    earliest = earliest ? std::min(*earliest, *after) : after;
    search_.until = std::max(search_.until, after->time);
  }
  for (std::size_t number = 0; number < search_.after.size(); ++number) {
    const auto& after = search_.after[number];
    if (!after) continue;
    note_changes(number, nullptr);
    look_at_lines(number, after->time);
  }
  if (!earliest) return {};
  const bool answer = answer_complete() && stop_at_answer_;
  if (!answer && stop_.hits.empty()) return {};
  stop_.reason = answer ? StopReason::Answer : StopReason::StopPoint;
  const Moment place = place_of_first_hit(*earliest);
  return Found{.moment = answer ? *earliest : place, .stop = stop_, .skipped = search_.skipped.size()};
}

/// In front of the next instruction of the station that it is about; of one that executes none any more, and without a hit,
/// `earliest`.
Moment Stepper::place_of_first_hit(const Moment& earliest) {
  std::optional<Moment> first;
  for (const Hit& hit : stop_.hits) {
    const std::size_t of = hit.stop.station;
    const Moment place = station(of).plc().executes() && search_.after[of] ? *search_.after[of] : earliest;
    if (first && *first <= place) continue;
    first = place;
    stop_.station = of;
  }
  return first.value_or(earliest);
}

void Stepper::begin_watching() {
  search_.until = 0;
  stop_ = {.station = focus_};
  looked_.reset();
  accessed_.clear();
  executing_since_ = kNever;
  const Moment now = history_.now();
  const bool goes_on =
      !backwards_ && listened_to_ && listened_to_->instructions == now.instructions && listened_to_->time == now.time;
  if (!goes_on) {
    frames_.begin();
    requests_.begin(now.time, frames_.frames_before());
  }
  requests_.await_no_masters();
  requests_.await_masters();
  if (!backwards_)
    for (StopPoint& stop : stops_) stop.skipped = stop.unknown = 0;
  note_set_since();
  read_values();
}

/// Conditions that hold because somebody has set memory since the last run, which ended at this moment.
void Stepper::note_set_since() {
  const Moment now = history_.now();
  const bool stands = held_at_ && held_at_->instructions == now.instructions && held_at_->time == now.time;
  if (backwards_ || !stands || now.actions <= held_at_->actions) return;
  for (SetStop& stop : stops_)
    if (stop.on == On::Becomes && stop.from_hit == 1 && stop.log.empty() && has_come_to_hold(stop))
      stop_.hits.push_back({.stop = stop, .action = now.actions - 1});
}

/// Looks at the conditions of stops, for note_set_since().
void Stepper::look_at_conditions() {
  held_at_ = history_.now();
  for (StopPoint& stop : stops_)
    if (stop.on == On::Becomes) stop.held = holds(stop);
}

/// What comes from outside ends a row of such scans by itself. A time that has come is looked for here.
bool Stepper::wants_scans() const {
  if (history_.stations() > 1) return true;  // a CPU in step never runs a whole one at once
  const auto is_within_a_scan = [](const StopPoint& stop) {
    return stop.on == On::Place || stop.on == On::Becomes || stop.is_watch();
  };
  const bool waits = requests_.has_patient_one() || frames_.next_end() != kNever;
  const bool ends = station(0).time() >= limit_;
  return goal_ || backwards_ || waits || ends || std::ranges::any_of(stops_, is_within_a_scan);
}

void Stepper::read_values() {
  for (StopPoint& stop : stops_) {
    if (stop.range) stop.value = stop.range->bytes_in(station(stop.station).cpu().state().image);
    if (stop.on == On::Becomes) stop.held = holds(stop);
  }
}

/// What has come up until now is not what the action does. A bridge acts between any two events, where no run stops.
bool Stepper::before_action() {
  if (std::holds_alternative<serial::HostCall>(*history_.action(history_.now().actions))) return true;
  if (const auto next = history_.next_station()) {
    note_changes(*next, nullptr);
    look_at_lines(*next, station(*next).cpu().time());
  } else {
    look_at_lines(0, history_.now().time);
  }
  if (backwards_) {
    note_found_here();
  } else if (const auto reason = reason_to_stop_here()) {
    stop_.reason = *reason;
    return false;
  }
  return !stops_before_action();
}

Stepper::Instruction Stepper::instruction_of(std::size_t number, std::uint32_t op) const {
  return {number, op, station(number).cpu().state().in_interrupt};
}

/// What is done in front of an instruction was done while the run stood there: stops at that place come before it.
bool Stepper::stops_before_action() {
  const auto number = history_.next_station();
  const auto op = number ? standing_at(station(*number).cpu().state()) : std::nullopt;
  if (!history_.now().settled || !op) return false;
  const Instruction here = instruction_of(*number, *op);
  looked_ = {history_.in_front().instructions, here};
  if (!backwards_ && next_ == here) return false;
  hit_places(*op);
  if (!has_due_hit()) return false;
  stop_.reason = StopReason::StopPoint;
  if (!backwards_) return true;
  search_.found.push_back(take_found(StopReason::StopPoint));
  search_.found.back().before_action = true;
  return false;
}

/// A part of the past may begin between what was done in front of an instruction and that instruction.
std::optional<Stepper::Looked> Stepper::looked_before() const {
  const Moment now = history_.now();
  const auto station = history_.next_station();
  const auto op = station ? standing_at(this->station(*station).cpu().state()) : std::nullopt;
  for (std::size_t number = now.actions; op && number > 0;) {
    const Action* const action = history_.action(--number);
    if (!action || history_.moment_of_action(number).instructions != now.instructions) break;
    const bool stood = history_.moment_of_action(number).settled && !std::holds_alternative<serial::HostCall>(*action);
    if (stood) return Looked{now.instructions, instruction_of(*station, *op)};
  }
  return {};
}

bool Stepper::has_looked_at(const Instruction& instruction) const {
  return looked_ && looked_->executed == history_.in_front().instructions && looked_->at == instruction;
}

/// Not in front of an instruction: it has stopped here when it ran, and nothing waits for its turn.
std::optional<StopReason> Stepper::reason_to_stop_here() {
  if (cpu_stopped_) {
    stop_.station = *cpu_stopped_;
    return StopReason::CpuStopped;
  }
  if (answer_complete()) return stop_with_answer();
  if (stop_.hits.empty()) return {};
  stop_.station = stop_.hits.front().stop.station;
  return StopReason::StopPoint;
}

/// Backwards: the same.
void Stepper::note_found_here() {
  const Moment here = history_.now();
  if (const auto next = history_.next_station()) {
    if (!search_.first[*next]) search_.first[*next] = here;
  } else {
    for (auto& first : search_.first)
      if (!first) first = here;
  }
  const auto reason = reason_to_stop_here();
  if (!reason) return;
  stop_.reason = *reason;
  search_.found.push_back({.moment = here, .stop = stop_, .skipped = search_.skipped.size()});
  stop_ = {.station = focus_};
}

void Stepper::acted() {
  requests_.await_masters();
  note_changes_from_outside();
}

/// A change is noted in front of the next instruction.
void Stepper::planned_done(std::size_t number) {
  for (StopPoint& stop : stops_)
    if (stop.range && stop.range->bytes_in(station(stop.station).cpu().state().image) != stop.value) stop.planned = number;
}

/// They are no hits that count: only what the CPU does is.
void Stepper::note_changes_from_outside() {
  for (SetStop& stop : stops_) {
    if (stop.on == On::Becomes && has_come_to_hold(stop) && stop.from_hit == 1) {
      if (!stop.log.empty() && !backwards_) on_message(stop, {});
      if (stop.log.empty()) stop_.hits.push_back({.stop = stop, .action = history_.now().actions - 1});
    }
    if (!stop.range) continue;
    std::vector<std::uint8_t> value = stop.range->bytes_in(station(stop.station).cpu().state().image);
    const bool meant = value != stop.value && stop.on != On::Read && stop.from_hit == 1 && holds(stop);
    if (meant && !stop.log.empty() && !backwards_) on_message(stop, {});
    if (meant && stop.log.empty())
      stop_.hits.push_back({.stop = stop, .value = value, .action = history_.now().actions - 1});
    stop.value = std::move(value);
  }
}

void Stepper::record(const TraceRecord& record) {
  const std::size_t station = history_.told_of();
  note_record(record);
  if (backwards_) return;
  if (record.kind == TraceKind::ModeChange && record.code == 0) cpu_stopped_ = station;
  on_record(station, record);
}

/// What a station does not execute any more cannot be waited for.
bool Stepper::is_turn_of(std::size_t number) const {
  return history_.told_of() == number || !station(number).plc().executes();
}

bool Stepper::before(std::uint32_t op) {
  const std::size_t number = history_.told_of();
  note_changes(number, nullptr);
  look_at_lines(number, station(number).cpu().time());
  if (backwards_) {
    const bool goes_on = note_place(instruction_of(number, op));
    note_accesses(op);
    executing_since_ = station(number).cpu().time();
    return goes_on;
  }
  const Instruction here = instruction_of(number, op);
  const bool stood_there = next_ == here, looked = has_looked_at(here);
  if (const auto reason = reason_to_stop(op, !stood_there && !looked)) {
    stop_.reason = *reason;
    return false;
  }
  if (stood_there) next_.reset();
  executing_start_ = start_ == here;
  if (executing_start_) {
    start_.reset();
    progress_.left = true;
  }
  note_accesses(op);
  executing_since_ = station(number).cpu().time();
  return true;
}

bool Stepper::note_place(const Instruction& instruction) {
  if (asked_to_stop()) return false;
  auto& first = search_.first[history_.told_of()];
  if (!first) first = history_.in_front();
  if (const auto reason = reason_to_stop(instruction.op, !has_looked_at(instruction)))
    search_.found.push_back(take_found(*reason));
  return true;
}

/// In front of an instruction.
Stepper::Found Stepper::take_found(StopReason reason) {
  Stop stop = std::exchange(stop_, {.station = focus_});
  stop.reason = reason;
  const bool goal = reason == StopReason::Goal && stop.hits.empty();
  return {.moment = history_.in_front(),
          .stop = goal ? std::nullopt : std::optional(std::move(stop)),
          .skipped = search_.skipped.size()};
}

std::optional<StopReason> Stepper::reason_to_stop(std::uint32_t op, bool looks_for_places) {
  const std::size_t number = history_.told_of();
  if (cpu_stopped_) {
    stop_.station = *cpu_stopped_;
    return StopReason::CpuStopped;
  }
  if (answer_complete()) return stop_with_answer();
  if (looks_for_places) hit_places(op);
  if (has_due_hit()) return StopReason::StopPoint;
  if (number == focus_ && goal_ && goal_(station(number).cpu().state(), op, progress_)) return StopReason::Goal;
  if (is_turn_of(focus_) && history_.in_front().time >= limit_) return StopReason::Limit;
  if (asked_to_stop()) return StopReason::Request;
  return {};
}

/// Something may have come up with it: if only at other stations, it goes over to one of them.
StopReason Stepper::stop_with_answer() {
  const auto is_own = [this](const Hit& hit) { return hit.stop.station == focus_; };
  if (!stop_.hits.empty() && std::ranges::none_of(stop_.hits, is_own)) stop_.station = stop_.hits.front().stop.station;
  return StopReason::Answer;
}

bool Stepper::has_due_hit() {
  const auto due = std::ranges::find_if(stop_.hits, [this](const Hit& hit) { return is_turn_of(hit.stop.station); });
  if (due != stop_.hits.end()) stop_.station = due->stop.station;
  return due != stop_.hits.end();
}

void Stepper::instruction(const InstructionRecord& record) {
  const std::size_t number = history_.told_of();
  note_changes(number, &record);
  executing_since_ = kNever;
  if (backwards_) return;
  if (number == focus_) ++progress_.executed;
  on_instruction(number, record, executing_start_);
}

void Stepper::add(StopPoint stop) {
  stops_.push_back({std::move(stop), {}});
  count_hits();
  const Moment now = history_.now();
  if (!held_at_ || held_at_->instructions != now.instructions || held_at_->time != now.time)
    look_at_conditions();
  else if (stops_.back().on == On::Becomes)
    stops_.back().held = holds(stops_.back());
}

bool Stepper::remove(int number) {
  return std::erase_if(stops_, [&](const StopPoint& stop) { return stop.number == number; }) != 0;
}

void Stepper::count_hits() {
  const History::Place here = history_.here();
  const SetStop::Instant now{here.moment.instructions, here.moment.time};
  const bool same_beginning =
      counted_on_ && counted_on_->checkpoints.front() == here.branch->checkpoints.front();  // it has forked
  for (SetStop& stop : stops_) {
    std::erase_if(stop.counted, [](const auto& entry) { return entry.first.expired(); });
    const auto before = stop.counted.find(counted_on_);
    const auto [counted, is_new] = stop.counted.try_emplace(here.branch, SetStop::Counted{.since = now});
    auto& [since, at] = counted->second;
    if (is_new && same_beginning && before != stop.counted.end()) {
      since = std::min(since, before->second.since);
      at.assign(before->second.at.begin(), std::ranges::upper_bound(before->second.at, now));
    }
    stop.hits = static_cast<std::uint64_t>(std::ranges::upper_bound(at, now) - at.begin());
  }
  counted_on_ = here.branch;
}

Time Stepper::counts_since(const SetStop& stop) const {
  const auto counted = stop.counted.find(history_.here().branch);
  return counted == stop.counted.end() ? history_.now().time : counted->second.since.second;
}

/// When a hit was, in the order of instructions: not after the next one of any station begins.
Time Stepper::time_of(const Hit& hit) const {
  if (hit.by) return hit.by->at;
  // that of a CPU without power stands still
  const Time now = std::max({history_.in_front().time, history_.now().time, search_.until});
  return hit.record ? std::min(hit.record->at, executing_since_) : now;
}

/// The number of the hit that is now; 0 of one from before the stop was set. What is played again was counted the first
/// time; backwards nothing is new.
std::uint64_t Stepper::count(SetStop& stop, Time when) {
  const std::uint64_t instructions = history_.in_front().instructions;
  const SetStop::Instant now{instructions, when};
  auto& [since, at] = stop.counted[counted_on_];
  if (backwards_) return static_cast<std::uint64_t>(std::ranges::upper_bound(at, now) - at.begin());
  if (now <= since) return 0;
  const auto next = at.begin() + static_cast<std::ptrdiff_t>(stop.hits);
  if (next == at.end() || *next != now) at.insert(next, now);
  return ++stop.hits;
}

/// A condition that cannot be computed does not hold.
bool Stepper::holds(StopPoint& stop) {
  if (!stop.condition) return true;
  const auto value = stop.condition->value(station(stop.station).cpu());
  if (!value && !backwards_ && stop.unknown++ == 0) stop.why_unknown = value.why();
  return value && value->truth();
}

/// Whether the condition holds since it was last looked at.
bool Stepper::has_come_to_hold(StopPoint& stop) {
  const bool held = std::exchange(stop.held, holds(stop));
  return stop.held && !held;
}

/// Counts, and stops unless there is a reason not to. It also stops at hits from before the stop was set, unless it waits
/// for a number.
void Stepper::hit(SetStop& stop, Hit with) {
  if (!holds(stop)) return;
  const std::uint64_t number = count(stop, time_of(with));
  if (stop.from_hit > 1 && number < stop.from_hit) return;
  if (!stop.log.empty()) {
    if (!backwards_) on_message(stop, with);
    return;
  }
  with.stop = stop;
  with.stop.hits = number;
  stop_.hits.push_back(std::move(with));
}

void Stepper::hit_places(std::uint32_t op) {
  const Cpu& cpu = station(history_.told_of()).cpu();
  for (SetStop& stop : stops_) {
    if (stop.station != history_.told_of() || stop.on != On::Place || stop.op != op) continue;
    const bool idle = stop.needs_power && depends_on_power_flow(cpu.program().ops[op]) && !cpu.state().stack.top();
    if (!idle)
      hit(stop, {});
    else if (holds(stop))
      note_skipped(stop);
  }
}

/// Backwards it counts only from where it comes to a stop.
void Stepper::note_skipped(SetStop& stop) {
  if (backwards_)
    search_.skipped.push_back(static_cast<std::size_t>(&stop - stops_.data()));
  else
    ++stop.skipped;
}

void Stepper::note_accesses(std::uint32_t op) {
  accessed_.clear();
  for (std::size_t i = 0; i < stops_.size(); ++i) {
    const auto on = stops_[i].on;
    if (stops_[i].station != history_.told_of() || !stops_[i].range) continue;
    const auto is_accessed = [&](Access access) {
      return accesses(station(stops_[i].station).cpu(), op, access, bits_of(*stops_[i].range));
    };
    const bool read = (on == On::Read || on == On::ReadWrite) && is_accessed(Access::Read);
    const bool written = (on == On::Write || on == On::ReadWrite) && is_accessed(Access::Write);
    if (read || written) accessed_.push_back(i);
  }
}

bool Stepper::is_meant(const StopPoint& stop, const TraceRecord& record) {
  const bool event = !stop.event || *stop.event == record.event;
  switch (record.kind) {
    case TraceKind::EventOccurred:
      return stop.on == On::EventOccurs && event;
    case TraceKind::ServiceBegin:
      return stop.on == On::EventServed && event;
    case TraceKind::EventLost:
      return stop.on == On::QueueOverflow || (stop.on == On::LostCharacter && is_receive_event(record.event));
    case TraceKind::EventDropped:
      return stop.on == On::LostCharacter && is_receive_event(record.event);
    case TraceKind::CharacterIgnored:
      return stop.on == On::LostCharacter && Ignored{record.code} != Ignored::NoPower;
    case TraceKind::Transmit:
      return stop.on == On::Transmit;
    case TraceKind::TransmitEnd:
      return stop.on == On::FrameSent;
    case TraceKind::ReceiveEnd:
      return stop.on == On::ReceiveEnd;
    case TraceKind::RuntimeError:
      return stop.on == On::RuntimeError && (!stop.code || *stop.code == record.code);
    case TraceKind::ModeChange:
      return stop.on == On::ModeChange;
    default:
      return false;
  }
}

void Stepper::note_record(const TraceRecord& record) {
  const std::size_t number = history_.told_of();
  requests_.note_record(number, record);
  const std::vector<std::uint8_t> frame = note_sent(number, record);
  frames_.note(number, record);
  for (SetStop& stop : stops_)
    if (stop.station == number && is_meant(stop, record) && is_of_others(station(number).plc(), record))
      hit(stop, {.record = record, .frame = frame});
}

/// All of a transmission that ends.
std::vector<std::uint8_t> Stepper::note_sent(std::size_t number, const TraceRecord& record) {
  if (record.kind != TraceKind::TransmitEnd) return {};
  const std::optional<SentByPlc>& sent = history_.requests().sending(number, record.port);
  if (!sent) return {};
  const bool unasked = record.port == station(number).port() && is_unasked(number);
  if (unasked && !backwards_) on_unasked({sent->from, record.at, sent->bytes});
  return sent->bytes;
}

bool Stepper::is_unasked(std::size_t number) const {
  const serial::Simulation& here = station(number);
  if (history_.stations() > 1 || !here.has_master() || here.master().asks()) return false;
  if (here.has_host_port() && here.host_port().state().attached) return false;
  const std::optional<Time>& heard = frames_.last_heard(number, here.port());
  const serial::Exchange& last = here.master().exchange();
  return !heard || last.given_up || (last.timed_out && *heard <= last.request_end + here.port_format().silence());
}

/// Backwards its beginning may lie in a part that was not played yet.
void Stepper::note_frame(HeardFrames::Frame frame) {
  if (backwards_) frame.bytes.clear();
  for (SetStop& stop : stops_)
    if (stop.station == frame.station && stop.on == On::FrameReceived && station(frame.station).plc().powered())
      hit(stop, {.frame = frame.bytes});
  requests_.note_frame(frame);
}

/// In front of an instruction of a station, and for those that execute none.
void Stepper::look_at_lines(std::size_t number, Time now) {
  frames_.look(number, now);
  requests_.look(now);
}

void Stepper::note_ended(const EndedRequest& request) {
  const On on = request.wrong.empty() ? On::Unanswered : On::WrongAnswer;
  for (SetStop& stop : stops_)
    if (stop.on == on && hears(stop, request.line))
      hit(stop, {.frame = request.frame, .asker = request.asker, .wrong = request.wrong, .answer = request.answer});
}

bool Stepper::hears(const StopPoint& stop, std::size_t line) const {
  if (stop.line) return *stop.line == line;
  return history_.requests().port_on(line, stop.station).has_value();
}

/// Whether that is a reason to stop.
bool Stepper::answer_complete() {
  const std::vector<std::size_t> finished = requests_.take_finished();
  for (const std::size_t number : finished)
    if (!backwards_) on_answer(number, station(number).master().exchange());
  if (stop_at_answer_) stop_.answered.insert(stop_.answered.end(), finished.begin(), finished.end());
  return !stop_.answered.empty();
}

/// By an instruction of a station; or between two, also of those that execute none.
void Stepper::note_changes(std::size_t number, const InstructionRecord* by) {
  for (std::size_t i = 0; i < stops_.size(); ++i) {
    SetStop& stop = stops_[i];
    const bool is_turn = stop.station == number || (!by && !station(stop.station).plc().executes());
    if (is_turn && stop.on == On::Becomes && has_come_to_hold(stop))
      hit(stop, {.by = by ? std::optional(*by) : std::nullopt});
    if (!stop.range || !is_turn) continue;
    std::vector<std::uint8_t> value = stop.range->bytes_in(station(stop.station).cpu().state().image);
    const bool changed = value != stop.value;
    const bool touched = by && by->powered && std::ranges::find(accessed_, i) != accessed_.end();
    const bool meant = stop.on == On::Read        ? touched
                       : stop.on == On::Write     ? touched || (by && changed)
                       : stop.on == On::ReadWrite ? touched || changed
                                                  : changed;
    const std::optional<std::size_t> planned = std::exchange(stop.planned, {});
    if (meant)
      hit(stop, {.value = value, .by = by ? std::optional(*by) : std::nullopt, .planned = by ? std::nullopt : planned});
    stop.value = std::move(value);
  }
}

}  // namespace s7200::tools

#include "tools/debugger/stepper.hpp"

#include <algorithm>
#include <utility>

#include "interpreter/program/networks.hpp"
#include "tools/debugger/access.hpp"

namespace s7200::tools {

Stepper::Stepper(serial::Simulation& simulation, History& history, const std::atomic<bool>* stop_request)
    : on_record([](const TraceRecord&) {}),
      on_instruction([](const InstructionRecord&, bool) {}),
      on_answer([](const serial::Exchange&) {}),
      on_message([](const StopPoint&) {}),
      on_search([](Time) {}),
      simulation_(simulation),
      history_(history),
      stop_request_(stop_request) {}

Stop Stepper::run(const Goal& goal, Time limit, bool stop_at_answer) {
  const State& state = simulation_.cpu().state();
  count_hits();
  goal_ = goal;
  limit_ = limit;
  stop_at_answer_ = stop_at_answer;
  standing_ = standing_at(state).has_value();
  start_op_ = standing_at(state).value_or(0);
  started_in_interrupt_ = state.in_interrupt;
  executing_start_ = reached_start_ = false;
  progress_ = {.executed = 0, .left = !standing_};
  begin_watching();
  const serial::Halt halt = history_.run(*this);
  listened_to_ = history_.now();
  if (halt == serial::Halt::Stopped) stop_.reason = StopReason::CpuStopped;
  if (halt == serial::Halt::Request) stop_.reason = StopReason::Request;
  return stop_;
}

Stop Stepper::run_back(const Goal& goal, std::uint64_t count, bool stop_at_answer) {
  const Moment start = history_.now();
  count_hits();
  goal_ = goal;
  limit_ = kNever;
  stop_at_answer_ = stop_at_answer;
  standing_ = false;
  progress_ = {.executed = 1, .left = true};
  backwards_ = true;
  first_place_.reset();
  std::optional<Found> there;
  std::optional<Moment> end;  // where the part that is played ends: the first place of the part played before it
  const auto begin = [&] {
    if (first_place_) end = first_place_;
    first_place_.reset();
    found_.clear();
    on_search(simulation_.time());
    begin_watching();
  };
  const auto found = [&] {
    if (end) {
      note_silence();
      note_host_timeout();
    }
    if (const auto reason = end ? reason_between() : std::nullopt) {
      stop_.reason = *reason;
      there = Found{*end, stop_};
    }
    for (auto last = found_.rbegin(); last != found_.rend() && !there; ++last)
      if (last->stop || --count == 0) there = std::move(*last);
    return there.has_value();
  };
  const History::Search search = history_.search_back(*this, start, begin, found);
  backwards_ = false;
  found_ = {};
  if (search == History::Search::Interrupted) {
    history_.go_to(start);
    return {.reason = StopReason::Request};
  }
  if (!there) return {.reason = StopReason::Oldest};
  history_.go_to(there->moment);
  return there->stop.value_or(Stop{.reason = StopReason::Goal});
}

void Stepper::begin_watching() {
  stop_ = {};
  accessed_.clear();
  const Moment now = history_.now();
  const bool goes_on =
      !backwards_ && listened_to_ && listened_to_->instructions == now.instructions && listened_to_->time == now.time;
  if (!goes_on) listen_from_now_on();
  awaiting_answer_ = simulation_.master().busy();
  if (!backwards_)
    for (StopPoint& stop : stops) stop.skipped = 0;
  read_values();
}

/// What came before is not known, only when the last character on the line ended, and when the last one that the PLC sent.
void Stepper::listen_from_now_on() {
  coming_in_.clear();
  const Time silence = simulation_.port_format().silence(), half_a_character = silence / 7;
  const Time last = simulation_.last_activity();
  silence_noted_ = simulation_.line_quiet_for(silence) ? last : 0;
  came_in_ = last > simulation_.plc().state().uart.at(simulation_.port()).send_end + half_a_character;
  host_waits_.reset();
  const bool waits = came_in_ && silence_noted_ != 0 && !simulation_.freeport().transmitting;
  if (waits && simulation_.time() < last + host_timeout) note_host_request({}, last);
}

/// What comes from outside ends a row of such scans by itself. A time that has come is looked for here.
bool Stepper::wants_scans() const {
  const auto is_within_a_scan = [](const StopPoint& stop) { return stop.on == StopPoint::On::Place || stop.is_watch(); };
  const bool waits = host_waits_ || simulation_.last_activity() != silence_noted_;
  const bool ends_soon = limit_ != kNever && limit_ - simulation_.time() <= history_.interval();
  return goal_ || backwards_ || waits || ends_soon || std::ranges::any_of(stops, is_within_a_scan);
}

void Stepper::read_values() {
  for (StopPoint& stop : stops)
    if (stop.range) stop.value = stop.range->bytes_in(simulation_.cpu().state().image);
}

void Stepper::acted() {
  awaiting_answer_ |= simulation_.master().busy();
  read_values();
}

void Stepper::record(const TraceRecord& record) {
  note_record(record);
  if (!backwards_) on_record(record);
}

bool Stepper::before(std::uint32_t op) {
  note_changes(nullptr);
  note_silence();
  note_host_timeout();
  if (backwards_) {
    const bool goes_on = note_place(op);
    note_accesses(op);
    return goes_on;
  }
  const bool in_interrupt = simulation_.cpu().state().in_interrupt;
  const bool at_start = !reached_start_ && op == start_op_ && in_interrupt == started_in_interrupt_;
  if (const auto reason = reason_to_stop(op, at_start)) {
    stop_.reason = *reason;
    return false;
  }
  executing_start_ = at_start;
  if (at_start) reached_start_ = progress_.left = true;
  note_accesses(op);
  return true;
}

bool Stepper::note_place(std::uint32_t op) {
  if (asked_to_stop()) return false;
  if (!first_place_) first_place_ = history_.in_front();
  if (const auto reason = reason_to_stop(op, false)) {
    stop_.reason = *reason;
    const bool goal = *reason == StopReason::Goal && stop_.hits.empty();
    found_.push_back({history_.in_front(), goal ? std::nullopt : std::optional(stop_)});
  }
  stop_ = {};
  return true;
}

std::optional<StopReason> Stepper::reason_to_stop(std::uint32_t op, bool at_start) {
  const State& state = simulation_.cpu().state();
  if (const auto reason = reason_between(); reason == StopReason::Answer) return reason;
  if (!(at_start && standing_)) hit_places(op);
  if (!stop_.hits.empty()) return StopReason::StopPoint;
  if (goal_ && goal_(state, op, progress_)) return StopReason::Goal;
  if (state.time >= limit_) return StopReason::Limit;
  if (asked_to_stop()) return StopReason::Request;
  return {};
}

/// A reason that has come up since the last instruction.
std::optional<StopReason> Stepper::reason_between() {
  if (answer_complete() && stop_at_answer_) return StopReason::Answer;
  return stop_.hits.empty() ? std::nullopt : std::optional(StopReason::StopPoint);
}

void Stepper::instruction(const InstructionRecord& record) {
  note_changes(&record);
  if (backwards_) return;
  ++progress_.executed;
  on_instruction(record, executing_start_);
}

void Stepper::count_hits() {
  const History::Place here = history_.here();
  const std::pair now{here.moment.instructions, here.moment.time};
  const bool same_beginning =
      counted_on_ && counted_on_->checkpoints.front() == here.branch->checkpoints.front();  // it has forked
  for (StopPoint& stop : stops) {
    const auto before = stop.hit_at.find(counted_on_);
    const auto [counted, is_new] = stop.hit_at.try_emplace(here.branch);
    StopPoint::Moments& moments = counted->second;
    if (is_new && same_beginning && before != stop.hit_at.end())
      moments.assign(before->second.begin(), std::ranges::upper_bound(before->second, now));
    stop.hits = static_cast<std::uint64_t>(std::ranges::upper_bound(moments, now) - moments.begin());
  }
  counted_on_ = here.branch;
}

/// The number of the hit that is now. What is played again was counted the first time; backwards nothing is new.
std::uint64_t Stepper::count(StopPoint& stop) {
  const State& state = simulation_.cpu().state();
  StopPoint::Moments& moments = stop.hit_at[counted_on_];
  if (backwards_) {
    const std::pair latest{state.instructions, kNever};
    return static_cast<std::uint64_t>(std::ranges::upper_bound(moments, latest) - moments.begin());
  }
  const std::pair now{state.instructions, state.time};
  const auto next = moments.begin() + static_cast<std::ptrdiff_t>(stop.hits);
  if (next == moments.end() || *next != now) moments.insert(next, now);
  return ++stop.hits;
}

/// Counts, and stops unless there is a reason not to. Backwards it also stops at hits from before the stop was set, unless
/// it waits for a number.
void Stepper::hit(StopPoint& stop, Hit with) {
  if (stop.condition && !stop.condition->holds(simulation_.cpu())) return;
  const std::uint64_t number = count(stop);
  if (stop.from_hit > 1 && number < stop.from_hit) return;
  if (!stop.log.empty()) {
    if (!backwards_) on_message(stop);
    return;
  }
  with.stop = stop;
  with.stop.hits = number;
  stop_.hits.push_back(std::move(with));
}

void Stepper::hit_places(std::uint32_t op) {
  const Cpu& cpu = simulation_.cpu();
  for (StopPoint& stop : stops) {
    if (stop.on != StopPoint::On::Place || stop.op != op) continue;
    const bool idle = stop.needs_power && is_box_or_coil(cpu.program().ops[op]) && !cpu.state().stack.top();
    if (!idle) hit(stop, {});
    if (idle && !backwards_) ++stop.skipped;
  }
}

void Stepper::note_accesses(std::uint32_t op) {
  accessed_.clear();
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const auto on = stops[i].on;
    if (on != StopPoint::On::Read && on != StopPoint::On::Write) continue;
    const Access access = on == StopPoint::On::Read ? Access::Read : Access::Write;
    if (accesses(simulation_.cpu(), op, access, bits_of(*stops[i].range))) accessed_.push_back(i);
  }
}

bool Stepper::is_meant(const StopPoint& stop, const TraceRecord& record) {
  using On = StopPoint::On;
  const bool event = !stop.event || *stop.event == record.event;
  switch (record.kind) {
    case TraceKind::EventOccurred:
      return stop.on == On::EventOccurs && event;
    case TraceKind::ServiceBegin:
      return stop.on == On::EventServed && event;
    case TraceKind::EventLost:
      return stop.on == On::QueueOverflow || (stop.on == On::LostCharacter && is_receive_event(record.event));
    case TraceKind::CharacterIgnored:
      return stop.on == On::LostCharacter;
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
  const bool heard = record.kind == TraceKind::CharacterIgnored && record.code == 0;
  const bool received = record.kind == TraceKind::CharacterReceived || heard || record.kind == TraceKind::CharacterDropped;
  if (received && std::exchange(host_waits_, std::nullopt)) note_unanswered(host_frame_);
  if (received) coming_in_.push_back(record.byte);
  if (received || record.kind == TraceKind::CharacterSent) came_in_ = received;
  if (record.kind == TraceKind::Transmit || record.kind == TraceKind::CharacterSent) host_waits_.reset();
  for (StopPoint& stop : stops)
    if (is_meant(stop, record)) hit(stop, {.record = record});
}

/// A frame has ended when nothing came for 3.5 characters.
void Stepper::note_silence() {
  const Time last = simulation_.last_activity();
  if (last == silence_noted_ || !simulation_.line_quiet_for(simulation_.port_format().silence())) return;
  silence_noted_ = last;
  const std::vector<std::uint8_t> heard = std::exchange(coming_in_, {});
  if (!came_in_) return;
  const std::vector<std::uint8_t> frame = backwards_ ? std::vector<std::uint8_t>{} : heard;
  for (StopPoint& stop : stops)
    if (stop.on == StopPoint::On::FrameReceived) hit(stop, {.frame = frame});
  note_host_request(frame, last);
}

/// `frame`: of a master outside; nothing if it is not known.
void Stepper::note_unanswered(const std::vector<std::uint8_t>& frame) {
  for (StopPoint& stop : stops)
    if (stop.on == StopPoint::On::Unanswered) hit(stop, {.frame = frame});
}

/// What came in without the simulated master came from outside.
void Stepper::note_host_request(std::vector<std::uint8_t> frame, Time end) {
  if (!simulation_.host_port().state().attached || simulation_.master().busy()) return;
  host_waits_ = end;
  host_frame_ = std::move(frame);
}

void Stepper::note_host_timeout() {
  if (!host_waits_ || simulation_.time() - *host_waits_ < host_timeout) return;
  host_waits_.reset();
  note_unanswered(host_frame_);
}

bool Stepper::answer_complete() {
  if (!awaiting_answer_ || simulation_.master().busy()) return false;
  awaiting_answer_ = false;
  if (simulation_.master().exchange().timed_out) note_unanswered({});
  if (!backwards_) on_answer(simulation_.master().exchange());
  return true;
}

void Stepper::note_changes(const InstructionRecord* by) {
  for (std::size_t i = 0; i < stops.size(); ++i) {
    StopPoint& stop = stops[i];
    if (!stop.range) continue;
    std::vector<std::uint8_t> value = stop.range->bytes_in(simulation_.cpu().state().image);
    const bool changed = value != stop.value;
    const bool touched = by && by->powered && std::ranges::find(accessed_, i) != accessed_.end();
    const bool meant = stop.on == StopPoint::On::Read    ? touched
                       : stop.on == StopPoint::On::Write ? touched || (by && changed)
                                                         : changed;
    if (meant) hit(stop, {.value = value, .by = by ? std::optional(*by) : std::nullopt});
    stop.value = std::move(value);
  }
}

}  // namespace s7200::tools

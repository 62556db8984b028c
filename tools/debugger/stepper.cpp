#include "tools/debugger/stepper.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

#include "interpreter/program/networks.hpp"
#include "tools/debugger/access.hpp"
#include "tools/views/broadcast.hpp"

namespace s7200::tools {
namespace {

using On = StopPoint::On;

}  // namespace

Stepper::Stepper(History& history, const std::atomic<bool>* stop_request)
    : on_record([](std::size_t, const TraceRecord&) {}),
      on_instruction([](std::size_t, const InstructionRecord&, bool) {}),
      on_answer([](const serial::Exchange&) {}),
      on_message([](const StopPoint&) {}),
      on_unasked([](const Transmission&) {}),
      on_search([](Time) {}),
      history_(history),
      stop_request_(stop_request),
      listening_(history.stations()),
      polling_(history.pollers().size()),
      given_up_(history.requests().lines().size()) {}

Stop Stepper::run(const Goal& goal, Time limit, bool stop_at_answer) {
  count_hits();
  goal_ = goal;
  limit_ = limit;
  stop_at_answer_ = stop_at_answer;
  const State& state = station(focus_).cpu().state();
  start_ = Instruction{focus_, standing_at(state).value_or(0), state.in_interrupt};
  progress_ = {.executed = 0, .left = !standing_at(state)};
  next_.reset();
  if (const auto at = history_.next_station()) {
    const State& next = station(*at).cpu().state();
    if (const auto op = standing_at(next)) next_ = {*at, *op, next.in_interrupt};
  }
  executing_start_ = answered_ = false;
  cpu_stopped_.reset();
  begin_watching();
  const serial::Halt halt = history_.run(*this);
  listened_to_ = history_.now();
  if (halt == serial::Halt::Stopped) stop_.reason = StopReason::CpuStopped;
  if (halt == serial::Halt::Request) stop_.reason = StopReason::Request;
  if (halt == serial::Halt::Time) end_idle();
  return stop_;
}

Time Stepper::idles_until(Time now) {
  if (asked_to_stop()) return now;
  note_line(0, now);
  const Time timeout = next_timeout();
  if (backwards_) {
    note_found_here();
    return timeout > now ? timeout : kNever;
  }
  answered_ |= answer_complete() && stop_at_answer_;
  const bool ends = answered_ || !stop_.hits.empty() || cpu_stopped_;
  return ends ? now : std::max(now, timeout > now ? std::min(limit_, timeout) : limit_);
}

/// When no CPU executes: of a simulated master, one that polls, one on a bridge, or a program; or of a frame that ends.
Time Stepper::next_timeout() const {
  Time next = kNever;
  const auto note = [&](const serial::Requester& requester) {
    const serial::Requester::State& state = requester.state();
    if (state.phase == serial::Requester::Phase::Waiting)
      next = std::min(next, state.exchange.request_end + state.request.timeout);
  };
  for (std::size_t number = 0; number < listening_.size(); ++number) {
    const serial::Simulation& here = station(number);
    const Listening& listening = listening_[number];
    if (here.last_activity() != listening.silence_noted)
      next = std::min(next, here.last_activity() + here.port_format().silence());
    if (listening.host_waits) next = std::min(next, *listening.host_waits + host_timeout);
    if (here.has_master()) note(here.master());
  }
  for (const auto& [name, poller] : history_.pollers()) note(poller->requester());
  for (std::size_t line = 0; line < given_up_.size(); ++line) next = std::min(next, timeout_of_plc(line));
  return next;
}

void Stepper::end_idle() {
  stop_.reason = asked_to_stop() ? StopReason::Request : StopReason::Limit;
  if (const auto reason = reason_to_stop_here()) stop_.reason = *reason;
  if (answered_ && !cpu_stopped_) stop_.reason = StopReason::Answer;
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

void Stepper::begin_search(const Goal& goal, std::uint64_t count, bool stop_at_answer) {
  count_hits();
  goal_ = goal;
  limit_ = kNever;
  stop_at_answer_ = stop_at_answer;
  cpu_stopped_.reset();
  progress_ = {.executed = 1, .left = true};
  const Places nowhere(history_.stations());
  search_ = {.count = count, .first = nowhere, .after = nowhere};
}

/// An earlier part of the past is going to be played: what it begins with is what comes after the next one.
void Stepper::begin_part() {
  for (std::size_t number = 0; number < search_.first.size(); ++number)
    if (const auto first = std::exchange(search_.first[number], {})) search_.after[number] = first;
  search_.found.clear();
  on_search(history_.now().time);
  begin_watching();
}

/// Takes the last place of the part; the goal only if it is met for the last time to be counted.
bool Stepper::end_part() {
  search_.there = found_after_part();
  for (auto last = search_.found.rbegin(); last != search_.found.rend() && !search_.there; ++last)
    if (last->stop || --search_.count == 0) search_.there = std::move(*last);
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
    note_line(number, after->time);
  }
  if (!earliest) return {};
  const bool answer = answer_complete() && stop_at_answer_;
  if (!answer && stop_.hits.empty()) return {};
  stop_.reason = answer ? StopReason::Answer : StopReason::StopPoint;
  const Moment place = place_of_first_hit(*earliest);
  return Found{answer ? *earliest : place, stop_};
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
  accessed_.clear();
  executing_since_ = kNever;
  const Moment now = history_.now();
  const bool goes_on =
      !backwards_ && listened_to_ && listened_to_->instructions == now.instructions && listened_to_->time == now.time;
  for (std::size_t number = 0; number < listening_.size() && !goes_on; ++number) listen_from_now_on(number);
  if (!goes_on) ask_from_now_on(now.time);
  for (Listening& listening : listening_) listening.awaits_answer = false;
  note_masters();
  if (!backwards_)
    for (StopPoint& stop : stops) stop.skipped = stop.unknown = 0;
  read_values();
}

/// Stations on one line have the same master.
void Stepper::note_masters() {
  for (std::size_t number = 0; number < listening_.size(); ++number) {
    const serial::Simulation& here = station(number);
    if (!here.has_master() || !here.master().busy()) continue;
    listening_[number].awaits_answer = first_beside(number) == number;
  }
}

/// What came before is not known, only when the last character on the line ended, and when the last one that the PLC sent.
void Stepper::listen_from_now_on(std::size_t number) {
  const serial::Simulation& here = station(number);
  Listening& listening = listening_[number];
  listening.coming_in.clear();
  const Time silence = here.port_format().silence(), half_a_character = silence / 7;
  const Time last = here.last_activity();
  listening.silence_noted = here.line_quiet_for(silence) ? last : 0;
  listening.came_in = last > here.plc().state().uart.at(here.port()).send_end + half_a_character;
  listening.heard = listening.came_in ? std::optional(last) : std::nullopt;
  listening.host_waits.reset();
  listening.host_frame_end = 0;
  const bool waits = listening.came_in && listening.silence_noted != 0 && !here.freeport().transmitting;
  if (waits && here.time() < last + host_timeout) note_host_request(number, {}, last);
}

/// What masters have asked already.
void Stepper::ask_from_now_on(Time now) {
  polling_.assign(polling_.size(), {});
  note_polls();
  for (std::size_t line = 0; line < given_up_.size(); ++line) {
    const auto& last = history_.requests().last(line);
    given_up_[line] = last && now - last->end >= host_timeout ? last->end : 0;
  }
}

/// What comes from outside ends a row of such scans by itself. A time that has come is looked for here.
bool Stepper::wants_scans() const {
  if (history_.stations() > 1) return true;  // a CPU in step never runs a whole one at once
  const auto is_within_a_scan = [](const StopPoint& stop) { return stop.on == On::Place || stop.is_watch(); };
  const serial::Simulation& only = station(0);
  const bool asks = std::ranges::any_of(std::views::iota(std::size_t{0}, given_up_.size()),
                                        [this](std::size_t line) { return is_open(line); });
  const bool waits = asks || listening_[0].host_waits || only.last_activity() != listening_[0].silence_noted;
  const bool ends = only.time() >= limit_;
  return goal_ || backwards_ || waits || ends || std::ranges::any_of(stops, is_within_a_scan);
}

void Stepper::read_values() {
  for (StopPoint& stop : stops)
    if (stop.range) stop.value = stop.range->bytes_in(station(stop.station).cpu().state().image);
}

/// What has come up until now is not what the action does. A bridge acts between any two events, where no run stops.
bool Stepper::before_action() {
  if (std::holds_alternative<serial::HostCall>(*history_.action(history_.now().actions))) return true;
  if (const auto next = history_.next_station()) {
    note_changes(*next, nullptr);
    note_line(*next, station(*next).cpu().time());
  } else {
    note_line(0, history_.now().time);
  }
  if (backwards_) {
    note_found_here();
    return true;
  }
  const auto reason = reason_to_stop_here();
  if (reason) stop_.reason = *reason;
  return !reason;
}

/// Not in front of an instruction: it has stopped here when it ran, and nothing waits for its turn.
std::optional<StopReason> Stepper::reason_to_stop_here() {
  if (cpu_stopped_) {
    stop_.station = *cpu_stopped_;
    return StopReason::CpuStopped;
  }
  if (answer_complete() && stop_at_answer_) return StopReason::Answer;
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
  search_.found.push_back({here, stop_});
  stop_ = {.station = focus_};
}

void Stepper::acted() {
  note_masters();
  note_changes_from_outside();
}

/// They are no hits that count: only what the CPU does is.
void Stepper::note_changes_from_outside() {
  for (StopPoint& stop : stops) {
    if (!stop.range) continue;
    std::vector<std::uint8_t> value = stop.range->bytes_in(station(stop.station).cpu().state().image);
    const bool meant = value != stop.value && stop.on != On::Read && stop.from_hit == 1 && holds(stop);
    if (meant && !stop.log.empty() && !backwards_) on_message(stop);
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
  note_line(number, station(number).cpu().time());
  if (backwards_) {
    const bool goes_on = note_place(op);
    note_accesses(op);
    executing_since_ = station(number).cpu().time();
    return goes_on;
  }
  const Instruction here{number, op, station(number).cpu().state().in_interrupt};
  const bool stood_there = next_ == here;
  if (const auto reason = reason_to_stop(op, stood_there)) {
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

bool Stepper::note_place(std::uint32_t op) {
  if (asked_to_stop()) return false;
  auto& first = search_.first[history_.told_of()];
  if (!first) first = history_.in_front();
  const auto reason = reason_to_stop(op, false);
  if (!reason) return true;
  stop_.reason = *reason;
  const bool goal = *reason == StopReason::Goal && stop_.hits.empty();
  search_.found.push_back({history_.in_front(), goal ? std::nullopt : std::optional(stop_)});
  stop_ = {.station = focus_};
  return true;
}

/// `stood_there`: the run started in front of this instruction, which is no hit then.
std::optional<StopReason> Stepper::reason_to_stop(std::uint32_t op, bool stood_there) {
  const std::size_t number = history_.told_of();
  if (cpu_stopped_) {
    stop_.station = *cpu_stopped_;
    return StopReason::CpuStopped;
  }
  if (answer_complete() && stop_at_answer_) return StopReason::Answer;
  if (!stood_there) hit_places(op);
  const auto due = std::ranges::find_if(stop_.hits, [this](const Hit& hit) { return is_turn_of(hit.stop.station); });
  if (due != stop_.hits.end()) {
    stop_.station = due->stop.station;
    return StopReason::StopPoint;
  }
  if (number == focus_ && goal_ && goal_(station(number).cpu().state(), op, progress_)) return StopReason::Goal;
  if (is_turn_of(focus_) && history_.in_front().time >= limit_) return StopReason::Limit;
  if (asked_to_stop()) return StopReason::Request;
  return {};
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
  stops.push_back(std::move(stop));
  count_hits();
}

void Stepper::count_hits() {
  const History::Place here = history_.here();
  const StopPoint::Instant now{here.moment.instructions, here.moment.time};
  const bool same_beginning =
      counted_on_ && counted_on_->checkpoints.front() == here.branch->checkpoints.front();  // it has forked
  for (StopPoint& stop : stops) {
    const auto before = stop.counted.find(counted_on_);
    const auto [counted, is_new] = stop.counted.try_emplace(here.branch, StopPoint::Counted{.since = now});
    auto& [since, at] = counted->second;
    if (is_new && same_beginning && before != stop.counted.end()) {
      since = std::min(since, before->second.since);
      at.assign(before->second.at.begin(), std::ranges::upper_bound(before->second.at, now));
    }
    stop.hits = static_cast<std::uint64_t>(std::ranges::upper_bound(at, now) - at.begin());
  }
  counted_on_ = here.branch;
}

Time Stepper::counts_since(const StopPoint& stop) const {
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
std::uint64_t Stepper::count(StopPoint& stop, Time when) {
  const std::uint64_t instructions = history_.in_front().instructions;
  const StopPoint::Instant now{instructions, when};
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
  std::string why;
  const auto value = stop.condition->value(station(stop.station).cpu(), why);
  if (!value && !backwards_ && stop.unknown++ == 0) stop.why_unknown = why;
  return value && value->truth();
}

/// Counts, and stops unless there is a reason not to. It also stops at hits from before the stop was set, unless it waits
/// for a number.
void Stepper::hit(StopPoint& stop, Hit with) {
  if (!holds(stop)) return;
  const std::uint64_t number = count(stop, time_of(with));
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
  const Cpu& cpu = station(history_.told_of()).cpu();
  for (StopPoint& stop : stops) {
    if (stop.station != history_.told_of() || stop.on != On::Place || stop.op != op) continue;
    const bool idle = stop.needs_power && is_box_or_coil(cpu.program().ops[op]) && !cpu.state().stack.top();
    if (!idle) hit(stop, {});
    if (idle && !backwards_) ++stop.skipped;
  }
}

void Stepper::note_accesses(std::uint32_t op) {
  accessed_.clear();
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const auto on = stops[i].on;
    if (stops[i].station != history_.told_of() || !stops[i].range) continue;
    const auto is_accessed = [&](Access access) {
      return accesses(station(stops[i].station).cpu(), op, access, bits_of(*stops[i].range));
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
  const std::size_t number = history_.told_of();
  Listening& listening = listening_[number];
  if (history_.requests().gives_up(number, record)) note_unanswered_plc(history_.requests().line_of(number, record.port));
  constexpr std::uint16_t kWhileSending = 2;  // the one reason to ignore it that hides what others send
  const bool heard = record.kind == TraceKind::CharacterIgnored && record.code != kWhileSending;
  const bool on_line = record.port == station(number).port();
  const bool received =
      on_line && (record.kind == TraceKind::CharacterReceived || heard || record.kind == TraceKind::CharacterDropped);
  const bool sent = on_line && record.kind == TraceKind::CharacterSent;
  if (received || (on_line && record.kind == TraceKind::TransmitEnd)) note_end_of_wait(number, record);
  if (received) listening.coming_in.push_back(record.byte);
  if (received) listening.heard = record.at;
  if (received || sent) listening.came_in = received;
  const std::vector<std::uint8_t> frame = note_sent(number, record);
  for (StopPoint& stop : stops)
    if (stop.station == number && is_meant(stop, record)) hit(stop, {.record = record, .frame = frame});
}

/// All of a transmission that ends.
std::vector<std::uint8_t> Stepper::note_sent(std::size_t number, const TraceRecord& record) {
  if (record.kind != TraceKind::TransmitEnd) return {};
  const std::optional<Transmission>& sent = history_.requests().sending(number, record.port);
  const bool unasked = record.port == station(number).port() && is_unasked(number);
  listening_[number].heard.reset();
  if (!sent) return {};
  if (unasked && !backwards_) on_unasked({sent->from, record.at, sent->bytes});
  return sent->bytes;
}

bool Stepper::is_unasked(std::size_t number) const {
  const serial::Simulation& here = station(number);
  if (history_.stations() > 1 || !here.has_master() || here.master().asks()) return false;
  if (here.has_host_port() && here.host_port().state().attached) return false;
  const std::optional<Time>& heard = listening_[number].heard;
  const serial::Exchange& last = here.master().exchange();
  return !heard || last.given_up || (last.timed_out && *heard <= last.request_end + here.port_format().silence());
}

/// A frame has ended when nothing came for 3.5 characters.
void Stepper::note_silence(std::size_t number, Time now) {
  const serial::Simulation& here = station(number);
  Listening& listening = listening_[number];
  const Time last = here.last_activity();
  if (last == listening.silence_noted || now - last < here.port_format().silence()) return;
  listening.silence_noted = last;
  const std::vector<std::uint8_t> heard = std::exchange(listening.coming_in, {});
  if (!listening.came_in) return;
  const std::vector<std::uint8_t> frame = backwards_ ? std::vector<std::uint8_t>{} : heard;
  for (StopPoint& stop : stops)
    if (stop.station == number && stop.on == On::FrameReceived && here.plc().powered()) hit(stop, {.frame = frame});
  note_host_request(number, frame, last);
}

/// In front of an instruction of a station, and for those that execute none.
void Stepper::note_line(std::size_t number, Time now) {
  for (std::size_t other = 0; other < listening_.size(); ++other) {
    if (other != number && station(other).plc().executes()) continue;
    note_silence(other, now);
    note_host_timeout(other, now);
  }
  note_polls();
  note_plc_timeouts(now);
}

/// A station has sent something, or hears a character: of an answer, unless it is damaged, or of the next request.
void Stepper::note_end_of_wait(std::size_t number, const TraceRecord& record) {
  Listening& line = line_of(number);
  if (!line.host_waits) return;
  const bool heard = record.kind != TraceKind::TransmitEnd;
  const bool again = heard ? is_of_a_master(number, record) : history_.requests().ends_request(number, record);
  const bool unclear = record.parity_error || record.framing_error || is_sending(number);
  if (heard && unclear && !again) return;
  line.host_waits.reset();
  if (again) note_unanswered(station(number).line(), line.host_frame);
}

/// `frame`: of a request that is not the simulated master's; nothing if it is not known.
void Stepper::note_unanswered(const serial::SharedLine& line, const std::vector<std::uint8_t>& frame,
                              std::optional<Asker> asker) {
  for (StopPoint& stop : stops)
    if (stop.on == On::Unanswered && hears(stop, line)) hit(stop, {.frame = frame, .asker = asker});
}

bool Stepper::hears(const StopPoint& stop, const serial::SharedLine& line) const {
  if (stop.line) return history_.requests().lines()[*stop.line] == &line;
  const serial::Plc& plc = station(stop.station).plc();
  for (std::uint8_t port = 0; port < plc.cpu().program().model->ports; ++port)
    if (&plc.line(port) == &line) return true;
  return false;
}

// --- masters that poll, and programs that ask ---

/// Between two looks one request may be over and the next under way.
void Stepper::note_polls() {
  for (std::size_t number = 0; number < polling_.size(); ++number) {
    const serial::Poller& poller = *history_.pollers()[number].poller;
    const serial::Poller::State& now = poller.state();
    const bool asks = poller.requester().asks();
    Polling& polling = polling_[number];
    const bool next = now.asked != polling.asked;
    const bool in_vain = next ? now.answered == polling.answered : poller.requester().exchange().timed_out;
    if (polling.asks && (next || !asks) && in_vain && !is_broadcast(polling.frame))
      for (const serial::SharedLine* const line : history_.requests().lines())
        if (poller.is_on(line->line())) note_unanswered(*line, polling.frame, Asker{Asker::Kind::Poller, number});
    if (asks && (next || !polling.asks)) polling.frame = serial::bytes_of(poller.requester().exchange().request);
    polling.asks = asks;
    polling.asked = now.asked;
    polling.answered = now.answered;
  }
}

/// A program has asked on that line, and nobody has answered yet.
bool Stepper::is_open(std::size_t line) const {
  const std::optional<PlcRequests::Request>& last = history_.requests().last(line);
  return last && last->waits() && last->end != given_up_[line];
}

/// Of the request of a program; kNever if none waits, or if what may be its answer is being sent.
Time Stepper::timeout_of_plc(std::size_t line) const {
  const PlcRequests& requests = history_.requests();
  return is_open(line) && !requests.is_sending(line) ? requests.last(line)->end + host_timeout : kNever;
}

void Stepper::note_unanswered_plc(std::size_t line) {
  if (!is_open(line)) return;
  const PlcRequests::Request& last = *history_.requests().last(line);
  given_up_[line] = last.end;
  note_unanswered(*history_.requests().lines()[line], last.frame, Asker{Asker::Kind::Plc, last.station});
}

void Stepper::note_plc_timeouts(Time now) {
  for (std::size_t line = 0; line < given_up_.size(); ++line)
    if (timeout_of_plc(line) <= now) note_unanswered_plc(line);
}

// --- masters on bridges ---

/// A PLC on the line of a station.
bool Stepper::is_sending(std::size_t number) const {
  const PlcRequests& requests = history_.requests();
  return requests.is_sending(requests.line_of(number, station(number).port()));
}

/// Of those on the line of a station.
std::size_t Stepper::first_beside(std::size_t number) const {
  std::size_t first = 0;
  while (&station(first).line() != &station(number).line()) ++first;
  return first;
}

/// A bridge on the line of a station that was sending then, or later.
std::optional<std::size_t> Stepper::host_that_sent(std::size_t number, Time after) const {
  const auto sent = [&](const serial::HostPort* host) {
    return host->state().attached && host->is_on(station(number).line().line()) && host->sent_until() > after;
  };
  const auto host = std::ranges::find_if(history_.hosts(), sent);
  if (host == history_.hosts().end()) return {};
  return static_cast<std::size_t>(host - history_.hosts().begin());
}

/// Of a simulated one or of one on a bridge. Any other character is of a station that answers.
bool Stepper::is_of_a_master(std::size_t number, const TraceRecord& received) const {
  return history_.requests().master_asks(station(number).line().line(), 0) || host_that_sent(number, received.since);
}

/// What a bridge has sent is a request, unless somebody on the line has just asked. All stations on its line hear it, one
/// of them later than another.
void Stepper::note_host_request(std::size_t number, std::vector<std::uint8_t> frame, Time end) {
  Listening& line = line_of(number);
  const Time character = station(number).port_format().character_time();  // who is set otherwise hears an end later
  const auto host = host_that_sent(number, end - character);
  if (!host || end <= line.host_frame_end || answers(number, end, character)) return;
  line.host_frame_end = end;
  if (history_.has_sent(*host, is_broadcast)) return;
  line.host_waits = end;
  line.host_frame = std::move(frame);
}

/// What has ended then on the line of a station is the answer to a simulated master, or to a program.
bool Stepper::answers(std::size_t number, Time end, Time character) const {
  const serial::Simulation& here = station(number);
  if (here.has_master() && here.master().busy()) return true;
  for (const auto& [name, poller] : history_.pollers()) {
    const serial::Requester& requester = poller->requester();
    if (poller->is_on(here.line().line()) && (requester.asks() || requester.exchange().response_end + character > end))
      return true;
  }
  const auto& last = history_.requests().last(history_.requests().line_of(number, here.port()));
  return last && last->answer && end > last->end && end < last->answer->to + character;
}

void Stepper::note_host_timeout(std::size_t number, Time now) {
  Listening& line = line_of(number);
  if (!line.host_waits || now - *line.host_waits < host_timeout || is_sending(number)) return;
  line.host_waits.reset();
  note_unanswered(station(number).line(), line.host_frame);
}

bool Stepper::answer_complete() {
  bool complete = false;
  for (std::size_t number = 0; number < listening_.size(); ++number) {
    if (!listening_[number].awaits_answer || station(number).master().busy()) continue;
    listening_[number].awaits_answer = false;
    const serial::Exchange& exchange = station(number).master().exchange();
    if (exchange.given_up) continue;
    complete = true;
    if (exchange.timed_out && !is_broadcast(serial::bytes_of(exchange.request))) note_unanswered(station(number).line(), {});
    if (!backwards_) on_answer(station(number).master().exchange());
  }
  return complete;
}

/// By an instruction of a station; or between two, also of those that execute none.
void Stepper::note_changes(std::size_t number, const InstructionRecord* by) {
  for (std::size_t i = 0; i < stops.size(); ++i) {
    StopPoint& stop = stops[i];
    const bool is_turn = stop.station == number || (!by && !station(stop.station).plc().executes());
    if (!stop.range || !is_turn) continue;
    std::vector<std::uint8_t> value = stop.range->bytes_in(station(stop.station).cpu().state().image);
    const bool changed = value != stop.value;
    const bool touched = by && by->powered && std::ranges::find(accessed_, i) != accessed_.end();
    const bool meant = stop.on == On::Read        ? touched
                       : stop.on == On::Write     ? touched || (by && changed)
                       : stop.on == On::ReadWrite ? touched || changed
                                                  : changed;
    if (meant) hit(stop, {.value = value, .by = by ? std::optional(*by) : std::nullopt});
    stop.value = std::move(value);
  }
}

}  // namespace s7200::tools

#include "serial_sim/faults/faults.hpp"

#include <algorithm>
#include <cassert>

#include "interpreter/base/split_mix.hpp"

namespace s7200::serial {
namespace {

constexpr std::uint8_t kNext = 0;  // the only event

/// The most bits for which noise is drawn ahead.
constexpr int kNoiseAhead = 4096;

Time later(Time at, Time by) { return by > kNever - at ? kNever : at + by; }

std::size_t index(Half half) { return static_cast<std::size_t>(half); }

bool concerns(const Fault& fault, Half half) { return fault.of == Half::Both || fault.of == half; }

/// Happens in some exchanges and not in others.
bool selective(const Fault& fault) { return fault.exchange != 0 || fault.every != 1 || fault.probability < 1; }

bool works_now(const Faults::Injected& injected) { return injected.applies || !selective(injected.fault); }

/// Whether the fault's place is counted from the start edge of a character.
bool bound_to_character(const Fault& fault) {
  switch (fault.kind) {
    case FaultKind::Flip:
    case FaultKind::Parity:
    case FaultKind::Framing:
    case FaultKind::Break:
    case FaultKind::Glitch:
    case FaultKind::Collision:
    case FaultKind::Cut:
      return !at_an_instant(fault);
    default:
      return false;
  }
}

bool hits_character(const Fault& fault, std::uint32_t number) {
  return fault.character == Fault::kEachCharacter || fault.character == number;
}

}  // namespace

std::uint64_t Faults::Chance::draw() { return draw_split_mix(state_); }

bool Faults::Chance::hits(double probability) { return static_cast<double>(draw() >> 11) * 0x1p-53 < probability; }

void Faults::add_plc(const Uart& plc, const FrameSender* sender) {
  senders_[static_cast<std::size_t>(plc.driver())] = sender;
  if (!first_plc_) first_plc_ = &plc;
  plc_drivers_ |= 1U << plc.driver();
  listen_in();
}

void Faults::inject(const Fault& fault, Time now, int driver) {
  assert(driver == kAnyDriver || is_of_a_station(fault));
  state_.injected.push_back({.fault = fault, .at = now, .driver = driver, .chance = Chance(fault.seed)});
  listen_in();
  Injected& injected = state_.injected.back();
  const Time from = later(now, fault.from.value_or(0));
  if (fault.kind == FaultKind::Noise) plan_noise(injected, from);
  if (at_an_instant(fault)) injected.next = from;
  schedule();
}

void Faults::clear(Time now) {
  state_.injected.clear();
  schedule();
  listen_in();
  line_.heal(now);
  if (watcher_) watcher_->faults_cleared(now);
}

void Faults::restore(const State& state) {
  state_ = state;
  listen_in();
}

/// A line without faults is not asked about any, unless one of its PLCs may be the master: that shows before there are any.
void Faults::listen_in() { line_.set_interference(state_.injected.empty() && !has_several_plcs() ? nullptr : this); }

void Faults::exchange_begins(int driver, Time at) {
  state_.announcer = driver;
  begin_exchange(at);
}

bool Faults::begins_unannounced(Half half, int driver, const SerialFormat& format, Time at) const {
  if (!state_.begun) return true;
  if (state_.announcer != -1 && (half == Half::Answer || driver == state_.announcer)) return false;
  const bool answered = state_.characters[index(Half::Answer)] != 0;
  const Time silence = format.silence();
  const bool quiet =
      std::all_of(state_.sent_until.begin(), state_.sent_until.end(), [&](Time end) { return at - end > silence; });
  return half == Half::Request ? answered || quiet : answered && quiet;
}

void Faults::begin_exchange(Time at) {
  state_.begun = true;
  state_.characters = {};
  state_.sent_until = {at, at};
  for (Injected& injected : state_.injected) {
    const Fault& fault = injected.fault;
    const std::uint64_t number = ++injected.exchanges;
    injected.characters = 0;
    injected.applies = (fault.exchange == 0 || fault.exchange == number) && number % fault.every == 0 &&
                       (fault.probability >= 1 || injected.chance.hits(fault.probability));
    const bool lasts_all_along = fault.kind == FaultKind::Echo || fault.kind == FaultKind::Baud;
    if (injected.applies && lasts_all_along) happens(injected, {.from = at, .to = at});
  }
}

void Faults::happens(Injected& injected, const FaultHappening& what) {
  injected.count += what.times;
  if (watcher_) watcher_->fault_happens(injected, what);
}

void Faults::disturb_wire(Injected& injected, std::uint32_t character, const Disturbance& disturbance) {
  injected.last_begin = disturbance.from;
  injected.last_end = disturbance.to;
  happens(injected, {character, disturbance.from, disturbance.to});
  line_.disturb(disturbance);
}

Mishap Faults::character_begins(int driver, const SerialFormat& format, std::uint8_t byte, Time at) {
  const bool is_unknown = !state_.begun && state_.master == -1;
  if (is_unknown && has_several_plcs() && is_plc(driver)) state_.master = driver;
  const Half half = answers(driver) ? Half::Answer : Half::Request;
  if (begins_unannounced(half, driver, format, at)) {
    state_.announcer = -1;
    begin_exchange(at);
  }
  ++state_.characters[index(half)];
  for (Injected& injected : state_.injected)
    if (injected.driver == driver) ++injected.characters;
  const BitClock clock{format, clock_error(driver)};

  const auto disturbed_by = [&](const Injected& injected) {
    const bool is_its_own = injected.driver == driver || (injected.driver == kAnyDriver && concerns(injected.fault, half));
    return injected.applies && is_its_own && injected.fault.kind != FaultKind::Answer;
  };
  const auto number_for = [&](const Injected& injected) {
    return injected.driver == driver ? injected.characters : state_.characters[index(half)];
  };
  Mishap mishap;
  for (Injected& injected : state_.injected)
    if (disturbed_by(injected)) disturb_sender(injected, number_for(injected), clock, at, mishap);

  if (half == Half::Answer && follow_answer(driver, byte)) change_answer(driver, clock, at, mishap);

  const Time character = clock.character_time();
  const Time start = at + mishap.delay + static_cast<Time>(mishap.before.size()) * character;
  for (Injected& injected : state_.injected)
    if (disturbed_by(injected) && bound_to_character(injected.fault) && hits_character(injected.fault, number_for(injected)))
      disturb_line(injected, number_for(injected), clock, start);

  state_.sent_until[index(half)] = start + mishap.pause + static_cast<Time>(1 + mishap.after.size()) * character;
  return mishap;
}

/// Whether the character belongs to an answer that can be changed as a whole. An answer that began before there was such a
/// fault cannot be changed.
bool Faults::follow_answer(int driver, std::uint8_t byte) {
  const auto is_of_answers = [](const Injected& injected) { return injected.fault.kind == FaultKind::Answer; };
  AnswerInProgress& answer = state_.answer;
  if (std::ranges::none_of(state_.injected, is_of_answers)) return answer = {}, false;
  const FrameSender* const sender = senders_[static_cast<std::size_t>(driver)];
  const bool first = state_.characters[index(Half::Answer)] == 1;
  if (first || (answer.length != 0 && answer.complete())) {
    if (answer.length != 0 && answer.complete()) answer.before = std::move(answer.bytes);
    const auto left = sender ? sender->characters_left() : std::nullopt;
    answer.length = left ? 1 + *left : 0;
    answer.bytes.clear();
    answer.sent.clear();
  }
  if (answer.length == 0) {
    for (Injected& injected : state_.injected)
      if (first && is_of_answers(injected) && injected.applies) ++injected.impossible;
    return false;
  }
  answer.bytes.push_back(byte);
  return true;
}

/// The first fault that misbehaves does; all that delay do.
void Faults::change_answer(int driver, const BitClock& clock, Time at, Mishap& mishap) {
  AnswerInProgress& answer = state_.answer;
  const bool first = answer.bytes.size() == 1;
  bool misbehaves = false;
  for (Injected& injected : state_.injected) {
    const Fault& fault = injected.fault;
    const bool is_its_own = injected.driver == driver || injected.driver == kAnyDriver;
    if (fault.kind != FaultKind::Answer || !injected.applies || !is_its_own) continue;
    if (fault.misbehaviour != Misbehaviour::Nothing && misbehaves) continue;
    if (!possible(fault.misbehaviour, answer)) {
      if (first) ++injected.impossible;
      continue;
    }
    if (first) {
      const Time delay = fault.length.at(clock);
      mishap.delay += delay;
      happens(injected, {1, at, at + delay + static_cast<Time>(answer.length) * clock.character_time()});
    }
    if (fault.misbehaviour == Misbehaviour::Nothing) continue;
    misbehaves = true;
    change(fault, answer, clock.format, mishap);
  }
}

void Faults::disturb_sender(Injected& injected, std::uint32_t number, const BitClock& clock, Time at, Mishap& mishap) {
  const Fault& fault = injected.fault;
  const Time character = clock.character_time();
  const auto append = [&](std::vector<std::uint8_t>& to) {
    const std::vector<std::uint8_t> bytes = uncalled_bytes(injected);
    to.insert(to.end(), bytes.begin(), bytes.end());
    happens(injected, {number, at, at + static_cast<Time>(bytes.size() + 1) * character, bytes.size()});
  };
  switch (fault.kind) {
    case FaultKind::Gap:
      if (!hits_character(fault, number)) return;
      mishap.delay += fault.length.at(clock);
      happens(injected, {number, at, at + fault.length.at(clock)});
      break;
    case FaultKind::Missing: {
      const std::uint32_t first = fault.character.value_or(1);
      if (first != Fault::kEachCharacter && (number < first || number - first >= fault.count)) return;
      mishap.lost = true;
      happens(injected, {number, at, at + character});
      break;
    }
    case FaultKind::Extra:
      if (fault.character == 0U && number == 1) append(mishap.before);
      if (fault.character == number) append(mishap.after);
      break;
    default:
      break;
  }
}

std::vector<std::uint8_t> Faults::uncalled_bytes(Injected& injected) {
  std::vector<std::uint8_t> bytes;
  for (std::uint32_t i = 0; i < injected.fault.count; ++i) {
    if (injected.fault.bytes.empty()) {
      bytes.push_back(static_cast<std::uint8_t>(injected.chance.draw() >> 56));
    } else {
      bytes.insert(bytes.end(), injected.fault.bytes.begin(), injected.fault.bytes.end());
    }
  }
  return bytes;
}

void Faults::disturb_line(Injected& injected, std::uint32_t number, const BitClock& clock, Time start) {
  switch (injected.fault.kind) {
    case FaultKind::Flip:
      return invert_bit(injected, number, injected.fault.bit, clock, start);
    case FaultKind::Parity:
      return invert_bit(injected, number, Fault::kParityBit, clock, start);
    case FaultKind::Framing:
      return invert_bit(injected, number, Fault::kStopBit, clock, start);
    default:
      return disturb(injected, number, clock, start + injected.fault.offset.at(clock));
  }
}

/// Inverts the bit from its first edge to its last, so that the receiver reads this bit wrong and no other.
void Faults::invert_bit(Injected& injected, std::uint32_t number, int bit, const BitClock& clock, Time start) {
  const bool has_parity = clock.format.parity != Parity::None;
  int place = 1 + bit;
  if (bit == Fault::kStopBit) place = first_stop_bit(clock.format);
  if (bit == Fault::kParityBit) place = first_stop_bit(clock.format) - 1;
  const bool is_data = bit >= 0 && bit < Fault::kParityBit;
  if ((bit == Fault::kParityBit && !has_parity) || (is_data && bit >= clock.format.data_bits)) {
    ++injected.impossible;
    return;
  }
  disturb_wire(injected, number,
               {Disturbance::Effect::Inverts, start + clock.bit_times(place), start + clock.bit_times(place + 1)});
}

void Faults::disturb(Injected& injected, std::uint32_t number, const BitClock& clock, Time at) {
  const Fault& fault = injected.fault;
  switch (fault.kind) {
    case FaultKind::Break:
      return disturb_wire(injected, number, {Disturbance::Effect::HoldsSpace, at, later(at, fault.length.at(clock))});
    case FaultKind::Glitch:
      return disturb_wire(injected, number, {Disturbance::Effect::Inverts, at, later(at, fault.length.at(clock))});
    case FaultKind::Cut:
      return disturb_wire(injected, number, {Disturbance::Effect::Cuts, at, later(at, fault.lasts)});
    case FaultKind::Collision:
      return collide(injected, number, clock, at);
    default:
      return;
  }
}

/// The line is at space while either of the two stations is: where the other one marks, nothing changes.
void Faults::collide(Injected& injected, std::uint32_t number, const BitClock& clock, Time at) {
  const unsigned data_mask = clock.format.data_bits == 7 ? 0x7F : 0xFF;
  for (const std::uint8_t byte : uncalled_bytes(injected)) {
    const auto data = static_cast<std::uint8_t>(byte & data_mask);
    const unsigned levels = character_levels(clock.format, data, clock.format.parity_bit(data));
    const Time end = at + clock.character_time();
    happens(injected, {number++, at, end});
    for (int bit = 0; bit < first_stop_bit(clock.format); ++bit)
      if ((levels >> bit & 1U) == 0)
        line_.disturb({Disturbance::Effect::HoldsSpace, at + clock.bit_times(bit), at + clock.bit_times(bit + 1)});
    at = end;
  }
}

/// Draws bit by bit until one is to be inverted.
void Faults::plan_noise(Injected& injected, Time from) {
  const Time end = later(later(injected.at, injected.fault.from.value_or(0)), injected.fault.lasts);
  const Time bit = plc_format().bit_times(1);
  injected.hit = false;
  injected.next = from;
  for (int drawn = 0; drawn < kNoiseAhead && injected.next < end; ++drawn) {
    injected.hit = injected.chance.hits(injected.fault.error_rate);
    if (injected.hit) return;
    injected.next += bit;
  }
  if (injected.next >= end) injected.next = kNever;
}

void Faults::make_noise(Injected& injected) {
  const Time at = injected.next, end = at + plc_format().bit_times(1);
  const auto sending = [&](Half half) { return concerns(injected.fault, half) && at < state_.sent_until[index(half)]; };
  const bool heard = injected.fault.of == Half::Both || sending(Half::Request) || sending(Half::Answer);
  if (injected.hit && works_now(injected) && heard) {
    disturb_wire(injected, 0, {Disturbance::Effect::Inverts, at, end});
  }
  plan_noise(injected, injected.hit ? end : at);
}

void Faults::schedule() {
  Time next = kNever;
  for (const Injected& injected : state_.injected) next = std::min(next, injected.next);
  if (next == kNever) {
    queue_.cancel(owner_, kNext);
  } else {
    queue_.schedule(next, owner_, kNext);
  }
}

void Faults::handle(const Event& event) {
  for (Injected& injected : state_.injected) {
    if (injected.next > event.at) continue;
    if (injected.fault.kind == FaultKind::Noise) {
      make_noise(injected);
    } else {
      disturb(injected, 0, {plc_format()}, injected.next);
      injected.next = kNever;
    }
  }
  schedule();
}

std::int32_t Faults::clock_error(int driver) const {
  const Station station = answers(driver) ? Station::Plc : Station::Master;
  std::int32_t error = 0;
  for (const Injected& injected : state_.injected) {
    const Fault& fault = injected.fault;
    const bool is_its_own = injected.driver == driver || (injected.driver == kAnyDriver && fault.station == station);
    if (fault.kind == FaultKind::Baud && is_its_own && works_now(injected)) error += fault.clock_error;
  }
  return std::clamp(error, -Fault::kLargestClockError, Fault::kLargestClockError);
}

bool Faults::echoes(int driver) const {
  const bool master = !answers(driver);
  return std::any_of(state_.injected.begin(), state_.injected.end(), [&](const Injected& i) {
    const bool is_its_own = i.driver == driver || (i.driver == kAnyDriver && master);
    return i.fault.kind == FaultKind::Echo && is_its_own && works_now(i);
  });
}

}  // namespace s7200::serial

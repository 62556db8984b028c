#include "serial_sim/line/uart.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace s7200::serial {
namespace {

std::uint8_t data_of(std::uint8_t byte, const SerialFormat& format) {
  return format.data_bits == 7 ? static_cast<std::uint8_t>(byte & 0x7F) : byte;
}

/// The character whose bits have these levels at their centres, with the level of the start bit in bit 0.
ReceivedCharacter character_of(unsigned levels, const BitTimes& times, Time start, Time end) {
  const auto sample = [levels](int bit) { return (levels >> bit & 1U) != 0; };
  const SerialFormat& format = times.clock.format;
  const int stop_bit = times.stop_bit;
  ReceivedCharacter character;
  character.byte = static_cast<std::uint8_t>(levels >> 1 & ((1U << format.data_bits) - 1));
  const bool bit_before_stop = sample(stop_bit - 1);
  if (format.parity != Parity::None) character.parity_error = bit_before_stop != format.parity_bit(character.byte);
  character.framing_error = !sample(stop_bit);
  character.line_break = character.byte == 0 && !bit_before_stop && character.framing_error;
  character.start = start;
  character.end = end;
  return character;
}

}  // namespace

Uart::Uart(Line& line, EventQueue& queue, EventOwner owner, int driver, bool plugged_in)
    : line_(line), queue_(queue), owner_(owner), driver_(driver) {
  if (plugged_in) plug_in();
}

void Uart::plug_in() {
  if (!plugged_in_) line_.attach(*this);
  plugged_in_ = true;
}

Uart::~Uart() { line_.detach(*this); }

void Uart::configure(const SerialFormat& format, Time at) {
  state_.format = format;
  const bool verified = state_.receiving || (state_.certain && start_check() < at);
  if (!verified && state_.start_edge != kNever) await_start_edge();
}

void Uart::enable_receiver(bool enabled, Time at) {
  if (enabled == state_.receiver_enabled()) return;
  if (enabled) {
    abandon_character();
    state_.off_from = kNever;
    state_.listen_from = at;
    await_start_edge();
  } else {
    // The instant may lie ahead: what is sampled before it is still heard.
    state_.off_from = at;
    if (last_sample() >= at) {
      if (bystander_ && state_.start_edge < at && bystander_->looks())
        tell_missed(character_of_others(state_.start_edge, clock_of_character()), at);
      abandon_character();
    }
  }
}

void Uart::send(std::uint8_t byte, Time at) {
  const std::uint8_t data = data_of(byte, state_.format);
  put_character(character_levels(state_.format, data, state_.format.parity_bit(data)), at);
}

void Uart::send_with_wrong_parity(std::uint8_t byte, Time at) {
  assert(state_.format.parity != Parity::None);
  const std::uint8_t data = data_of(byte, state_.format);
  put_character(character_levels(state_.format, data, !state_.format.parity_bit(data)), at);
}

void Uart::send_without_stop_bit(std::uint8_t byte, Time at) {
  const std::uint8_t data = data_of(byte, state_.format);
  const unsigned stop_bit = 1U << first_stop_bit(state_.format);
  put_character(character_levels(state_.format, data, state_.format.parity_bit(data)) & ~stop_bit, at);
}

void Uart::send_break(int bit_times, Time at) {
  assert(bit_times > 0);
  begin_break(at);
  const Time end = at + BitClock{state_.format, clock_error()}.bit_times(bit_times);
  end_break(end, end);
}

void Uart::begin_break(Time at) {
  assert(!state_.sending && at >= state_.send_end);
  line_.drive(driver_, at, false);
  state_.sending = true;
  state_.send_end = kNever;
}

void Uart::end_break(Time at, Time sent) {
  line_.drive(driver_, at, true);
  sends_until(sent);
}

void Uart::begin_exchange(Time at) {
  if (line_.interference() != nullptr) line_.interference()->exchange_begins(driver_, at);
}

std::int32_t Uart::clock_error() const {
  return line_.interference() == nullptr ? 0 : line_.interference()->clock_error(driver_);
}

void Uart::put_character(unsigned levels, Time at) {
  assert(!state_.sending && at >= state_.send_end);
  if (line_.interference() != nullptr) return put_character_with_mishaps(levels, at);
  sends_until(drive_character(levels, {state_.format}, at));
}

void Uart::put_character_with_mishaps(unsigned levels, Time at) {
  const auto sent = static_cast<std::uint8_t>(levels >> 1 & (state_.format.data_bits == 7 ? 0x7FU : 0xFFU));
  const Mishap mishap = line_.interference()->character_begins(driver_, state_.format, sent, at);
  const BitClock clock{state_.format, clock_error()};
  at += mishap.delay;
  const auto levels_of = [&](std::uint8_t byte) {
    const std::uint8_t data = data_of(byte, clock.format);
    return character_levels(clock.format, data, clock.format.parity_bit(data));
  };
  for (const std::uint8_t byte : mishap.before) at = drive_character(levels_of(byte), clock, at);
  if (mishap.instead) levels = levels_of(*mishap.instead);
  at = mishap.lost ? at + clock.character_time() : drive_character(levels, clock, at);
  at += mishap.pause;
  for (const std::uint8_t byte : mishap.after) at = drive_character(levels_of(byte), clock, at);
  sends_until(at);
}

/// Returns its end. A character without stop bit takes a bit longer, at mark.
Time Uart::drive_character(unsigned levels, const BitClock& clock, Time at) {
  const BitTimes& times = times_of(clock, sending_times_);
  line_.drive(driver_, levels, times, at);
  const bool stops = (levels >> times.stop_bit & 1U) != 0;
  const Time end = at + times.begin_of_bit(times.bits + (stops ? 0 : 1));
  line_.occupy(driver_, at, end);
  return end;
}

/// The bit times of a clock, which are computed once for each clock.
const BitTimes& Uart::times_of(const BitClock& clock, BitTimes& known) {
  if (!(known.clock == clock)) known = BitTimes(clock);
  return known;
}

void Uart::sends_until(Time end) {
  state_.sending = true;
  state_.send_end = end;
  queue_.add(end, owner_, kSent);
}

Uart::Report Uart::handle(const Event& event) {
  Report report;
  switch (event.what) {
    case kStartCheck:
      check_start_bit(event.at);
      break;
    case kStopSample:
      report.received = take_character(event.at);
      break;
    case kSent:
      state_.sending = false;
      report.sent = event.at;
      break;
  }
  if (report.sent || report.received || line_.disturbed()) line_.forget(event.at);
  return report;
}

void Uart::line_changed(Time at) {
  const bool may_bring_an_earlier_start = !state_.receiving && at <= state_.start_edge && at < state_.off_from;
  const bool is_certain_no_more = state_.certain && at <= start_check();
  if (may_bring_an_earlier_start || is_certain_no_more) return await_start_edge();
  if (!state_.receiver_enabled() && bystander_ && bystander_->looks()) look_for_missed(at);
}

/// Another station begins a character, whose edges are all known, while the receiver is off and stays so.
void Uart::look_for_missed(Time at) {
  const bool stays_off = !state_.sending || at < state_.send_end;
  if (at < state_.off_from || at < missed_until_ || !stays_off || !others_space(at)) return;
  tell_missed(character_of_others(at, {state_.format}), at);
}

void Uart::tell_missed(ReceivedCharacter character, Time lost_at) {
  missed_until_ = character.end;
  character.end = lost_at;
  bystander_->missed(character);
}

/// The expected event has come: the receiver waits for the next start bit.
void Uart::listen_again(Time now) {
  state_.start_edge = kNever;
  state_.listen_from = now;
  await_start_edge();
}

void Uart::await_start_edge() {
  expect_nothing();
  state_.start_edge = line_.falling_edge(state_.listen_from, driver_);
  if (state_.start_edge == kNever) return listen_no_more();
  state_.clock_error = clock_error();
  const BitTimes& times = times_of({state_.format, state_.clock_error}, receiving_times_);
  const Time check = state_.start_edge + times.middle_of_bit(0);
  state_.certain = line_.has_start_bit_alone(state_.start_edge, check);
  if (state_.certain) return expect_stop_bit(times);
  expect(kStartCheck, check);
}

void Uart::expect_stop_bit(const BitTimes& times) {
  state_.receiving_as = times.clock;
  expect(kStopSample, state_.start_edge + times.middle_of_bit(times.stop_bit));
}

void Uart::check_start_bit(Time now) {
  if (line_.level(now, driver_)) return listen_again(now);
  state_.receiving = true;
  expect_stop_bit(times_of({state_.format, state_.clock_error}, receiving_times_));
}

ReceivedCharacter Uart::take_character(Time now) {
  const BitTimes& times = times_of(state_.receiving_as, receiving_times_);
  const unsigned levels = line_.levels(state_.start_edge, times, driver_);
  const ReceivedCharacter character = character_of(levels, times, state_.start_edge, now);
  listen_again(now);
  return character;
}

/// The character as the other stations send it, whether this UART sends or not.
ReceivedCharacter Uart::character_of_others(Time start, const BitClock& clock) const {
  const BitTimes& times = times_of(clock, receiving_times_);
  unsigned levels = 0;
  for (int bit = 0; bit <= times.stop_bit; ++bit)
    levels |= unsigned{line_.level_without(driver_, start + times.middle_of_bit(bit))} << bit;
  return character_of(levels, times, start, start + times.middle_of_bit(times.stop_bit));
}

void Uart::power_off(Time at) {
  line_.release(driver_, at);
  queue_.cancel(owner_, kSent);
  expect_nothing();
  state_ = {.format = state_.format};
  state_.send_end = state_.off_from = state_.listen_from = at;
}

/// The instant at which the awaited start bit is, or was, to be verified.
Time Uart::start_check() const {
  if (state_.start_edge == kNever) return kNever;
  return state_.start_edge + times_of(clock_of_character(), receiving_times_).middle_of_bit(0);
}

/// The last of its instants to come that is known: that of the stop bit once the start bit is certain.
Time Uart::last_sample() const { return state_.receiving || state_.certain ? character_due() : start_check(); }

BitClock Uart::clock_of_character() const {
  return state_.receiving || state_.certain ? state_.receiving_as : BitClock{state_.format, state_.clock_error};
}

Time Uart::character_due() const {
  if (state_.start_edge == kNever) return kNever;
  const BitClock clock = clock_of_character();
  const BitTimes& times = times_of(clock, receiving_times_);
  return state_.start_edge + times.middle_of_bit(times.stop_bit);
}

Time Uart::next_report() const { return std::min(state_.sending ? state_.send_end : kNever, character_due()); }

void Uart::expect(What what, Time at) {
  if (at < state_.off_from) {
    queue_.add(at, owner_, what);
  } else {
    abandon_character();
  }
}

/// An event is pending as long as there is a start edge.
void Uart::expect_nothing() {
  if (state_.start_edge != kNever) queue_.cancel(owner_, state_.receiving || state_.certain ? kStopSample : kStartCheck);
  state_.receiving = state_.certain = false;
  state_.start_edge = kNever;
}

void Uart::abandon_character() {
  expect_nothing();
  listen_no_more();
}

/// The receiver is switched off: it hears nothing from now on.
void Uart::listen_no_more() {
  if (!state_.receiver_enabled()) state_.listen_from = state_.off_from;
}

}  // namespace s7200::serial

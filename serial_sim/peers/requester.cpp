#include "serial_sim/peers/requester.hpp"

#include <algorithm>
#include <cassert>

namespace s7200::serial {

std::optional<Time> Exchange::latency() const {
  if (response.empty()) return std::nullopt;
  return response_start - request_end;
}

bool Exchange::parity_error() const {
  return std::any_of(response.begin(), response.end(), [](const ReceivedCharacter& c) { return c.parity_error; });
}

bool Exchange::framing_error() const {
  return std::any_of(response.begin(), response.end(), [](const ReceivedCharacter& c) { return c.framing_error; });
}

std::string_view Exchange::damage() const {
  if (too_long) return "an answer without end, cut off";
  if (of_another_master) return "the request of another master, and no answer";
  if (parity_error()) return "characters with wrong parity";
  if (framing_error()) return "characters with framing errors";
  return {};
}

Bytes bytes_of(const std::vector<ReceivedCharacter>& characters) {
  Bytes bytes;
  bytes.reserve(characters.size());
  for (const ReceivedCharacter& character : characters) bytes.push_back(character.byte);
  return bytes;
}

Requester::Requester(Uart& uart, EventQueue& queue, EventOwner owner) : uart_(uart), queue_(queue), owner_(owner) {}

void Requester::start(const Request& request, Time at) {
  assert(!busy() && !request.frame.empty());
  begin(request, at);
  state_.phase = Phase::Sending;
  state_.heard.clear();
  queue_.schedule(at, owner_, kBegin);
}

void Requester::begin(const Request& request, Time at) {
  state_.request = request;
  state_.sent = 0;
  Exchange& exchange = state_.exchange;
  exchange.response.clear();
  exchange.echo.clear();
  exchange.request = request.frame;
  exchange.request_start = at;
  exchange.request_end = exchange.response_start = exchange.response_end = 0;
  exchange.timed_out = exchange.too_long = exchange.given_up = exchange.of_another_master = exchange.early = false;
}

void Requester::listen(const Listening& listening, Time at) {
  assert(!busy());
  begin({.frame = {}, .timeout = listening.timeout, .silence = listening.silence}, at);
  state_.exchange.request_end = at;
  take_first_transmission();
  if (state_.exchange.response.empty()) {
    state_.phase = Phase::Waiting;
    queue_.schedule(at + listening.timeout, owner_, kQuiet);
    return;
  }
  const Time over = state_.exchange.response_end + silence();
  const bool goes_on = over > at || uart_.state().start_edge < over;
  if (!state_.heard.empty() || !goes_on) return;
  state_.phase = Phase::Receiving;
  queue_.schedule(std::max(at, over), owner_, kQuiet);
}

void Requester::take_first_transmission() {
  std::vector<ReceivedCharacter>& heard = state_.heard;
  Exchange& exchange = state_.exchange;
  const Time character_time = uart_.state().format.character_time();
  std::size_t length = 0;
  const auto goes_on = [&] {
    return length < heard.size() && (length == 0 || heard[length].start < exchange.response_end + silence());
  };
  while (goes_on() && length < kLongestResponse) exchange.response_end = heard[length++].start + character_time;
  exchange.too_long = goes_on();
  const auto end = heard.begin() + static_cast<std::ptrdiff_t>(length);
  exchange.response.assign(heard.begin(), end);
  heard.erase(heard.begin(), end);
  if (length > 0) exchange.response_start = exchange.response.front().start;
}

void Requester::handle(const Event& event) {
  switch (event.what) {
    case kBegin:
      uart_.begin_exchange(event.at);
      uart_.enable_receiver(uart_.hears_itself(), event.at);
      drive_sync(true, event.at);
      send_next(event.at);
      break;
    case kQuiet:
      quiet(event.at);
      break;
  }
}

void Requester::on(const Uart::Report& report, bool another_sends) {
  const bool of_request = state_.sent > 0;  // and not the last character of one that was given up
  if (report.received) take(*report.received, another_sends);
  if (report.sent && state_.phase == Phase::Sending && of_request) sent(*report.sent);
}

void Requester::take(const ReceivedCharacter& character, bool another_sends) {
  switch (state_.phase) {
    case Phase::Idle:
      if (character.start >= uart_.state().send_end && state_.heard.size() < kMostHeard) state_.heard.push_back(character);
      return;
    case Phase::Sending:
      if (character.start >= state_.exchange.request_start) state_.exchange.echo.push_back(character);
      return;
    case Phase::Waiting:
    case Phase::Receiving:
      return received(character, another_sends);
  }
}

void Requester::send_next(Time at) {
  const serial::FrameCharacter& character = state_.request.frame[state_.sent++];
  if (character.wrong_parity) {
    uart_.send_with_wrong_parity(character.byte, at);
  } else {
    uart_.send(character.byte, at);
  }
}

void Requester::sent(Time at) {
  if (state_.sent < state_.request.frame.size()) {
    send_next(at + state_.request.gap);
    return;
  }
  drive_sync(false, at);
  state_.exchange.request_end = at;
  state_.exchange.early = !uart_.hears_itself() && uart_.others_space(at - 1);
  state_.phase = Phase::Waiting;
  uart_.enable_receiver(true, at);
  queue_.schedule(at + state_.request.timeout, owner_, kQuiet);
}

void Requester::received(const ReceivedCharacter& character, bool another_sends) {
  Exchange& exchange = state_.exchange;
  if (exchange.response.size() == kLongestResponse) {
    exchange.too_long = true;
    state_.heard.push_back(character);
    finish();
    return;
  }
  if (exchange.response.empty()) {
    exchange.response_start = character.start;
    exchange.of_another_master = another_sends;
  }
  exchange.response.push_back(character);
  exchange.response_end = character.start + uart_.state().format.character_time();
  state_.phase = Phase::Receiving;
  queue_.schedule(exchange.response_end + silence(), owner_, kQuiet);
}

/// The line has been quiet for as long as was to be waited, unless a character is just coming in: then it is waited for,
/// bit by bit, because a glitch is never reported.
void Requester::quiet(Time now) {
  const bool coming_in = uart_.state().start_edge < now;
  if (coming_in) {
    queue_.schedule(now + uart_.state().format.bit_times(1), owner_, kQuiet);
    return;
  }
  state_.exchange.timed_out = state_.exchange.response.empty();
  finish();
}

void Requester::finish() {
  queue_.cancel(owner_, kQuiet);
  state_.phase = Phase::Idle;
}

void Requester::give_up(Time at) {
  if (!busy()) return;
  const bool has_begun = state_.phase == Phase::Sending && state_.sent > 0;
  if (has_begun) {
    drive_sync(false, at);
    uart_.enable_receiver(true, std::max(at, uart_.state().send_end));
  }
  queue_.cancel(owner_, kBegin);
  state_.exchange.given_up = true;
  finish();
}

void Requester::power_off(Time at) {
  if (state_.phase == Phase::Sending) drive_sync(false, at);
  queue_.cancel(owner_, kBegin);
  finish();
  state_.heard.clear();
}

void Requester::drive_sync(bool high, Time at) const {
  if (state_.request.sync && sync_wire_) sync_wire_(high, at);
}

Time Requester::silence() const { return state_.request.silence.value_or(uart_.state().format.silence()); }

}  // namespace s7200::serial

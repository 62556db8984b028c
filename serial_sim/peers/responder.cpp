#include "serial_sim/peers/responder.hpp"

#include <utility>

namespace s7200::serial {

Responder::Responder(Uart& uart, EventQueue& queue, EventOwner owner, std::unique_ptr<Automaton> automaton)
    : uart_(uart), queue_(queue), owner_(owner), state_{AutomatonValue(std::move(automaton))} {
  uart_.configure(state_.automaton->format(), 0);
}

void Responder::sync(bool high, Time at) {
  state_.automaton->sync(high, at);
  look();
}

void Responder::power_off(Time at) {
  state_.automaton->reset(at);
  queue_.cancel(owner_, kSend);
  queue_.cancel(owner_, kWake);
  state_.transmission = {};
  state_.sent = 0;
}

void Responder::power_on(Time at) {
  uart_.configure(state_.automaton->format(), at);
  state_.automaton->reset(at);
}

void Responder::on(const Uart::Report& report) {
  if (report.received && !(sending() && is_own(*report.received))) {
    state_.automaton->hear(*report.received);
    look();
  }
  if (!report.sent) return;
  if (state_.sent < state_.transmission.bytes.size()) return send_next(*report.sent);
  uart_.enable_receiver(true, *report.sent);
}

void Responder::handle(const Event& event) {
  switch (event.what) {
    case kSend:
      if (!state_.automaton->full_duplex()) uart_.enable_receiver(uart_.hears_itself(), event.at);
      return send_next(event.at);
    case kWake:
      // A character that has begun counts: it is waited for bit by bit, because a glitch is never reported.
      if (uart_.state().start_edge < event.at)
        return queue_.schedule(event.at + uart_.state().format.bit_times(1), owner_, kWake);
      state_.automaton->wake(event.at);
      return look();
  }
}

bool Responder::is_own(const ReceivedCharacter& character) const {
  return character.byte == state_.on_the_line && !character.parity_error && !character.framing_error;
}

void Responder::send_next(Time at) {
  if (state_.sent == state_.transmission.bytes.size()) return;
  state_.on_the_line = state_.transmission.bytes[state_.sent++];
  uart_.send(state_.on_the_line, at);
}

/// Does what the automaton asks for after it has been told something.
void Responder::look() {
  if (state_.automaton->take_abort()) {
    queue_.cancel(owner_, kSend);
    state_.transmission.bytes.resize(state_.sent);
  }
  if (auto transmission = state_.automaton->take_answer(); transmission && !sending()) {
    state_.transmission = std::move(*transmission);
    state_.sent = 0;
    queue_.schedule(state_.transmission.at, owner_, kSend);
  }
  if (state_.automaton->due() == kNever)
    queue_.cancel(owner_, kWake);
  else
    queue_.schedule(state_.automaton->due(), owner_, kWake);
}

}  // namespace s7200::serial

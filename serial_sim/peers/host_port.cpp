#include "serial_sim/peers/host_port.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace s7200::serial {

HostPort::HostPort(Uart& uart) : uart_(uart) { uart_.enable_receiver(false, 0); }

void HostPort::attach(const SerialFormat& format, Time at) {
  assert(!state_.attached);
  note({.what = HostCall::What::Attach, .format = format, .characters = {}});
  receive_as(format, at);
  state_.attached = true;
  uart_.plug_in();
  uart_.enable_receiver(true, at);
}

void HostPort::receive_as(const SerialFormat& format, Time at) {
  if (state_.format == format && uart_.state().format == format) return;
  const bool changes = state_.format != format || !sending();
  if (state_.attached && changes) note({.what = HostCall::What::ReceiveAs, .format = format, .characters = {}});
  state_.format = format;
  if (!sending()) uart_.configure(format, at);
}

void HostPort::send(std::span<const HostCharacter> characters, Time at) {
  assert(state_.attached);
  note({.what = HostCall::What::Send, .characters = {characters.begin(), characters.end()}});
  state_.to_send.insert(state_.to_send.end(), characters.begin(), characters.end());
  for (const HostCharacter& character : characters) ++state_.waiting[character.sender];
  if (sending() || state_.to_send.empty()) return;
  send_next(at);
  uart_.enable_receiver(uart_.hears_itself(), at);
}

void HostPort::send_next(Time at) {
  const HostCharacter character = state_.to_send.front();
  state_.to_send.pop_front();
  if (const auto waiting = state_.waiting.find(character.sender); --waiting->second == 0) state_.waiting.erase(waiting);
  uart_.configure(character.format, at);
  switch (character.fault) {
    case HostCharacter::Fault::None:
      return uart_.send(character.byte, at);
    case HostCharacter::Fault::WrongParity:
      return uart_.send_with_wrong_parity(character.byte, at);
    case HostCharacter::Fault::NoStopBit:
      return uart_.send_without_stop_bit(character.byte, at);
    case HostCharacter::Fault::Break:
      return send_break(character, at);
  }
}

void HostPort::send_break(const HostCharacter& character, Time at) {
  uart_.begin_break(at);
  if (character.lasts > 0)
    finish_break(at + character.lasts);
  else
    state_.held_break = {character.sender, at};
}

void HostPort::finish_break(Time end) { uart_.end_break(end, end + mark_after_break(uart_.state().format)); }

void HostPort::end_break(std::uint64_t sender, Time lasts, Time at) {
  note({.what = HostCall::What::EndBreak, .characters = {}, .sender = sender, .lasts = lasts});
  if (state_.held_break && state_.held_break->sender == sender) {
    const Time end = state_.held_break->since + std::max(lasts, shortest_break(uart_.state().format));
    state_.held_break.reset();
    return finish_break(std::max(at, end));
  }
  const auto waiting = std::ranges::find_if(state_.to_send, [&](const HostCharacter& character) {
    return character.fault == HostCharacter::Fault::Break && character.sender == sender && character.lasts == 0;
  });
  if (waiting != state_.to_send.end()) waiting->lasts = std::max(lasts, shortest_break(waiting->format));
}

std::size_t HostPort::waiting(std::uint64_t sender) const {
  const auto found = state_.waiting.find(sender);
  return found == state_.waiting.end() ? 0 : found->second;
}

std::size_t HostPort::drop(std::uint64_t sender) {
  if (waiting(sender) != 0) note({.what = HostCall::What::Drop, .characters = {}, .sender = sender});
  state_.waiting.erase(sender);
  return std::erase_if(state_.to_send, [&](const HostCharacter& character) { return character.sender == sender; });
}

std::vector<ReceivedCharacter> HostPort::take_received() {
  if (!state_.received.empty()) note({.what = HostCall::What::TakeReceived, .characters = {}});
  return std::exchange(state_.received, {});
}

void HostPort::repeat(const HostCall& call, Time at) {
  HostJournal* const journal = std::exchange(journal_, nullptr);
  switch (call.what) {
    case HostCall::What::Attach:
      attach(call.format, at);
      break;
    case HostCall::What::ReceiveAs:
      receive_as(call.format, at);
      break;
    case HostCall::What::Send:
      send(call.characters, at);
      break;
    case HostCall::What::Drop:
      drop(call.sender);
      break;
    case HostCall::What::TakeReceived:
      take_received();
      break;
    case HostCall::What::EndBreak:
      end_break(call.sender, call.lasts, at);
      break;
  }
  journal_ = journal;
}

void HostPort::on(const Uart::Report& report) {
  if (report.received) state_.received.push_back(*report.received);
  if (!report.sent) return;
  if (!state_.to_send.empty()) return send_next(*report.sent);
  uart_.configure(state_.format, *report.sent);
  uart_.enable_receiver(true, *report.sent);
}

}  // namespace s7200::serial

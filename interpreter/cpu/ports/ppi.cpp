#include "interpreter/cpu/ports/ppi.hpp"

#include <algorithm>
#include <cassert>
#include <optional>
#include <span>
#include <utility>

#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/cpu/network.hpp"
#include "interpreter/cpu/ports/s7_services.hpp"
#include "interpreter/cpu/scan.hpp"

namespace s7200::ppi {
namespace {

using Job = PpiPort::Job;

constexpr std::size_t kShortestWithBody = 6;

void reply(Core& core, std::uint8_t number, std::uint8_t to, Reply function, std::span<const std::uint8_t> data,
           Time reply_at) {
  send(core, number, to_frame({to, core.s.station[number], function, data}), reply_at);
}

void accept(Core& core, std::uint8_t number, Time reply_at) { send(core, number, std::array{kAccepted}, reply_at); }

/// Whether a request or a poll that came at `at` has to wait: the port works for one master at a time.
bool has_no_resource(const Core& core, std::uint8_t number, const Body& body, Time at) {
  const PpiPort& port = core.s.ppi[number];
  const bool works = (port.job == Job::Waiting || port.job == Job::Ready) && at - port.asked < kPatienceOfMasters;
  const bool is_second = port.master == body.source && !body.data.empty();
  return works &&
         (port.master != body.source || (is_second && core.program().system_block.second_request == SecondRequest::Refused));
}

void take_request(Core& core, std::uint8_t number, const Body& body, Time reply_at) {
  PpiPort& port = core.s.ppi[number];
  if (port.job == Job::Ready) port.wanted_mode.reset();
  port.job = Job::Waiting;
  port.master = body.source;
  port.length = static_cast<std::uint8_t>(body.data.size());
  std::copy(body.data.begin(), body.data.end(), port.message.begin());
  accept(core, number, reply_at);
}

void take_poll(Core& core, std::uint8_t number, const Body& body, Time reply_at) {
  PpiPort& port = core.s.ppi[number];
  const bool frame_count = (body.function & kFrameCount) != 0;
  const bool again = port.job == Job::Delivered && port.frame_count == frame_count;
  if (port.master != body.source || !(port.job == Job::Ready || again)) {
    if (port.job == Job::Delivered && port.master == body.source) port.job = Job::None;
    return accept(core, number, reply_at);
  }
  port.job = Job::Delivered;
  port.frame_count = frame_count;
  reply(core, number, port.master, kData, {port.message.data(), port.length}, reply_at);
}

void trace_unmodelled(const Core& core, std::uint8_t number, PpiUnmodelled what, std::uint8_t source,
                      std::uint8_t destination, Time at) {
  core.trace({.at = at,
              .kind = TraceKind::PpiNotModelled,
              .event = source,
              .byte = destination,
              .port = number,
              .code = static_cast<std::uint16_t>(what)});
}

void pass_by(const Core& core, std::uint8_t number, const Body& body, Time at) {
  const bool asks = (body.function & kIsRequest) != 0;
  const auto trace = [&](PpiUnmodelled what) { trace_unmodelled(core, number, what, body.source, body.destination, at); };
  if (body.destination == kEveryStation) return trace(PpiUnmodelled::Broadcast);
  if (asks && network::is_master(core, number)) trace(PpiUnmodelled::AnotherMaster);
}

/// Takes a frame whose last character has come at `at`.
void take_frame(Core& core, std::uint8_t number, std::span<const std::uint8_t> frame, Time at, Time reply_at) {
  const std::uint8_t own = core.s.station[number];
  if (const auto token = token_of(frame)) {
    if (token->destination == own)
      trace_unmodelled(core, number, PpiUnmodelled::Token, token->source, token->destination, at);
    return;
  }
  const auto body = body_of(frame);
  if (!body) {
    if (frame.size() < kShortestWithBody) return network::heard(core, number, frame, reply_at);
    network::heard_damaged(core, number);
    core.trace({.at = at, .kind = TraceKind::PpiIgnored, .port = number, .count = frame.size()});
    return;
  }
  if (((body->destination | body->source) & kExtension) != 0) {
    if ((body->destination & ~kExtension) == own)
      trace_unmodelled(core, number, PpiUnmodelled::ExtendedAddress, body->source, body->destination, at);
    return;
  }
  if (body->destination != own) return pass_by(core, number, *body, at);
  if ((body->function & kIsRequest) == 0) return network::heard(core, number, frame, reply_at);
  switch (body->function & kService) {
    case kStatus:
      return reply(core, number, body->source, kSlave, {}, reply_at);
    case kAnswerLow:
    case kAnswerHigh:
      if (has_no_resource(core, number, *body, at)) return reply(core, number, body->source, kNoResource, {}, reply_at);
      if (!body->data.empty() || body->source == core.s.ppi[number].master) core.s.ppi[number].asked = at;
      return body->data.empty() ? take_poll(core, number, *body, reply_at) : take_request(core, number, *body, reply_at);
    default:
      return reply(core, number, body->source, kNoService, {}, reply_at);
  }
}

/// Takes a character, which may be the last of a frame, or show that this is none.
void take_character(Core& core, std::uint8_t number, const ReceivedCharacter& character) {
  PpiPort& port = core.s.ppi[number];
  port.frame[port.received++] = character.byte;
  const std::span<const std::uint8_t> frame(port.frame.data(), port.received);
  const auto length = frame_length(frame);
  port.lost = character.parity_error || character.framing_error || length == 0U;
  if (port.lost || length != port.received) return;
  port.received = 0;
  const SerialFormat format = format_of(core.program(), number);
  const Time reply_at = character.end + format.half_bits(1) + format.bit_times(kBitsToReply);
  take_frame(core, number, Bytes(frame.begin(), frame.end()), character.end, reply_at);
}

bool answer_has_left(const PpiPort& port) {
  return port.job != Job::Ready && !(port.job == Job::Delivered && port.sending != 0);
}

void change_mode(Core& core, std::uint8_t number) {
  const Mode wanted = *std::exchange(core.s.ppi[number].wanted_mode, std::nullopt);
  scan::change_mode(core, wanted);
}

void carry_out(Core& core, std::uint8_t number) {
  PpiPort& port = core.s.ppi[number];
  const Bytes request(port.message.begin(), port.message.begin() + port.length);
  const Bytes answer = s7_services::carry_out(core, number, port.master, request);
  port.job = answer.empty() ? Job::None : Job::Ready;
  if (answer.empty())
    trace_unmodelled(core, number, PpiUnmodelled::NoRequest, port.master, core.s.station[number], core.s.time);
  assert(answer.size() <= port.message.size());
  port.length = static_cast<std::uint8_t>(answer.size());
  std::copy(answer.begin(), answer.end(), port.message.begin());
}

}  // namespace

SerialFormat format_of(const Program& program, std::uint8_t port) {
  SerialFormat format = kFormat;
  format.baud = program.system_block.ppi_rates[port];
  return format;
}

void send(Core& core, std::uint8_t number, std::span<const std::uint8_t> frame, Time at) {
  PpiPort& port = core.s.ppi[number];
  std::copy(frame.begin(), frame.end(), port.frame.begin());
  port.sending = static_cast<std::uint16_t>(frame.size());
  port.sent = 0;
  core.port(number).enable_receiver(false, at);
  if (core.s.port[number].on_wire != OnWire::Nothing) return;
  core.s.port[number].on_wire = OnWire::Ppi;
  core.port(number).send(port.frame[port.sent++], at);
}

void begin(Core& core, std::uint8_t number, Time at) {
  core.s.ppi[number] = {.heard = at};
  core.port(number).configure(format_of(core.program(), number), at);
  core.port(number).enable_receiver(true, at);
}

void end(Core& core, std::uint8_t number) { core.s.ppi[number] = {}; }

void character_received(Core& core, std::uint8_t number, const ReceivedCharacter& character) {
  PpiPort& port = core.s.ppi[number];
  if (character.start - port.heard >= format_of(core.program(), number).bit_times(kBitsOfSilence)) {
    port.received = 0;
    port.lost = false;
  }
  port.heard = character.end;
  const bool lost_before = port.lost;
  if (!port.lost) take_character(core, number, character);
  if (port.lost) network::heard_damaged(core, number);
  if (port.lost)
    core.trace({.at = character.end,
                .kind = TraceKind::CharacterIgnored,
                .byte = character.byte,
                .parity_error = character.parity_error,
                .framing_error = character.framing_error,
                .port = number,
                .code = static_cast<std::uint16_t>(Ignored::NoPpiFrame),
                .count = lost_before ? 1U : 0U,
                .since = character.start});
}

void character_sent(Core& core, std::uint8_t number, Time at) {
  PpiPort& port = core.s.ppi[number];
  if (port.sent < port.sending) {
    core.s.port[number].on_wire = OnWire::Ppi;
    return core.port(number).send(port.frame[port.sent++], at);
  }
  port.sending = 0;
  port.received = 0;
  port.lost = false;  // what is heard now is a reply, however soon it comes
  port.heard = at;
  core.port(number).enable_receiver(true, at);
}

void communicate(Core& core, std::uint8_t number) {
  const PpiPort& port = core.s.ppi[number];
  if (port.wanted_mode && answer_has_left(port)) change_mode(core, number);
  if (port.job == Job::Waiting) carry_out(core, number);
}

}  // namespace s7200::ppi

// Which characters did no routine get, and what has kept them from it?
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/model/ports.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/causes/inquiry.hpp"
#include "tools/session/causes/last/last_attachment.hpp"
#include "tools/session/causes/last/last_turn.hpp"
#include "tools/session/causes/last/last_write.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// The instruction after which `holds` has been true up to a character that nobody wanted, which had ended at `until`: one
/// that ends later is none of it.
std::optional<LastTurn> turn_before(Inquiry& inquiry, Time until, const std::function<bool(const State& state)>& holds) {
  if (!inquiry.history().go_to(until)) return inquiry.answers.interrupted = true, std::nullopt;
  for (;;) {
    const TurnSearch search = find_last_turn(inquiry.history(), inquiry.station(), holds, inquiry.stop_request());
    inquiry.answers.interrupted |= search.interrupted;
    if (!search.turn || search.turn->at <= until) return search.turn;
    inquiry.history().go_to(search.turn->moment);
  }
}

/// Whether an instruction may attach the receive event of a port, or receive there with RCV.
bool may_hear(const Program& program, std::size_t port) {
  return std::ranges::any_of(program.ops, [&](const Op& op) {
    const bool attaches = op.instruction->structure == Structure::Attach && op[1].at == kPorts[port].received;
    return attaches || (op.instruction->effect == Effect::Receives && op[1].at == port);
  });
}

/// A write that is over later than `until` is none of it.
WriteSearch write_before(Inquiry& inquiry, const MemoryRange& range, Time until) {
  for (;;) {
    WriteSearch search = find_last_write(inquiry.history(), inquiry.station(), range, inquiry.stop_request());
    inquiry.answers.interrupted |= search.interrupted;
    if (!search.write || search.write->at <= until) return search;
    inquiry.history().go_to(search.write->moment);
  }
}

/// As far as nothing has changed it: what was written last, though it was so before.
Keeper what_attached_nothing(Inquiry& inquiry, std::uint8_t event, Time until) {
  const AttachmentSearch search = find_last_attachment(inquiry.history(), inquiry.station(), event, inquiry.stop_request());
  inquiry.answers.interrupted |= search.interrupted;
  if (search.interrupted) return {};
  if (search.attachment) return inquiry.kept_by(search.attachment->moment, search.attachment->by, "detached");
  Keeper keeper{.text = "; no instruction has attached it " + since_oldest_text(inquiry.history())};
  const auto port = std::ranges::find_if(kPorts, [&](const PortInfo& one) { return one.received == event; });
  if (port == kPorts.end() || may_hear(inquiry.program(), static_cast<std::size_t>(port - kPorts.begin()))) return keeper;
  keeper.text += fmt::format(", and the program has no ATCH for event {} and no RCV", event);
  const MemoryRange control = range_at(port->control, Width::Byte, *inquiry.program().model).value();
  const WriteSearch freeport = write_before(inquiry, control, until);
  if (!freeport.write || !freeport.write->by) return keeper;
  Keeper setter = inquiry.kept_by(freeport.write->moment, *freeport.write->by,
                                  fmt::format("{}, which puts the port in Freeport mode, was set", control.name_of(0)));
  setter.text.insert(0, keeper.text);
  return setter;
}

Keeper what_detached(Inquiry& inquiry, std::uint8_t event, Time until) {
  const auto turn = turn_before(inquiry, until, [&](const State& state) { return state.attached[event] == kNotAttached; });
  if (inquiry.answers.interrupted) return {};
  if (!turn) return what_attached_nothing(inquiry, event, until);
  if (!turn->by) return {.text = "; the CPU has been in STOP since it was"};
  return inquiry.kept_by(turn->moment, *turn->by, "detached");
}

Keeper what_wrote_ppi_mode(Inquiry& inquiry, const MemoryRange& control, Time until) {
  const WriteSearch search = write_before(inquiry, control, until);
  if (search.interrupted) return {};
  const std::string name = control.name_of(0);
  if (!search.write) return {.text = fmt::format("; nothing has written {} {}", name, since_oldest_text(inquiry.history()))};
  if (!search.write->by)
    return {.text = fmt::format("; {} was set from outside at {}", name, moment_text(search.write->at))};
  return inquiry.kept_by(search.write->moment, *search.write->by, name + " was set");
}

Keeper what_left_freeport(Inquiry& inquiry, std::uint8_t port, Time until) {
  const auto turn = turn_before(inquiry, until, [&](const State& state) { return !state.port[port].active; });
  if (inquiry.answers.interrupted) return {};
  if (inquiry.here().cpu().state().mode == Mode::Stop) return {.text = "; the CPU is in STOP"};
  const MemoryRange control = range_at(kPorts[port].control, Width::Byte, *inquiry.program().model).value();
  if (turn && turn->by) return inquiry.kept_by(turn->moment, *turn->by, control.name_of(0) + " was set");
  return what_wrote_ppi_mode(inquiry, control, until);
}

Keeper what_kept_in_ppi_mode(Inquiry& inquiry, const TraceRecord& ignored) {
  if (inquiry.stopped() && ignored.at >= *inquiry.stopped()) return {.text = "; the CPU is in STOP"};
  return what_left_freeport(inquiry, ignored.port, ignored.at);
}

/// A break that RCV asks for is dropped too: with it the start of the message has come. Leaves the simulation where it came.
bool is_awaited_break(Inquiry& inquiry, const TraceRecord& untaken) {
  if (untaken.kind != TraceKind::CharacterDropped || !untaken.framing_error || untaken.byte != 0) return false;
  if (!inquiry.history().go_to(untaken.at)) return inquiry.answers.interrupted = true, false;
  return (inquiry.here().cpu().state().port[untaken.port].message.control & sm::message::kFromBreak) != 0;
}

/// RCV had not found the start of its message when the character had ended; after a break that it asks for it may have gone
/// on since.
Keeper what_was_searched(Inquiry& inquiry, const TraceRecord& dropped) {
  const bool is_awaited = is_awaited_break(inquiry, dropped);
  if (!inquiry.history().go_to(is_awaited ? inquiry.start().time : dropped.at))
    return inquiry.answers.interrupted = true, Keeper{};
  const MessageReceiver& message = inquiry.here().cpu().state().port[dropped.port].message;
  if (message.phase != MessageReceiver::Phase::Search) return {.text = ignored_because(dropped)};
  Keeper keeper = inquiry.kept_by_rcv(dropped.port);
  keeper.text = "RCV waits for " + keeper.text;
  return keeper;
}

/// Whether RCV has found the start of its message by now.
bool has_begun_since(Inquiry& inquiry, std::uint8_t port) {
  return inquiry.here_at_start().cpu().state().port[port].message.phase != MessageReceiver::Phase::Search;
}

/// The reason why nobody got the character, with what has detached their event, ended the last RCV or left Freeport mode,
/// which also ends in STOP.
Keeper what_kept(Inquiry& inquiry, const TraceRecord& untaken) {
  if (untaken.kind == TraceKind::CharacterDropped) return what_was_searched(inquiry, untaken);
  const Ignored why{untaken.code};
  Keeper keeper = why == Ignored::NotAttached  ? what_detached(inquiry, kPorts[untaken.port].received, untaken.at)
                  : why == Ignored::NoRcvWaits ? what_ended_receiving(inquiry, untaken)
                  : why == Ignored::NoPpiFrame ? what_kept_in_ppi_mode(inquiry, untaken)
                                               : Keeper{};
  keeper.text = ignored_because(untaken) + keeper.text;
  return keeper;
}

/// PPI takes characters for its own as long as they may be a frame of it. One for this station it has heard; why it gives no
/// answer to that is not known here.
void find_port_in_ppi_mode(Inquiry& inquiry) {
  const AskedRequest& request = *inquiry.request();
  if (const auto body = ppi::body_of(request.frame)) {
    const std::uint8_t own = inquiry.here().cpu().state().station[request.port];
    if (body->destination != own)
      inquiry.add(
          request.end,
          fmt::format("the request was for PPI station {}; port {} is station {}", body->destination, request.port, own),
          {});
    return;
  }
  const Keeper keeper = what_left_freeport(inquiry, request.port, request.end);
  inquiry.add(request.end, fmt::format("no answer: port {} is in PPI mode{}", request.port, keeper.text), keeper);
}

}  // namespace

void find_characters_untaken(Inquiry& inquiry) {
  for (const auto& [first, characters, end] : inquiry.witness().line.untaken()) {
    if (first.at < inquiry.since()) continue;
    if (is_awaited_break(inquiry, first) && has_begun_since(inquiry, first.port)) continue;
    const Keeper kept = what_kept(inquiry, first);
    inquiry.add(first.at, inquiry.left_text({.characters = characters, .since = first.since, .decided_by = kept.text}),
                kept);
  }
  if (!inquiry.has_unanswered() || !inquiry.answers.unanswered.empty()) return;
  if (!inquiry.history().go_to(inquiry.request()->end)) return void(inquiry.answers.interrupted = true);
  const serial::Simulation& then = inquiry.here();
  if (then.plc().powered() && !then.cpu().state().port[inquiry.port()].active) find_port_in_ppi_mode(inquiry);
}

}  // namespace s7200::tools

#include "interpreter/cpu/ports/message_receiver.hpp"

#include <algorithm>

#include "interpreter/cpu/interrupts.hpp"
#include "interpreter/cpu/ports/freeport.hpp"
#include "interpreter/cpu/units.hpp"

namespace s7200::message_receiver {
namespace {

using namespace sm::message;
using Phase = MessageReceiver::Phase;

std::uint8_t timer_of(std::uint8_t port) { return static_cast<std::uint8_t>(kMessageTimer0 + port); }

void start_timer(Core& core, std::uint8_t port, Time from, Time duration) {
  const Time tick = core.by_own_clock(kMillisecond);
  const Time passed = (from + core.by_own_clock(duration) + tick - 1) / tick * tick;
  const Time next_tick = (from / tick + 1) * tick;
  core.schedule(std::max(passed, next_tick), timer_of(port));
}

MessageReceiver parameters(const Core& core, std::uint8_t port, std::uint32_t table) {
  const std::uint8_t* const sm = &core.s.image[kPorts[port].message];
  return {.phase = Phase::Search,
          .control = static_cast<std::uint8_t>(sm[kControl] & core.model().message_control),
          .start_character = sm[kStartCharacter],
          .end_character = sm[kEndOfMessage],
          .most = sm[kMost],
          .idle_time = load16(sm + kIdleTime) * kMillisecond,
          .timeout = load16(sm + kTimeout) * kMillisecond,
          .table = table};
}

bool asks_for_silence(const MessageReceiver& m) { return (m.control & kFromIdleLine) && m.idle_time > 0; }

/// The receiver takes any character as the start of the message, so that the start condition is met when RCV is executed.
bool takes_any_character(const MessageReceiver& m) {
  return (m.control & kFromIdleLine) && m.idle_time == 0 && !(m.control & kFromStart);
}

bool times_from_the_beginning(const MessageReceiver& m) {
  return takes_any_character(m) && (m.control & kTimed) && (m.control & kWholeMessage);
}

/// Whether the next character can be the first one of the message.
bool may_start(const MessageReceiver& m, const ReceiveChoices& choices) {
  const bool idle = !asks_for_silence(m) || m.was_idle;
  switch (m.control & (kFromIdleLine | kFromBreak)) {
    case kFromIdleLine:
      return idle;
    case kFromBreak:
      return m.had_break;
    case kFromIdleLine | kFromBreak:
      return choices.idle_or_break ? idle || m.had_break : idle && m.had_break;
    default:
      return true;
  }
}

bool is_bad(const ReceivedCharacter& character) { return character.parity_error || character.framing_error; }

void end(Core& core, std::uint8_t port, std::uint8_t status, Time at, bool raises_event = true) {
  MessageReceiver& m = core.s.port[port].message;
  m.phase = Phase::Off;
  core.cancel(timer_of(port));
  core.s.image[kPorts[port].message] = status;
  core.trace({.at = at, .kind = TraceKind::ReceiveEnd, .byte = status, .port = port, .count = m.stored});
  if (raises_event) interrupts::occurred(core, kPorts[port].received_message, at);
}

/// A character before the message. A break starts the search for the idle line again only if it is not itself the start.
void drop(Core& core, std::uint8_t port, const ReceivedCharacter& character) {
  MessageReceiver& m = core.s.port[port].message;
  freeport::trace_character(core, port, character, TraceKind::CharacterDropped);
  const bool awaited_break = character.line_break && (m.control & kFromBreak);
  m.had_break = awaited_break;
  m.was_idle = m.was_idle && awaited_break;
  if (asks_for_silence(m) && !m.was_idle) start_timer(core, port, character.end, m.idle_time);
}

/// The table may lie in special memory, over the control byte of a port.
void store(Core& core, MessageReceiver& m, std::uint8_t byte) {
  core.s.image[m.table + ++m.stored] = byte;
  core.s.image[m.table] = m.stored;
  freeport::follow_control(core);
}

bool is_end(const MessageReceiver& m, std::uint8_t byte, const ReceiveChoices& choices) {
  if (!(m.control & kHasEnd) || byte != m.end_character) return false;
  const bool is_start = m.stored == 1 && (m.control & kFromStart);
  return !is_start || choices.start_may_end;
}

void run_timer(Core& core, std::uint8_t port, Time at) {
  const MessageReceiver& m = core.s.port[port].message;
  if (!(m.control & kTimed) || times_from_the_beginning(m)) return;
  if (m.stored == 1 || !(m.control & kWholeMessage)) start_timer(core, port, at, m.timeout);
}

void add(Core& core, std::uint8_t port, const ReceivedCharacter& character) {
  MessageReceiver& m = core.s.port[port].message;
  const ReceiveChoices& choices = core.model().receive;
  freeport::trace_character(core, port, character, TraceKind::CharacterReceived);
  if (is_bad(character)) {
    if (choices.stores_bad_character && !character.line_break) store(core, m, character.byte);
    return end(core, port, kParity, character.end);
  }
  store(core, m, character.byte);
  if (!active(core, port)) return;
  std::uint8_t status = is_end(m, character.byte, choices) ? kEndCharacter : 0;
  if (m.stored >= m.most && (status == 0 || choices.end_and_count)) status |= kCount;
  if (status != 0) return end(core, port, status, character.end);
  run_timer(core, port, character.end);
}

bool starts(const MessageReceiver& m, const ReceivedCharacter& character, const ReceiveChoices& choices) {
  if (character.line_break || !may_start(m, choices)) return false;
  return !(m.control & kFromStart) || (character.byte == m.start_character && !is_bad(character));
}

}  // namespace

void receive(Core& core, std::uint8_t port, std::uint32_t table) {
  State& s = core.s;
  const PortInfo& info = kPorts[port];
  const ReceiveChoices& choices = core.model().receive;
  const MessageReceiver asked = parameters(core, port, table);
  const bool ends = !(asked.control & kEnable) && active(core, port);
  if (!ends && !freeport::free(core, port)) return core.run_error(info.busy);
  core.attend();
  if (ends) return end(core, port, kUser, s.time, choices.event_after_user_end);
  if (!(asked.control & kEnable)) {
    s.image[info.message] = kUser;
    return;
  }
  const bool has_start = asked.control & (kFromIdleLine | kFromStart | kFromBreak);
  if (!has_start || asked.most == 0) {
    s.port[port].message = {};
    return end(core, port, kParameters, s.time, choices.event_after_bad_parameters);
  }
  if (!core.in_area(table, asked.most + 1u)) return core.run_error(RunError::OperandRange);
  s.port[port].message = asked;
  s.image[info.message] = 0;
  s.image[table] = 0;
  core.trace({.at = s.time, .kind = TraceKind::Receive, .port = port, .op = core.loop.op, .count = asked.most});
  if (asks_for_silence(asked)) start_timer(core, port, s.time, asked.idle_time);
  if (times_from_the_beginning(asked)) start_timer(core, port, s.time, asked.timeout);
}

bool active(const Core& core, std::uint8_t port) { return core.s.port[port].message.phase != Phase::Off; }

void take(Core& core, std::uint8_t port, const ReceivedCharacter& character) {
  MessageReceiver& m = core.s.port[port].message;
  if (m.phase == Phase::Search) {
    if (!starts(m, character, core.model().receive)) return drop(core, port, character);
    m.phase = Phase::Message;
    if (!times_from_the_beginning(m)) core.cancel(timer_of(port));
  }
  add(core, port, character);
}

void abandon(Core& core, std::uint8_t port) {
  core.s.port[port].message = {};
  core.cancel(timer_of(port));
}

void enter_stop(Core& core) {
  for (std::uint8_t port = 0; port < core.port_count(); ++port) abandon(core, port);
}

/// The idle time has passed, or that of the message, or that between two characters.
void handle(Core& core, std::uint8_t what, Time at) {
  const auto port = static_cast<std::uint8_t>(what - kMessageTimer0);
  MessageReceiver& m = core.s.port[port].message;
  if (m.phase == Phase::Search && asks_for_silence(m))
    m.was_idle = true;
  else
    end(core, port, kTimer, at);
}

}  // namespace s7200::message_receiver

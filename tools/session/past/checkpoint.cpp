#include "tools/session/past/checkpoint.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <deque>
#include <map>
#include <type_traits>
#include <utility>

#include "tools/session/past/digest.hpp"
#include "tools/session/past/state_members.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 26;  // of a checkpoint of the largest system

// --- the members of each part that is not of a CPU ---

using tools::members;

auto members(Is<Moment> auto& part) {
  auto& [instructions, actions, settled, time, stopped] = part;
  return std::tie(instructions, actions, settled, time, stopped);
}

auto members(Is<Event> auto& part) {
  auto& [at, owner, what] = part;
  return std::tie(at, owner, what);
}

auto members(Is<ReceivedCharacter> auto& part) {
  auto& [byte, parity_error, framing_error, start, end, line_break] = part;
  return std::tie(byte, parity_error, framing_error, start, end, line_break);
}

auto members(Is<serial::BitClock> auto& part) {
  auto& [format, clock_error] = part;
  return std::tie(format, clock_error);
}

auto members(Is<serial::Uart::State> auto& part) {
  auto& [format, receiving_as, clock_error, receiving, certain, start_edge, listen_from, off_from, sending, send_end] = part;
  return std::tie(format, receiving_as, clock_error, receiving, certain, start_edge, listen_from, off_from, sending,
                  send_end);
}

auto members(Is<serial::AnswerInProgress> auto& part) {
  auto& [length, bytes, sent, before] = part;
  return std::tie(length, bytes, sent, before);
}

auto members(Is<serial::Faults::Injected> auto& part) {
  auto& [fault, at, driver, chance, exchanges, applies, characters, next, hit, count, last_begin, last_end, impossible] =
      part;
  return std::tie(fault, at, driver, chance, exchanges, applies, characters, next, hit, count, last_begin, last_end,
                  impossible);
}

auto members(Is<serial::Faults::State> auto& part) {
  auto& [injected, announcer, begun, master, characters, sent_until, answer] = part;
  return std::tie(injected, announcer, begun, master, characters, sent_until, answer);
}

auto members(Is<serial::PortAction> auto& part) {
  auto& [what, at, format, value] = part;
  return std::tie(what, at, format, value);
}

auto members(Is<serial::OutputEdge> auto& part) {
  auto& [wire, on, at] = part;
  return std::tie(wire, on, at);
}

auto members(Is<serial::Field::Running> auto& part) {
  auto& [train, edge, next] = part;
  return std::tie(train, edge, next);
}

auto members(Is<serial::Field::State> auto& part) {
  auto& [next_change, next_train, running] = part;
  return std::tie(next_change, next_train, running);
}

auto members(Is<serial::Plc::State> auto& part) {
  auto& [cpu, uart, actions, output_edges, field, powered, executed_before, framing_errors] = part;
  return std::tie(cpu, uart, actions, output_edges, field, powered, executed_before, framing_errors);
}

auto members(Is<serial::FrameCharacter> auto& part) {
  auto& [byte, wrong_parity] = part;
  return std::tie(byte, wrong_parity);
}

auto members(Is<serial::Request> auto& part) {
  auto& [frame, timeout, gap, silence, sync] = part;
  return std::tie(frame, timeout, gap, silence, sync);
}

auto members(Is<serial::Exchange> auto& part) {
  auto& [request, request_start, request_end, echo, response, response_start, response_end, timed_out, too_long, given_up,
         of_another_master, early] = part;
  return std::tie(request, request_start, request_end, echo, response, response_start, response_end, timed_out, too_long,
                  given_up, of_another_master, early);
}

auto members(Is<serial::Requester::State> auto& part) {
  auto& [phase, request, sent, exchange, heard] = part;
  return std::tie(phase, request, sent, exchange, heard);
}

auto members(Is<serial::RequesterStation::State> auto& part) {
  auto& [uart, requester] = part;
  return std::tie(uart, requester);
}

auto members(Is<serial::Poller::State> auto& part) {
  auto& [next, round_begin, waiting, asked, answered, refused, wrong, least_latency, most_latency] = part;
  return std::tie(next, round_begin, waiting, asked, answered, refused, wrong, least_latency, most_latency);
}

auto members(Is<serial::PollerStation::State> auto& part) {
  auto& [uart, requester, poller, powered] = part;
  return std::tie(uart, requester, poller, powered);
}

auto members(Is<serial::HostCharacter> auto& part) {
  auto& [byte, format, fault, sender, lasts] = part;
  return std::tie(byte, format, fault, sender, lasts);
}

auto members(Is<serial::HostPort::State::HeldBreak> auto& part) {
  auto& [sender, since] = part;
  return std::tie(sender, since);
}

auto members(Is<serial::HostPort::State> auto& part) {
  auto& [attached, format, to_send, waiting, received, held_break] = part;
  return std::tie(attached, format, to_send, waiting, received, held_break);
}

auto members(Is<serial::HostStation::State> auto& part) {
  auto& [uart, port] = part;
  return std::tie(uart, port);
}

/// The line is quiet, and has no levels to keep.
auto members(Is<serial::SharedLine::State> auto& part) {
  auto& [line, faults, last_activity] = part;
  return std::tie(faults, last_activity);
}

auto members(Is<serial::System::Snapshot> auto& part) {
  auto& [queues, lines, plcs, requesters, host_ports, responders, pollers, clock, done] = part;
  return std::tie(queues, lines, plcs, requesters, host_ports, pollers, clock, done);
}

auto members(Is<SentByPlc> auto& part) {
  auto& [from, to, bytes] = part;
  return std::tie(from, to, bytes);
}

auto members(Is<PlcRequests::Request::Answer> auto& part) {
  auto& [from, to] = part;
  return std::tie(from, to);
}

auto members(Is<PlcRequests::Request::Heard> auto& part) {
  auto& [bytes, to, parity_error, framing_error] = part;
  return std::tie(bytes, to, parity_error, framing_error);
}

auto members(Is<PlcRequests::Request> auto& part) {
  auto& [station, frame, start, end, answer, given_up, heard] = part;
  return std::tie(station, frame, start, end, answer, given_up, heard);
}

auto members(Is<PlcRequests::Asked> auto& part) {
  auto& [start, frame, by, answered] = part;
  return std::tie(start, frame, by, answered);
}

auto members(Is<PlcRequests::Hearing> auto& part) {
  auto& [bytes, to] = part;
  return std::tie(bytes, to);
}

auto members(Is<PlcRequests::State> auto& part) {
  auto& [hearing, sending, last, before, asked] = part;
  return std::tie(hearing, sending, last, before, asked);
}

auto members(Is<Checkpoint> auto& part) {
  auto& [moment, state, ops, requests, lasts] = part;
  return std::tie(moment, state, ops, requests);
}

template <class T>
constexpr bool kPackedAsNumber = std::is_integral_v<T> || std::is_enum_v<T>;

// --- to bytes ---

class Packer {
 public:
  template <class T>
  requires kPackedAsNumber<T>
  void add(T number) {
    auto bits = static_cast<std::uint64_t>(number);
    for (; bits >= 0x80; bits >>= 7) bytes_ += static_cast<char>(0x80 | (bits & 0x7F));
    bytes_ += static_cast<char>(bits);
  }

  template <class T, std::size_t N>
  void add(const std::array<T, N>& all) {
    if constexpr (std::is_same_v<T, std::uint8_t>)
      bytes_.append(reinterpret_cast<const char*>(all.data()), N);
    else
      for (const T& one : all) add(one);
  }

  template <class T>
  void add(const std::vector<T>& all) {
    add_each(all);
  }
  template <class T>
  void add(const std::deque<T>& all) {
    add_each(all);
  }

  template <class Key, class T>
  void add(const std::map<Key, T>& all) {
    add(all.size());
    for (const auto& [key, one] : all) add(key), add(one);
  }

  template <class T>
  void add(const std::optional<T>& one) {
    add(one.has_value());
    if (one) add(*one);
  }

  void add(const LogicStack& stack) { add(stack.bits()); }
  void add(serial::Faults::Chance chance) { add(std::bit_cast<std::uint64_t>(chance)); }
  void add(const serial::Fault& fault) {
    const std::string text = serial::to_text(fault);
    add(std::vector<std::uint8_t>(text.begin(), text.end()));
  }
  void add(EventQueue queue) {
    std::vector<Event> events;
    while (queue.next() != kNever) events.push_back(queue.pop());
    add(events);
  }

  template <class T>
  requires std::is_class_v<T>
  void add(const T& part) {
    std::apply([this](const auto&... member) { (this->add(member), ...); }, members(part));
  }

  /// Each row of zeros as a zero and its length.
  std::string taken() && {
    Packer rows;
    for (std::size_t i = 0; i < bytes_.size();) {
      if (bytes_[i] != 0) {
        rows.bytes_ += bytes_[i++];
        continue;
      }
      const std::size_t end = std::min(bytes_.find_first_not_of('\0', i), bytes_.size());
      rows.bytes_ += '\0';
      rows.add(end - i);
      i = end;
    }
    return std::move(rows.bytes_);
  }

 private:
  template <class List>
  void add_each(const List& all) {
    add(all.size());
    for (const auto& one : all) add(one);
  }

  std::string bytes_{};
};

// --- and back ---

/// Reads on from the beginning; after the first mistake everything is 0.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}

  /// Nothing was wrong, and nothing is left over.
  bool done() const { return fine_ && bytes_.empty(); }
  bool fine() const { return fine_; }
  bool at_end() const { return bytes_.empty(); }

  template <class T>
  requires kPackedAsNumber<T>
  void take(T& number) {
    std::uint64_t bits = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const std::uint8_t byte = take_byte();
      bits |= static_cast<std::uint64_t>(byte & 0x7F) << shift;
      if (byte < 0x80) break;
    }
    number = static_cast<T>(bits);
  }

  template <class T, std::size_t N>
  void take(std::array<T, N>& all) {
    if constexpr (std::is_same_v<T, std::uint8_t>)
      for (T& one : all) one = take_byte();
    else
      for (T& one : all) take(one);
  }

  template <class T>
  void take(std::vector<T>& all) {
    take_each(all);
  }
  template <class T>
  void take(std::deque<T>& all) {
    take_each(all);
  }

  template <class Key, class T>
  void take(std::map<Key, T>& all) {
    all.clear();
    for (std::size_t count = take_count(); count > 0 && fine_; --count) {
      Key key{};
      take(key);
      take(all[key]);
    }
  }

  template <class T>
  void take(std::optional<T>& one) {
    bool there = false;
    take(there);
    one.reset();
    if (!there) return;
    T value{};
    take(value);
    one = std::move(value);
  }

  void take(LogicStack& stack) {
    std::uint16_t bits = 0;
    take(bits);
    stack = LogicStack::from_bits(bits);
  }
  void take(serial::Faults::Chance& chance) {
    std::uint64_t bits = 0;
    take(bits);
    chance = std::bit_cast<serial::Faults::Chance>(bits);
  }
  void take(serial::Fault& fault) {
    std::vector<std::uint8_t> text;
    take(text);
    const serial::ParsedFault parsed = serial::parse_fault(std::string(text.begin(), text.end()));
    fine_ = fine_ && parsed.ok();
    fault = parsed.fault;
  }
  void take(EventQueue& queue) {
    std::vector<Event> events;
    take(events);
    queue = EventQueue();
    for (const Event& event : events) queue.schedule(event.at, event.owner, event.what);
  }

  template <class T>
  requires std::is_class_v<T>
  void take(T& part) {
    std::apply([this](auto&... member) { (this->take(member), ...); }, members(part));
  }

  std::uint8_t take_byte() {
    fine_ = fine_ && !bytes_.empty();
    if (!fine_) return 0;
    const auto byte = static_cast<std::uint8_t>(bytes_.front());
    bytes_.remove_prefix(1);
    return byte;
  }

 private:
  /// Each element has at least one byte.
  std::size_t take_count() {
    std::size_t count = 0;
    take(count);
    fine_ = fine_ && count <= bytes_.size();
    return fine_ ? count : 0;
  }

  template <class List>
  void take_each(List& all) {
    all.clear();
    for (std::size_t count = take_count(); count > 0 && fine_; --count) take(all.emplace_back());
  }

  std::string_view bytes_;
  bool fine_ = true;
};

/// Rows of zeros as they were. Nothing if that is too much, or damaged.
std::optional<std::string> with_zeros(std::string_view bytes) {
  std::string text;
  for (Unpacker rows(bytes); !rows.at_end();) {
    const std::uint8_t byte = rows.take_byte();
    std::size_t count = 1;
    if (byte == 0) rows.take(count);
    if (!rows.fine() || count > kMostBytes - text.size()) return {};
    text.append(count, static_cast<char>(byte));
  }
  return text;
}

bool is_quiet(const serial::Uart::State& uart) { return !uart.receiving && !uart.sending; }

bool is_quiet(serial::Line line, Time now) {
  line.forget(now);  // a copy has no listeners, so nothing that is past is kept
  return line == serial::Line();
}

bool same_stations(const Checkpoint& one, const Checkpoint& other) {
  const auto sizes = [](const Checkpoint& of) {
    return std::array{of.state.queues.size(),
                      of.state.lines.size(),
                      of.state.plcs.size(),
                      of.state.requesters.size(),
                      of.state.host_ports.size(),
                      of.state.pollers.size(),
                      of.ops.size(),
                      of.requests.hearing.size(),
                      of.requests.sending.size(),
                      of.requests.last.size(),
                      of.requests.before.size(),
                      of.requests.asked.size()};
  };
  return sizes(one) == sizes(other) && other.state.responders.empty();
}

}  // namespace

bool can_be_packed(const serial::System::Snapshot& state, Time now) {
  const auto listens = [](const auto& station) { return is_quiet(station.uart); };
  return state.responders.empty() &&
         std::ranges::all_of(state.lines, [now](const auto& one) { return is_quiet(one.line, now); }) &&
         std::ranges::all_of(state.plcs,
                             [](const serial::Plc::State& plc) {
                               return std::ranges::all_of(plc.uart, [](const auto& uart) { return is_quiet(uart); });
                             }) &&
         std::ranges::all_of(state.requesters, listens) && std::ranges::all_of(state.host_ports, listens) &&
         std::ranges::all_of(state.pollers, listens);
}

std::string packed(const Checkpoint& checkpoint) {
  Packer packer;
  packer.add(checkpoint);
  const std::string bytes = std::move(packer).taken();
  return digest_of(bytes) + bytes;
}

std::optional<Checkpoint> unpacked(std::string_view bytes, const Checkpoint& like) {
  const std::size_t head = digest_of("").size();
  if (bytes.size() < head || digest_of(bytes.substr(head)) != bytes.substr(0, head)) return {};
  const auto text = with_zeros(bytes.substr(head));
  if (!text) return {};
  Checkpoint checkpoint;
  Unpacker unpacker(*text);
  unpacker.take(checkpoint);
  if (!unpacker.done() || !same_stations(checkpoint, like)) return {};
  return checkpoint;
}

}  // namespace s7200::tools

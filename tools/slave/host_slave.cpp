#include "tools/slave/host_slave.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/counted.hpp"
#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/peers/quiet_time.hpp"
#include "serial_sim/system/simulation.hpp"

namespace s7200::tools {
namespace {

constexpr int kStrayReads = 256;       // from a side that never stops talking
constexpr Time kToComplete = kSecond;  // an answer over Modbus TCP that has begun

void refuse_wrong_parity(const serial::Frame& frame) {
  if (serial::has_wrong_parity(frame))
    throw std::invalid_argument("a byte with wrong parity (p) can only be sent to a program in simulation");
}

Bytes bytes_of(const std::vector<HostLink::Character>& characters) {
  Bytes bytes;
  for (const auto& character : characters) bytes.push_back(character.byte);
  return bytes;
}

std::string hex(const std::vector<HostLink::Character>& characters) { return beginning_in_hex(bytes_of(characters)); }

std::uint16_t word_at(const std::vector<HostLink::Character>& characters, std::size_t place) {
  return static_cast<std::uint16_t>(characters[place].byte << 8 | characters[place + 1].byte);
}

}  // namespace

HostSlave::HostSlave(std::unique_ptr<HostLink> link) : link_(std::move(link)) { link_->open(); }

void HostSlave::remark(const std::string& text) { remark_ += (remark_.empty() ? "" : "; ") + text; }

void HostSlave::make_ready() {
  remark_.clear();
  if (link_->is_open()) {
    std::vector<HostLink::Character> stray;
    try {
      for (int read = 0; read < kStrayReads && link_->wait_for_input(host_time()); ++read) link_->read(stray);
    } catch (const SlaveUnreachable&) {
      // A server may close a connection that was idle; whether it is still there shows below.
    }
    if (!stray.empty()) remark(ignored_text(bytes_of(stray)));
  }
  if (!link_->is_open()) link_->open();
}

void HostSlave::open_again() {
  remark_.clear();
  if (!link_->is_open()) link_->open();
}

bool HostSlave::take_in(std::vector<HostLink::Character>& characters, Time until) {
  if (!link_->is_open() || !link_->wait_for_input(until + made_at_)) return false;
  try {
    link_->read(characters);
  } catch (const SlaveUnreachable& end) {
    if (characters.empty()) throw;
    remark(end.what());
    return false;
  }
  return true;
}

RtuSlave::RtuSlave(const std::string& device, const SerialFormat& format, IsComplete is_complete, StopToken stop)
    : HostSlave(std::make_unique<SerialLink>(device, format, stop)),
      is_complete_(is_complete),
      has_parity_(format.parity != Parity::None),
      shortest_silence_(std::max(kSilence, format.silence())),
      quiet_(serial::default_quiet(format)) {}

RtuSlave::RtuSlave(const std::string& host, const std::string& port, IsComplete is_complete, StopToken stop)
    : HostSlave(std::make_unique<TcpLink>(host, port, stop)), is_complete_(is_complete), shortest_silence_(kSilence) {}

void RtuSlave::send(const Bytes& bytes, Time gap) {
  if (gap == 0) {
    link_->write(bytes);
    return;
  }
  for (std::size_t i = 0; i < bytes.size() && !link_->stop_requested(); ++i) {
    if (i > 0) wait(link_->character_time() + gap);
    link_->write({&bytes[i], 1});
  }
}

Time RtuSlave::silence_after(const serial::Exchange& exchange) const {
  return is_complete_(exchange.response_bytes()) ? shortest_silence_ : std::max(shortest_silence_, kSilenceInside);
}

serial::Exchange RtuSlave::exchange(const serial::Request& request) {
  refuse_wrong_parity(request.frame);
  make_ready();
  serial::Exchange exchange;
  exchange.request = request.frame;
  exchange.request_start = now();
  const bool synchronised = request.sync && link_->drive_sync(true);
  if (request.sync && !synchronised) remark("there is no DTR here to drive the sync signal");
  send(serial::bytes_of(request.frame), request.gap);
  if (synchronised) {
    link_->drain();
    link_->drive_sync(false);
  }
  const Time character_time = link_->character_time();
  const auto length = static_cast<Time>(request.frame.size());
  exchange.request_end = std::max(now(), exchange.request_start + length * character_time + (length - 1) * request.gap);

  collect(exchange, exchange.request_end + request.timeout, request.silence);
  unanswered_ = exchange.timed_out;
  if (!exchange.timed_out)  // a pty may be faster than a line
    exchange.request_end = std::min(exchange.request_end, exchange.response_start);
  return exchange;
}

serial::Exchange RtuSlave::receive(const serial::Listening& listening) {
  open_again();
  serial::Exchange exchange;
  exchange.request_start = exchange.request_end = now();
  collect(exchange, exchange.request_end + listening.timeout, listening.silence);
  return exchange;
}

/// Collects a transmission until it ends; its first character comes before `until`. Where others talk all the time, so that
/// no silence ends it, it ends when it has taken as long as its characters and one time-out.
void RtuSlave::collect(serial::Exchange& exchange, Time until, const std::optional<Time>& silence) {
  const Time character_time = link_->character_time(), timeout = until - exchange.request_end;
  std::vector<HostLink::Character> received;
  while (!exchange.too_long && take_in(received, until)) {
    const Time arrival = now();
    const std::size_t known = exchange.response.size();
    exchange.too_long = received.size() > serial::Requester::kLongestResponse;
    if (exchange.too_long) received.resize(serial::Requester::kLongestResponse);
    for (std::size_t i = known; i < received.size(); ++i) {
      const Time end = arrival - static_cast<Time>(received.size() - 1 - i) * character_time;
      const Time earliest = i > 0 ? exchange.response[i - 1].start : exchange.request_start;
      // Linux does not say what was wrong with a character; with parity that is the likelier.
      exchange.response.push_back({.byte = received[i].byte,
                                   .parity_error = received[i].error && has_parity_,
                                   .framing_error = received[i].error && !has_parity_,
                                   .start = std::max(end - character_time, earliest),
                                   .end = end});
    }
    const Time longest = timeout + static_cast<Time>(received.size()) * character_time;
    until = std::min(arrival + silence.value_or(silence_after(exchange)), exchange.response.front().end + longest);
  }
  exchange.timed_out = exchange.response.empty();
  if (exchange.timed_out) return;
  exchange.response_start = exchange.response.front().start;
  exchange.response_end = exchange.response.back().end;
}

ModbusTcpSlave::ModbusTcpSlave(const std::string& host, const std::string& port, StopToken stop)
    : HostSlave(std::make_unique<TcpLink>(host, port, stop)) {}

serial::Exchange ModbusTcpSlave::exchange(const serial::Request& request) {
  constexpr std::size_t kHeader = 6;  // transaction, protocol, length
  refuse_wrong_parity(request.frame);
  const Bytes adu = serial::bytes_of(request.frame);
  if (adu.size() < 4 || !modbus::crc_ok(adu))
    throw std::invalid_argument(
        "Modbus TCP carries no CRC: only frames with a right one can be sent, of which it is taken off");
  const Bytes pdu(adu.begin() + 1, adu.end() - 2);
  if (pdu.size() > modbus::kLongestPdu)
    throw std::invalid_argument(
        fmt::format("Modbus TCP carries {} bytes of function and data at most", modbus::kLongestPdu));
  if (request.gap != 0) throw std::invalid_argument("Modbus TCP carries frames in one piece: there are no pauses in it");
  make_ready();

  serial::Exchange exchange;
  exchange.request = request.frame;
  ++transaction_;
  const Bytes message = modbus::to_bytes({transaction_, adu[0], pdu});
  exchange.request_start = exchange.request_end = now();
  link_->write(message);

  std::vector<HostLink::Character> received;
  Time begun = 0;
  std::size_t ignored = 0;
  const Time until = now() + request.timeout;
  const auto deadline = [&] { return received.empty() ? until : until + kToComplete; };
  do {
    if (!take_in(received, deadline())) break;
    if (begun == 0) begun = now();
    while (exchange.response.empty() && received.size() >= kHeader) {
      const std::size_t length = word_at(received, 4), size = kHeader + length;
      if (word_at(received, 2) != 0 || length < 2 || length > serial::Requester::kLongestResponse) {
        remark("no Modbus TCP: " + hex(received));
        link_->close();
        received.clear();
      } else if (received.size() < size) {
        break;
      } else if (word_at(received, 0) == transaction_) {
        for (std::size_t i = kHeader; i < size; ++i) exchange.response.push_back({.byte = received[i].byte});
      } else {
        ++ignored;
        received.erase(received.begin(), received.begin() + static_cast<std::ptrdiff_t>(size));
        begun = received.empty() ? 0 : now();
      }
    }
  } while (exchange.response.empty() && now() < deadline());  // a server may never stop talking
  if (ignored > 0) remark(fmt::format("ignored {} to other transactions than {}", counted(ignored, "answer"), transaction_));
  exchange.timed_out = exchange.response.empty();
  if (exchange.timed_out) {
    if (received.empty()) return exchange;
    remark("only a part of an answer came: " + hex(received));
    link_->close();  // its rest must not be taken for another answer
    return exchange;
  }
  Bytes answer = exchange.response_bytes();
  modbus::add_crc(answer);
  exchange.response.clear();
  for (const std::uint8_t byte : answer) exchange.response.push_back({.byte = byte, .start = begun, .end = begun});
  exchange.response_start = begun;
  exchange.response_end = now();
  return exchange;
}

serial::Exchange ModbusTcpSlave::receive(const serial::Listening&) {
  throw std::invalid_argument("over Modbus TCP a slave only speaks when it is asked");
}

}  // namespace s7200::tools

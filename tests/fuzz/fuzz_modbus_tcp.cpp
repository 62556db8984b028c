// Any bytes from several clients of the Modbus TCP gateway, and anything as answers of the line.
//
// The input is a script: an operation, then its operands. Promises: every frame on the line is one of a client that is
// there, with a right CRC, on a line that is quiet; every answer is to a client that is there, is Modbus TCP, and belongs to
// exactly one request of that client; in the end no client waits for anything.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "serial_sim/modbus/functions.hpp"
#include "serial_sim/modbus/gateway.hpp"
#include "serial_sim/modbus/request.hpp"

namespace {

using namespace s7200;
using modbus::Gateway;

void must(bool promise) {
  if (!promise) std::abort();
}

class Script {
 public:
  Script(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}
  bool over() const { return rest_.empty(); }
  std::uint8_t byte() {
    if (rest_.empty()) return 0;
    const std::uint8_t first = rest_[0];
    rest_ = rest_.subspan(1);
    return first;
  }
  std::span<const std::uint8_t> bytes(std::size_t count) {
    const auto taken = rest_.first(std::min(count, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }

 private:
  std::span<const std::uint8_t> rest_;
};

class World {
 public:
  void run(Script script) {
    while (!script.over()) {
      const std::uint8_t operation = script.byte();
      const std::uint64_t client = operation >> 4 & 3;
      switch (operation & 7) {
        case 0:
        case 1:
          write(client, script.bytes(script.byte()));
          break;
        case 2:
          write(client, well_formed(script));
          break;
        case 3:
          gateway_.forget(client);
          owed_.erase(client);
          readers_.erase(client);
          break;
        case 4:
          pass(script.byte() * kMillisecond);
          break;
        case 5:
          answer(script.bytes(script.byte()), operation >> 6);
          break;
        case 6:
          answer(right_answer(script), 0);
          break;
        case 7:
          line_.quiet_since = line_.now;  // another station talks
          break;
      }
      turn();
    }
    for (int i = 0; i < 100'000 && (line_.sending || open() != 0); ++i) pass(10 * kMillisecond);
    for (const auto& [client, owed] : owed_) must(owed.empty());
    must(!line_.sending && open() == 0);
  }

 private:
  std::size_t open() const {
    std::size_t sum = 0;
    for (std::uint64_t client = 0; client < 4; ++client) sum += gateway_.open(client);
    return sum;
  }

  /// A second reader says what the gateway owes to whom.
  void write(std::uint64_t client, std::span<const std::uint8_t> bytes) {
    gateway_.take(client, bytes);
    modbus::MbapReader& reader = readers_[client];
    reader.take(bytes);
    while (const auto request = reader.next())
      if (is_answered(*request)) owed_[client].insert({request->transaction, request->unit});
    must(reader.error() == gateway_.error(client) || gateway_.open(client) == Gateway::kMostOpen);
    must(gateway_.open(client) <= Gateway::kMostOpen);
  }

  /// A broadcast has no answer, unless it asks for one: that is refused.
  static bool is_answered(const modbus::TcpMessage& request) {
    const modbus::FunctionRow* const function = modbus::find_function(request.pdu[0]);
    return request.unit != 0 || (function != nullptr && !function->broadcast);
  }

  static Bytes well_formed(Script& script) {
    const std::uint8_t transaction = script.byte(), unit = script.byte();
    const auto pdu = script.bytes(1 + script.byte() % modbus::kLongestPdu);
    if (pdu.empty()) return {};
    return modbus::to_bytes({transaction, unit, {pdu.begin(), pdu.end()}});
  }

  Bytes right_answer(Script& script) const {
    if (frame_.empty()) return {};
    Bytes pdu{frame_[1]};
    const auto data = script.bytes(script.byte() % modbus::kLongestPdu);
    pdu.insert(pdu.end(), data.begin(), data.end());
    return modbus::rtu_frame(frame_[0], pdu);
  }

  void answer(std::span<const std::uint8_t> bytes, unsigned error) {
    if (line_.sending) pass(sending_until_ - line_.now);
    for (const std::uint8_t byte : bytes) {
      gateway_.received({.byte = byte, .parity_error = error == 1, .framing_error = error == 2, .start = line_.now},
                        line_.format);
      line_.now += line_.format.character_time();
      line_.quiet_since = line_.now;
    }
  }

  void pass(Time time) {
    line_.now += time;
    turn();
  }

  void turn() {
    if (line_.sending && line_.now >= sending_until_) {
      line_.sending = false;
      line_.quiet_since = sending_until_;
    }
    const Bytes frame = gateway_.turn(line_);
    if (!frame.empty()) {
      must(!line_.sending && line_.now - line_.quiet_since >= line_.quiet_time);
      must(modbus::crc_ok(frame) && frame.size() <= modbus::kLongestRtuFrame && frame[0] <= 247);
      frame_ = frame;
      line_.sending = true;
      sending_until_ = line_.now + static_cast<Time>(frame.size()) * line_.format.character_time();
    }
    for (const Gateway::Answer& answer : gateway_.take_answers()) {
      modbus::MbapReader reader;
      reader.take(answer.bytes);
      const auto message = reader.next();
      must(message && reader.pending() == 0);
      auto& owed = owed_[answer.client];
      const auto request = owed.find({message->transaction, message->unit});
      must(request != owed.end());
      owed.erase(request);
    }
  }

  Gateway gateway_{100 * kMillisecond};
  modbus::LineTurns::Line line_{.format = {}, .quiet_time = 18 * kMillisecond};
  Time sending_until_ = 0;
  Bytes frame_;
  std::map<std::uint64_t, modbus::MbapReader> readers_;
  std::map<std::uint64_t, std::multiset<std::pair<unsigned, unsigned>>> owed_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  World().run(Script(data, size));
  return 0;
}

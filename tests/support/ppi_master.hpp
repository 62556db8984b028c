// A PPI master for tests, written from the rules (facts 10.9) apart from the simulator's code: frames and S7 requests as
// bytes, and a station that speaks them to the port of a test's PLC.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "tests/support/plc.hpp"

namespace s7200::test::ppi {

inline constexpr Time kBit = 104'167, kCharacter = 1'145'833;  // 9600 baud, 8E1: 11 bits

/// A PLC whose port is at another rate.
inline std::shared_ptr<const Program> at_rate(std::string_view stl, std::uint32_t baud, const CpuModel& model) {
  return with_system_block(*program_of(stl, model), {.ppi_rates = {baud, baud}});
}

inline std::uint8_t sum(const Bytes& bytes) {
  unsigned total = 0;
  for (const std::uint8_t byte : bytes) total += byte;
  return static_cast<std::uint8_t>(total % 256);
}

inline Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

inline Bytes word(unsigned value) {
  return {static_cast<std::uint8_t>(value / 256), static_cast<std::uint8_t>(value % 256)};
}

inline Bytes sd1(std::uint8_t to, std::uint8_t from, std::uint8_t function) {
  const Bytes body{to, from, function};
  return joined({{0x10}, body, {sum(body), 0x16}});
}

inline Bytes sd2(std::uint8_t to, std::uint8_t from, std::uint8_t function, const Bytes& data) {
  const Bytes body = joined({{to, from, function}, data});
  const auto length = static_cast<std::uint8_t>(body.size());
  return joined({{0x68, length, length, 0x68}, body, {sum(body), 0x16}});
}

inline Bytes request(const Bytes& parameters, const Bytes& data = {}, unsigned number = 1) {
  return joined({{0x32, 1, 0, 0},
                 word(number),
                 word(static_cast<unsigned>(parameters.size())),
                 word(static_cast<unsigned>(data.size())),
                 parameters,
                 data});
}

/// A variable of a request. `address` in bits; of T, C and HC their number.
inline Bytes variable(std::uint8_t type, unsigned count, std::uint8_t area, unsigned address, unsigned block = 0) {
  return joined({{0x12, 0x0A, 0x10, type},
                 word(count),
                 word(block),
                 {area, static_cast<std::uint8_t>(address / 65536)},
                 word(address % 65536)});
}

inline Bytes reading(std::initializer_list<Bytes> variables) {
  Bytes parameters{0x04, static_cast<std::uint8_t>(variables.size())};
  for (const Bytes& each : variables) parameters.insert(parameters.end(), each.begin(), each.end());
  return request(parameters);
}

/// One variable, with its value.
inline Bytes writing(const Bytes& variable, std::uint8_t data_type, unsigned length, const Bytes& value) {
  return request(joined({{0x05, 0x01}, variable}), joined({{0x00, data_type}, word(length), value}));
}

/// Speaks to port 0 of a PLC. A call of the master is a frame and what comes back.
class Master {
 public:
  explicit Master(Plc& plc, std::uint8_t station = 0, std::uint32_t baud = 9600)
      : plc_(plc), station_(station), bit_(kSecond / baud), character_(11 * kSecond / baud) {}

  /// Sends bytes, the first start bit at `plc.cpu.time()` plus a silence, and waits; what the CPU has sent since.
  Bytes say(const Bytes& frame, Time wait = 400 * ms) {
    plc_.port.sent.clear();
    begin_ = plc_.cpu.time() + 40 * bit_;
    for (std::size_t i = 0; i < frame.size(); ++i) {
      const Time start = begin_ + static_cast<Time>(i) * character_;
      plc_.received_at({.byte = frame[i], .start = start, .end = start + 10 * bit_ + bit_ / 2});
    }
    end_ = begin_ + static_cast<Time>(frame.size()) * character_;
    plc_.run_until(end_ + wait);
    Bytes heard;
    for (const Port::Sent& sent : plc_.port.sent) heard.push_back(sent.byte);
    return heard;
  }

  /// Asks and polls until there is an answer; its PDU. Nothing if the slave does not answer so.
  Bytes ask(const Bytes& pdu, std::uint8_t to = 2) {
    return say(sd2(to, station_, 0x6C, pdu), 20 * ms) == Bytes{0xE5} ? fetch(to) : Bytes{};
  }

  /// Polls until the answer to what has been asked is there.
  Bytes fetch(std::uint8_t to = 2) {
    for (int poll = 0; poll < 8; ++poll) {
      const Bytes heard = say(sd1(to, station_, poll % 2 == 0 ? 0x5C : 0x7C));
      if (heard == Bytes{0xE5}) continue;
      if (heard.size() < 9 || heard != sd2(station_, to, 0x08, {heard.begin() + 7, heard.end() - 2})) return {};
      return {heard.begin() + 7, heard.end() - 2};
    }
    return {};
  }

  Time end_of_frame() const { return end_; }

 private:
  Plc& plc_;
  std::uint8_t station_;
  Time bit_, character_;
  Time begin_ = 0, end_ = 0;
};

/// The value of the only variable of an answer to a read: after its return code, type and length.
inline Bytes value_of(const Bytes& answer) {
  constexpr std::size_t kHead = 12 + 2 + 4;
  if (answer.size() < kHead || answer[14] != 0xFF) return {};
  return {answer.begin() + kHead, answer.end()};
}

/// The return code of the only variable of an answer.
inline int code_of(const Bytes& answer) { return answer.size() < 15 ? -1 : answer[14]; }

/// The error of a whole answer.
inline int error_of(const Bytes& answer) { return answer.size() < 12 ? -1 : answer[10] * 256 + answer[11]; }

}  // namespace s7200::test::ppi

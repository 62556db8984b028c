#include "serial_sim/westinghouse/messages/block_message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

#include "interpreter/base/word_bytes.hpp"
#include "serial_sim/line/frame.hpp"

namespace s7200::westinghouse {
namespace {

constexpr std::array<std::uint8_t, kEraseKeyLength> kEraseKey{0xC5, 0x3A, 0xA3, 0x5C, 0xEE, 0x2A, 0xE2, 0xAE,
                                                              0x2A, 0xEE, 0xAE, 0xE2, 0xC5, 0x3A, 0xA3, 0x5C};
constexpr std::size_t kErrorLength = 2;

Opcode opcode_of(std::span<const std::uint8_t> message) { return static_cast<Opcode>(message[0]); }

bool is_error(std::span<const std::uint8_t> response) {
  return response.size() == kErrorLength && response[0] == kHighwayError;
}

/// The length in bytes of the answer that begins like this.
std::size_t length_of_answer(std::span<const std::uint8_t> response) {
  if (response[0] == kHighwayError) return kErrorLength;
  if (opcode_of(response) != Opcode::ReadBlock) return kMessageLength;
  constexpr std::size_t kCount = 3;
  return response.size() > kCount ? kMessageLength + response[kCount] + 2U : kMessageLength + 2;
}

/// Whether the answer repeats the request as far as the request's opcode demands.
bool repeats(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response) {
  std::size_t same = kMessageLength - 1;
  if (opcode_of(request) == Opcode::SetUnitAddress) same = 2;
  if (opcode_of(request) == Opcode::Highway && request[1] != 0) same = 2;
  return std::ranges::equal(request.first(same), response.first(same));
}

}  // namespace

std::uint8_t sum(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint8_t>(std::accumulate(bytes.begin(), bytes.end(), 0U) & 0xFF);
}

std::uint8_t data_check(std::span<const std::uint8_t> data, DataCheck by) {
  if (by == DataCheck::Sum) return sum(data);
  return std::accumulate(data.begin(), data.end(), std::uint8_t{0}, std::bit_xor<std::uint8_t>());
}

std::string wrong_data_check(std::span<const std::uint8_t> data, std::uint8_t check, DataCheck by) {
  const DataCheck other = by == DataCheck::Sum ? DataCheck::Xor : DataCheck::Sum;
  if (check != data_check(data, other)) return "wrong data check";
  return fmt::format("wrong data check: it is {}",
                     other == DataCheck::Xor ? "the XOR of the data, not the sum" : "the sum of the data, not the XOR");
}

Bytes message(Opcode opcode, std::uint8_t b1, std::uint8_t b2, std::uint8_t b3, std::uint8_t b4) {
  Bytes bytes{static_cast<std::uint8_t>(opcode), b1, b2, b3, b4};
  bytes.push_back(sum(bytes));
  return bytes;
}

Bytes set_unit_address(std::uint8_t unit) { return message(Opcode::SetUnitAddress, unit); }

Bytes read_block(std::uint16_t address, std::size_t bytes) {
  return message(Opcode::ReadBlock, low_byte(address), high_byte(address), static_cast<std::uint8_t>(bytes - 1));
}

Bytes write_block(std::uint16_t address, std::span<const std::uint8_t> data, DataCheck by) {
  Bytes bytes =
      message(Opcode::WriteBlock, low_byte(address), high_byte(address), static_cast<std::uint8_t>(data.size() - 1));
  bytes.insert(bytes.end(), data.begin(), data.end());
  bytes.push_back(data_check(data, by));
  return bytes;
}

Bytes write_bit(std::uint16_t address, std::uint8_t bit, bool on) {
  return message(Opcode::BitWrite, low_byte(address), high_byte(address), static_cast<std::uint8_t>((on ? 0x10 : 0) | bit));
}

Bytes retest() { return write_bit(kRetestWord, kRetestBit, true); }

bool is_retest(std::span<const std::uint8_t> message) { return std::ranges::equal(message, retest()); }

Bytes erase() {
  Bytes bytes = message(Opcode::Erase, 1);
  bytes.insert(bytes.end(), kEraseKey.begin(), kEraseKey.end());
  return bytes;
}

Bytes highway(HighwayCommand command, std::uint8_t highway, std::uint8_t drop, std::uint8_t subdrop) {
  return message(Opcode::Highway, static_cast<std::uint8_t>(command), highway, drop, subdrop);
}

std::span<const std::uint8_t> erase_key() { return kEraseKey; }

bool is_whole_answer(std::span<const std::uint8_t> response) {
  return !response.empty() && response.size() == length_of_answer(response);
}

serial::Answer check_block_answer(std::span<const std::uint8_t> request, std::span<const std::uint8_t> response,
                                  DataCheck by) {
  serial::Answer answer;
  if (response.empty()) return answer;
  answer.verdict = serial::Verdict::Wrong;
  const auto wrong = [&](std::string fault) {
    answer.fault = std::move(fault);
    return answer;
  };
  if (is_error(response)) {
    answer.verdict = serial::Verdict::Exception;
    answer.exception = response[1];
    return answer;
  }
  if (request.size() < kMessageLength || response[0] != request[0])
    return wrong("not the answer to this message: " + serial::to_hex(response));
  const std::size_t expected = length_of_answer(response);
  if (response.size() != expected)
    return wrong(fmt::format("wrong length: {} bytes, expected {}", response.size(), expected));
  const auto head = response.first(kMessageLength);
  if (sum(head.first(kMessageLength - 1)) != head.back()) return wrong("wrong check");
  if (!repeats(request, head)) return wrong("does not repeat the message: " + serial::to_hex(head));
  if (const auto data = response.subspan(kMessageLength); !data.empty()) {
    const auto block = data.first(data.size() - 1);
    if (data_check(block, by) != data.back()) return wrong(wrong_data_check(block, data.back(), by));
    answer.bytes.assign(data.begin(), data.end() - 1);
  } else if (opcode_of(request) == Opcode::SetUnitAddress || opcode_of(request) == Opcode::Highway) {
    answer.bytes.assign(head.begin() + 2, head.end() - 1);
  }
  answer.verdict = serial::Verdict::Right;
  return answer;
}

std::string unit_text(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kStop = 1, kProtect = 2, kModify = 4, kFaultMode = 8;
  const std::uint8_t key = bytes[0];
  std::string text = "keyswitch in ";
  if ((key & kStop) != 0)
    text += "stop";
  else if ((key & kProtect) != 0)
    text += "run, protected";
  else if ((key & kModify) != 0)
    text += "run, modify";
  else
    text += fmt::format("16#{:02X}", key);
  if ((key & kFaultMode) != 0) text += ", fault mode";
  return fmt::format("{}, fault register 16#{:02X}{:02X}", text, bytes[2], bytes[1]);
}

std::string highway_text(std::span<const std::uint8_t> request, std::span<const std::uint8_t> bytes) {
  const std::string drop = fmt::format("{:02X}.{:02X}.{:02X}", bytes[0], bytes[1], bytes[2]);
  switch (static_cast<HighwayCommand>(request[1])) {
    case HighwayCommand::SetAddress:
      return fmt::format("PLC {} addressed", drop);
    case HighwayCommand::ReadRemoteAddress:
      return fmt::format("addressed is {}", drop);
    case HighwayCommand::ReadHighwayStatus:
      return bytes[0] == 0 ? "no error" : serial::error_text(bytes[0], highway_error_name(bytes[0]));
    case HighwayCommand::OpenSession:
      return "session open";
    case HighwayCommand::CloseSession:
      return "session closed";
    case HighwayCommand::ReadSessionStatus:
      return bytes[0] == kNoSession ? "no session" : fmt::format("session of {}", drop);
    case HighwayCommand::ReadLocalAddress:
      return fmt::format("this computer is at {}", drop);
  }
  return serial::to_hex(bytes);
}

std::string_view highway_error_name(std::uint16_t code) {
  switch (code) {
    case 0x01:
      return "message buffer full";
    case 0x02:
      return "invalid drop addressed";
    case 0x04:
      return "message size invalid";
    case 0x12:
    case 12:  // as busy_code=decimal has it [W3]
      return "PLC in session with another computer";
    default:
      return "unknown code";
  }
}

}  // namespace s7200::westinghouse

#include "serial_sim/modbus/mbap.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/bytes.hpp"
#include "serial_sim/modbus/functions.hpp"

namespace s7200::modbus {
namespace {

constexpr std::size_t kHeader = 6;  // transaction, protocol, length; the unit counts as data

}  // namespace

Bytes to_bytes(const TcpMessage& message) {
  Bytes bytes(kHeader + 1 + message.pdu.size());
  store16(&bytes[0], message.transaction);
  store16(&bytes[4], static_cast<std::uint16_t>(1 + message.pdu.size()));
  bytes[6] = message.unit;
  std::copy(message.pdu.begin(), message.pdu.end(), bytes.begin() + kHeader + 1);
  return bytes;
}

std::uint32_t exchange_of(const TcpMessage& message) { return message.transaction * kUnitsOfATransaction + message.unit; }

TcpMessage exception_to(const TcpMessage& request, GatewayException code) {
  const auto function = static_cast<std::uint8_t>(request.pdu[0] | 0x80);
  return {request.transaction, request.unit, {function, static_cast<std::uint8_t>(code)}};
}

bool is_tcp_request(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kHeader + 2 && load16(&bytes[2]) == 0 && load16(&bytes[4]) == bytes.size() - kHeader &&
         find_function(bytes[kHeader + 1]) != nullptr;
}

void MbapReader::take(std::span<const std::uint8_t> bytes) {
  if (error_.empty()) bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

std::optional<TcpMessage> MbapReader::next() {
  if (bytes_.size() < kHeader) return {};
  const unsigned protocol = load16(&bytes_[2]), length = load16(&bytes_[4]);
  if (protocol != 0)
    error_ = fmt::format("protocol {} instead of 0", protocol);
  else if (length < 2 || length > 1 + kLongestPdu)
    error_ = fmt::format("length {}; 2 to {} are possible", length, 1 + kLongestPdu);
  if (!error_.empty()) {
    bytes_.clear();
    return {};
  }
  if (bytes_.size() < kHeader + length) return {};
  const auto end = bytes_.begin() + static_cast<std::ptrdiff_t>(kHeader + length);
  TcpMessage message{load16(&bytes_[0]), bytes_[6], Bytes(bytes_.begin() + kHeader + 1, end)};
  bytes_.erase(bytes_.begin(), end);
  return message;
}

}  // namespace s7200::modbus

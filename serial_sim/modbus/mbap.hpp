// Messages of Modbus TCP (MODBUS Messaging on TCP/IP Implementation Guide V1.0b, 3.1).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "serial_sim/modbus/crc.hpp"

namespace s7200::modbus {

inline constexpr std::size_t kLongestPdu = 253;  // MODBUS Application Protocol V1.1b3, 4.1

/// Exceptions that a gateway gives itself (the same, 7).
enum class GatewayException : std::uint8_t { PathUnavailable = 0x0A, TargetFailedToRespond = 0x0B };

struct TcpMessage {
  std::uint16_t transaction = 0;
  std::uint8_t unit = 0;
  Bytes pdu;  ///< function code and data, 1 to 253 bytes

  bool operator==(const TcpMessage&) const = default;
};

Bytes to_bytes(const TcpMessage& message);

/// Transaction and unit: a request and its answer have the same.
std::uint32_t exchange_of(const TcpMessage& message);
constexpr std::uint32_t kUnitsOfATransaction = 256;  ///< exchanges that follow each other

/// An answer to `request` that carries an exception.
TcpMessage exception_to(const TcpMessage& request, GatewayException code);

/// Whether the bytes are one message of Modbus TCP from its first to its last, with a function that requests have.
bool is_tcp_request(std::span<const std::uint8_t> bytes);

/// A stream of bytes, in pieces of any size, to messages.
class MbapReader {
 public:
  void take(std::span<const std::uint8_t> bytes);

  /// The next complete message, in the order of the stream.
  std::optional<TcpMessage> next();

  /// The error in a stream that is not Modbus TCP. No message follows it: the start of the next message cannot be known.
  const std::string& error() const { return error_; }

  /// The number of bytes that are not in a complete message yet.
  std::size_t pending() const { return bytes_.size(); }

 private:
  Bytes bytes_;
  std::string error_;
};

}  // namespace s7200::modbus

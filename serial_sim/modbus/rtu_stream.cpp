#include "serial_sim/modbus/rtu_stream.hpp"

#include <algorithm>

#include "serial_sim/modbus/crc.hpp"
#include "serial_sim/modbus/functions.hpp"

namespace s7200::modbus {
namespace {

constexpr std::size_t kShortest = 4;  // station, function, CRC
constexpr std::size_t kUnknown = 0;

/// The length of a request by its function and byte count, if it has one. While the byte count is missing, it is more than
/// the stream has.
std::size_t length(std::span<const std::uint8_t> stream) {
  const auto with_byte_count_at = [&](std::size_t place) {
    return stream.size() > place ? place + 1 + stream[place] + 2 : stream.size() + 1;
  };
  const FunctionRow* row = find_function(stream[1]);
  if (!row) return kUnknown;
  switch (row->shape) {
    case Shape::ReadBits:
    case Shape::ReadRegisters:
    case Shape::WriteOne:
      return 8;
    case Shape::WriteBits:
    case Shape::WriteRegisters:
      return with_byte_count_at(6);
    case Shape::ReadFile:
    case Shape::WriteFile:
      return with_byte_count_at(2);
    case Shape::Status:
    case Shape::SlaveId:
      return kShortest;
    case Shape::Diagnostics:
      return kUnknown;  // subfunction 0 returns any data
  }
  return kUnknown;
}

}  // namespace

std::size_t first_request(std::span<const std::uint8_t> stream) {
  if (stream.size() < kShortest) return 0;
  if (stream.size() <= kLongestRtuFrame && crc_ok(stream)) return stream.size();
  const std::size_t expected = length(stream);
  if (expected > stream.size() && expected <= kLongestRtuFrame) return 0;
  if (expected != kUnknown && expected <= kLongestRtuFrame && crc_ok(stream.first(expected))) return expected;
  for (std::size_t size = kShortest; size <= std::min(stream.size(), kLongestRtuFrame); ++size)
    if (crc_ok(stream.first(size))) return size;
  return 0;
}

Extent extent_of_request(std::span<const std::uint8_t> stream) {
  if (stream.size() < kShortest) return Extent::Part;
  const std::size_t expected = length(stream);
  if (expected == kUnknown || expected > kLongestRtuFrame) return Extent::Unknown;
  return stream.size() < expected ? Extent::Part : Extent::Whole;
}

bool lacks_crc(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kShortestWithData = 6, kCrc = 2;  // shorter ones are too much like anything else
  return bytes.size() >= kShortestWithData && bytes.front() <= kLastStation && !crc_ok(bytes) &&
         length(bytes) == bytes.size() + kCrc;
}

std::size_t length_of_answer(std::span<const std::uint8_t> request, std::span<const std::uint8_t> stream) {
  constexpr std::size_t kException = 5, kStatus = 5, kWritten = 8, kByteCount = 2, kAroundCounted = 5;
  const FunctionRow* const row = request.size() < kShortest ? nullptr : find_function(request[1]);
  if (row == nullptr || (!stream.empty() && stream[0] != request[0])) return 0;
  if (stream.size() < 2) return stream.size() + 1;
  if (stream[1] == (request[1] | kExceptionFlag)) return kException;
  if (stream[1] != request[1]) return 0;
  switch (row->shape) {
    case Shape::ReadBits:
    case Shape::ReadRegisters:
    case Shape::SlaveId:
    case Shape::ReadFile:
      return stream.size() > kByteCount ? stream[kByteCount] + kAroundCounted : stream.size() + 1;
    case Shape::WriteOne:
    case Shape::WriteBits:
    case Shape::WriteRegisters:
      return kWritten;
    case Shape::Status:
      return kStatus;
    case Shape::WriteFile:
    case Shape::Diagnostics:
      return request.size();
  }
  return 0;
}

}  // namespace s7200::modbus

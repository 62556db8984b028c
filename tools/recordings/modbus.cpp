#include <fmt/format.h>

#include "serial_sim/modbus/address.hpp"
#include "serial_sim/modbus/answer.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/modbus/rtu_stream.hpp"
#include "tools/recordings/readers.hpp"

namespace s7200::tools {
namespace {

using Data = std::span<const std::uint8_t>;

constexpr std::size_t kShortestRtu = 4;

/// `station 1, read holding registers 40001, 10 of them`
std::string modbus_request_text(Data frame) {
  const std::uint8_t station = frame[0], function = frame[1];
  const modbus::FunctionRow* row = modbus::find_function(function);
  std::string text = station == modbus::kBroadcast ? "all stations" : fmt::format("station {}", station);
  if (row == nullptr) return text + fmt::format(", function {}", function);
  text += fmt::format(", {}", row->name);
  if (frame.size() < kShortestRtu + 4) return text;
  const std::uint16_t first = load16(&frame[2]), second = load16(&frame[4]);
  for (const modbus::AreaRow& area : modbus::areas()) {
    const bool reads = area.read == row->function, one = area.write_one == row->function,
               many = area.write_many == row->function;
    if (!reads && !one && !many) continue;
    const std::string notation = modbus::notation({area.area, first});
    text += " " + (notation.empty() ? fmt::format("{} on the wire", first) : notation);
    text += one ? fmt::format(" = 16#{:04X}", second) : fmt::format(", {} of them", second);
  }
  return text;
}

/// As long as its function says, if that does.
bool has_length_of_request(Data bytes) {
  if (bytes.size() < kShortestRtu || (bytes[1] & modbus::kExceptionFlag) != 0) return false;
  const modbus::Extent extent = modbus::extent_of_request(bytes);
  return extent == modbus::Extent::Unknown ||
         (extent == modbus::Extent::Whole &&
          modbus::extent_of_request(bytes.first(bytes.size() - 1)) == modbus::Extent::Part);
}

ReadFrame read_modbus(const RecordedFrame& frame, const RecordedFrame* open) {
  const Data bytes(frame.bytes);
  ReadFrame read;
  if (open != nullptr && frame.direction != Direction::Request) {
    const modbus::Answer answer = modbus::check_answer(open->bytes, bytes);
    const bool fits = answer.verdict == modbus::Verdict::Right || answer.verdict == modbus::Verdict::Exception;
    if (fits || frame.direction == Direction::Answer) {
      read.direction = Direction::Answer;
      read.right = fits;
      read.text = modbus::describe(open->bytes, bytes, modbus::Numbering::Notation);
      return read;
    }
  }
  const bool crc = bytes.size() >= kShortestRtu && modbus::crc_ok(bytes);
  const bool whole = crc && has_length_of_request(bytes);
  if (frame.direction == Direction::Answer || (frame.direction == Direction::Unknown && !whole)) {
    read.right = crc;
    read.text = !crc ? "wrong CRC, or not a whole frame" : "an answer without its request";
    return read;
  }
  read.direction = Direction::Request;
  read.station = bytes[0];
  read.needs_no_answer = crc && bytes[0] == modbus::kBroadcast;
  read.right = whole;
  read.text = !crc    ? "wrong CRC, or not a whole frame"
              : whole ? modbus_request_text(bytes)
                      : "no request: it does not have the length of its function";
  return read;
}

/// Only what the function says of its length counts: part of a long frame may have a right CRC by chance.
std::size_t first_modbus_message(Data bytes, const RecordedFrame* open) {
  const auto answers = [&](std::size_t length) {
    const modbus::Verdict verdict = modbus::check_answer(open->bytes, bytes.first(length)).verdict;
    return verdict == modbus::Verdict::Right || verdict == modbus::Verdict::Exception;
  };
  constexpr std::size_t kLongest = 2 * modbus::kLongestRtuFrame;  // PLCs with limits of their own
  for (std::size_t length = kShortestRtu; length <= std::min(bytes.size(), kLongest); ++length) {
    if (open != nullptr && answers(length)) return length;
    const Data first = bytes.first(length);
    if (modbus::extent_of_request(first) == modbus::Extent::Whole && has_length_of_request(first) && modbus::crc_ok(first))
      return length;
  }
  return 0;
}

}  // namespace

std::unique_ptr<FrameReader> modbus_reader() { return std::make_unique<PlainReader<read_modbus, first_modbus_message>>(); }

}  // namespace s7200::tools

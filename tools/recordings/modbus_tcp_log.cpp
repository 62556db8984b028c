// Modbus TCP in logs: programs with a console print each message with its head.
#include <fmt/format.h>

#include <algorithm>

#include "serial_sim/modbus/mbap.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tools/recordings/forms.hpp"

namespace s7200::tools {
namespace {

/// Empty if the bytes are not whole messages. A request on a serial line may look like one, but has a CRC.
std::vector<modbus::TcpMessage> messages_of(const Bytes& bytes) {
  if (modbus::crc_ok(bytes)) return {};
  modbus::MbapReader reader;
  reader.take(bytes);
  std::vector<modbus::TcpMessage> messages;
  while (auto message = reader.next()) messages.push_back(std::move(*message));
  const bool whole = reader.error().empty() && reader.pending() == 0;
  return whole ? messages : std::vector<modbus::TcpMessage>{};
}

RecordedFrame on_a_line(const RecordedFrame& frame, const modbus::TcpMessage& message) {
  return {.at = frame.at,
          .direction = frame.direction,
          .bytes = modbus::rtu_frame(message.unit, message.pdu),
          .place = frame.place,
          .stream = 1,
          .exchange = modbus::exchange_of(message)};
}

}  // namespace

void read_modbus_tcp(LineRecording& recording) {
  std::vector<RecordedFrame> frames;
  std::string first_other;
  std::size_t over_tcp = 0, others = 0;
  for (const RecordedFrame& frame : recording.frames) {
    const auto messages = messages_of(frame.bytes);
    if (messages.empty() && others++ == 0) first_other = frame.place;
    over_tcp += messages.empty() ? 0U : 1U;
    for (const modbus::TcpMessage& message : messages) frames.push_back(on_a_line(frame, message));
  }
  if (over_tcp <= others) return;
  recording.frames = std::move(frames);
  recording.notes.emplace_back("the frames are messages of Modbus TCP: each is shown as on a serial line, with its CRC");
  if (others > 0)
    recording.notes.push_back(fmt::format("{}: left out{}: it is not a whole message of Modbus TCP", first_other,
                                          others == 1 ? "" : fmt::format(", and {} more", others - 1)));
}

}  // namespace s7200::tools

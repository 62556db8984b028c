// The protocols of our own programs, and PPI, in recordings.
#pragma once

#include <memory>
#include <span>

#include "interpreter/base/text/counted.hpp"
#include "serial_sim/peers/answer.hpp"
#include "tools/recordings/conversation.hpp"

namespace s7200::tools {

inline bool fits(const serial::Answer& answer) {
  return answer.verdict == serial::Verdict::Right || answer.verdict == serial::Verdict::Exception;
}

/// Whether bytes have the form of a request of Modbus RTU to read or write two items from address 0, whatever their CRC:
/// `01 03 00 00 00 02 C4 0C`. By chance they have that of a message of Modbus TCP, too.
bool may_be_rtu_request_from_0(std::span<const std::uint8_t> bytes);

std::unique_ptr<FrameReader> modbus_reader(const ChosenWords& chosen);
std::unique_ptr<FrameReader> ppi_reader(const ChosenWords& chosen);
std::unique_ptr<FrameReader> freeport_pc_reader(const ChosenWords& chosen);
/// Lines of ASCII with CR, LF or both at their ends, texts between STX and ETX, and ENQ, ACK, NAK and their like. Who asks
/// is for the recording to say.
std::unique_ptr<FrameReader> text_reader(const ChosenWords& chosen);

/// The reader of a protocol whose frames can each be read alone: it keeps nothing from frame to frame.
template <ReadFrame (*Read)(const RecordedFrame& frame, const RecordedFrame* open),
          std::size_t (*First)(std::span<const std::uint8_t> bytes, const RecordedFrame* open)>
class PlainReader : public FrameReader {
 public:
  ReadFrame read(const RecordedFrame& frame, const RecordedFrame* open) override { return Read(frame, open); }
  bool may_be_echoed(const RecordedFrame& frame) const override {
    const RecordedFrame unsaid{.bytes = frame.bytes};
    return Read(unsaid, &unsaid).direction == Direction::Answer;
  }
  std::size_t first_message(std::span<const std::uint8_t> bytes, const RecordedFrame* open) const override {
    return First(bytes, open);
  }
};

}  // namespace s7200::tools

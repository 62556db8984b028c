#include "serial_sim/faults/answer_change.hpp"

#include <algorithm>
#include <optional>

#include "serial_sim/line/crc16.hpp"

namespace s7200::serial {
namespace {

constexpr std::size_t kCrcLength = 2, kShortenedBy = 2;
constexpr std::size_t kShortestFrame = 1 + 1 + kCrcLength;  // station, function
constexpr std::uint8_t kExceptionBit = 0x80;

/// The length in bytes that the changed frame has without its CRC.
std::size_t body_length(const Fault& fault, const AnswerInProgress& answer) {
  switch (fault.misbehaviour) {
    case Misbehaviour::Exception:
      return 3;
    case Misbehaviour::Stale:
      return answer.before.size() - kCrcLength;
    case Misbehaviour::Short:
      return answer.length - kCrcLength - kShortenedBy;
    default:
      return answer.length - kCrcLength;
  }
}

/// The byte of the changed frame at `place`, in front of its CRC. The station has given as many bytes, or it follows from
/// those that it has given.
std::uint8_t body_byte(const Fault& fault, const AnswerInProgress& answer, std::size_t place) {
  switch (fault.misbehaviour) {
    case Misbehaviour::Exception:
      if (place == 1) return answer.bytes[place] | kExceptionBit;
      return place == 2 ? fault.code : answer.bytes[place];
    case Misbehaviour::Station:
      return place == 0 ? fault.code : answer.bytes[place];
    case Misbehaviour::Function:
      return place == 1 ? fault.code : answer.bytes[place];
    case Misbehaviour::Stale:
      return answer.before[place];
    default:
      return answer.bytes[place];
  }
}

/// The next byte of the changed frame; nothing after its end.
std::optional<std::uint8_t> next_byte(const Fault& fault, AnswerInProgress& answer) {
  const std::size_t place = answer.sent.size(), body = body_length(fault, answer);
  if (place >= body + kCrcLength) return {};
  std::uint8_t byte = 0;
  if (place < body) {
    byte = body_byte(fault, answer, place);
  } else {
    const std::uint16_t crc = crc16(std::span(answer.sent).first(body));
    byte = static_cast<std::uint8_t>(place == body ? crc & 0xFF : crc >> 8);
  }
  answer.sent.push_back(byte);
  return byte;
}

}  // namespace

bool possible(Misbehaviour misbehaviour, const AnswerInProgress& answer) {
  if (answer.length < kShortestFrame && misbehaviour != Misbehaviour::Nothing && misbehaviour != Misbehaviour::Silent &&
      misbehaviour != Misbehaviour::Twice)
    return false;
  if (misbehaviour == Misbehaviour::Stale) return answer.before.size() >= kShortestFrame;
  if (misbehaviour == Misbehaviour::Short) return answer.length >= kShortestFrame + kShortenedBy;
  return answer.length != 0;
}

void change(const Fault& fault, AnswerInProgress& answer, const SerialFormat& format, Mishap& mishap) {
  switch (fault.misbehaviour) {
    case Misbehaviour::Nothing:
      return;
    case Misbehaviour::Silent:
      mishap.lost = true;
      return;
    case Misbehaviour::Twice:
      if (!answer.complete()) return;
      mishap.pause = format.silence();
      mishap.after.insert(mishap.after.end(), answer.bytes.begin(), answer.bytes.end());
      return;
    default:
      break;
  }
  mishap.instead = next_byte(fault, answer);
  if (!mishap.instead) mishap.lost = true;
  while (answer.complete())
    if (const auto more = next_byte(fault, answer))
      mishap.after.push_back(*more);
    else
      return;
}

}  // namespace s7200::serial

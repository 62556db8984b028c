// An answer that a slave sends wrongly, character by character: what goes out in place of each of its characters.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "serial_sim/faults/fault.hpp"

namespace s7200::serial {

/// A frame that is being sent, and the one before it, of a station.
struct AnswerInProgress {
  std::size_t length = 0;              ///< of the frame, with its CRC; 0: no frame is being sent, or it is not known
  std::vector<std::uint8_t> bytes{};   ///< of the answer so far, as the station gives them
  std::vector<std::uint8_t> sent{};    ///< in their place
  std::vector<std::uint8_t> before{};  ///< the frame before it; empty: there was none
  bool operator==(const AnswerInProgress&) const = default;

  bool complete() const { return bytes.size() >= length; }
};

/// Whether the misbehaviour is possible: a stale answer needs an earlier answer, a short answer needs some data.
bool possible(Misbehaviour misbehaviour, const AnswerInProgress& answer);

/// Puts what goes out in place of the last of answer.bytes into `mishap`, and notes it in answer.sent.
///
/// The answer is that of Modbus RTU: station, function, data, CRC. The sender's own time is not changed: it is busy for as
/// long as its own frame takes, and as what comes after that takes. Not documented, modelled so: an answer that is sent
/// twice has 3.5 characters of silence in between, as two frames have.
/// [AnswerChange.AnAnswerThatIsSentTwiceHasAPauseBetween]
void change(const Fault& fault, AnswerInProgress& answer, const SerialFormat& format, Mishap& mishap);

}  // namespace s7200::serial

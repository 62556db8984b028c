#include "tools/session/past/host_frames.hpp"

#include <algorithm>

#include "tools/session/past/line_times.hpp"
#include "tools/session/past/plc_requests.hpp"

namespace s7200::tools {

/// A character waits for those before it. What is dropped has not begun.
void HostFrames::note(const serial::HostCall& call, Time at) {
  Time free = at;
  const auto append = [&](Character character) {
    character.from = free;
    character.to = free + character.format.character_time();
    free = character.to;
    characters_.push_back(character);
  };
  if (call.what == serial::HostCall::What::Drop) {
    const auto waiting = std::ranges::find_if(characters_, [&](const Character& one) { return one.from >= at; });
    const std::vector<Character> kept(waiting, characters_.end());
    characters_.erase(waiting, characters_.end());
    if (!characters_.empty()) free = std::max(free, characters_.back().to);
    for (const Character& one : kept)
      if (one.sender != call.sender) append(one);
  }
  if (call.what != serial::HostCall::What::Send) return;
  if (!characters_.empty()) free = std::max(free, characters_.back().to);
  for (const serial::HostCharacter& one : call.characters)
    append({.byte = one.byte, .fault = one.fault, .sender = one.sender, .format = one.format});
}

std::vector<SentByHost> HostFrames::frames() const {
  std::vector<SentByHost> frames;
  for (const Character& one : characters_) {
    const bool follows = !frames.empty() && one.from == frames.back().to;
    const bool goes_on =
        follows || (!frames.empty() && one.from < frames.back().to + kNextPiece && !is_rtu_frame(frames.back().bytes));
    if (!goes_on) frames.push_back({.from = one.from, .format = one.format});
    frames.back().bytes.push_back(one.byte);
    frames.back().to = one.to;
  }
  return frames;
}

std::vector<HostTransmission> HostFrames::transmissions() const {
  using Fault = serial::HostCharacter::Fault;
  std::vector<HostTransmission> all;
  for (const Character& one : characters_) {
    const bool follows = !all.empty() && one.from == all.back().to && one.format == all.back().format;
    if (!follows) all.push_back({.from = one.from, .format = one.format});
    all.back().frame.push_back({one.byte, one.fault == Fault::WrongParity});
    all.back().lacks_stop_bit |= one.fault == Fault::NoStopBit || one.fault == Fault::Break;
    all.back().to = one.to;
  }
  return all;
}

}  // namespace s7200::tools

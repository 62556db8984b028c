#include "tools/session/past/actions/host_frames.hpp"

#include <algorithm>

#include "tools/session/past/actions/plc_requests.hpp"
#include "tools/session/past/line_times.hpp"

namespace s7200::tools {

Time HostFrames::duration(const Character& character) {
  if (character.fault != serial::HostCharacter::Fault::Break) return character.format.character_time();
  return std::max(character.lasts, serial::shortest_break(character.format)) + serial::mark_after_break(character.format);
}

/// A character waits for those before it.
void HostFrames::append(Character character, Time at) {
  character.from = characters_.empty() ? at : std::max(at, characters_.back().to);
  character.to = character.from + duration(character);
  characters_.push_back(character);
}

/// What is dropped has not begun.
void HostFrames::drop(std::uint64_t sender, Time at) {
  const auto waiting = std::ranges::find_if(characters_, [&](const Character& one) { return one.from >= at; });
  const std::vector<Character> kept(waiting, characters_.end());
  characters_.erase(waiting, characters_.end());
  for (const Character& one : kept)
    if (one.sender != sender) append(one, at);
}

void HostFrames::end_break(std::uint64_t sender, Time lasts) {
  const auto held = std::ranges::find_if(characters_, [&](const Character& one) {
    return one.fault == serial::HostCharacter::Fault::Break && one.sender == sender && one.lasts == 0;
  });
  if (held == characters_.end()) return;
  std::vector<Character> again(held, characters_.end());
  characters_.erase(held, characters_.end());
  again.front().lasts = lasts;
  for (const Character& one : again) append(one, one.from);
}

void HostFrames::note(const serial::HostCall& call, Time at) {
  using What = serial::HostCall::What;
  if (call.what == What::Drop) drop(call.sender, at);
  if (call.what == What::EndBreak) end_break(call.sender, call.lasts);
  if (call.what != What::Send) return;
  for (const serial::HostCharacter& one : call.characters)
    append({.byte = one.byte, .fault = one.fault, .sender = one.sender, .format = one.format}, at);
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

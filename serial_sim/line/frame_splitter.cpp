#include "serial_sim/line/frame_splitter.hpp"

#include <algorithm>
#include <utility>

namespace s7200::serial {

FrameSplitter::FrameSplitter(std::function<void(const WireFrame&)> on_frame) : on_frame_(std::move(on_frame)) {
  for (std::size_t wire = 0; wire < kWires; ++wire) ears_[wire].open.wire = static_cast<Wire>(wire);
}

void FrameSplitter::edge(Wire wire, Time at, bool mark) { ears_[static_cast<std::size_t>(wire)].line.drive(0, at, mark); }

void FrameSplitter::settled(Time until, const SerialFormat& port) {
  for (Ear& ear : ears_)
    if (port != ear.uart.state().format) ear.uart.configure(port, until);
  hear(until, port);
  // A character that began within the silence would be complete by then.
  for (Ear& ear : ears_)
    if (until > ear.open.end + port.silence() + port.character_time()) close(ear);
  tell();
}

void FrameSplitter::finish() {
  for (Ear& ear : ears_) close(ear);
  tell();
}

/// Both wires in one order of time.
void FrameSplitter::hear(Time until, const SerialFormat& port) {
  for (;;) {
    const std::size_t wire = ears_[0].queue.next() <= ears_[1].queue.next() ? 0 : 1;
    Ear& ear = ears_[wire];
    if (ear.queue.next() >= until) return;
    if (const auto received = ear.uart.handle(ear.queue.pop()).received) take(wire, *received, port);
  }
}

void FrameSplitter::take(std::size_t wire, const ReceivedCharacter& character, const SerialFormat& port) {
  Ear& ear = ears_[wire];
  WireFrame& open = ear.open;
  const Time other_spoke = ears_[1 - wire].last_start;
  const bool is_full = open.characters.size() == kLongestFrame;
  const bool is_answered = other_spoke >= open.end && other_spoke < character.start;
  if (is_full || is_answered || character.start > open.end + port.silence()) close(ear);
  open.characters.push_back(character);
  open.end = character.start + port.character_time();
  ear.last_start = character.start;
}

void FrameSplitter::close(Ear& ear) {
  if (ear.open.characters.empty()) return;
  closed_.push_back(ear.open);
  ear.open.characters.clear();
}

/// A frame waits for one on the other wire that began before it and is not over.
void FrameSplitter::tell() {
  if (closed_.empty()) return;
  Time open_since = kNever;
  for (const Ear& ear : ears_)
    if (!ear.open.characters.empty()) open_since = std::min(open_since, ear.open.start());
  const auto earlier = [](const WireFrame& a, const WireFrame& b) { return a.start() < b.start(); };
  std::stable_sort(closed_.begin(), closed_.end(), earlier);
  auto waiting = closed_.begin();
  for (; waiting != closed_.end() && waiting->start() <= open_since; ++waiting) on_frame_(*waiting);
  closed_.erase(closed_.begin(), waiting);
}

}  // namespace s7200::serial

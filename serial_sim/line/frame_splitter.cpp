#include "serial_sim/line/frame_splitter.hpp"

#include <algorithm>
#include <utility>

namespace s7200::serial {

FrameSplitter::FrameSplitter(std::function<void(const WireFrame&)> on_frame) : on_frame_(std::move(on_frame)) {
  for (std::size_t wire = 0; wire < kWires; ++wire) ears_[wire].open.wire = static_cast<Wire>(wire);
}

void FrameSplitter::edge(Wire wire, Time at, bool mark) { ears_[static_cast<std::size_t>(wire)].line.drive(0, at, mark); }

void FrameSplitter::settled(Time until, const SerialFormat& port) {
  for (Ear& ear : ears_) hear(ear, until, port);
  tell();
}

void FrameSplitter::finish() {
  for (Ear& ear : ears_) close(ear);
  tell();
}

void FrameSplitter::hear(Ear& ear, Time until, const SerialFormat& port) {
  if (port != ear.uart.state().format) ear.uart.configure(port, until);
  WireFrame& open = ear.open;
  while (ear.queue.next() < until) {
    const auto received = ear.uart.handle(ear.queue.pop()).received;
    if (!received) continue;
    const bool is_full = open.characters.size() == kLongestFrame;
    if (is_full || received->start > open.end + port.silence()) close(ear);
    open.characters.push_back(*received);
    open.end = received->start + port.character_time();
  }
  // A character that began within the silence would be complete by then.
  if (until > open.end + port.silence() + port.character_time()) close(ear);
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

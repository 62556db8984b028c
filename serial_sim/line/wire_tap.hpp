// Probes on the line, for whoever records what runs over it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interpreter/base/serial_format.hpp"
#include "serial_sim/line/line.hpp"

namespace s7200::serial {

/// The two directions, named as at the port of a PLC, of whatever make.
enum class Wire : std::uint8_t {
  Rx,  ///< what all others together make of the line: what the PLC hears, and what it would hear while it sends
  Tx,  ///< what the PLC drives
};

inline constexpr std::size_t kWires = 2;

/// Who watches the wires. Both are at mark (true) at first.
class WireSink {
 public:
  virtual ~WireSink() = default;

  /// `wire` is at `mark` from `at` on. Told in the order of time, Rx first, and only of changes.
  virtual void edge(Wire wire, Time at, bool mark) = 0;

  /// All edges before `until` have been told. The PLC's port is set to `port`.
  virtual void settled(Time until, const SerialFormat& port) = 0;

  /// Nothing more comes.
  virtual void finish() = 0;
};

/// Edges may be driven long before they are due and by several drivers; a tap tells them once they can no longer change.
/// It only watches: the line keeps no edge longer for it than for those who listen.
class WireTap final : public LineListener {
 public:
  /// `plc`: the driver that is the PLC. The line is not owned.
  WireTap(Line& line, int plc) : line_(line), plc_(plc) {}
  ~WireTap() { line_.detach(*this); }
  WireTap(const WireTap&) = delete;
  WireTap& operator=(const WireTap&) = delete;

  /// Tells `sink` what happens from `from` on; null ends that. Not owned.
  void watch(WireSink* sink, Time from);

  bool watched() const { return sink_ != nullptr; }

  /// No driver gets an edge before `until` any more.
  void settle(Time until, const SerialFormat& port) {
    if (sink_) tell(until, port);
  }

  /// The line has been restored to what it was at `now`.
  void go_back(Time now) { told_until_ = now; }

 private:
  void line_changed(Time) override {}
  Time needs_from() const override { return told_until_; }

  void tell(Time until, const SerialFormat& port);

  Line& line_;
  int plc_;
  WireSink* sink_ = nullptr;
  Time told_until_ = 0;  ///< edges before this
  std::array<bool, kWires> mark_{true, true};
};

}  // namespace s7200::serial

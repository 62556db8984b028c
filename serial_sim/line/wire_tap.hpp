// Probes on the line, for whoever records what runs over it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "interpreter/base/serial_format.hpp"
#include "serial_sim/line/line.hpp"

namespace s7200::serial {

/// The wires at the port of a PLC of any make: the two directions, and the line, which carries both.
enum class Wire : std::uint8_t {
  Rx,    ///< the line without the PLC: the level that all others together, and disturbances, give it
  Tx,    ///< the level that the PLC drives
  Line,  ///< the level at the port: what a receiver there reads that is always on, in a collision too
};

inline constexpr std::size_t kWires = 3;

/// A sink is told of all edges on the wires. All wires are at mark (true) at first.
class WireSink {
 public:
  virtual ~WireSink() = default;

  /// The wire is at `mark` from `at` on. Edges are told in the order of time and of Wire, and only changes. `driver` is the
  /// line's driver that holds it at space, of several the one with the lowest number; Line::kNobody at mark, and if a
  /// disturbance does.
  virtual void edge(Wire wire, Time at, bool mark, int driver) = 0;

  /// All edges before `until` have been told. The PLC's port is set to `port`.
  virtual void settled(Time until, const SerialFormat& port) = 0;

  /// The recording is over: no more edges come.
  virtual void finish() = 0;
};

/// Edges may be driven long before they are due and by several drivers; a tap tells them once they can no longer change.
/// It only watches: the line keeps no edge longer for it than for those who listen.
class WireTap final : public LineListener {
 public:
  /// `plc` is the number of the PLC's driver. The line is not owned.
  WireTap(Line& line, int plc) : line_(line), plc_(plc) {}
  ~WireTap() { line_.detach(*this); }
  WireTap(const WireTap&) = delete;
  WireTap& operator=(const WireTap&) = delete;

  /// Tells `sink` what happens from `from` on; null ends that. Not owned.
  void watch(WireSink* sink, Time from);

  /// Tells the sink that no driver gets another edge before `until`.
  void settle(Time until, const SerialFormat& port) {
    if (sink_) tell(until, port);
  }

  /// The line has been restored to what it was at `now`. The sink is told again what happens from there on; a level that is
  /// not the one it was told last is an edge at `now`.
  void go_back(Time now) { told_until_ = now; }

 private:
  void line_changed(Time) override {}
  Time needs_from() const override { return told_until_; }
  bool waits_for_settled_levels() const override { return true; }

  void tell(Time until, const SerialFormat& port);
  int driver_of(Wire wire, Time at) const;

  static constexpr std::array<bool, kWires> kMark{true, true, true};

  Line& line_;
  int plc_;
  WireSink* sink_ = nullptr;
  Time told_until_ = 0;                    ///< edges before this
  std::array<bool, kWires> mark_ = kMark;  ///< as the sink was told last
};

}  // namespace s7200::serial

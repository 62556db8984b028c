// Several sinks for the wires at one port.
#pragma once

#include <utility>
#include <vector>

#include "serial_sim/line/wire_tap.hpp"

namespace s7200::serial {

/// The sinks are not owned.
class WireFanOut final : public WireSink {
 public:
  explicit WireFanOut(std::vector<WireSink*> sinks) : sinks_(std::move(sinks)) {}

  void edge(Wire wire, Time at, bool mark, int driver) override {
    for (WireSink* const sink : sinks_) sink->edge(wire, at, mark, driver);
  }
  void settled(Time until, const SerialFormat& port) override {
    for (WireSink* const sink : sinks_) sink->settled(until, port);
  }
  void finish() override {
    for (WireSink* const sink : sinks_) sink->finish();
  }

 private:
  std::vector<WireSink*> sinks_;
};

}  // namespace s7200::serial

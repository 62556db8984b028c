// The levels on the line as a Value Change Dump (IEEE 1364, clause 18), for waveform viewers and sigrok.
#pragma once

#include <iosfwd>
#include <string_view>

#include "serial_sim/line/wire_tap.hpp"

namespace s7200::serial {

/// Wires `rx`, `tx` and `line` in nanoseconds, as Wire has them. The stream is not owned.
class VcdCapture final : public WireSink {
 public:
  /// The text at the start of each capture, including those from before there was `line`.
  static constexpr std::string_view kBeginning = "$comment s7200: rx is what ";

  explicit VcdCapture(std::ostream& out);

  void edge(Wire wire, Time at, bool mark, int driver) override;
  void settled(Time until, const SerialFormat&) override { until_ = until; }

  /// Writes how long the last levels lasted.
  void finish() override { go_to(until_); }

 private:
  void go_to(Time at);

  std::ostream& out_;
  Time at_ = 0;  ///< the time written last
  Time until_ = 0;
};

}  // namespace s7200::serial

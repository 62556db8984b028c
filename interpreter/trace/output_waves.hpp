// The outputs over time as a Value Change Dump (IEEE 1364, clause 18), for waveform viewers and sigrok.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <string_view>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// A wire for each point of Q and a vector of 16 bits for each word of AQ that the CPU has, in nanoseconds; all are 0 at
/// power-up. The stream is not owned.
class OutputWaves final : public TraceSink {
 public:
  /// How each dump begins.
  static constexpr std::string_view kBeginning = "$comment s7200: outputs of CPU ";

  OutputWaves(std::ostream& out, const CpuModel& model);
  void record(const TraceRecord& record) override;
  bool wants_scans() const override { return false; }

 private:
  void go_to(Time at);

  std::ostream& out_;
  std::array<std::uint8_t, 16> points_{};
  Time at_ = 0;  ///< the time written last
};

}  // namespace s7200

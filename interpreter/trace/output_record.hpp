// The outputs over time as CSV: one row for each change of a point of Q or a word of AQ.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <string_view>

#include "interpreter/trace/trace.hpp"

namespace s7200 {

/// Rows `2.000000,Q0.3,1` and `2.512000,AQW0,-5`, time in ms. All outputs are 0 before the first row. The stream is
/// not owned.
class OutputRecord final : public TraceSink {
 public:
  static constexpr std::string_view kFirstLine = "time_ms,address,value";

  explicit OutputRecord(std::ostream& out);
  void record(const TraceRecord& record) override;
  bool wants_scans() const override { return false; }

 private:
  std::ostream& out_;
  std::array<std::uint8_t, 16> points_{};
};

}  // namespace s7200

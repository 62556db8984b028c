// How fast a program is simulated on this computer.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/base/stop_token.hpp"
#include "interpreter/program/program.hpp"

namespace s7200::tools {

struct Figure {
  std::string name;
  std::string_view unit;
  double per_second = 0;
  double takes = 0;  ///< instead of a rate, and the less the better

  /// The speed: twice the value is twice as fast.
  double speed() const { return takes > 0 ? 1 / takes : per_second; }
};

/// The number of rounds that share the time of a figure; the best one counts.
inline constexpr int kRounds = 5;

/// The host's time for which each figure is measured. Once `stop` asks for it, no more are measured: all functions return
/// the figures that were complete before.
struct Effort {
  Time each;
  StopToken stop{};
};

/// The best round on one core. The program is a Modbus slave at address 1; throws std::runtime_error if it does not answer.
std::vector<Figure> measure(const std::shared_ptr<const Program>& program, const Effort& effort);

/// Measures mixed programs of three lengths (mixed_program.hpp), every scan run.
std::vector<Figure> measure_mixed(const Effort& effort);
inline constexpr std::array<std::uint32_t, 3> kMixedLengths{340, 1900, 4000};

/// Measures a slave whose first scan makes a table in loops, and that receives each character in an interrupt, like the one
/// of Application Tip 41. `every_scan`: no scan is passed over.
std::vector<Figure> measure_tip_like(const Effort& effort, bool every_scan);

/// Measures the speed of checking files, as `s7200 check` does it: lines of a listing of 100,000 (long_listing.hpp).
std::vector<Figure> measure_files(const Effort& effort);

/// Measures the time from the start of the process `command instructions LD` to its first output, by the clock; the shortest
/// of all. Throws std::runtime_error if it prints nothing.
std::vector<Figure> measure_start(const std::string& command, const Effort& effort);

}  // namespace s7200::tools

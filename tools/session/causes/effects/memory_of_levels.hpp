// Memory that changes hands without being written: each level of calls has local memory of its own, and the CPU gives the
// accumulators and SMB1 back when an interrupt routine ends. What a routine finds again is what it had left there.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "interpreter/cpu/cpu.hpp"
#include "tools/session/causes/effects/point_samples.hpp"

namespace s7200::tools {

class MemoryOfLevels {
 public:
  /// `seen` is the image as it was seen last; the CPU is not owned.
  MemoryOfLevels(const Cpu& cpu, std::vector<std::uint8_t>& seen, PointSamples& samples);

  /// If another level runs than when this was called last: makes its memory as it was seen last then, with what happened to it
  /// last.
  void follow();

 private:
  struct Kept {
    std::vector<std::uint8_t> bytes{};
    std::vector<std::size_t> changes{};  ///< by bit, as PointSamples has them
  };

  Kept kept(const Bits& place) const;
  void restore(const Bits& place, const Kept& kept);

  const Cpu& cpu_;
  std::vector<std::uint8_t>& seen_;
  PointSamples& samples_;
  std::size_t level_ = 0;
  bool in_interrupt_ = false;
  std::array<Kept, kLocalLevels> local_{};  // of those that do not run
  Kept accumulators_{}, flags_{};           // of the interrupted program
};

}  // namespace s7200::tools

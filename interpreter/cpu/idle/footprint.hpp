// What the program of a scan reads and writes of the state.
//
// A footprint is taken of a program whose instructions work on memory alone; counters, and timers that are off, may be among
// them, with what they remember. What such a program does follows from what it finds in its footprint: with the same values
// there it takes the same way in the same time and leaves the same, whatever else has changed.
#pragma once

#include <cstdint>
#include <vector>

#include "interpreter/analysis/effects/bits.hpp"
#include "interpreter/cpu/core.hpp"

namespace s7200 {

class Footprint {
 public:
  Footprint();

  /// Adds what the next instruction is going to read and write. Returns false if it works on more than memory, so that there
  /// is no footprint of this program.
  bool add_next(const Core& core);

  /// Whether all that has been written so far is now as it was before the program.
  bool unchanged(const State& before, const State& now);

  /// The program has ended: nothing is added any more.
  void complete(const Program& program);

  /// Whether both states have the same there.
  bool same_in(const State& a, const State& b) const;

  /// Whether SM0.4 or SM0.5 is in it.
  bool has_clock_bits() const { return has_clock_bits_; }
  /// Whether it has what the system writes in each scan: SM0.6, or the times of scans.
  bool has_scan_values() const { return has_scan_values_; }

 private:
  /// Eight bytes of the image, and the bits among them.
  struct Bytes {
    std::uint32_t at = 0;
    std::uint64_t mask = 0;
  };

  bool add_number(const Op& op);
  bool same_besides_memory(const State& a, const State& b, std::size_t levels) const;
  void add(const Bits& bits);
  bool has(std::uint32_t at, std::uint32_t count, std::uint8_t bits = 0xFF) const;

  std::vector<std::uint8_t> bits_;  // of each byte of the image, until it is complete
  std::vector<Bits> changed_{};     // written, and not known to be as before
  std::vector<Bytes> memory_{};
  std::vector<std::uint8_t> timers_{}, counters_{};
  std::size_t calls_ = 0;   // levels of subroutines
  std::size_t levels_ = 0;  // of local memory
  bool has_clock_bits_ = false, has_scan_values_ = false;
};

}  // namespace s7200

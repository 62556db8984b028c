// What bits have at a point of the program: each time it is passed they are looked at, and only what is new there is kept.
//
// A word that is written several times in a scan turns to and fro in each of them, in two runs as like as not in the same
// way, one step later. At the same point of the program it has one value in each of them.
#pragma once

#include <cstdint>
#include <vector>

#include "interpreter/analysis/effects/bits.hpp"
#include "tools/session/causes/effects/run_record.hpp"

namespace s7200::tools {

class PointSamples {
 public:
  /// `run` gets the series, and must live as long as this.
  explicit PointSamples(RunRecord& run);

  /// What happened last to a bit.
  void changed(std::uint64_t bit, std::size_t happening) { last_change_[bit] = happening + 1; }

  /// The same of each bit of a place, by the number of the happening from 1; 0: nothing has happened to it.
  std::vector<std::size_t> last_changes(const Bits& place) const;
  void set_last_changes(const Bits& place, const std::vector<std::size_t>& changes);

  /// Whether it is not what it was when it was looked at there before.
  bool is_new(Point point, const Bits& place, const std::vector<std::uint8_t>& image) const;

  /// At a point of the program, of the memory as it is then.
  void look(Point point, const std::vector<Bits>& places, const std::vector<std::uint8_t>& image, Time now);

  /// Of all memory, between two scans.
  void look_between_scans(const std::vector<std::uint8_t>& image, Time now);

 private:
  static std::vector<std::uint8_t> bytes_of(const Bits& place, const std::vector<std::uint8_t>& image);
  void compare(Point point, std::uint64_t first_byte, const std::uint8_t* now, std::uint8_t* last, std::size_t bytes,
               Time seen);

  RunRecord& run_;
  std::vector<std::vector<std::vector<std::uint8_t>>> last_;  // by point, by the number of the place: its bytes
  std::vector<std::uint8_t> between_;                         // the image of all memory when the last scan ended
  std::vector<std::size_t> last_change_;                      // by bit: its happening, from 1
};

}  // namespace s7200::tools

// The tables that the true execution times may be among.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/times.hpp"

namespace s7200 {

/// A figure that is a part of a sum, in ns.
struct PartOfSum {
  double figure = 0;
  TimeRange range;
};

/// Moves them so that they add up to that, as far as their ranges allow: each by the same share of the way to its range's
/// end. 30 (20 to 36) and 10 (8 to 14) add up to 40. If they are to give 45, which is 5 of the 10 that are left upwards,
/// each goes half of its way: 33 and 12. If they are to give 60, they end at 36 and 14.
void settle(std::span<PartOfSum> parts, double sum);

/// A table with each figure anywhere within its uncertainty, all ratios equally likely: with 25 percent from 1 / 1.25 to
/// 1.25 times the figure. Besides, the CPU is faster or slower as a whole by as much as is known to be possible, as far as
/// each figure's uncertainty allows it. Where the line says how far the true figure is at most, all between is equally
/// likely. Parts of a sum then move until it is within its own uncertainty. The same numbers give the same table.
///
/// A CPU was measured: CALL + RET take 45 us together, within 0, CALL + (interrupt entry) 60. CALL is drawn as 30 us, RET as
/// 10, the entry as 50. The first sum settles CALL at 33 and RET at 12. In the second CALL stays as it is, and the entry
/// alone moves, from 50 to 27.
TimeTable random_times(const TimeTable& table, std::uint32_t seed, std::uint32_t number);

/// The number of random tables in a band, and their seed.
struct BandSettings {
  std::size_t random = 0;
  std::uint32_t seed = 1;
};

/// Tables with their names, then random ones around each of these in turn, which are made when they are asked for.
class TimesBand {
 public:
  struct Named {
    std::string name;
    TimeTable table;
  };

  TimesBand(std::vector<Named> named, const BandSettings& settings) : named_(std::move(named)), settings_(settings) {}

  std::size_t size() const { return named_.size() + settings_.random; }
  TimeTable operator[](std::size_t table) const;

  /// The name of a table: `cpu214`, `random table 12 of seed 1`; random tables are counted from 1 on.
  std::string name(std::size_t table) const;

  /// The last table, which is a random one: in place of a name it has the text that a copy must say of it.
  Named last() const;

 private:
  std::vector<Named> named_;
  BandSettings settings_;
};

}  // namespace s7200

// The tables that the true execution times may be among.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times.hpp"

namespace s7200 {

/// A table with each figure anywhere within its uncertainty, all ratios equally likely: with 25 percent from 1 / 1.25 to
/// 1.25 times the figure. The same numbers give the same table.
TimeTable random_times(const TimeTable& table, std::uint32_t seed, std::uint32_t number);

/// How many random tables there are in a band, and which.
struct BandSettings {
  std::size_t random = 0;
  std::uint32_t seed = 1;
};

/// The table itself, then `others`, then random ones within its uncertainty, which are made when they are asked for.
class TimesBand {
 public:
  TimesBand(TimeTable own, const std::vector<TimeTable>& others, const BandSettings& settings);

  std::size_t size() const { return named_.size() + settings_.random; }
  TimeTable operator[](std::size_t table) const;

 private:
  std::vector<TimeTable> named_;
  BandSettings settings_;
};

}  // namespace s7200

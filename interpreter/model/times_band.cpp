#include "interpreter/model/times_band.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace s7200 {

TimeTable random_times(const TimeTable& table, std::uint32_t seed, std::uint32_t number) {
  std::seed_seq seeds{seed, number};
  std::mt19937 random(seeds);
  const auto within = [&](Time figure, double uncertainty) {
    const double place = (static_cast<double>(random()) + 0.5) / 0x1p32;  // between 0 and 1
    const double factor = std::pow(1 + uncertainty / 100, 2 * place - 1);
    // No time becomes none: 0 is for labels and heads alone.
    return figure == 0 ? 0 : std::max<Time>(1, std::llround(static_cast<double>(figure) * factor));
  };
  return table.with([&](TimeRow& row) {
    row.base = within(row.base, row.uncertainty);
    row.per_unit = within(row.per_unit, row.uncertainty);
  });
}

TimesBand::TimesBand(TimeTable own, const std::vector<TimeTable>& others, const BandSettings& settings)
    : named_{std::move(own)}, settings_(settings) {
  named_.insert(named_.end(), others.begin(), others.end());
}

TimeTable TimesBand::operator[](std::size_t table) const {
  if (table < named_.size()) return named_[table];
  return random_times(named_.front(), settings_.seed, static_cast<std::uint32_t>(table - named_.size()));
}

}  // namespace s7200

#include "interpreter/model/times_band.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "interpreter/model/times_file.hpp"

namespace s7200 {

namespace {

/// A CPU 214 that is faster or slower as a whole by more contradicts Application Tip 41, whose first scan takes 655 to 735
/// ms (measuring/statements.cpp) and 690 ms with the tables of this CPU. In percent.
constexpr double kAsAWhole = 6;

}  // namespace

TimeTable random_times(const TimeTable& table, std::uint32_t seed, std::uint32_t number) {
  std::seed_seq seeds{seed, number};
  std::mt19937 random(seeds);
  /// Between 1 / (1 + percent / 100) and its inverse.
  const auto factor = [&](double percent) {
    const double place = (static_cast<double>(random()) + 0.5) / 0x1p32;  // between 0 and 1
    return std::pow(1 + percent / 100, 2 * place - 1);
  };
  const double of_all = factor(kAsAWhole);
  const auto within = [&](Time figure, double uncertainty) {
    const double most = 1 + uncertainty / 100, drawn = std::clamp(of_all * factor(uncertainty), 1 / most, most);
    if (figure == 0) return figure;  // of a label or a routine's head; any other stays above 0
    return std::clamp<Time>(std::llround(static_cast<double>(figure) * drawn), 1, kLongestFigure);
  };
  return table.with([&](TimeRow& row) {
    row.base = within(row.base, row.uncertainty);
    row.per_unit = within(row.per_unit, row.uncertainty);
  });
}

TimeTable TimesBand::operator[](std::size_t table) const {
  if (table < named_.size()) return named_[table].table;
  const std::size_t number = table - named_.size();
  return random_times(named_[number % named_.size()].table, settings_.seed, static_cast<std::uint32_t>(number));
}

std::string TimesBand::name(std::size_t table) const {
  if (table < named_.size()) return named_[table].name;
  return fmt::format("random table {} of seed {}", table - named_.size() + 1, settings_.seed);
}

}  // namespace s7200

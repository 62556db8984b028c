#include "interpreter/model/times/times_band.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "interpreter/base/text/text.hpp"
#include "interpreter/model/times/times_file.hpp"

namespace s7200 {

namespace {

/// A CPU 214 that is faster or slower as a whole by more contradicts Application Tip 41, whose first scan takes 655 to 735
/// ms (measuring/statements.cpp) and 690 ms with the tables of this CPU. In percent.
constexpr double kAsAWhole = 6;

/// A drawn time in place of a figure. That of a label or a routine's head may be 0; any other stays above 0.
Time drawn_time(double ns, Time in_place_of) {
  return std::clamp<Time>(std::llround(ns), in_place_of == 0 ? 0 : 1, kLongestFigure);
}

/// The number of times that each line of a table is a part of a sum, by the line's number: a line may have several mnemonics
/// of the sum.
std::map<std::size_t, int> lines_of_sum(const TimeTable& table, const std::string& sum) {
  std::map<std::size_t, int> lines;
  for (const std::string& name : parts_of_sum(sum))
    if (const TimeRow* known = table.find(name, {})) ++lines[static_cast<std::size_t>(known - table.rows().data())];
  return lines;
}

/// A table drawn around another, with the sums that are known. What an earlier sum has settled stays as it is.
TimeTable with_sums(TimeTable drawn, const TimeTable& around) {
  std::map<std::size_t, double> settled;  // figures by their lines
  for (const TimeRow& sum : drawn.rows()) {
    if (sum.mnemonics.front() != kSum) continue;
    auto left = static_cast<double>(sum.base);
    const std::map<std::size_t, int> lines = lines_of_sum(around, sum.form);
    std::vector<PartOfSum> parts;
    for (const auto& [line, times] : lines) {
      const TimeRange range = range_of_base(around.rows()[line]);
      if (settled.contains(line))
        left -= times * settled[line];
      else
        parts.push_back({static_cast<double>(times * drawn.rows()[line].base), {times * range.least, times * range.most}});
    }
    settle(parts, left);
    auto part = parts.begin();
    for (const auto& [line, times] : lines)
      if (!settled.contains(line)) settled[line] = (part++)->figure / times;
  }
  std::size_t line = 0;
  return drawn.with([&](TimeRow& row) {
    const auto figure = settled.find(line++);
    if (figure != settled.end()) row.base = drawn_time(figure->second, row.base);
  });
}

}  // namespace

void settle(std::span<PartOfSum> parts, double sum) {
  double figures = 0, way = 0;
  for (const PartOfSum& part : parts) figures += part.figure;
  const auto end = [up = sum > figures](const PartOfSum& part) { return up ? part.range.most : part.range.least; };
  for (const PartOfSum& part : parts) way += end(part) - part.figure;
  if (way == 0) return;
  const double share = std::clamp((sum - figures) / way, 0.0, 1.0);
  for (PartOfSum& part : parts) part.figure += share * (end(part) - part.figure);
}

TimeTable random_times(const TimeTable& table, std::uint32_t seed, std::uint32_t number) {
  std::seed_seq seeds{seed, number};
  std::mt19937 random(seeds);
  /// Draws a number between 0 and 1.
  const auto place = [&] { return (static_cast<double>(random()) + 0.5) / 0x1p32; };
  /// Draws a factor between 1 / (1 + percent / 100) and its inverse.
  const auto factor = [&](double percent) { return std::pow(1 + percent / 100, 2 * place() - 1); };
  const double of_all = factor(kAsAWhole);
  const auto of_ratio = [&](Time figure, double uncertainty) {
    const double most = 1 + uncertainty / 100, drawn = std::clamp(of_all * factor(uncertainty), 1 / most, most);
    return drawn_time(static_cast<double>(figure) * drawn, figure);
  };
  const auto of_range = [&](Time figure, const TimeRange& range) {
    return drawn_time(range.least + place() * (range.most - range.least), figure);
  };
  TimeTable drawn = table.with([&](TimeRow& row) {
    const TimeRange base = range_of_base(row), unit = range_of_unit(row);
    row.base = row.base_within > 0 ? of_range(row.base, base) : of_ratio(row.base, row.uncertainty);
    row.per_unit = row.per_unit_within > 0 ? of_range(row.per_unit, unit) : of_ratio(row.per_unit, row.uncertainty);
  });
  return with_sums(std::move(drawn), table);
}

TimeTable TimesBand::operator[](std::size_t table) const {
  if (table < named_.size()) return named_[table].table;
  const std::size_t number = table - named_.size();
  return random_times(named_[number % named_.size()].table, settings_.seed, static_cast<std::uint32_t>(number));
}

TimesBand::Named TimesBand::last() const {
  const std::size_t table = size() - 1;
  const std::string around = stl::printable(named_[(table - named_.size()) % named_.size()].name);
  return {
      fmt::format("{} around {}: each figure drawn; form, marker and source are those of {}", name(table), around, around),
      (*this)[table]};
}

std::string TimesBand::name(std::size_t table) const {
  if (table < named_.size()) return named_[table].name;
  return fmt::format("random table {} of seed {}", table - named_.size() + 1, settings_.seed);
}

}  // namespace s7200

#include "tools/recordings/samplerate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"

namespace s7200::tools {
namespace {

struct Unit {
  std::string_view word;
  double hertz;
};
constexpr std::array kUnits{Unit{"", 1},    Unit{"HZ", 1},    Unit{"K", 1e3}, Unit{"KHZ", 1e3},
                            Unit{"M", 1e6}, Unit{"MHZ", 1e6}, Unit{"G", 1e9}, Unit{"GHZ", 1e9}};

constexpr Between<double> kRates{1, 1e11};

}  // namespace

std::optional<std::uint64_t> samplerate_of(std::string_view text) {
  text = stl::trim(text);
  const std::size_t end = std::min(text.find_first_not_of("0123456789."), text.size());
  const auto figure = parse_decimal<double>(text.substr(0, end));
  const std::string word = stl::upper_case(stl::trim(text.substr(end)));
  const auto unit = std::ranges::find(kUnits, word, &Unit::word);
  if (!figure || unit == kUnits.end() || !kRates.has(*figure * unit->hertz)) return {};
  return static_cast<std::uint64_t>(std::llround(*figure * unit->hertz));
}

}  // namespace s7200::tools

#include "tools/recordings/levels/samplerate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

struct RateUnit {
  std::string_view word;
  double hertz;
};
constexpr std::array kRateUnits{RateUnit{"", 1},    RateUnit{"HZ", 1},    RateUnit{"K", 1e3}, RateUnit{"KHZ", 1e3},
                                RateUnit{"M", 1e6}, RateUnit{"MHZ", 1e6}, RateUnit{"G", 1e9}, RateUnit{"GHZ", 1e9}};

constexpr Between<double> kPossibleRates{1, 1e11};

}  // namespace

std::optional<std::uint64_t> samplerate_of(std::string_view text) {
  text = stl::trim(text);
  const std::size_t end = std::min(text.find_first_not_of("0123456789."), text.size());
  const auto figure = parse_decimal<double>(text.substr(0, end));
  const std::string word = stl::upper_case(stl::trim(text.substr(end)));
  const auto unit = std::ranges::find(kRateUnits, word, &RateUnit::word);
  if (!figure || unit == kRateUnits.end() || !kPossibleRates.has(*figure * unit->hertz)) return {};
  return static_cast<std::uint64_t>(std::llround(*figure * unit->hertz));
}

}  // namespace s7200::tools

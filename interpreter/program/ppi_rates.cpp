#include "interpreter/program/ppi_rates.hpp"

#include <fmt/format.h>

#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/program/program.hpp"

namespace s7200 {
namespace {

struct Rate {
  std::uint32_t baud;
  CpuSet cpus;
};
constexpr std::array kRates{Rate{9600, kEveryCpu}, Rate{19200, kEveryCpu}, Rate{187500, kCpu22x}};

std::optional<std::uint32_t> parse_rate(std::string_view text, const CpuModel& model, std::string& why) {
  const auto baud = parse_decimal<std::uint32_t>(text);
  for (const Rate& rate : kRates) {
    if (rate.baud != baud) continue;
    if ((rate.cpus & model.self) != 0) return baud;
    why = needs(fmt::format("PPI at {} baud needs", rate.baud), rate.cpus);
    return {};
  }
  why = fmt::format("'{}' is not a rate of PPI; there are 9600, 19200 and, on {}, 187500", stl::shortened(text),
                    to_text(kCpu22x));
  return {};
}

}  // namespace

std::optional<PpiRates> parse_ppi_rates(std::string_view text, const CpuModel& model, std::string& why) {
  const std::size_t comma = text.find(',');
  const auto first = parse_rate(stl::trim(text.substr(0, comma)), model, why);
  if (!first) return {};
  if (comma == std::string_view::npos) return PpiRates{*first, *first};
  if (model.ports < kPorts.size()) {
    why = fmt::format("CPU {} has no port 1 for the second rate; a second port needs {}", model.name, to_text(kTwoPorts));
    return {};
  }
  const auto second = parse_rate(stl::trim(text.substr(comma + 1)), model, why);
  return second ? std::optional(PpiRates{*first, *second}) : std::nullopt;
}

std::string to_text(const PpiRates& rates) {
  return rates[0] == rates[1] ? fmt::format("{}", rates[0]) : fmt::format("{},{}", rates[0], rates[1]);
}

std::shared_ptr<const Program> with_ppi_rates(const Program& program, const PpiRates& rates) {
  const auto same = std::make_shared<Program>(program);
  same->ppi_rates = rates;
  return same;
}

}  // namespace s7200

#include "interpreter/program/loading/system_block.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/operands/address.hpp"
#include "interpreter/program/program.hpp"

namespace s7200 {
namespace {

struct Rate {
  std::uint32_t baud;
  CpuSet cpus;
};
constexpr std::array kRates{Rate{9600, kEveryCpu}, Rate{19200, kEveryCpu}, Rate{187500, kCpu22x}};

Result<std::uint32_t> parse_rate(std::string_view text, const CpuModel& model) {
  const auto baud = parse_decimal<std::uint32_t>(text);
  for (const Rate& rate : kRates) {
    if (rate.baud != baud) continue;
    if ((rate.cpus & model.self) != 0) return *baud;
    return Trouble{needs(fmt::format("PPI at {} baud needs", rate.baud), rate.cpus)};
  }
  return trouble("'{}' is not a rate of PPI; write {}", stl::shortened(text), ppi_rates_text());
}

Result<std::uint8_t> parse_station(std::string_view text, const CpuModel&) {
  const auto station = parse_decimal<std::uint8_t>(text);
  if (station && *station >= 1 && *station <= ppi::kLastStation) return *station;
  return trouble("'{}' is not a PPI station from 1 to {}", stl::shortened(text), ppi::kLastStation);
}

/// Calls a function for each value of a list: those of port 0, port 1 and so on. The last is also that of the ports after it.
template <class Each>
Result<std::array<Each, kPorts.size()>> parse_ports(std::string_view text, const CpuModel& model, std::string_view what,
                                                    Result<Each> (*parse)(std::string_view, const CpuModel&)) {
  constexpr std::array kOrder{"first", "second", "third", "fourth"};
  std::array<Each, kPorts.size()> values{};
  std::size_t port = 0;
  for (std::size_t begin = 0; begin <= text.size(); ++port) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (port > 0 && port >= model.ports)
      return trouble("CPU {} has no port {} for the {} {}{}", model.name, port, kOrder.at(port), what,
                     port == 1 ? "; a second port needs " + to_text(kTwoPorts) : "");
    const auto value = parse(stl::trim(text.substr(begin, end - begin)), model);
    if (!value) return value.trouble();
    std::fill(values.begin() + static_cast<std::ptrdiff_t>(port), values.end(), *value);
    begin = end + 1;
  }
  return values;
}

bool contains(const RetentiveRange& whole, const RetentiveRange& part) {
  return whole.area == part.area && part.first >= whole.first && part.first + part.count <= whole.first + whole.count;
}

/// `VB0:100`, `T0:32`
Result<RetentiveRange> parse_retentive_range(std::string_view text, const CpuModel& model) {
  const auto place = parse_range(text, model);
  const bool area = text.size() > 1 && std::string_view("VMTC").find(stl::upper_case(text.substr(0, 1))) != text.npos;
  if (!place && area) return place.trouble();
  if (!place)
    return trouble("'{}' is no range of memory; write for example VB0:100, MB0:14, T0:32, C0:5, or none",
                   stl::shortened(text));
  const bool numbered = info(place->area).element != 0;
  const RetentiveRange range{place->area, place->number, numbered ? place->count : place->bytes()};
  const auto possible = retainable(model);
  const bool fits = std::ranges::any_of(possible, [&](const RetentiveRange& whole) { return contains(whole, range); });
  if (fits && place->width != Width::Bit) return range;
  return trouble("'{}' cannot be retentive; bytes of V and M, timers of TONR (T0 to T31, T64 to T95) and counters can",
                 stl::shortened(text));
}

template <class Each>
std::string ports_text(const std::array<Each, kPorts.size()>& ports) {
  const bool alike = std::ranges::all_of(ports, [&](const Each& port) { return port == ports[0]; });
  return alike ? fmt::format("{}", ports[0]) : fmt::format("{}", fmt::join(ports, ","));
}

}  // namespace

std::string ppi_rates_text() {
  std::string text;
  for (const Rate& rate : kRates) {
    if (!text.empty()) text += &rate == &kRates.back() ? " or" : ",";
    if (rate.cpus != kEveryCpu) text += fmt::format(", on {},", to_text(rate.cpus));
    text += fmt::format("{}{}", text.empty() ? "" : " ", rate.baud);
  }
  return text;
}

Result<PpiRates> parse_ppi_rates(std::string_view text, const CpuModel& model) {
  return parse_ports(text, model, "rate", parse_rate);
}

Result<SecondRequest> parse_second_request(std::string_view text) {
  for (std::size_t i = 0; i < kSecondRequestWords.size(); ++i)
    if (text == kSecondRequestWords[i]) return static_cast<SecondRequest>(i);
  return trouble("'{}' is not what a port does with a second request; write {}", stl::shortened(text),
                 fmt::join(kSecondRequestWords, " or "));
}

Result<PpiStations> parse_ppi_stations(std::string_view text, const CpuModel& model) {
  return parse_ports(text, model, "station", parse_station);
}

std::string to_text(const PpiRates& rates) { return ports_text(rates); }

std::string to_text(const PpiStations& stations) { return ports_text(stations); }

std::vector<RetentiveRange> retainable(const CpuModel& model) {
  std::vector<RetentiveRange> ranges{{Area::V, 0, model.size_of(Area::V)}, {Area::M, 0, model.size_of(Area::M)}};
  for (const RetentiveRange& timers : {RetentiveRange{Area::T, 0, 32}, RetentiveRange{Area::T, 64, 32}})
    if (timers.first < model.size_of(Area::T)) ranges.push_back(timers);
  ranges.push_back({Area::C, 0, model.size_of(Area::C)});
  return ranges;
}

Result<std::vector<RetentiveRange>> parse_retentive(std::string_view text, const CpuModel& model) {
  std::vector<RetentiveRange> ranges;
  if (stl::upper_case(stl::trim(text)) == "NONE") return ranges;
  for (std::size_t from = 0, comma = 0; comma != std::string_view::npos; from = comma + 1) {
    comma = text.find(',', from);
    const auto range = parse_retentive_range(stl::trim(text.substr(from, comma - from)), model);
    if (!range) return range.trouble();
    ranges.push_back(*range);
  }
  if (ranges.size() <= kMostRetentiveRanges) return ranges;
  return trouble("{} ranges; a system block has {} at most", ranges.size(), kMostRetentiveRanges);
}

std::string to_text(const std::vector<RetentiveRange>& ranges) {
  std::string text;
  for (const RetentiveRange& range : ranges)
    text += fmt::format("{}{}{}{}:{}", text.empty() ? "" : ",", info(range.area).name, info(range.area).element ? "" : "B",
                        range.first, range.count);
  return text.empty() ? "none" : text;
}

std::shared_ptr<const Program> with_system_block(const Program& program, const SystemBlock& block) {
  const auto same = std::make_shared<Program>(program);
  same->system_block = block;
  return same;
}

}  // namespace s7200

#include "tools/faces/dap/addresses.hpp"

#include <fmt/format.h>

#include <charconv>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/operands/address.hpp"
#include "tools/session/observers/call_stack.hpp"

namespace s7200::tools::dap {
namespace {

constexpr std::int64_t kInstructions = 0x1000'0000;  // the number of the first one
constexpr std::uint32_t kRoutines = 0x0400'0000;     // where what the innermost one has begins
constexpr std::uint32_t kOfARoutine = 0x100;         // from one to the next
constexpr std::uint32_t kSaved = 0x10;               // of that, where the accumulators begin

std::optional<std::int64_t> number_of(std::string_view text) {
  if (!text.starts_with("0x")) return {};
  std::int64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data() + 2, end, number, 16);
  return error == std::errc{} && stopped == end ? std::optional(number) : std::nullopt;
}

MemoryPlace place_in(const AreaInfo& area, std::uint32_t at, const CpuModel& model) {
  return {at, area.base, area.base + model.size_of(area.area) * area.step()};
}

MemoryPlace place_of(Owner owner, std::uint32_t open, const CpuModel& model) {
  const bool stack = owner == Owner::LogicStack;
  const std::uint32_t begin = kRoutines + open * kOfARoutine + (stack ? 0 : kSaved);
  const std::uint32_t size = stack ? LogicStack::kLevels : model.size_of(Area::AC) * info(Area::AC).step();
  return {begin, begin, begin + size, owner, open};
}

std::optional<MemoryPlace> of_routine(std::int64_t number, const CpuModel& model) {
  if (number < kRoutines || number >= kRoutines + kMostOpen * kOfARoutine) return {};
  const auto at = static_cast<std::uint32_t>(number);
  for (const Owner owner : {Owner::LogicStack, Owner::SavedAccumulators}) {
    MemoryPlace place = place_of(owner, (at - kRoutines) / kOfARoutine, model);
    if (at < place.begin || at >= place.end) continue;
    place.at = at;
    return place;
  }
  return {};
}

/// `stack`, `stack:1`, `AC:1`
std::optional<MemoryPlace> of_routine(std::string_view reference, const CpuModel& model) {
  const std::size_t colon = reference.find(':');
  const std::string name = stl::upper_case(reference.substr(0, colon));
  const auto open = colon == std::string_view::npos ? std::optional<std::uint32_t>(0)
                                                    : parse_decimal<std::uint32_t>(reference.substr(colon + 1));
  if (!open || *open >= kMostOpen) return {};
  if (name == "STACK") return place_of(Owner::LogicStack, *open, model);
  if (name == "AC" && colon != std::string_view::npos) return place_of(Owner::SavedAccumulators, *open, model);
  return {};
}

}  // namespace

std::optional<MemoryPlace> find_memory(std::string_view reference, const Program& program) {
  const CpuModel& model = *program.model;
  if (const auto place = of_routine(reference, model)) return place;
  if (const auto number = number_of(reference)) {
    if (const auto place = of_routine(*number, model)) return place;
    for (const AreaInfo& area : all_areas()) {
      const MemoryPlace place = place_in(area, static_cast<std::uint32_t>(*number), model);
      if (*number >= place.begin && *number < place.end) return place;
    }
    return {};
  }
  if (const auto area = area_named(stl::upper_case(reference)); area && model.size_of(*area) != 0)
    return place_in(info(*area), info(*area).base, model);
  const auto range = parse_range(reference, program);
  return range ? std::optional(place_in(info(range->area), range->at, model)) : std::nullopt;
}

std::vector<std::uint8_t> bytes_of(const MemoryPlace& place, const State& state) {
  if (place.owner == Owner::All) return {state.image.begin() + place.begin, state.image.begin() + place.end};
  const auto routines = open_routines(state);
  std::vector<std::uint8_t> bytes;
  if (place.owner == Owner::LogicStack && (place.open < routines.size() || place.open == 0)) {
    const LogicStack stack = routines.empty() ? state.stack : routines[place.open].stack;
    for (int level = 0; level < LogicStack::kLevels; ++level) bytes.push_back(stack.level(level) ? 1 : 0);
  }
  if (place.owner == Owner::SavedAccumulators && place.open < routines.size()) {
    const auto& all = routines[place.open].accumulators;
    bytes.assign(all.begin(), all.begin() + (place.end - place.begin));
  }
  return bytes;
}

std::string stack_reference(std::uint32_t open) { return open == 0 ? "stack" : fmt::format("stack:{}", open); }

std::string accumulators_reference(std::uint32_t open, bool interrupted) {
  return interrupted ? fmt::format("AC:{}", open) : "AC";
}

std::string level_reference(std::uint32_t open, std::uint32_t level) {
  return address_text(kRoutines + open * kOfARoutine + level);
}

std::string at_station(const std::string& reference, std::size_t station) {
  if (station == 0 || reference.empty()) return reference;
  if (const auto number = number_of(reference))
    return address_text(*number + static_cast<std::int64_t>(station) * kOfAStation);
  return fmt::format("{}@{}", reference, station);
}

std::optional<StationReference> find_station(std::string_view reference, std::size_t stations) {
  StationReference found{0, std::string(reference)};
  const std::size_t sign = reference.rfind('@');
  if (const auto number = number_of(reference)) {
    found = {static_cast<std::size_t>(*number / kOfAStation), address_text(*number % kOfAStation)};
  } else if (sign != std::string_view::npos) {
    const auto station = parse_decimal<std::uint32_t>(reference.substr(sign + 1));
    if (!station) return {};
    found = {*station, std::string(reference.substr(0, sign))};
  }
  return found.station < stations ? std::optional(found) : std::nullopt;
}

std::string instruction_reference(std::int64_t op) { return address_text(kInstructions + op); }

std::optional<std::int64_t> find_instruction_number(std::string_view reference) {
  const auto number = number_of(reference);
  return number && *number >= kInstructions / 2 ? std::optional(*number - kInstructions) : std::nullopt;
}

std::string address_text(std::int64_t address) { return fmt::format("0x{:08X}", address); }

}  // namespace s7200::tools::dap

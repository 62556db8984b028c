#include "tools/dap/addresses.hpp"

#include <fmt/format.h>

#include <charconv>

#include "interpreter/base/text.hpp"
#include "interpreter/program/address.hpp"

namespace s7200::tools::dap {
namespace {

constexpr std::int64_t kInstructions = 0x1000'0000;  // the number of the first one

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

}  // namespace

std::optional<MemoryPlace> find_memory(std::string_view reference, const Program& program) {
  const CpuModel& model = *program.model;
  if (const auto number = number_of(reference)) {
    for (const AreaInfo& area : all_areas()) {
      const MemoryPlace place = place_in(area, static_cast<std::uint32_t>(*number), model);
      if (*number >= place.begin && *number < place.end) return place;
    }
    return {};
  }
  if (const auto area = area_named(stl::upper_case(reference)); area && model.size_of(*area) != 0)
    return place_in(info(*area), info(*area).base, model);
  std::string why;
  const auto range = parse_range(reference, program, why);
  return range ? std::optional(place_in(info(range->area), range->at, model)) : std::nullopt;
}

std::string instruction_reference(std::int64_t op) { return address_text(kInstructions + op); }

std::optional<std::int64_t> find_instruction_number(std::string_view reference) {
  const auto number = number_of(reference);
  return number && *number >= kInstructions / 2 ? std::optional(*number - kInstructions) : std::nullopt;
}

std::string address_text(std::int64_t address) { return fmt::format("0x{:08X}", address); }

}  // namespace s7200::tools::dap

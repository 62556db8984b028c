#include "tools/session/words/force_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/special_memory.hpp"
#include "tools/session/past/actions/access.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools {
namespace {

bool room_for(Forcing forcing, const std::vector<Assignment>& assignments) {
  return std::ranges::all_of(assignments, [&](const Assignment& a) { return forcing::add(forcing, a.place, a.value); });
}

}  // namespace

Result<Force> force_of(const std::vector<std::string>& assignments, const Cpu& cpu) {
  Force force;
  for (const std::string& text : assignments) {
    const auto assignment = parse_assignment(text, cpu.program());
    if (!assignment) return assignment.trouble();
    if (!forcing::possible(assignment->place))
      return trouble(
          "'{}' cannot be forced: the CPU forces points of I and Q, bytes, words and double words of V and M, and words of "
          "AI and AQ",
          stl::shortened(text));
    force.assignments.push_back(*assignment);
  }
  const Forcing& now = cpu.state().forcing;
  if (room_for(now, force.assignments)) return force;
  const std::size_t limit = now.memory.size();
  const auto given = std::ranges::count_if(
      force.assignments, [](const Assignment& a) { return a.place.area != Area::I && a.place.area != Area::Q; });
  if (now.values == limit)
    return trouble("no room: {} values of memory are forced already, as many as the CPU can; 'unforce' releases one", limit);
  if (now.values == 0) return trouble("no room: {} values of memory given, {} is the limit", given, limit);
  return trouble("no room: {} values of memory given, {} forced already, {} is the limit; 'unforce' releases one", given,
                 now.values, limit);
}

Result<Unforce> unforce_of(const std::vector<std::string>& places, const Cpu& cpu) {
  const std::vector<Forced> all = forced_in(cpu);
  Unforce unforce;
  if (places.size() == 1 && stl::lower_case(places[0]) == "all") {
    for (const Forced& forced : all) unforce.places.push_back(forced.place);
    return unforce;
  }
  for (const std::string& text : places) {
    const auto range = parse_range(text, cpu.program());
    if (!range) return range.trouble();
    const Bits bits = bits_of(*range);
    if (std::ranges::none_of(all, [&](const Forced& forced) { return bits_of(forced.place).overlaps(bits); }))
      return trouble("{} is not forced; 'force' lists what is", range->name_of(0));
    unforce.places.push_back(*range);
  }
  return unforce;
}

/// Potentiometers and the mode switch are turned by hand.
bool is_from_field(const MemoryRange& place) {
  const bool potentiometer =
      place.width == Width::Byte && std::ranges::find(sm::kPotentiometer, place.at) != sm::kPotentiometer.end();
  const bool mode_switch = place.width == Width::Bit && place.at == sm::kScanStatus && 1U << place.bit == sm::kModeSwitchRun;
  return place.area == Area::I || place.area == Area::AI || potentiometer || mode_switch;
}

std::string not_settable(const MemoryRange& place) {
  const bool read_only = place.area == Area::SM && place.at < sm::byte(kReadOnlySpecialMemory);
  if (!read_only || is_from_field(place)) return {};
  return fmt::format("{} cannot be set: only the CPU writes SM0.0 to SM{}.7", place.name_of(0), kReadOnlySpecialMemory - 1);
}

std::vector<Forced> forced_in(const Cpu& cpu) {
  std::vector<Forced> all;
  for (const Assignment& forced : forcing::listed(cpu.state().forcing)) {
    std::array<std::uint8_t, 4> bytes{};
    store32(bytes.data(), forced.value);
    const std::size_t size = s7200::bytes_of(forced.place.width);
    all.push_back({forced.place, value_text(cpu.program(), forced.place, {bytes.data() + bytes.size() - size, size})});
  }
  return all;
}

}  // namespace s7200::tools

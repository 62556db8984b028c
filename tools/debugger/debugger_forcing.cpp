// The commands force and unforce, and how what is forced is shown.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ostream>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/cpu/forcing.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/memory.hpp"

namespace s7200::tools {
namespace {

/// `1`, `16#0005 (5)`
std::string forced_value(const Program& program, const Assignment& forced) {
  std::array<std::uint8_t, 4> bytes{};
  store32(bytes.data(), forced.value);
  const std::size_t size = s7200::bytes_of(forced.place.width);
  return value_text(program, forced.place, {bytes.data() + bytes.size() - size, size});
}

constexpr std::string_view kRed = "\x1b[31m", kPlain = "\x1b[0m";

std::string cannot_force(std::string_view what) {
  return fmt::format(
      "'{}' cannot be forced: the CPU forces points of I and Q, bytes, words and double words of V and M, and words of AI "
      "and AQ",
      stl::shortened(what));
}

bool room_for(Forcing forcing, const std::vector<Assignment>& assignments) {
  return std::ranges::all_of(assignments, [&](const Assignment& a) { return forcing::add(forcing, a.place, a.value); });
}

std::vector<MemoryRange> places_of(const Forcing& forcing) {
  std::vector<MemoryRange> places;
  for (const Assignment& forced : forcing::listed(forcing)) places.push_back(forced.place);
  return places;
}

}  // namespace

std::string Debugger::forced_text(const std::vector<Bits>& places) const {
  const Cpu& cpu = simulation_.cpu();
  std::string text;
  for (const Assignment& forced : forcing::listed(cpu.state().forcing)) {
    const Bits bits = bits_of(forced.place);
    if (std::ranges::none_of(places, [&](const Bits& place) { return place.overlaps(bits); })) continue;
    text += fmt::format("{} {}={}", text.empty() ? "  forced:" : ",", forced.place.name_of(0),
                        forced_value(cpu.program(), forced));
  }
  return red(std::move(text));
}

std::string Debugger::red(std::string text) const {
  return text.empty() || !options_.colour ? text : fmt::format("{}{}{}", kRed, text, kPlain);
}

std::string Debugger::memory_text(const MemoryRange& range) const {
  const std::string forced = forced_text({bits_of(range)});
  return dump_text(simulation_.cpu(), range) + (forced.empty() ? "" : "       " + forced + "\n");
}

Debugger::Error Debugger::force(const Arguments& arguments) {
  const Cpu& cpu = simulation_.cpu();
  if (arguments.empty()) {
    const std::vector<Assignment> all = forcing::listed(cpu.state().forcing);
    if (all.empty()) out_ << "nothing is forced; 'force I0.3=1' forces an input\n";
    for (const Assignment& forced : all)
      out_ << red(fmt::format("{:<8} {}", forced.place.name_of(0), forced_value(cpu.program(), forced))) << '\n';
    return {};
  }
  std::vector<Assignment> assignments;
  std::string why;
  for (const std::string& text : assignments_of(arguments)) {
    const auto assignment = parse_assignment(text, cpu.program(), why);
    if (!assignment) return why;
    if (!forcing::possible(assignment->place)) return cannot_force(text);
    assignments.push_back(*assignment);
  }
  if (!room_for(cpu.state().forcing, assignments))
    return fmt::format("no room: {} values of memory are forced already, as many as the CPU can; 'unforce' releases one",
                       cpu.state().forcing.values);
  act(Force{assignments});
  return {};
}

Debugger::Error Debugger::unforce(const Arguments& arguments) {
  const Forcing& forcing = simulation_.cpu().state().forcing;
  std::vector<MemoryRange> places;
  if (arguments.size() == 1 && lower_case(arguments[0]) == "all")
    places = places_of(forcing);
  else if (arguments.empty())
    return expects("unforce", "addresses that 'force' lists, or all");
  else if (Error error = ranges_of(arguments, places))
    return error;
  for (const MemoryRange& place : places)
    if (forced_text({bits_of(place)}).empty())
      return fmt::format("{} is not forced; 'force' lists what is", place.name_of(0));
  if (!places.empty()) act(Unforce{places});
  return {};
}

}  // namespace s7200::tools

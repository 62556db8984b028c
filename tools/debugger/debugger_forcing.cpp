// The commands force and unforce.
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "tools/debugger/debugger.hpp"
#include "tools/session/commands/force_words.hpp"
#include "tools/views/machine_text.hpp"
#include "tools/views/memory.hpp"

namespace s7200::tools {

std::string Debugger::forced_text(const Cpu& cpu, const std::vector<Bits>& places) const {
  std::string text;
  for (const Forced& forced : forced_in(cpu)) {
    const Bits bits = bits_of(forced.place);
    if (std::ranges::none_of(places, [&](const Bits& place) { return place.overlaps(bits); })) continue;
    text += fmt::format("{} {}={}", text.empty() ? "  forced:" : ",", forced.place.name_of(0), forced.value);
  }
  return red(std::move(text));
}

Debugger::Error Debugger::force(const Arguments& arguments) {
  const Cpu& cpu = simulation().cpu();
  if (arguments.empty()) {
    const std::vector<Forced> all = forced_in(cpu);
    if (all.empty()) out_ << "nothing is forced; 'force I0.3=1' forces an input\n";
    for (const Forced& forced : all) out_ << red(fmt::format("{:<8} {}", forced.place.name_of(0), forced.value)) << '\n';
    return {};
  }
  if (Error error = without_power("force")) return error;
  std::string why;
  auto force = force_of(assignments_of(arguments), cpu, why);
  if (!force) return why;
  act(std::move(*force));
  return {};
}

Debugger::Error Debugger::unforce(const Arguments& arguments) {
  if (arguments.empty()) return expects("unforce", "addresses that 'force' lists, or all");
  if (Error error = without_power("unforce")) return error;
  std::string why;
  auto unforce = unforce_of(arguments, simulation().cpu(), why);
  if (!unforce) return why;
  if (!unforce->places.empty()) act(std::move(*unforce));
  return {};
}

}  // namespace s7200::tools

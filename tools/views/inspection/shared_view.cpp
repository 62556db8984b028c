#include "tools/views/inspection/shared_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/shared_memory.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

struct Shared {
  CrossReference reference;
  std::vector<SharedMemory> all;
};

bool is_shared_wanted(const Selection& selection, const CrossReference& reference, const SharedMemory& shared) {
  const auto has_op = [&](const SharedMemory::Side& side) {
    return selection.wants_ops(side.reads) || selection.wants_ops(side.writes);
  };
  return selection.wants_memory({reference.entries[shared.entry].bits}) && std::ranges::any_of(shared.sides, has_op);
}

Shared wanted_shared(const Inspection& inspection) {
  Shared shared{cross_reference(inspection.facts), {}};
  shared.all = shared_memory(inspection.facts, calls_of(*inspection.program, inspection.facts.flow), shared.reference);
  std::erase_if(shared.all,
                [&](const SharedMemory& each) { return !is_shared_wanted(inspection.selection, shared.reference, each); });
  return shared;
}

std::string quoted(const std::string& symbol) { return fmt::format("\"{}\"", stl::printable(symbol)); }

/// `VW10, VB11 "Speed"`
std::string memory_in_words(const ReferenceEntry& entry) {
  std::string text = stl::joined(entry.parts, memory_text);
  if (!entry.symbols.empty()) text += " " + stl::joined(entry.symbols, quoted);
  return text;
}

/// `writes in a.stl:5, a.stl:9; reads in a.stl:7`, the first few of each.
std::string side_text(const Inspection& inspection, const SharedMemory::Side& side) {
  constexpr std::size_t kShown = 4;
  const auto places = [&](std::string_view what, const std::vector<std::uint32_t>& ops) {
    if (ops.empty()) return std::string();
    const std::vector<std::uint32_t> shown(ops.begin(),
                                           ops.begin() + static_cast<std::ptrdiff_t>(std::min(ops.size(), kShown)));
    std::string text =
        fmt::format("{} in {}", what, stl::joined(shown, [&](std::uint32_t op) { return line_text(inspection, op); }));
    if (ops.size() > kShown) text += fmt::format(" and {} more", ops.size() - kShown);
    return text;
  };
  const std::string writes = places("writes", side.writes), reads = places("reads", side.reads);
  return writes + (writes.empty() || reads.empty() ? "" : "; ") + reads;
}

ordered_json ops_json(const Inspection& inspection, const std::vector<std::uint32_t>& ops) {
  ordered_json all = ordered_json::array();
  for (const std::uint32_t op : ops) all.push_back(place_json(inspection, op));
  return all;
}

}  // namespace

std::string shared_text(const Inspection& inspection) {
  constexpr std::size_t kRoutine = 12;
  const Shared shared = wanted_shared(inspection);
  if (shared.all.empty()) return "the main program and interrupt routines share no memory\n";
  std::string text;
  for (const SharedMemory& each : shared.all) {
    text += wrapped_at(memory_in_words(shared.reference.entries[each.entry]), 2) + "\n";
    for (const SharedMemory::Side& side : each.sides)
      text += "  " + column(routine_text(inspection.facts.flow.routines[side.routine]), kRoutine) +
              wrapped_at(side_text(inspection, side), 2 + kRoutine, 2 + kRoutine) + "\n";
  }
  return text;
}

ordered_json shared_json(const Inspection& inspection) {
  const Shared shared = wanted_shared(inspection);
  ordered_json all = ordered_json::array();
  for (const SharedMemory& each : shared.all) {
    const ReferenceEntry& entry = shared.reference.entries[each.entry];
    ordered_json json{{"address", memory_text(entry.parts.front())}, {"symbols", entry.symbols}};
    json["parts"] = ordered_json::array();
    for (const Bits& part : entry.parts) json["parts"].push_back(memory_text(part));
    json["sides"] = ordered_json::array();
    for (const SharedMemory::Side& side : each.sides)
      json["sides"].push_back({{"routine", routine_text(inspection.facts.flow.routines[side.routine])},
                               {"writes", ops_json(inspection, side.writes)},
                               {"reads", ops_json(inspection, side.reads)}});
    all.push_back(std::move(json));
  }
  return all;
}

}  // namespace s7200::tools

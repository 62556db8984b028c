#include "interpreter/analysis/shared_memory.hpp"

#include <algorithm>

#include "interpreter/analysis/effects/memory_names.hpp"

namespace s7200 {
namespace {

/// By routine: whether `root` executes it, itself or through calls.
std::vector<bool> executed_by(const Calls& calls, std::uint32_t root) {
  std::vector<bool> executed(calls.nodes.size());
  std::vector<std::uint32_t> open{root};
  while (!open.empty()) {
    const std::uint32_t routine = open.back();
    open.pop_back();
    if (executed[routine]) continue;
    executed[routine] = true;
    for (const CallSite& site : calls.nodes[routine].calls) open.push_back(site.routine);
  }
  return executed;
}

SharedMemory::Side uses_of(const ControlFlow& flow, const ReferenceEntry& entry, std::uint32_t root,
                           const std::vector<bool>& executed) {
  SharedMemory::Side side{.routine = root, .reads = {}, .writes = {}};
  for (const auto* uses : {&entry.uses, &entry.reached})
    for (const Use& use : *uses) {
      if (use.access.by_pointer || !executed[flow.nodes[use.op].routine]) continue;
      if (use.access.reads()) side.reads.push_back(use.op);
      if (use.access.writes()) side.writes.push_back(use.op);
    }
  for (auto* ops : {&side.reads, &side.writes}) {
    std::ranges::sort(*ops);
    ops->erase(std::unique(ops->begin(), ops->end()), ops->end());
  }
  return side;
}

}  // namespace

std::vector<SharedMemory> shared_memory(const Facts& facts, const Calls& calls, const CrossReference& reference) {
  std::vector<std::uint32_t> roots{0};
  for (std::uint32_t i = 1; i < calls.nodes.size(); ++i)
    if (!calls.nodes[i].events.empty()) roots.push_back(i);
  std::vector<std::vector<bool>> executed;
  for (const std::uint32_t root : roots) executed.push_back(executed_by(calls, root));

  std::vector<SharedMemory> all;
  for (std::size_t entry = 0; entry < reference.entries.size(); ++entry) {
    if (!contains(kSharedAreas, area_of(reference.entries[entry].bits))) continue;
    SharedMemory shared{.entry = entry, .sides = {}};
    for (std::size_t i = 0; i < roots.size(); ++i) {
      SharedMemory::Side side = uses_of(facts.flow, reference.entries[entry], roots[i], executed[i]);
      if (!side.reads.empty() || !side.writes.empty()) shared.sides.push_back(std::move(side));
    }
    const bool written = std::ranges::any_of(shared.sides, [](const SharedMemory::Side& side) { return !side.writes.empty(); });
    if (shared.sides.size() > 1 && written) all.push_back(std::move(shared));
  }
  return all;
}

}  // namespace s7200

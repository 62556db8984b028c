#include "tools/mutants/hunt.hpp"

#include <algorithm>
#include <utility>

#include "tools/coverage/programs.hpp"
#include "tools/measuring/parallel_run.hpp"
#include "tools/scenario/run.hpp"

namespace s7200::tools {
namespace {

/// A scenario that passes, and what it tries of the program.
struct Hunter {
  const Scenario* scenario = nullptr;
  const Bench* bench = nullptr;
  Tried tried;
  double host_seconds = 0;

  bool comes_to(const Mutation& mutation) const {
    return std::ranges::any_of(mutation.instead, [&](const auto& each) { return tried.marks[each.first] != 0; });
  }
};

struct Pack {
  std::shared_ptr<const Program> program;
  std::vector<Hunter> hunters;
};

bool can_hunt(const Scenario& scenario, const Bench& bench) {
  return bench.program && bench.problem.empty() && !scenario.plan && scenario.skipped.empty();
}

Pack& pack_of(std::vector<Pack>& packs, const std::shared_ptr<const Program>& program) {
  const auto pack = std::ranges::find_if(packs, [&](const Pack& p) { return is_same_program(*p.program, *program); });
  return pack != packs.end() ? *pack : packs.emplace_back(Pack{program, {}});
}

/// Programs with the scenarios that pass on them; after a stop request also programs whose scenarios were not run.
std::vector<Pack> packs_of(const std::vector<Scenario>& scenarios, const Benches& benches, const HuntSettings& settings,
                           MutantsResult& result) {
  std::vector<Pack> packs;
  std::size_t i = 0;
  for (; i < scenarios.size(); ++i) {
    Bench bench = benches.of[i];
    if (!can_hunt(scenarios[i], bench)) {
      ++result.left_out;
      continue;
    }
    bench.observed.coverage = true;
    const ScenarioResult as_it_is = run_scenario(scenarios[i], bench);
    if (settings.stop.stop_requested()) {
      result.interrupted = true;
      break;
    }
    if (as_it_is.outcome != ScenarioResult::Outcome::Passed) {
      ++(as_it_is.outcome == ScenarioResult::Outcome::Failed ? result.failing : result.left_out);
      continue;
    }
    pack_of(packs, bench.program)
        .hunters.push_back(
            {&scenarios[i], &benches.of[i], as_it_is.coverage.programs().front().tried, as_it_is.host_seconds});
  }
  for (; i < scenarios.size(); ++i)
    if (can_hunt(scenarios[i], benches.of[i])) pack_of(packs, benches.of[i].program);
  for (Pack& pack : packs) std::ranges::stable_sort(pack.hunters, {}, &Hunter::host_seconds);
  return packs;
}

/// What came of a change.
struct Hunted {
  enum class What : std::uint8_t { Noticed, Survived, NeverReached, Same, Refused, Interrupted } what{};
};

Hunted hunt(const Pack& pack, const Mutation& mutation, const StopToken& stop) {
  const Mutant mutant = mutated(*pack.program, mutation);
  if (mutant.kind != Mutant::Kind::Program)
    return {mutant.kind == Mutant::Kind::Same ? Hunted::What::Same : Hunted::What::Refused};
  bool tried = false;
  for (const Hunter& hunter : pack.hunters) {
    if (!hunter.comes_to(mutation)) continue;
    tried = true;
    Bench bench = *hunter.bench;
    auto changed = std::make_shared<Program>(*mutant.program);
    changed->system_block = bench.program->system_block;
    bench.program = std::move(changed);
    bench.observed = {};
    bench.exchanges_wanted = false;
    const bool passed = Run(*hunter.scenario, bench).result().outcome == ScenarioResult::Outcome::Passed;
    if (stop.stop_requested()) return {Hunted::What::Interrupted};
    if (!passed) return {Hunted::What::Noticed};
  }
  return {tried ? Hunted::What::Survived : Hunted::What::NeverReached};
}

void count(MutantsOfProgram& all, const Mutation& mutation, const Hunted& hunted) {
  switch (hunted.what) {
    case Hunted::What::Same:
      ++all.same;
      return;
    case Hunted::What::Refused:
      ++all.refused;
      return;
    case Hunted::What::Interrupted:
      return;
    case Hunted::What::Noticed:
      ++all.noticed;
      break;
    case Hunted::What::Survived:
    case Hunted::What::NeverReached:
      all.survivors.push_back({mutation, hunted.what == Hunted::What::Survived});
      break;
  }
  ++all.mutants;
}

}  // namespace

MutantsResult hunt_mutants(const std::vector<Scenario>& scenarios, const Benches& benches, const HuntSettings& settings) {
  MutantsResult result;
  for (const Pack& pack : packs_of(scenarios, benches, settings, result)) {
    const std::vector<Mutation> mutations = mutations_of(*pack.program);
    MutantsOfProgram& all =
        result.programs.emplace_back(MutantsOfProgram{.program = pack.program, .scenarios = pack.hunters.size()});
    std::size_t done = 0;
    ParallelRun<Hunted>(mutations.size(), settings.jobs,
                        [&](std::size_t i) { return hunt(pack, mutations[i], settings.stop); })
        .each(
            [&](std::size_t i, Hunted hunted) {
              if (settings.stop.stop_requested()) return false;
              count(all, mutations[i], hunted);
              ++done;
              return true;
            },
            [&](std::size_t) {
              if (settings.progress) settings.progress(done, mutations.size());
            });
    all.not_tried = mutations.size() - done;
    result.not_tried += all.not_tried;
  }
  result.interrupted |= result.not_tried > 0;
  return result;
}

}  // namespace s7200::tools

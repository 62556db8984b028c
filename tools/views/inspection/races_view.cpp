#include "tools/views/inspection/races_view.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/analysis/races.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

std::string_view name_of(Race::Kind kind) {
  switch (kind) {
    case Race::Kind::LostUpdate:
      return "lost update";
    case Race::Kind::Overwritten:
      return "overwritten update";
    case Race::Kind::Scratch:
      return "scratch memory of both sides";
    case Race::Kind::TornRead:
      return "torn read";
    case Race::Kind::TornWrite:
      return "torn write";
    case Race::Kind::MixedRead:
      break;
  }
  return "mixed read";
}

std::string_view explanation(Race::Kind kind) {
  switch (kind) {
    case Race::Kind::LostUpdate:
      return "the main program writes what it has worked out from an older value; what the interrupt wrote between is lost";
    case Race::Kind::Overwritten:
      return "the main program reads it and then writes over it; what the interrupt wrote between is never read";
    case Race::Kind::Scratch:
      return "the main program writes it and reads it again for its own use; what the interrupt writes between is read "
             "instead";
    case Race::Kind::TornRead:
      return "the main program reads it in parts; between them the interrupt writes all of it";
    case Race::Kind::TornWrite:
      return "the main program writes it in parts; between them the interrupt reads all of it";
    case Race::Kind::MixedRead:
      break;
  }
  return "the main program works out one value from both; between its reads the interrupt writes both";
}

std::string with_symbols(const Inspection& inspection, const Bits& bits) {
  std::string text = memory_text(bits);
  for (const stl::Symbol& symbol : inspection.program->source.symbols)
    if (const auto of = bits_of(*inspection.program, symbol); of && of->overlaps(bits))
      text += fmt::format(" \"{}\"", stl::printable(symbol.name));
  return text;
}

std::string shared_text(const Inspection& inspection, const Race& race) {
  const std::string text = with_symbols(inspection, race.bits);
  return race.with ? fmt::format("{} and {}", text, with_symbols(inspection, *race.with)) : text;
}

std::string memory_of(const Race& race) {
  return race.with ? fmt::format("{}, {}", memory_text(race.bits), memory_text(*race.with)) : memory_text(race.bits);
}

bool is_race_wanted(const Selection& selection, const Race& race) {
  return selection.wants_memory({race.bits, race.with.value_or(race.bits)}) &&
         selection.wants_ops({race.first, race.last, race.interrupt});
}

std::string scenario_text(const Inspection& inspection, const FoundRace& found) {
  const auto& [race, lost] = found;
  if (inspection.has_errors) return "  no run of it: a program with errors is not run\n";
  if (!inspection.lose_word) return {};
  if (!lost && inspection.was_interrupted()) return "  interrupted before a run was found in which the word is lost\n";
  if (!lost) return "  no run of it was found in which the word is lost\n";
  return "  " +
         wrapped_at(
             fmt::format("lost: {}; {} comes after {} ({}); then {} = {}, but {} if it comes before, {} if it comes after "
                         "both",
                         lost->situation, routine_text(inspection.facts.flow.routines[race.routine]),
                         instruction_text(inspection, lost->after), line_text(inspection, lost->after), lost->place,
                         lost->between, lost->before, lost->behind),
             4, 2) +
         "\n";
}

std::string race_text(const Inspection& inspection, const FoundRace& found) {
  const Race& race = found.race;
  std::string text = fmt::format("{} of {}: {}", name_of(race.kind), shared_text(inspection, race), explanation(race.kind));
  text = wrapped_at(text, 2) + "\n";
  text += row_text(inspection, "  main       ", race.first) + row_text(inspection, "  main       ", race.last);
  text += row_text(inspection, fmt::format("  event {}", column(std::to_string(race.event), 5)), race.interrupt);
  return text + scenario_text(inspection, found);
}

/// Why a CALL was not followed.
std::string reason_text(const Inspection& inspection, const NotFollowed& left) {
  if (left.reason == NotFollowed::Reason::TooManySteps)
    return fmt::format("{} instructions are executed before it, and no further calls are followed", kMostStepsOfRaces);
  const CpuModel& model = *inspection.program->model;
  const bool in_main = left.from == 0;
  const std::uint32_t most = in_main ? model.call_depth : model.interrupt_call_depth;
  return fmt::format("the CPU nests {}{}; one more is run-time error 0008, and calls nothing", counted(most, "call"),
                     in_main ? "" : " in an interrupt routine");
}

std::string not_followed_text(const Inspection& inspection, const NotFollowed& left) {
  const auto& routines = inspection.facts.flow.routines;
  const std::string text =
      fmt::format("not looked at: {}, called in {} ({}, from {}): {}", routine_in_words(inspection, routines[left.routine]),
                  place_in_words(inspection, left.call), instruction_text(inspection, left.call),
                  routine_text(routines[left.from]), reason_text(inspection, left));
  return wrapped_at(text, 2) + "\n";
}

Races wanted_races(const Inspection& inspection) {
  Races all = find_races(inspection.facts, calls_of(*inspection.program, inspection.facts.flow), inspection.waiter);
  const Selection& selection = inspection.selection;
  std::erase_if(all.races, [&](const Race& race) { return !is_race_wanted(selection, race); });
  std::erase_if(all.not_followed, [&](const NotFollowed& left) { return !selection.wants_ops({left.call}); });
  return all;
}

}  // namespace

FoundRaces found_races(const Inspection& inspection) {
  Races wanted = wanted_races(inspection);
  FoundRaces all{{}, std::move(wanted.not_followed)};
  for (const Race& race : wanted.races) {
    const bool runs = inspection.lose_word && !inspection.has_errors && !inspection.was_interrupted();
    auto lost = runs ? inspection.lose_word(inspection, race) : std::nullopt;
    if (lost || !race.suspected) all.races.push_back({race, std::move(lost)});
  }
  return all;
}

std::string races_text(const Inspection& inspection) {
  const auto [races, not_followed] = found_races(inspection);
  std::string text;
  for (const FoundRace& race : races) text += race_text(inspection, race);
  for (const NotFollowed& left : not_followed) text += not_followed_text(inspection, left);
  if (inspection.was_interrupted())
    return text + fmt::format("{} found before the interruption\n", counted(races.size(), "race"));
  if (races.empty()) text += not_followed.empty() ? "no races found\n" : "no races found in the rest\n";
  if (inspection.has_errors) text += "the program has errors and was not run: what only a run can show is left out\n";
  if (races.empty()) return text;
  return text + fmt::format("{}; DISI before the first instruction and ENI after the last keep the interrupt away\n",
                            counted(races.size(), "race"));
}

ordered_json not_followed_json(const Inspection& inspection) {
  ordered_json all = ordered_json::array();
  for (const NotFollowed& left : wanted_races(inspection).not_followed)
    all.push_back({{"call", place_json(inspection, left.call)},
                   {"called", routine_text(inspection.facts.flow.routines[left.routine])},
                   {"from", routine_text(inspection.facts.flow.routines[left.from])},
                   {"why", reason_text(inspection, left)}});
  return all;
}

ordered_json races_json(const Inspection& inspection) {
  ordered_json all = ordered_json::array();
  for (const auto& [race, lost] : found_races(inspection).races) {
    ordered_json json{{"kind", name_of(race.kind)}, {"memory", memory_of(race)}, {"event", race.event}};
    json["interrupt_routine"] = routine_text(inspection.facts.flow.routines[race.routine]);
    json["first"] = place_json(inspection, race.first);
    json["last"] = place_json(inspection, race.last);
    json["interrupt"] = place_json(inspection, race.interrupt);
    json["lost"] = nullptr;
    if (lost)
      json["lost"] = {{"situation", lost->situation},    {"after", place_json(inspection, lost->after)},
                      {"memory", lost->place},           {"value", lost->between},
                      {"value_if_before", lost->before}, {"value_if_after", lost->behind}};
    all.push_back(std::move(json));
  }
  return all;
}

}  // namespace s7200::tools

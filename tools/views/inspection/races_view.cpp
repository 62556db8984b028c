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
      break;
  }
  return "torn write";
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
      break;
  }
  return "the main program writes it in parts; between them the interrupt reads all of it";
}

std::string with_symbols(const Inspection& inspection, const Bits& bits) {
  std::string text = memory_text(bits);
  for (const stl::Symbol& symbol : inspection.program->source.symbols)
    if (const auto of = bits_of(*inspection.program, symbol); of && of->overlaps(bits))
      text += fmt::format(" \"{}\"", stl::printable(symbol.name));
  return text;
}

bool is_wanted(const Selection& selection, const Race& race) {
  const bool memory = selection.memory.empty() || selection.has(race.bits);
  const bool ops = selection.ops.empty() || selection.has_op(race.first) || selection.has_op(race.last) ||
                   selection.has_op(race.interrupt);
  return memory && ops;
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
  std::string text =
      fmt::format("{} of {}: {}", name_of(race.kind), with_symbols(inspection, race.bits), explanation(race.kind));
  text = wrapped_at(text, 2) + "\n";
  text += row_text(inspection, "  main       ", race.first) + row_text(inspection, "  main       ", race.last);
  text += row_text(inspection, fmt::format("  event {}", column(std::to_string(race.event), 5)), race.interrupt);
  return text + scenario_text(inspection, found);
}

}  // namespace

std::vector<FoundRace> found_races(const Inspection& inspection) {
  std::vector<FoundRace> all;
  for (const Race& race :
       find_races(inspection.facts, calls_of(*inspection.program, inspection.facts.flow), inspection.waiter)) {
    if (!is_wanted(inspection.selection, race)) continue;
    const bool runs = inspection.lose_word && !inspection.has_errors && !inspection.was_interrupted();
    auto lost = runs ? inspection.lose_word(inspection, race) : std::nullopt;
    if (lost || !race.suspected) all.push_back({race, std::move(lost)});
  }
  return all;
}

std::string races_text(const Inspection& inspection) {
  const std::vector<FoundRace> races = found_races(inspection);
  std::string text;
  for (const FoundRace& race : races) text += race_text(inspection, race);
  if (inspection.was_interrupted())
    return text + fmt::format("{} found before the interruption\n", counted(races.size(), "race"));
  if (races.empty()) text += "no races found\n";
  if (inspection.has_errors) text += "the program has errors and was not run: what only a run can show is left out\n";
  if (races.empty()) return text;
  return text + fmt::format("{}; DISI before the first instruction and ENI after the last keep the interrupt away\n",
                            counted(races.size(), "race"));
}

ordered_json races_json(const Inspection& inspection) {
  ordered_json all = ordered_json::array();
  for (const auto& [race, lost] : found_races(inspection)) {
    ordered_json json{{"kind", name_of(race.kind)}, {"memory", memory_text(race.bits)}, {"event", race.event}};
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

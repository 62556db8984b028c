#include <fmt/format.h>
#include <fmt/ranges.h>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/compare/behaviour.hpp"
#include "tools/trials/chance.hpp"
#include "tools/trials/trial_text.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;
using End = BehaviourResult::End;

constexpr std::size_t kShown = 20;  ///< contacts that were not seen both ways

std::string_view end_word(End end) {
  constexpr std::string_view kWords[]{"differs", "all contacts", "runs", "seconds", "interrupted"};
  return kWords[static_cast<std::size_t>(end)];
}

std::string_view end_text(End end) {
  constexpr std::string_view kTexts[]{"", "every contact was seen both ways", "--runs were over", "--seconds were over",
                                      "interrupted"};
  return kTexts[static_cast<std::size_t>(end)];
}

std::string never_text(const Inspection& inspection, const std::vector<ContactsSeen::Never>& never) {
  std::string text;
  for (std::size_t i = 0; i < never.size() && i < kShown; ++i) {
    const char* const seen = never[i].open ? "never closed" : never[i].closed ? "never open" : "never executed";
    text += row_text(inspection, fmt::format("    {:<15}", seen), never[i].op);
  }
  if (never.size() > kShown) text += fmt::format("    … and {} more\n", never.size() - kShown);
  return text;
}

std::string beyond_text(const BehaviourResult& result) {
  if (result.beyond.empty()) return {};
  return fmt::format("  not counted to the end: {} of {}; no input gets more than {} edges running\n",
                     result.beyond.size() == 1 ? "a counter with a preset" : "counters with presets",
                     fmt::join(result.beyond, " and "), TrialMaker::kMostEdges);
}

std::string contacts_text(const char* side, const Inspection& inspection, const BehaviourResult& result,
                          std::size_t number) {
  return fmt::format("  {}: {} of {} seen both ways\n", side, result.both_ways[number],
                     counted(result.contacts[number], "contact")) +
         never_text(inspection, result.never[number]);
}

std::string writer_text(const char* side, const Inspection& inspection, const std::optional<std::uint32_t>& op) {
  if (!op || *op == kNoRoutine) return fmt::format("  {}: no instruction\n", side);
  return fmt::format("  {}: {}  {}\n", side, place_in_words(inspection, *op), instruction_text(inspection, *op));
}

ordered_json writer_json(const Inspection& inspection, const std::optional<std::uint32_t>& op) {
  return op && *op != kNoRoutine ? place_json(inspection, *op) : ordered_json();
}

ordered_json side_json(const Inspection& inspection, const BehaviourResult& result, std::size_t number) {
  ordered_json json{{"contacts", result.contacts[number]}, {"both_ways", result.both_ways[number]}};
  json["never"] = ordered_json::array();
  for (const ContactsSeen::Never& never : result.never[number]) {
    ordered_json entry = place_json(inspection, never.op);
    entry["seen_open"] = never.open;
    entry["seen_closed"] = never.closed;
    json["never"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace

std::string behaviour_text(const Inspection& older, const Inspection& newer, const BehaviourResult& result) {
  const std::string tried =
      fmt::format("{}, {} of simulated time", counted(result.runs, "run"), format_duration(result.simulated, 3));
  const std::string timing =
      result.timing_alone == 0 ? "" : fmt::format("  {} differed in timing alone\n", counted(result.timing_alone, "run"));
  if (!result.difference)
    return fmt::format("\nBehaviour: no difference in {}; {}\n", tried, end_text(result.end)) + timing +
           beyond_text(result) + contacts_text("old", older, result, 0) + contacts_text("new", newer, result, 1);
  const BehaviourDifference& difference = *result.difference;
  return fmt::format("\nBehaviour: differs {} after power-up, found in {}\n", format_duration(difference.at, 3), tried) +
         fmt::format("  {}: old {}, new {}\n", difference.what, difference.older, difference.newer) +
         writer_text("old", older, difference.older_op) + writer_text("new", newer, difference.newer_op) +
         (difference.trial.empty() ? "  without any input\n" : "  after\n" + trial_text(difference.trial, difference.begun));
}

ordered_json behaviour_json(const Inspection& older, const Inspection& newer, const BehaviourResult& result) {
  ordered_json json{{"same", !result.difference}, {"ended_by", end_word(result.end)}, {"runs", result.runs}};
  json["simulated_ns"] = result.simulated;
  json["timing_alone"] = result.timing_alone;
  json["presets_beyond"] = result.beyond;
  json["old"] = side_json(older, result, 0);
  json["new"] = side_json(newer, result, 1);
  json["difference"] = nullptr;
  if (!result.difference) return json;
  const BehaviourDifference& found = *result.difference;
  ordered_json difference{{"at_ns", found.at}, {"what", found.what}};
  difference["old"] = {{"value", found.older}, {"written_by", writer_json(older, found.older_op)}};
  difference["new"] = {{"value", found.newer}, {"written_by", writer_json(newer, found.newer_op)}};
  difference["inputs"] = trial_json(found.trial, found.begun);
  json["difference"] = std::move(difference);
  return json;
}

}  // namespace s7200::tools

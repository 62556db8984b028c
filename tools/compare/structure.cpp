#include "tools/compare/structure.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "interpreter/analysis/selection.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::tools {
namespace {

std::string value_text(const stl::Symbol& symbol) {
  return symbol.value ? stl::to_text(stl::Operand{.value = *symbol.value}) : "";
}

/// What stands between two instructions that both programs have: first against first, and so on.
void add_gap(std::vector<InstructionRow>& rows, std::uint32_t older, std::uint32_t older_end, std::uint32_t newer,
             std::uint32_t newer_end, const Program& of_older, const Program& of_newer) {
  while (older < older_end || newer < newer_end) {
    InstructionRow row;
    if (older < older_end) row.older = older++;
    if (newer < newer_end) row.newer = newer++;
    row.same_symbols = row.older && row.newer &&
                       symbolic_text(of_older.statement(*row.older)) == symbolic_text(of_newer.statement(*row.newer));
    rows.push_back(row);
  }
}

std::vector<InstructionRow> rows_of(const ComparedNetwork& older, const ComparedNetwork& newer, const Program& of_older,
                                    const Program& of_newer) {
  std::vector<InstructionRow> rows;
  std::uint32_t o = older.first, n = newer.first;
  for (const auto& [in_older, in_newer] : common_row(older.code, newer.code)) {
    const auto o_same = older.first + static_cast<std::uint32_t>(in_older);
    const auto n_same = newer.first + static_cast<std::uint32_t>(in_newer);
    add_gap(rows, o, o_same, n, n_same, of_older, of_newer);
    rows.push_back({o_same, n_same, true, false});
    o = o_same + 1;
    n = n_same + 1;
  }
  add_gap(rows, o, older.end, n, newer.end, of_older, of_newer);
  return rows;
}

std::vector<NetworkChange> network_changes(const StructureDifference& of, const Program& older, const Program& newer) {
  std::vector<NetworkChange> all;
  for (const NetworkMatch& match : match_networks(of.older, of.newer)) {
    NetworkChange change{match};
    if (match.older && match.newer) {
      const ComparedNetwork &o = of.older[*match.older], &n = of.newer[*match.newer];
      change.comments_differ = o.comments != n.comments || o.title != n.title;
      if (!match.same) change.rows = rows_of(o, n, older, newer);
    }
    all.push_back(std::move(change));
  }
  return all;
}

std::vector<SymbolChange> symbol_changes(const Program& older, const Program& newer) {
  using What = SymbolChange::What;
  std::map<std::string, const stl::Symbol*> by_name;
  std::vector<SymbolChange> all;
  for (const stl::Symbol& symbol : older.source.symbols) by_name.emplace(symbol.name, &symbol);
  std::vector<const stl::Symbol*> new_names;
  for (const stl::Symbol& symbol : newer.source.symbols) {
    const auto found = by_name.find(symbol.name);
    if (found == by_name.end()) {
      new_names.push_back(&symbol);
      continue;
    }
    if (value_text(*found->second) != value_text(symbol))
      all.push_back({What::Moved, found->second, &symbol});
    else if (found->second->comment != symbol.comment)
      all.push_back({What::Comment, found->second, &symbol});
    by_name.erase(found);
  }
  for (const stl::Symbol* symbol : new_names) {
    const auto renamed = std::find_if(by_name.begin(), by_name.end(), [&](const auto& entry) {
      return symbol->value && value_text(*entry.second) == value_text(*symbol);
    });
    const bool found = renamed != by_name.end();
    all.push_back({found ? What::Renamed : What::Added, found ? renamed->second : nullptr, symbol});
    if (found) by_name.erase(renamed);
  }
  for (const auto& [name, symbol] : by_name) all.push_back({What::Removed, symbol, nullptr});
  std::ranges::stable_sort(all, {}, &SymbolChange::what);
  return all;
}

std::map<std::uint32_t, std::uint8_t> data_of(const Program& program) {
  std::map<std::uint32_t, std::uint8_t> bytes;
  for (const InitialData& data : program.data)
    for (std::uint32_t i = 0; i < data.bytes.size(); ++i) bytes[data.offset + i] = data.bytes[i];
  return bytes;
}

std::vector<DataChange> data_changes(const Program& older, const Program& newer) {
  const auto old_bytes = data_of(older), new_bytes = data_of(newer);
  std::set<std::uint32_t> places;
  for (const auto& [place, byte] : old_bytes) places.insert(place);
  for (const auto& [place, byte] : new_bytes) places.insert(place);
  const auto byte_in = [](const auto& bytes, std::uint32_t place) -> std::optional<std::uint8_t> {
    const auto found = bytes.find(place);
    return found == bytes.end() ? std::nullopt : std::optional(found->second);
  };
  std::vector<DataChange> all;
  for (const std::uint32_t place : places) {
    const auto o = byte_in(old_bytes, place), n = byte_in(new_bytes, place);
    if (o == n) continue;
    if (all.empty() || all.back().offset + all.back().older.size() != place) all.push_back({place, {}, {}});
    all.back().older.push_back(o);
    all.back().newer.push_back(n);
  }
  return all;
}

/// The routines that are attached to each event, as far as that is known.
std::map<std::uint8_t, std::vector<std::string>> attached(const Inspection& inspection) {
  std::map<std::uint8_t, std::set<std::string>> all;
  for (const Attachment& attachment : inspection.facts.flow.attachments)
    if (attachment.event && attachment.routine)
      all[*attachment.event].insert(routine_text(inspection.facts.flow.routines[*attachment.routine]));
  std::map<std::uint8_t, std::vector<std::string>> lists;
  for (const auto& [event, routines] : all) lists[event].assign(routines.begin(), routines.end());
  return lists;
}

std::vector<EventChange> event_changes(const Inspection& older, const Inspection& newer) {
  auto of_older = attached(older), of_newer = attached(newer);
  std::set<std::uint8_t> events;
  for (const auto& [event, routines] : of_older) events.insert(event);
  for (const auto& [event, routines] : of_newer) events.insert(event);
  std::vector<EventChange> all;
  for (const std::uint8_t event : events)
    if (of_older[event] != of_newer[event]) all.push_back({event, of_older[event], of_newer[event]});
  return all;
}

std::vector<SettingChange> setting_changes(const Program& older, const Program& newer) {
  std::vector<SettingChange> all;
  const auto compare = [&](const char* setting, const std::string& o, const std::string& n) {
    if (o != n) all.push_back({setting, o, n});
  };
  compare("CPU", std::string(older.model->name), std::string(newer.model->name));
  compare("PPI rate", s7200::to_text(older.system_block.ppi_rates), s7200::to_text(newer.system_block.ppi_rates));
  compare("PPI station", s7200::to_text(older.system_block.ppi_stations), s7200::to_text(newer.system_block.ppi_stations));
  if (older.model == newer.model || older.system_block.retentive || newer.system_block.retentive)
    compare("retentive memory", s7200::to_text(older.retentive()), s7200::to_text(newer.retentive()));
  return all;
}

/// The instructions of each routine: how they are divided into networks means nothing to the CPU.
std::map<std::string, std::vector<std::string>> code_of(const std::vector<ComparedNetwork>& networks) {
  std::map<std::string, std::vector<std::string>> code;
  for (const ComparedNetwork& network : networks)
    code[network.routine].insert(code[network.routine].end(), network.code.begin(), network.code.end());
  return code;
}

}  // namespace

bool StructureDifference::same_for_the_cpu() const {
  return code_of(older) == code_of(newer) && data.empty() && settings.empty();
}

bool StructureDifference::same_for_people() const {
  const auto differs = [](const NetworkChange& change) { return change.comments_differ; };
  return same_for_the_cpu() && symbols.empty() && count(differs) == 0;
}

StructureDifference structure_difference(const Inspection& older, const Inspection& newer) {
  StructureDifference difference;
  difference.older = compared_networks(older);
  difference.newer = compared_networks(newer);
  difference.networks = network_changes(difference, *older.program, *newer.program);
  difference.symbols = symbol_changes(*older.program, *newer.program);
  difference.data = data_changes(*older.program, *newer.program);
  difference.events = event_changes(older, newer);
  difference.settings = setting_changes(*older.program, *newer.program);
  return difference;
}

}  // namespace s7200::tools

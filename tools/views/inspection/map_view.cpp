#include "tools/views/inspection/map_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/memory_map.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/loading/stand_ins.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/views/state/memory_meaning.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

std::string map_name(const std::string& text) { return text; }

/// `VB8 to VB9`, not VW8: what is free or used need not be one word.
std::string range_text(const Bits& bits) {
  const AreaInfo& area = info(area_of(bits));
  const bool bytes = area.element == 0 && bits.first % 8 == 0 && bits.count % 8 == 0 && bits.count > 8;
  if (!bytes || area.area == Area::AI || area.area == Area::AQ) return memory_text(bits);
  return fmt::format("{} to {}", memory_text({bits.first, 8}), memory_text({bits.end() - 8, 8}));
}

std::vector<std::string> routine_names(const Inspection& inspection, const MemoryMap::Used& used) {
  std::vector<std::string> names;
  for (const std::uint32_t routine : used.routines) names.push_back(routine_text(inspection.facts.flow.routines[routine]));
  return names;
}

std::vector<std::string> pointer_names(const CrossReference& reference, const MemoryMap::AreaUse& area) {
  std::vector<std::string> names;
  for (const std::size_t i : area.pointers) names.push_back(pointer_text(reference.pointers[i].at));
  return names;
}

/// The symbols of memory, as far as they fit: the first few.
std::string symbols_text(const Inspection& inspection, const Bits& bits) {
  constexpr std::size_t kShown = 4;
  std::vector<std::string> names;
  for (const stl::Symbol& symbol : inspection.program->source.symbols)
    if (const auto of = bits_of(*inspection.program, symbol); of && of->overlaps(bits))
      names.push_back(fmt::format("\"{}\"", stl::printable(symbol.name)));
  const std::size_t more = names.size() - std::min(names.size(), kShown);
  names.resize(names.size() - more);
  if (more != 0) names.push_back(fmt::format("{} more", more));
  return stl::joined(names, map_name);
}

std::string used_text(const Inspection& inspection, const MemoryMap::Used& used) {
  std::vector<std::string> by = routine_names(inspection, used);
  if (used.by_data) by.insert(by.begin(), "data block");
  std::string text = stl::joined(by, map_name);
  for (const std::string& about : {meaning_text(*inspection.program->model, used.bits), symbols_text(inspection, used.bits)})
    if (!about.empty()) text += "; " + about;
  return "  " + column(range_text(used.bits), 24) + wrapped_at(text, 26, 26) + "\n";
}

/// `VB135 to VB139 (INT_4)`
std::string idle_text(const Inspection& inspection, const MemoryMap::AreaUse& area) {
  if (area.idle.empty()) return {};
  const std::string parts = stl::joined(area.idle, [&](const MemoryMap::Used& used) {
    return fmt::format("{} ({})", range_text(used.bits), stl::joined(routine_names(inspection, used), map_name));
  });
  return "  " + wrapped_at("used only by routines that are never executed: " + parts, 4, 2) + "\n";
}

std::vector<std::string> texts(const std::vector<Bits>& all) {
  std::vector<std::string> names;
  for (const Bits& bits : all) names.push_back(range_text(bits));
  return names;
}

/// `*AC1 in line 396, *VD150 in lines 769 and 771`, the first few of them.
std::string through_text(const Inspection& inspection, const MemoryMap::Perhaps& perhaps) {
  constexpr std::size_t kShown = 4;
  std::vector<std::string> names;
  for (const MemoryMap::Through& through : perhaps.through)
    if (names.size() < kShown)
      names.push_back(fmt::format("{} in {}", pointer_text(through.at), line_text(inspection, through.op)));
  if (perhaps.through.size() > kShown) names.push_back(fmt::format("{} more", perhaps.through.size() - kShown));
  return stl::joined(names, map_name, " and ");
}

std::string perhaps_text(const Inspection& inspection, const MemoryMap::AreaUse& area) {
  std::string text;
  for (const MemoryMap::Perhaps& perhaps : area.perhaps)
    text += "  " +
            wrapped_at(fmt::format("perhaps used through {}: {}", through_text(inspection, perhaps),
                                   stl::joined(perhaps.bits, range_text)),
                       4, 2) +
            "\n";
  return text;
}

std::uint64_t size_of(const std::vector<Bits>& all) {
  std::uint64_t bits = 0;
  for (const Bits& each : all) bits += each.count;
  return bits;
}

/// `VB0 to VB4095: 120 of 4096 bytes used`
std::string head_text(const Inspection& inspection, const MemoryMap::AreaUse& area) {
  const AreaInfo& about = info(area.area);
  std::string text = fmt::format("{}: {}", about.name, about.meaning);
  if (area.routine) text += " " + routine_text(inspection.facts.flow.routines[*area.routine]);
  const bool by_bits =
      about.element == 0 && (area.area == Area::I || area.area == Area::Q || area.area == Area::M || area.area == Area::S);
  const std::uint64_t unit = about.element != 0 ? about.element * 8u : by_bits ? 1 : 8;
  const std::string_view thing = about.element != 0 ? "element" : by_bits ? "bit" : "byte";
  std::uint64_t unused = size_of(area.free);
  for (const MemoryMap::Perhaps& perhaps : area.perhaps) unused += size_of(perhaps.bits);
  return text + fmt::format(", {} of {} used\n", (area.all.count - unused) / unit, counted(area.all.count / unit, thing));
}

std::string area_text(const Inspection& inspection, const CrossReference& reference, const MemoryMap::AreaUse& area) {
  std::string text = head_text(inspection, area);
  for (const MemoryMap::Used& used : area.used) text += used_text(inspection, used);
  text += idle_text(inspection, area);
  if (area.area != Area::AC && area.area != Area::SM)
    text += perhaps_text(inspection, area) + list_text(2, "free", texts(area.free));
  text += list_text(2, "retentive", texts(area.retentive));
  const auto pointers = pointer_names(reference, area);
  if (!pointers.empty()) text += "  " + wrapped_at("pointers may reach it: " + stl::joined(pointers, map_name), 4, 2) + "\n";
  return text + "\n";
}

std::string preset_text(const Inspection& inspection, const MemoryMap::Element& element) {
  return stl::printable(stl::to_text(inspection.program->statement(element.op).operands[1]));
}

/// The time that a constant preset is: `30 s`, `0.25 s`.
std::string time_text(const MemoryMap::Element& timer) {
  if (!timer.preset) return "";
  return fmt::format(" = {:g} s",
                     static_cast<double>(*timer.preset * (timer_base(timer.number).base / kMillisecond)) / 1000);
}

std::string timers_text(const Inspection& inspection, const MemoryMap& map) {
  if (map.timers.empty()) return {};
  std::string text = "Timers: resolution, preset\n";
  for (const MemoryMap::Element& timer : map.timers) {
    const std::string& kind = inspection.program->statement(timer.op).mnemonic;
    text += row_text(inspection,
                     fmt::format("  {}{}", column(fmt::format("T{}", timer.number), 6),
                                 column(fmt::format("{}, {} ms, {}{}", kind, timer_base(timer.number).base / kMillisecond,
                                                    preset_text(inspection, timer), time_text(timer)),
                                        36)),
                     timer.op);
  }
  return text + "\n";
}

std::string counters_text(const Inspection& inspection, const MemoryMap& map) {
  if (map.counters.empty()) return {};
  std::string text = "Counters: preset\n";
  for (const MemoryMap::Element& counter : map.counters)
    text += row_text(
        inspection,
        fmt::format("  {}{}", column(fmt::format("C{}", counter.number), 6), column(preset_text(inspection, counter), 36)),
        counter.op);
  return text + "\n";
}

std::string data_text(const Inspection& inspection, const MemoryMap& map) {
  if (map.data.empty()) return {};
  std::string text = "Data block, and what writes over it\n";
  for (const MemoryMap::Data& data : map.data) {
    text += fmt::format("  {}\n", range_text(data.bits));
    for (const std::uint32_t op : data.writers) text += row_text(inspection, "    ", op);
  }
  return text + "\n";
}

std::string eeprom_text(const Inspection& inspection, const MemoryMap& map) {
  if (map.savers.empty()) return {};
  std::string text = fmt::format("EEPROM: VB0 to VB{}; SMB31 saves to it\n", inspection.program->model->eeprom_bytes - 1);
  for (const std::uint32_t op : map.savers) text += row_text(inspection, "  ", op);
  return text + "\n";
}

std::string stand_ins_text(const std::vector<StandIn>& stand_ins) {
  std::string text;
  for (const StandIn& stand_in : stand_ins)
    text += "  " +
            wrapped_at(fmt::format("VB{} to VB{}: {}, for {}", stand_in.memory, stand_in.memory + stand_in.bytes - 1,
                                   stand_in.file, stl::joined(stand_in.routines, map_name)),
                       4, 2) +
            "\n";
  return text.empty() ? text : "Memory of stand-ins for libraries\n" + text;
}

bool is_area_wanted(const Inspection& inspection, const MemoryMap::AreaUse& area) {
  const Selection& selection = inspection.selection;
  const auto is_used = [&](const MemoryMap::Used& used) {
    return std::ranges::any_of(used.routines,
                               [&](std::uint32_t i) { return selection.has_op(inspection.facts.flow.routines[i].first); });
  };
  return selection.wants_memory({area.all}) && (selection.ops.empty() || std::ranges::any_of(area.used, is_used));
}

/// What is asked for of the map, with the stand-ins, which are no part of it.
struct WantedMap {
  MemoryMap map;
  std::vector<StandIn> stand_ins;
};

WantedMap wanted_map(const Inspection& inspection, const CrossReference& reference) {
  WantedMap wanted{memory_map(inspection.facts, reference), stand_ins_of(inspection.program->source)};
  const Selection& selection = inspection.selection;
  MemoryMap& map = wanted.map;
  const auto is_element_unwanted = [&](std::uint32_t values) {
    return [&selection, values](const MemoryMap::Element& element) {
      const Bits value = as_named({(values + 2 * element.number) * 8u, 16});
      return !selection.wants_memory({value}) || !selection.wants_ops({element.op});
    };
  };
  std::erase_if(map.areas, [&](const MemoryMap::AreaUse& area) { return !is_area_wanted(inspection, area); });
  std::erase_if(map.timers, is_element_unwanted(image::kT));
  std::erase_if(map.counters, is_element_unwanted(image::kC));
  std::erase_if(map.data, [&](const MemoryMap::Data& data) {
    return !selection.wants_memory({data.bits}) || !selection.wants_ops(data.writers);
  });
  const Bits request{sm::kEepromRequest * 8u, 8};
  std::erase_if(map.savers,
                [&](std::uint32_t op) { return !selection.wants_memory({request}) || !selection.wants_ops({op}); });
  std::erase_if(wanted.stand_ins, [&](const StandIn& each) {
    const Bits variables{(std::uint64_t{image::kV} + each.memory) * 8, std::uint64_t{each.bytes} * 8};
    return !selection.wants_memory({variables}) || !selection.ops.empty();
  });
  return wanted;
}

ordered_json area_json(const Inspection& inspection, const CrossReference& reference, const MemoryMap::AreaUse& area) {
  ordered_json json{{"area", info(area.area).name}};
  json["routine"] =
      area.routine ? ordered_json(routine_text(inspection.facts.flow.routines[*area.routine])) : ordered_json();
  json["memory"] = range_text(area.all);
  json["used"] = ordered_json::array();
  for (const MemoryMap::Used& used : area.used)
    json["used"].push_back(
        {{"memory", range_text(used.bits)}, {"routines", routine_names(inspection, used)}, {"data_block", used.by_data}});
  json["idle"] = ordered_json::array();
  for (const MemoryMap::Used& used : area.idle)
    json["idle"].push_back({{"memory", range_text(used.bits)}, {"routines", routine_names(inspection, used)}});
  json["perhaps"] = ordered_json::array();
  for (const MemoryMap::Perhaps& perhaps : area.perhaps) {
    ordered_json through = ordered_json::array();
    for (const MemoryMap::Through& each : perhaps.through)
      through.push_back({{"pointer", pointer_text(each.at)}, {"place", place_json(inspection, each.op)}});
    json["perhaps"].push_back({{"memory", texts(perhaps.bits)}, {"through", std::move(through)}});
  }
  json["free"] = texts(area.free);
  json["retentive"] = texts(area.retentive);
  json["pointers"] = pointer_names(reference, area);
  return json;
}

ordered_json element_json(const Inspection& inspection, const MemoryMap::Element& element, std::string_view name) {
  ordered_json json{{"name", fmt::format("{}{}", name, element.number)}, {"preset", preset_text(inspection, element)}};
  if (name == "T") json["resolution_ns"] = timer_base(element.number).base;
  json["place"] = place_json(inspection, element.op);
  return json;
}

ordered_json map_places_json(const Inspection& inspection, const std::vector<std::uint32_t>& ops) {
  ordered_json all = ordered_json::array();
  for (const std::uint32_t op : ops) all.push_back(place_json(inspection, op));
  return all;
}

}  // namespace

std::string map_text(const Inspection& inspection) {
  const CrossReference reference = cross_reference(inspection.facts);
  const auto [map, stand_ins] = wanted_map(inspection, reference);
  std::string text;
  for (const MemoryMap::AreaUse& area : map.areas) text += area_text(inspection, reference, area);
  return text + timers_text(inspection, map) + counters_text(inspection, map) + data_text(inspection, map) +
         eeprom_text(inspection, map) + stand_ins_text(stand_ins);
}

ordered_json map_json(const Inspection& inspection) {
  const CrossReference reference = cross_reference(inspection.facts);
  const auto [map, stand_ins] = wanted_map(inspection, reference);
  ordered_json json;
  for (const char* key : {"areas", "timers", "counters", "data_block", "stand_ins"}) json[key] = ordered_json::array();
  for (const MemoryMap::AreaUse& area : map.areas) json["areas"].push_back(area_json(inspection, reference, area));
  for (const MemoryMap::Element& timer : map.timers) json["timers"].push_back(element_json(inspection, timer, "T"));
  for (const MemoryMap::Element& counter : map.counters) json["counters"].push_back(element_json(inspection, counter, "C"));
  for (const MemoryMap::Data& data : map.data)
    json["data_block"].push_back(
        {{"memory", range_text(data.bits)}, {"writers", map_places_json(inspection, data.writers)}});
  json["eeprom_savers"] = map_places_json(inspection, map.savers);
  for (const StandIn& stand_in : stand_ins)
    json["stand_ins"].push_back({{"file", stand_in.file},
                                 {"routines", stand_in.routines},
                                 {"memory", fmt::format("VB{}:{}", stand_in.memory, stand_in.bytes)}});
  return json;
}

}  // namespace s7200::tools

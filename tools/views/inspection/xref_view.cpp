#include "tools/views/inspection/xref_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <vector>

#include "interpreter/analysis/cross_reference.hpp"
#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/views/state/memory_meaning.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

std::string as_it_is(const std::string& text) { return text; }

/// The pointer that an access goes through: `*AC1`, of a profile `SMW168`; empty for a direct one.
std::string through(const Inspection& inspection, const Use& use) {
  if (!use.access.by_pointer) return {};
  const auto pointer = pointer_of(*inspection.program, use.op, use.access);
  return pointer ? pointer_text(*pointer) : "a pointer";
}

std::string_view verb_of(const MemoryAccess& access) {
  return access.role == Role::In ? "reads" : access.role == Role::Out ? "writes" : "changes";
}

std::string_view possible_verb_of(const MemoryAccess& access) {
  return access.role == Role::In ? "may read" : access.role == Role::Out ? "may write" : "may change";
}

std::string_view name_of(Usage usage) {
  switch (usage) {
    case Usage::NeverRead:
      return "never read";
    case Usage::NeverWritten:
      return "never written";
    case Usage::SetByData:
      return "set by the data block only";
    case Usage::OnlyChanged:
      return "changed, but never looked at";
    case Usage::Both:
      break;
  }
  return "";
}

/// What pointers may lead to: `anywhere in Q, V; VB100 to VB355`.
std::string targets_text(const Inspection& inspection, const std::vector<Bits>& targets) {
  std::vector<std::string> areas, places;
  for (const Bits& bits : targets) {
    const bool anywhere = is_anywhere(*inspection.program, {.bits = bits, .by_pointer = true});
    (anywhere ? areas : places).push_back(anywhere ? std::string(info(area_of(bits)).name) : memory_text(bits));
  }
  const std::string all = areas.empty() ? "" : "anywhere in " + stl::joined(areas, as_it_is);
  return all + (all.empty() || places.empty() ? "" : "; ") + stl::joined(places, as_it_is);
}

std::string reason_text(const Inspection& inspection, const Pointers::Unknown& unknown) {
  using Reason = Pointers::Unknown::Reason;
  switch (unknown.reason) {
    case Reason::NotSet:
      return "no instruction sets it";
    case Reason::DataBlock:
      return "the data block sets it";
    case Reason::Elsewhere:
      return "it is in memory that others write, too";
    case Reason::Counted:
      return fmt::format("{} ({}) counts it, and no comparison ends that", instruction_text(inspection, unknown.op),
                         place_in_words(inspection, unknown.op));
    case Reason::Length:
      return "how many segments the profile there has is known only in a run";
    case Reason::Written:
      break;
  }
  return fmt::format("{} ({}) puts into it what is known only in a run", instruction_text(inspection, unknown.op),
                     place_in_words(inspection, unknown.op));
}

/// The parts of the cross reference that the selection asks for.
class Wanted {
 public:
  explicit Wanted(const Selection& selection) : selection_(selection) {}

  bool memory(const Bits& bits) const { return selection_.memory.empty() || selection_.has(bits); }
  bool op(std::uint32_t op) const { return selection_.ops.empty() || selection_.has_op(op); }
  /// With each entry, accesses that may be anywhere would hide the others.
  bool anywhere() const { return !selection_.memory.empty(); }

  std::vector<Use> uses(const ReferenceEntry& entry) const {
    std::vector<Use> all;
    for (const Use& use : entry.uses)
      if (op(use.op)) all.push_back(use);
    return all;
  }
  std::vector<Use> reached(const Program& program, const ReferenceEntry& entry) const {
    std::vector<Use> all;
    for (const Use& use : entry.reached)
      if (op(use.op) && (anywhere() || !is_anywhere(program, use.access))) all.push_back(use);
    return all;
  }

 private:
  const Selection& selection_;
};

/// The pointers through which an entry may be reached anywhere in its area, each once.
std::vector<std::string> anywhere_through(const Inspection& inspection, const ReferenceEntry& entry) {
  std::set<std::string> names;
  for (const Use& use : entry.reached)
    if (is_anywhere(*inspection.program, use.access)) names.insert(through(inspection, use));
  return {names.begin(), names.end()};
}

std::string use_text(const Inspection& inspection, const Use& use, bool surely) {
  const std::string pointer = through(inspection, use);
  const std::string what = pointer.empty() ? memory_text(use.access.bits) : pointer;
  const std::string_view verb = surely ? verb_of(use.access) : possible_verb_of(use.access);
  return row_text(inspection, "  " + column(std::string(verb), 11) + column(what, 17), use.op);
}

std::string head_text(const Inspection& inspection, const ReferenceEntry& entry) {
  std::string text = stl::joined(entry.parts, memory_text);
  if (entry.routine) text += " of " + routine_text(inspection.facts.flow.routines[*entry.routine]);
  for (const std::string& symbol : entry.symbols) text += fmt::format(" \"{}\"", stl::printable(symbol));
  const std::string meaning = meaning_text(*inspection.program->model, entry.bits);
  if (!meaning.empty()) text += fmt::format(" ({})", meaning);
  const std::string_view usage = name_of(usage_of(*inspection.program, entry));
  if (!usage.empty()) text += fmt::format("; {}", usage);
  return wrapped_at(text, 2) + "\n";
}

std::string entry_text(const Inspection& inspection, const Wanted& wanted, const ReferenceEntry& entry) {
  const auto uses = wanted.uses(entry), reached = wanted.reached(*inspection.program, entry);
  if (!wanted.memory(entry.bits) || (uses.empty() && reached.empty())) return {};
  std::string text = head_text(inspection, entry);
  for (const Use& use : uses) text += use_text(inspection, use, true);
  for (const Use& use : reached) text += use_text(inspection, use, false);
  const auto pointers = anywhere_through(inspection, entry);
  if (!pointers.empty() && !wanted.anywhere())
    text += fmt::format("  {}{}\n", column("may reach", 11), stl::joined(pointers, as_it_is) + " (see Pointers)");
  return text;
}

std::string pointers_text(const Inspection& inspection, const Wanted& wanted, const CrossReference& reference) {
  std::string text;
  for (const PointerEntry& pointer : reference.pointers) {
    const bool meant = std::ranges::any_of(pointer.ops, [&](std::uint32_t op) { return wanted.op(op); }) &&
                       std::ranges::any_of(pointer.targets, [&](const Bits& bits) { return wanted.memory(bits); });
    if (!meant) continue;
    std::string head = fmt::format("{}: {}", pointer_text(pointer.at), targets_text(inspection, pointer.targets));
    if (pointer.unknown) head += "; " + reason_text(inspection, *pointer.unknown);
    text += wrapped_at(head, 2) + "\n";
    for (const std::uint32_t op : pointer.ops)
      if (wanted.op(op)) text += row_text(inspection, "  ", op);
  }
  return text.empty() ? text : "\nPointers\n" + text;
}

std::string constants_text(const Inspection& inspection, const Wanted& wanted, const CrossReference& reference) {
  std::string text;
  for (const ConstantEntry& constant : reference.constants)
    for (const ConstantEntry::Place& place : constant.places)
      if (wanted.op(place.op)) {  // as it is written there: 32, 16#20 or ' '
        const std::string written = stl::to_text(inspection.program->statement(place.op).operands[place.operand]);
        text += row_text(inspection, "  " + column(stl::printable(written), 28), place.op);
      }
  return text.empty() ? text : "\nConstants\n" + text;
}

/// The used memory next to what is not used, on both sides, in the same area.
std::vector<std::string> neighbours(const CrossReference& reference, const Bits& bits) {
  const ReferenceEntry *before = nullptr, *after = nullptr;
  for (const ReferenceEntry& entry : reference.entries) {
    if (area_of(entry.bits) != area_of(bits)) continue;
    if (entry.bits.first < bits.first && (!before || entry.bits.end() > before->bits.end())) before = &entry;
    if (entry.bits.first >= bits.end() && (!after || entry.bits.first < after->bits.first)) after = &entry;
  }
  std::vector<std::string> names;
  if (before) names.push_back(memory_text(before->parts.back()));
  if (after) names.push_back(memory_text(after->parts.front()));
  return names;
}

/// Memory that no instruction names, but which is part of a block, or of what a pointer may reach.
ReferenceEntry entry_within(const Facts& facts, const Bits& bits) {
  ReferenceEntry entry{.bits = bits, .routine = {}, .parts = {bits}, .uses = {}, .reached = {}, .symbols = {}};
  for (std::uint32_t op = 0; op < facts.effects.size(); ++op)
    for (MemoryAccess access : facts.effects[op]) {
      access.bits = as_named(access.bits);
      if (access.bits.overlaps(bits) && !is_anywhere(facts.program, access)) entry.reached.push_back({op, access});
    }
  return entry;
}

/// With an entry for each address that is asked for, where anything reaches it.
CrossReference reference_of(const Inspection& inspection) {
  CrossReference reference = cross_reference(inspection.facts);
  for (const Selection::Memory& asked : inspection.selection.memory) {
    const auto overlaps = [&](const ReferenceEntry& entry) { return entry.bits.overlaps(asked.bits); };
    if (std::ranges::any_of(reference.entries, overlaps)) continue;
    ReferenceEntry entry = entry_within(inspection.facts, asked.bits);
    if (!entry.reached.empty()) reference.entries.push_back(std::move(entry));
  }
  return reference;
}

std::vector<Selection::Memory> not_used(const Inspection& inspection, const CrossReference& reference) {
  std::vector<Selection::Memory> all;
  for (const Selection::Memory& asked : inspection.selection.memory)
    if (std::ranges::none_of(reference.entries,
                             [&](const ReferenceEntry& entry) { return entry.bits.overlaps(asked.bits); }))
      all.push_back(asked);
  return all;
}

std::string not_used_text(const Inspection& inspection, const CrossReference& reference) {
  std::string text;
  for (const Selection::Memory& asked : not_used(inspection, reference)) {
    const auto near = neighbours(reference, asked.bits);
    text += fmt::format("{}: no instruction names it{}\n", stl::printable(asked.text),
                        near.empty() ? "" : "; near it the program uses " + stl::joined(near, as_it_is, " and "));
  }
  return text;
}

ordered_json use_json(const Inspection& inspection, const Use& use, bool surely) {
  const std::string pointer = through(inspection, use);
  ordered_json json{
      {"access", verb_of(use.access)}, {"certain", surely}, {"address", targets_text(inspection, {use.access.bits})}};
  json["through"] = pointer.empty() ? ordered_json() : ordered_json(pointer);
  json.update(place_json(inspection, use.op));
  return json;
}

ordered_json entry_json(const Inspection& inspection, const Wanted& wanted, const ReferenceEntry& entry) {
  ordered_json json{{"address", memory_text(entry.bits)}, {"parts", ordered_json::array()}, {"symbols", entry.symbols}};
  for (const Bits& part : entry.parts) json["parts"].push_back(memory_text(part));
  json["routine"] =
      entry.routine ? ordered_json(routine_text(inspection.facts.flow.routines[*entry.routine])) : ordered_json();
  json["meaning"] = meaning_text(*inspection.program->model, entry.bits);
  json["usage"] = name_of(usage_of(*inspection.program, entry));
  json["uses"] = ordered_json::array();
  for (const Use& use : wanted.uses(entry)) json["uses"].push_back(use_json(inspection, use, true));
  for (const Use& use : wanted.reached(*inspection.program, entry)) json["uses"].push_back(use_json(inspection, use, false));
  json["anywhere_through"] = anywhere_through(inspection, entry);
  return json;
}

ordered_json pointer_json(const Inspection& inspection, const PointerEntry& pointer) {
  ordered_json json{{"pointer", pointer_text(pointer.at)}, {"targets", ordered_json::array()}};
  for (const Bits& bits : pointer.targets) json["targets"].push_back(targets_text(inspection, {bits}));
  json["why"] = pointer.unknown ? reason_text(inspection, *pointer.unknown) : "";
  json["uses"] = ordered_json::array();
  for (const std::uint32_t op : pointer.ops) json["uses"].push_back(place_json(inspection, op));
  return json;
}

ordered_json constant_json(const Inspection& inspection, const Wanted& wanted, const ConstantEntry& constant) {
  ordered_json json{{"constant", stl::printable(constant.text)}, {"uses", ordered_json::array()}};
  for (const ConstantEntry::Place& place : constant.places)
    if (wanted.op(place.op)) json["uses"].push_back(place_json(inspection, place.op));
  return json;
}

}  // namespace

std::string xref_text(const Inspection& inspection) {
  const CrossReference reference = reference_of(inspection);
  const Wanted wanted(inspection.selection);
  std::string text;
  for (const ReferenceEntry& entry : reference.entries) text += entry_text(inspection, wanted, entry);
  text += not_used_text(inspection, reference);
  text += pointers_text(inspection, wanted, reference);
  if (inspection.selection.memory.empty()) text += constants_text(inspection, wanted, reference);
  if (inspection.selection.everything() && !reference.unused_symbols.empty())
    text += "\n" +
            wrapped_at("Symbols of memory that no instruction uses: " +
                           stl::printable(stl::joined(reference.unused_symbols, as_it_is)),
                       2) +
            "\n";
  return text;
}

ordered_json xref_json(const Inspection& inspection) {
  const CrossReference reference = reference_of(inspection);
  const Wanted wanted(inspection.selection);
  ordered_json json;
  for (const char* key : {"entries", "pointers", "constants", "not_used"}) json[key] = ordered_json::array();
  for (const ReferenceEntry& entry : reference.entries) {
    auto of_entry = entry_json(inspection, wanted, entry);
    if (wanted.memory(entry.bits) && !of_entry["uses"].empty()) json["entries"].push_back(std::move(of_entry));
  }
  for (const PointerEntry& pointer : reference.pointers) json["pointers"].push_back(pointer_json(inspection, pointer));
  for (const ConstantEntry& constant : reference.constants) {
    auto of_constant = constant_json(inspection, wanted, constant);
    if (!of_constant["uses"].empty()) json["constants"].push_back(std::move(of_constant));
  }
  for (const Selection::Memory& asked : not_used(inspection, reference))
    json["not_used"].push_back({{"address", asked.text}, {"near", neighbours(reference, asked.bits)}});
  json["unused_symbols"] = reference.unused_symbols;
  return json;
}

}  // namespace s7200::tools

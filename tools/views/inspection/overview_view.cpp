#include "tools/views/inspection/overview_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "interpreter/analysis/cross_reference.hpp"
#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/flow/calls.hpp"
#include "interpreter/analysis/warnings/remarks.hpp"
#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/views/inspection/races_view.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

/// Instructions that talk on a port or to another station, and those for what comes too fast for a scan.
constexpr std::string_view kOutside[]{"XMT", "RCV", "NETR", "NETW", "HSC", "PLS", "PID", "TODR", "TODW"};

std::string overview_name(const std::string& text) { return text; }

/// What there is to say, worked out once for both forms.
struct Overview {
  explicit Overview(const Inspection& of)
      : inspection(of),
        calls(calls_of(*of.program, of.facts.flow)),
        reference(cross_reference(of.facts)),
        races(found_races(of)),
        remarks(remarks_of(of.facts, reference)) {}

  const Inspection& inspection;
  Calls calls;
  CrossReference reference;
  FoundRaces races;
  std::vector<Remark> remarks;

  std::size_t networks() const {
    std::size_t count = 0;
    for (std::uint32_t op = 0; op < inspection.program->ops.size(); ++op)
      count += inspection.facts.flow.nodes[op].network == op && inspection.facts.networks[op] != 0;
    return count;
  }

  /// The parts of an area that the program names, with their symbols.
  std::vector<std::string> named(Area area) const {
    std::vector<std::string> all;
    for (const ReferenceEntry& entry : reference.entries)
      if (area_of(entry.bits) == area)
        all.push_back(memory_text(entry.parts.front()) +
                      stl::joined(
                          entry.symbols,
                          [](const std::string& symbol) { return fmt::format(" \"{}\"", stl::printable(symbol)); }, ""));
    return all;
  }

  /// `XMT 3 times`
  std::vector<std::string> outside() const {
    std::vector<std::string> all;
    for (const std::string_view name : kOutside) {
      const auto count =
          std::ranges::count_if(inspection.program->ops, [&](const Op& op) { return op.instruction->mnemonic == name; });
      if (count != 0) all.push_back(fmt::format("{} {}", name, count == 1 ? "once" : fmt::format("{} times", count)));
    }
    return all;
  }

  std::vector<std::string> with_usage(Usage usage) const {
    std::vector<std::string> all;
    for (const ReferenceEntry& entry : reference.entries)
      if (usage_of(*inspection.program, entry) == usage) all.push_back(memory_text(entry.parts.front()));
    return all;
  }

  std::vector<std::string> never_executed() const {
    std::vector<std::string> all;
    for (std::uint32_t i = 1; i < calls.nodes.size(); ++i)
      if (!calls.nodes[i].executed()) all.push_back(routine_text(inspection.facts.flow.routines[i]));
    return all;
  }
};

std::string routine_line(const Overview& overview, std::uint32_t i) {
  const Routine& routine = overview.inspection.facts.flow.routines[i];
  std::string text = "  " + column(routine_in_words(overview.inspection, routine), 30) +
                     column(counted(routine.end - routine.first, "instruction"), 20);
  for (const std::uint8_t number : overview.calls.nodes[i].events) {
    const InterruptEvent* event = find_event(number);
    text += fmt::format("event {}{} ", number, event ? fmt::format(": {}", event->cause) : "");
  }
  if (i != 0 && !overview.calls.nodes[i].executed()) text += "never executed";
  return std::string(stl::trim_end(text)) + "\n";
}

std::string quoted_symbol(const std::string& symbol) { return fmt::format("\"{}\"", stl::printable(symbol)); }

/// `M10.5 "Al_Jam"`
std::string bit_text(const Inspection& inspection, const Bits& bit) {
  std::string text = memory_text(bit);
  for (const stl::Symbol& symbol : inspection.program->source.symbols)
    if (const auto of = bits_of(*inspection.program, symbol); of && *of == bit) text += " " + quoted_symbol(symbol.name);
  return text;
}

std::string remark_text(const Inspection& inspection, const Remark& remark) {
  const std::string places = stl::joined(remark.ops, [&](std::uint32_t op) { return line_text(inspection, op); });
  switch (remark.kind) {
    case Remark::Kind::NeverReset:
      return fmt::format("{} is set in {}, and no instruction resets it", bit_text(inspection, remark.bits), places);
    case Remark::Kind::NeverSet:
      return fmt::format("{} is reset in {}, and no instruction sets it", bit_text(inspection, remark.bits), places);
    case Remark::Kind::SharedMemory:
      return fmt::format("{} has {} in it, {}: {}", quoted_symbol(remark.symbols[0]), quoted_symbol(remark.symbols[1]),
                         memory_text(remark.bits), places);
    case Remark::Kind::OtherCoil:
      return fmt::format("{} is a coil in {} in every scan, and in {} at times", bit_text(inspection, remark.bits),
                         line_text(inspection, remark.ops.front()),
                         stl::joined(std::vector(remark.ops.begin() + 1, remark.ops.end()),
                                     [&](std::uint32_t op) { return line_text(inspection, op); }));
    case Remark::Kind::WrittenWhole:
      return fmt::format("{} is a coil in {}, and {} in {} writes over it at times", bit_text(inspection, remark.bits),
                         line_text(inspection, remark.ops.front()), instruction_text(inspection, remark.ops.back()),
                         line_text(inspection, remark.ops.back()));
    case Remark::Kind::SwitchedOff:
      return fmt::format("LDN SM0.0 in {} switches {} off", line_text(inspection, remark.ops.front()),
                         instruction_text(inspection, remark.ops.back()));
    case Remark::Kind::PastItsSymbol:
    case Remark::Kind::MayPassItsSymbol:
      break;
  }
  constexpr std::size_t kShown = 3;
  std::vector<std::string> over;
  for (std::size_t i = 1; i < std::min(remark.symbols.size(), kShown + 1); ++i)
    over.push_back(quoted_symbol(remark.symbols[i]));
  if (remark.symbols.size() > kShown + 1) over.push_back(fmt::format("{} more", remark.symbols.size() - kShown - 1));
  const bool may = remark.kind == Remark::Kind::MayPassItsSymbol;
  return fmt::format("{} in {} begins at {} and {} over {}", instruction_text(inspection, remark.ops.front()), places,
                     quoted_symbol(remark.symbols[0]), may ? "may go on" : "goes on", stl::joined(over, overview_name));
}

std::string remarks_text(const Overview& overview) {
  if (overview.remarks.empty()) return {};
  std::string text = "worth a look:\n";
  for (const Remark& remark : overview.remarks)
    text += "  " + wrapped_at(remark_text(overview.inspection, remark), 4, 2) + "\n";
  return text;
}

ordered_json remarks_json(const Overview& overview) {
  constexpr std::string_view kKinds[]{"never reset",         "never set",  "shared memory", "past its symbol",
                                      "may pass its symbol", "other coil", "written whole", "switched off"};
  ordered_json all = ordered_json::array();
  for (const Remark& remark : overview.remarks) {
    ordered_json json{{"kind", kKinds[static_cast<std::size_t>(remark.kind)]},
                      {"memory", memory_text(remark.bits)},
                      {"text", remark_text(overview.inspection, remark)},
                      {"places", ordered_json::array()}};
    for (const std::uint32_t op : remark.ops) json["places"].push_back(place_json(overview.inspection, op));
    all.push_back(std::move(json));
  }
  return all;
}

}  // namespace

std::string overview_text(const Inspection& inspection) {
  const Overview overview(inspection);
  const auto& routines = inspection.facts.flow.routines;
  std::string text = fmt::format("CPU {}: {}, {}, {}\n", inspection.program->model->name,
                                 counted(inspection.program->ops.size(), "instruction"),
                                 counted(overview.networks(), "network"), counted(routines.size(), "routine"));
  for (std::uint32_t i = 0; i < routines.size(); ++i) text += routine_line(overview, i);
  text += list_text(0, "inputs", overview.named(Area::I)) + list_text(0, "outputs", overview.named(Area::Q)) +
          list_text(0, "analog inputs", overview.named(Area::AI)) +
          list_text(0, "analog outputs", overview.named(Area::AQ)) + list_text(0, "timers", overview.named(Area::T)) +
          list_text(0, "counters", overview.named(Area::C)) + list_text(0, "to the outside", overview.outside());
  text += list_text(0, "written, never read", overview.with_usage(Usage::NeverRead)) +
          list_text(0, "read, never written", overview.with_usage(Usage::NeverWritten));
  text += remarks_text(overview);
  if (const std::size_t races = overview.races.races.size(); races != 0)
    text += fmt::format("{}: see the view races\n", counted(races, "race"));
  if (const std::size_t calls = overview.races.not_followed.size(); calls != 0)
    text += fmt::format("races: {} not followed: see the view races\n", counted(calls, "call"));
  return text;
}

ordered_json overview_json(const Inspection& inspection) {
  const Overview overview(inspection);
  return {{"instructions", inspection.program->ops.size()},
          {"networks", overview.networks()},
          {"routines", inspection.facts.flow.routines.size()},
          {"inputs", overview.named(Area::I)},
          {"outputs", overview.named(Area::Q)},
          {"timers", overview.named(Area::T)},
          {"counters", overview.named(Area::C)},
          {"outside", overview.outside()},
          {"never_executed", overview.never_executed()},
          {"never_read", overview.with_usage(Usage::NeverRead)},
          {"never_written", overview.with_usage(Usage::NeverWritten)},
          {"worth_a_look", remarks_json(overview)},
          {"races", overview.races.races.size()},
          {"races_not_followed", overview.races.not_followed.size()}};
}

}  // namespace s7200::tools

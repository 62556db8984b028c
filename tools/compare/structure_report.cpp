#include <fmt/format.h>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/compare/structure.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kColumn = 46;  ///< of a side in text
constexpr std::size_t kAround = 2;   ///< instructions that are shown on both sides of a change
constexpr std::string_view kSideBySide = "  {:<46} {} {}";

std::string_view change_word(const NetworkChange& change) {
  if (!change.match.older) return "added";
  if (!change.match.newer) return "removed";
  if (!change.match.same) return "changed";
  return change.match.moved ? "moved" : "same";
}

std::string network_name(const ComparedNetwork& network) {
  std::string text = network.routine;
  if (network.number != 0) text += fmt::format(", network {}", network.number);
  if (!network.title.empty()) text += fmt::format(" \"{}\"", stl::printable(network.title));
  return text;
}

std::string address_text(const stl::Symbol& symbol) {
  return symbol.value ? stl::to_text(stl::Operand{.value = *symbol.value}) : "no address";
}

class StructureText {
 public:
  StructureText(const Inspection& older, const Inspection& newer, const StructureDifference& difference)
      : older_(older), newer_(newer), difference_(difference) {}

  std::string text() const {
    std::string text = summary();
    for (const NetworkChange& change : difference_.networks) text += network(change);
    return text + comments() + symbols() + data() + events() + settings();
  }

 private:
  std::string summary() const {
    constexpr std::string_view kWords[]{"same", "moved", "changed", "added", "removed"};
    std::string text;
    for (const std::string_view word : kWords) {
      const std::size_t number = difference_.count([&](const NetworkChange& change) { return change_word(change) == word; });
      if (number == 0) continue;
      text += text.empty() ? counted(number, "network") : fmt::format(", {}", number);
      text += fmt::format(" {}{}", word == "same" ? "the " : "", word);
    }
    const std::string head = fmt::format("Structure: {}\n", text.empty() ? "no networks" : text);
    if (difference_.same_for_people()) return head + "The programs are the same.\n";
    if (!difference_.same_for_the_cpu()) return head;
    return head + "The CPU gets the same: only what people read differs.\n";
  }

  std::string network(const NetworkChange& change) const {
    const std::string_view word = change_word(change);
    if (word == "same") return {};
    const ComparedNetwork* const o = change.match.older ? &difference_.older[*change.match.older] : nullptr;
    const ComparedNetwork* const n = change.match.newer ? &difference_.newer[*change.match.newer] : nullptr;
    std::string text = fmt::format("\n{:<8} {}", word, network_name(n ? *n : *o));
    if (o && n && network_name(*o) != network_name(*n)) text += fmt::format(", was {}", network_name(*o));
    if (word == "changed" && change.match.moved) text += ", and moved";
    text += "\n";
    if (word == "added")
      for (std::uint32_t op = n->first; op < n->end; ++op) text += row("", ">", side(newer_, op));
    if (word == "removed")
      for (std::uint32_t op = o->first; op < o->end; ++op) text += row(side(older_, op), "<", "");
    return text + rows(change.rows);
  }

  /// Changes with some of what is the same around them.
  std::string rows(const std::vector<InstructionRow>& rows) const {
    std::string text;
    bool left_out = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      bool near = false;
      for (std::size_t k = i < kAround ? 0 : i - kAround; k < rows.size() && k <= i + kAround; ++k) near |= !rows[k].same;
      if (near) text += row_of(rows[i]);
      if (!near && !left_out) text += "  …\n";
      left_out = !near;
    }
    return text;
  }

  std::string row_of(const InstructionRow& of) const {
    const std::string left = of.older ? side(older_, *of.older) : "", right = of.newer ? side(newer_, *of.newer) : "";
    if (of.same) return row(left, " ", right);
    if (!of.newer) return row(left, "<", "");
    if (!of.older) return row("", ">", right);
    std::string text = row(left, "|", right);
    if (of.same_symbols) text += "    the same symbols, but not the same addresses or values\n";
    return text;
  }

  static std::string row(const std::string& left, std::string_view mark, const std::string& right) {
    if (stl::count_characters(left) > kColumn || stl::count_characters(right) > kColumn) {
      std::string text;
      if (!left.empty()) text += fmt::format("  {} {}\n", mark == "|" ? "<" : mark, left);
      if (!right.empty() && mark != " ") text += fmt::format("  {} {}\n", mark == "|" ? ">" : mark, right);
      return text;
    }
    return std::string(stl::trim_end(fmt::format(kSideBySide, left, mark, right))) + "\n";
  }

  static std::string side(const Inspection& of, std::uint32_t op) {
    return column(line_text(of, op), 16) + instruction_text(of, op);
  }

  std::string comments() const {
    std::string text;
    for (const NetworkChange& change : difference_.networks)
      if (change.comments_differ && change_word(change) == "same")
        text += fmt::format("  {}\n", network_name(difference_.newer[*change.match.newer]));
    return text.empty() ? "" : "\nComments alone\n" + text;
  }

  std::string symbols() const {
    using What = SymbolChange::What;
    std::string text;
    for (const SymbolChange& change : difference_.symbols) {
      const auto name = [](const stl::Symbol* symbol) { return "\"" + stl::printable(symbol->name) + "\""; };
      const stl::Symbol* const any = change.newer ? change.newer : change.older;
      const auto line = [&](const char* word, const std::string& what) { text += fmt::format("  {:<8} {}\n", word, what); };
      if (change.what == What::Renamed)
        line("renamed", fmt::format("{}: {} -> {}", address_text(*any), name(change.older), name(change.newer)));
      else if (change.what == What::Moved)
        line("moved", fmt::format("{}: {} -> {}", name(any), address_text(*change.older), address_text(*change.newer)));
      else
        line(change.what == What::Added     ? "added"
             : change.what == What::Removed ? "removed"
                                            : "comment",
             fmt::format("{}: {}", name(any), address_text(*any)));
    }
    return text.empty() ? "" : "\nSymbols\n" + text;
  }

  static std::string bytes(const std::vector<std::optional<std::uint8_t>>& all) {
    return stl::joined(
        all, [](const auto& byte) { return byte ? fmt::format("{:02X}", *byte) : std::string("--"); }, " ");
  }

  std::string data() const {
    std::string text;
    for (const DataChange& change : difference_.data) {
      const std::string place = change.older.size() == 1
                                    ? fmt::format("VB{}", change.offset)
                                    : fmt::format("VB{} to VB{}", change.offset, change.offset + change.older.size() - 1);
      text += "  " + wrapped_at(fmt::format("{}: {} -> {}", place, bytes(change.older), bytes(change.newer)), 4, 2) + "\n";
    }
    return text.empty() ? "" : "\nData block\n" + text;
  }

  static std::string routines(const std::vector<std::string>& all) {
    return all.empty() ? "nothing" : stl::joined(all, [](const std::string& routine) { return routine; });
  }

  std::string events() const {
    std::string text;
    for (const EventChange& change : difference_.events) {
      const InterruptEvent* const event = find_event(change.event);
      text += fmt::format("  event {}{}: {} -> {}\n", change.event, event ? fmt::format(", {}", event->cause) : "",
                          routines(change.older), routines(change.newer));
    }
    return text.empty() ? "" : "\nAttached interrupt routines\n" + text;
  }

  std::string settings() const {
    std::string text;
    for (const SettingChange& change : difference_.settings)
      text += fmt::format("  {}: {} -> {}\n", change.setting, change.older, change.newer);
    return text.empty() ? "" : "\nSettings\n" + text;
  }

  const Inspection &older_, &newer_;
  const StructureDifference& difference_;
};

ordered_json network_json(const Inspection& inspection, const ComparedNetwork& network) {
  ordered_json json{{"routine", network.routine}};
  json["network"] = network.number == 0 ? ordered_json() : ordered_json(network.number);
  json["title"] = network.title;
  json["first"] = place_json(inspection, network.first);
  json["instructions"] = network.end - network.first;
  return json;
}

ordered_json symbol_json(const stl::Symbol* symbol) {
  if (!symbol) return {};
  return {{"name", symbol->name}, {"address", address_text(*symbol)}, {"comment", symbol->comment}};
}

ordered_json bytes_json(const std::vector<std::optional<std::uint8_t>>& bytes) {
  ordered_json json = ordered_json::array();
  for (const auto& byte : bytes) json.push_back(byte ? ordered_json(*byte) : ordered_json());
  return json;
}

}  // namespace

std::string structure_text(const Inspection& older, const Inspection& newer, const StructureDifference& difference) {
  return StructureText(older, newer, difference).text();
}

ordered_json structure_json(const Inspection& older, const Inspection& newer, const StructureDifference& difference) {
  ordered_json json{{"same", difference.same_for_the_cpu()}, {"comments_same", difference.same_for_people()}};
  json["networks"] = ordered_json::array();
  for (const NetworkChange& change : difference.networks) {
    ordered_json entry{
        {"change", change_word(change)}, {"moved", change.match.moved}, {"comments_differ", change.comments_differ}};
    entry["old"] = change.match.older ? network_json(older, difference.older[*change.match.older]) : ordered_json();
    entry["new"] = change.match.newer ? network_json(newer, difference.newer[*change.match.newer]) : ordered_json();
    entry["rows"] = ordered_json::array();
    for (const InstructionRow& row : change.rows)
      entry["rows"].push_back({{"same", row.same},
                               {"same_symbols", row.same_symbols},
                               {"old", row.older ? place_json(older, *row.older) : ordered_json()},
                               {"new", row.newer ? place_json(newer, *row.newer) : ordered_json()}});
    json["networks"].push_back(std::move(entry));
  }
  constexpr std::string_view kWords[]{"renamed", "moved", "added", "removed", "comment"};
  json["symbols"] = ordered_json::array();
  for (const SymbolChange& change : difference.symbols)
    json["symbols"].push_back({{"change", kWords[static_cast<std::size_t>(change.what)]},
                               {"old", symbol_json(change.older)},
                               {"new", symbol_json(change.newer)}});
  json["data"] = ordered_json::array();
  for (const DataChange& change : difference.data)
    json["data"].push_back({{"address", fmt::format("VB{}", change.offset)},
                            {"old", bytes_json(change.older)},
                            {"new", bytes_json(change.newer)}});
  json["interrupts"] = ordered_json::array();
  for (const EventChange& change : difference.events)
    json["interrupts"].push_back({{"event", change.event}, {"old", change.older}, {"new", change.newer}});
  json["settings"] = ordered_json::array();
  for (const SettingChange& change : difference.settings)
    json["settings"].push_back({{"setting", change.setting}, {"old", change.older}, {"new", change.newer}});
  return json;
}

}  // namespace s7200::tools

#include "tools/session/words/address_words.hpp"

#include <set>

#include "interpreter/model/area.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::tools {

std::vector<std::string> address_words(const Program& program) {
  std::set<std::string> words;
  for (const stl::Symbol& symbol : program.source.symbols)
    if (symbol.value && std::holds_alternative<stl::Address>(*symbol.value) && symbol.name.find(' ') == std::string::npos)
      words.insert(symbol.name);
  for (const stl::Statement& statement : program.statements)
    for (const stl::Operand& operand : statement.operands) {
      if (const auto* address = std::get_if<stl::Address>(&operand.value))
        words.insert(stl::to_text(stl::Operand{.value = *address}));
      if (const auto* pointer = std::get_if<stl::Indirect>(&operand.value))
        words.insert(stl::to_text(stl::Operand{.value = *pointer}));
    }
  return {words.begin(), words.end()};
}

std::vector<std::string> area_words(const CpuModel& model) {
  std::vector<std::string> words;
  for (const AreaInfo& area : all_areas()) {
    if (model.size_of(area.area) == 0) continue;
    const bool is_analog = area.area == Area::AI || area.area == Area::AQ;
    const std::string_view widths = is_analog ? "W" : "BWD";
    if (area.element != 0) words.emplace_back(area.name);
    for (std::size_t i = 0; area.element == 0 && i < widths.size(); ++i) words.push_back(std::string(area.name) + widths[i]);
  }
  return words;
}

}  // namespace s7200::tools

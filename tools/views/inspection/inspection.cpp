#include "tools/views/inspection/inspection.hpp"

#include <fmt/format.h>

#include <utility>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kColumns = 100;

stl::FileLine place_of(const Inspection& inspection, std::uint32_t op) {
  return stl::in_file(inspection.program->source, inspection.program->statement(op).position.line);
}

std::string network_text(const Inspection& inspection, std::uint32_t op) {
  const std::uint32_t number = inspection.facts.networks[op];
  return number == 0 ? "-" : std::to_string(number);
}

}  // namespace

std::string line_text(const Inspection& inspection, std::uint32_t op) {
  const auto [file, line] = place_of(inspection, op);
  const std::size_t slash = file.find_last_of('/');
  return fmt::format("{}:{}", stl::printable(slash == std::string::npos ? file : file.substr(slash + 1)), line);
}

std::string column(std::string text, std::size_t width) {
  const std::size_t characters = stl::count_characters(text);
  text.append(characters < width ? width - characters : 1, ' ');
  return text;
}

std::string wrapped_at(std::string_view text, std::size_t indent, std::size_t used) {
  std::string all;
  bool begins = true;  // a line, so that a word stands in it however long it is
  for (const std::string& word : stl::split_words(text)) {
    const std::size_t size = stl::count_characters(word);
    if (!begins && used + 1 + size > kColumns) {
      all += "\n" + std::string(indent, ' ');
      used = indent;
      begins = true;
    }
    if (!begins) all += ' ';
    used += size + (begins ? 0 : 1);
    all += word;
    begins = false;
  }
  return all;
}

std::string list_text(std::size_t indent, std::string_view what, const std::vector<std::string>& all) {
  if (all.empty()) return {};
  const std::string text = fmt::format("{}: {}", what, stl::joined(all, [](const std::string& each) { return each; }));
  return std::string(indent, ' ') + wrapped_at(text, indent + 2, indent) + "\n";
}

std::string row_text(const Inspection& inspection, const std::string& before, std::uint32_t op) {
  const std::string head = before + place_text(inspection, op);
  const std::size_t width = stl::count_characters(head);
  return head + wrapped_at(instruction_text(inspection, op), width, width) + "\n";
}

std::string routine_at(const Inspection& inspection, std::uint32_t op) {
  return routine_text(inspection.facts.flow.routine_of(op));
}

std::string routine_in_words(const Inspection& inspection, const Routine& routine) {
  const stl::Block* block = block_of(*inspection.program, routine);
  std::string text = routine_text(routine);
  if (block && !block->name.empty() && stl::upper_case(block->name) != text)
    text += fmt::format(" \"{}\"", stl::printable(block->name));
  return text;
}

std::string place_text(const Inspection& inspection, std::uint32_t op) {
  return column(routine_at(inspection, op), 8) + column(network_text(inspection, op), 4) +
         column(line_text(inspection, op), 24);
}

std::string place_in_words(const Inspection& inspection, std::uint32_t op) {
  const std::uint32_t network = inspection.facts.networks[op];
  return fmt::format("{}, {}{}", routine_at(inspection, op), network == 0 ? "" : fmt::format("network {}, ", network),
                     line_text(inspection, op));
}

nlohmann::ordered_json place_json(const Inspection& inspection, std::uint32_t op) {
  const auto [file, line] = place_of(inspection, op);
  const std::uint32_t network = inspection.facts.networks[op];
  nlohmann::ordered_json json{{"routine", routine_at(inspection, op)}};
  json["network"] = network == 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(network);
  json["file"] = file;
  json["line"] = line;
  json["instruction"] = instruction_text(inspection, op);
  return json;
}

std::string instruction_text(const Inspection& inspection, std::uint32_t op) {
  const stl::Statement& statement = inspection.program->statement(op);
  std::string text = statement.mnemonic;
  for (const stl::Operand& operand : statement.operands)
    text += (&operand == statement.operands.data() ? " " : ", ") + stl::to_text(operand);
  return stl::printable(text);
}

}  // namespace s7200::tools

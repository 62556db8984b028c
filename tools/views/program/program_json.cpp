#include "tools/views/program/program_json.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <variant>

#include "interpreter/base/text/text.hpp"
#include "interpreter/program/ladder/networks.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::tools {
namespace {

using Json = nlohmann::ordered_json;

/// The NETWORK line in front of an instruction; null without one.
using Heads = std::map<std::uint32_t, const stl::NetworkHead*>;

Heads heads_of(const stl::Source& source) {
  Heads heads;
  std::uint32_t op = 0;
  for (const stl::Line& line : source.lines) {
    if (std::holds_alternative<stl::Statement>(line)) ++op;
    if (const auto* const head = std::get_if<stl::NetworkHead>(&line)) heads[op] = head;
  }
  return heads;
}

Json network_json(const Listing& listing, const Heads& heads, std::uint32_t first) {
  const auto found = heads.find(first);
  const stl::NetworkHead* const head = found == heads.end() ? nullptr : found->second;
  return {{"number", head && head->number != 0 ? Json(head->number) : Json()},
          {"title", head ? stl::trim(head->comment) : std::string_view()},
          {"line", head ? head->position.line : listing.line_of(first)},
          {"first", first}};
}

/// Of the block of a Micro/WIN export that has this line; null in a listing without blocks.
const stl::Block* block_of(const Program& program, std::uint32_t line) {
  const auto& blocks = program.source.blocks;
  const auto found = std::ranges::find_if(
      blocks, [&](const stl::Block& block) { return block.position.line <= line && line <= block.last_line; });
  return found == blocks.end() ? nullptr : &*found;
}

Json routines_json(const Program& program, const Listing& listing) {
  const Heads heads = heads_of(program.source);
  Json routines = Json::array();
  const auto ops = static_cast<std::uint32_t>(program.ops.size());
  for (std::uint32_t op = 0; op < ops; ++op) {
    if (op == 0 || listing.routine_of(op) != listing.routine_of(op - 1)) {
      const std::uint32_t line = listing.line_of(op);
      const stl::Block* const block = block_of(program, line);
      routines.push_back({{"name", listing.routine_of(op)},
                          {"title", block ? block->title : ""},
                          {"line", line},
                          {"first", op},
                          {"end", ops},
                          {"networks", Json::array()}});
    }
    Json& networks = routines.back()["networks"];
    if (listing.begins_network(op) || networks.empty()) networks.push_back(network_json(listing, heads, op));
    networks.back()["end"] = op + 1;
    routines.back()["end"] = op + 1;
  }
  return routines;
}

Json symbols_json(const Program& program) {
  Json symbols = Json::array();
  for (const stl::Symbol& symbol : program.source.symbols)
    if (symbol.value)
      symbols.push_back({{"name", symbol.name},
                         {"address", stl::to_text(stl::Operand{.value = *symbol.value})},
                         {"comment", symbol.comment}});
  return symbols;
}

/// How a page draws an instruction.
std::string_view kind_of(const Op& op) {
  const Instruction& row = *op.instruction;
  if (row.effect == Effect::Coil || row.effect == Effect::SetsBits || row.effect == Effect::ResetsBits) return "coil";
  if (is_box_or_coil(op)) return row.rung.stack.needs > 0 ? "box" : "structure";
  return row.rules().empty() || row.rules()[0].kind == OperandKind::StackLevel ? "stack" : "contact";
}

/// The address that an operand names, or that of its pointer; empty of a constant and of the number of a routine.
std::string address_of(const stl::Operand& operand) {
  if (const auto* const address = std::get_if<stl::Address>(&operand.value)) return stl::to_text(stl::Operand{*address});
  if (const auto* const indirect = std::get_if<stl::Indirect>(&operand.value))
    return stl::to_text(stl::Operand{indirect->pointer});
  if (const auto* const of = std::get_if<stl::AddressOf>(&operand.value)) return stl::to_text(stl::Operand{of->target});
  return {};
}

Json operands_json(const stl::Statement& statement) {
  Json operands = Json::array();
  for (const stl::Operand& operand : statement.operands)
    operands.push_back({{"text", operand.symbol.empty() ? stl::to_text(operand) : operand.symbol},
                        {"address", address_of(operand)},
                        {"symbol", operand.symbol},
                        {"pointer", std::holds_alternative<stl::Indirect>(operand.value)}});
  return operands;
}

/// The inputs and outputs that operands name bit by bit: `I0.0`, `Q1.2`.
Json points_json(const Program& program) {
  std::set<std::string> points;
  for (const stl::Statement& statement : program.statements)
    for (const stl::Operand& operand : statement.operands) {
      const std::string address = address_of(operand);
      const bool is_point = (address.starts_with('I') || address.starts_with('Q')) && address.find('.') != std::string::npos;
      if (is_point) points.insert(address);
    }
  return points;
}

}  // namespace

Json outline_json(const Program& program, const Listing& listing) {
  Json files = Json::array({{{"line", 1}, {"name", program.source.name}}});
  for (const stl::FurtherFile& file : program.source.further_files)
    files.push_back({{"line", file.first_line}, {"name", file.name}});
  return {{"program", program.source.name},   {"files", std::move(files)},
          {"cpu", program.model->name},       {"lines", program.source.text.size()},
          {"ops", program.ops.size()},        {"routines", routines_json(program, listing)},
          {"symbols", symbols_json(program)}, {"points", points_json(program)}};
}

Json lines_json(const Program& program, std::uint32_t from, std::uint32_t to) {
  Json lines = Json::array();
  for (std::uint32_t line = std::max(from, 1U); line <= to && line <= program.source.text.size(); ++line)
    lines.push_back({{"line", line}, {"text", program.source.text[line - 1]}, {"op", nullptr}});
  const auto at_line = [](const stl::Statement& statement, std::uint32_t line) { return statement.position.line < line; };
  const auto first = std::lower_bound(program.statements.begin(), program.statements.end(), from, at_line);
  for (auto statement = first; statement != program.statements.end() && statement->position.line <= to; ++statement) {
    const auto op = static_cast<std::uint32_t>(statement - program.statements.begin());
    const std::size_t place = statement->position.line - std::max(from, 1U);
    if (place >= lines.size()) continue;
    Json& line = lines[place];
    line["op"] = op;
    line["mnemonic"] = statement->mnemonic;
    line["kind"] = kind_of(program.ops[op]);
    line["operands"] = operands_json(*statement);
  }
  return lines;
}

}  // namespace s7200::tools

#include "tools/compare/networks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/analysis/drawn_networks.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::tools {
namespace {

template <class TextOf>
std::string with_operands(const stl::Statement& statement, TextOf text_of) {
  std::string text = statement.mnemonic;
  for (const stl::Operand& operand : statement.operands)
    text += (&operand == &statement.operands.front() ? " " : ", ") + text_of(operand);
  return text;
}

/// The end of a network without MEND, RET and RETI: they end whatever network happens to be the last of its routine.
std::uint32_t without_end(const Program& program, const DrawnNetwork& network) {
  std::uint32_t end = network.end;
  const auto ends_routine = [&](std::uint32_t op) {
    const Structure structure = program.ops[op].instruction->structure;
    return structure == Structure::MainEnd || structure == Structure::SubroutineEnd || structure == Structure::InterruptEnd;
  };
  while (end > network.first && ends_routine(end - 1)) --end;
  return end;
}

/// Puts a comment to the network that it stands in or in front of; after the last one, to that.
void add_comment(std::vector<ComparedNetwork>& networks, const Program& program, std::uint32_t line,
                 const std::string& text) {
  if (text.empty() || networks.empty()) return;
  const auto ends_before = [&](const ComparedNetwork& network, std::uint32_t at) {
    return program.statement(network.end - 1).position.line < at;
  };
  auto network = std::lower_bound(networks.begin(), networks.end(), line, ends_before);
  if (network == networks.end()) --network;
  network->comments.push_back(text);
}

}  // namespace

std::string cpu_text(const stl::Statement& statement) {
  return with_operands(statement, [](stl::Operand operand) {
    operand.symbol.clear();
    if (auto* integer = std::get_if<stl::Integer>(&operand.value)) *integer = {.value = integer->value};
    return stl::to_text(operand);
  });
}

std::string symbolic_text(const stl::Statement& statement) {
  return with_operands(statement, [](const stl::Operand& operand) {
    return operand.symbol.empty() ? stl::to_text(operand) : operand.symbol;
  });
}

std::vector<ComparedNetwork> compared_networks(const Inspection& inspection) {
  const Program& program = *inspection.program;
  std::vector<ComparedNetwork> networks;
  for (const DrawnNetwork& drawn : drawn_networks(program.source)) {
    const std::uint32_t end = without_end(program, drawn);
    if (drawn.first == end) continue;
    ComparedNetwork network{.routine = drawn.routine,
                            .number = inspection.facts.networks[drawn.first],
                            .title = std::string(stl::trim(drawn.title)),
                            .first = drawn.first,
                            .end = end};
    for (std::uint32_t op = drawn.first; op < end; ++op) network.code.push_back(cpu_text(program.statement(op)));
    networks.push_back(std::move(network));
  }
  for (const stl::Line& line : program.source.lines) {
    if (const auto* comment = std::get_if<stl::CommentLine>(&line))
      add_comment(networks, program, comment->line, comment->text);
    else if (const auto* head = std::get_if<stl::NetworkHead>(&line))
      add_comment(networks, program, head->position.line, head->comment);
    else if (const auto* statement = std::get_if<stl::Statement>(&line))
      add_comment(networks, program, statement->position.line, statement->comment);
  }
  return networks;
}

}  // namespace s7200::tools

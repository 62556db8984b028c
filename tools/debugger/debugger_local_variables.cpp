// Variables of blocks: `#level` is the local memory that the block has given it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ostream>

#include "interpreter/base/nearest.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/debugger/debugger.hpp"

namespace s7200::tools {
namespace {

/// Of an instruction; null in a program without blocks.
const stl::Block* block_of(const Program& program, const Listing& listing, std::uint32_t op) {
  const std::uint32_t line = listing.line_of(op);
  const auto holds = [&](const stl::Block& block) { return block.position.line <= line && line <= block.last_line; };
  const auto found = std::ranges::find_if(program.source.blocks, holds);
  return found == program.source.blocks.end() ? nullptr : &*found;
}

/// `LD4:real`
std::string address_of(const stl::Variable& variable) {
  return stl::to_text(stl::Operand{.value = variable.address}) + (variable.type == stl::Variable::Type::Real ? ":real" : "");
}

const stl::Variable* find_variable(const stl::Block& block, std::string_view name) {
  const std::string wanted = stl::upper_case(name);
  const auto found = std::ranges::find_if(
      block.variables, [&](const stl::Variable& variable) { return stl::upper_case(variable.name) == wanted; });
  return found == block.variables.end() ? nullptr : &*found;
}

std::string no_variable_text(std::string_view name, const std::string& routine, const stl::Block* block) {
  std::vector<std::string> names;
  if (block)
    for (const stl::Variable& variable : block->variables) names.push_back("#" + variable.name);
  const std::vector<std::string_view> known(names.begin(), names.end());
  const std::string_view meant = nearest(name, known);
  const std::string there = names.empty()   ? "it has none"
                            : meant.empty() ? fmt::format("it has {}", fmt::join(names, ", "))
                                            : fmt::format("did you mean {}?", meant);
  return fmt::format("{} is not a variable of {}, where it stands; {}", stl::shortened(name), routine,
                     stl::printable(there));
}

/// The places of `#name` in a word: not within a quotation, and not after a letter, as in 16#FF.
std::size_t find_local(std::string_view word, std::size_t from) {
  for (std::size_t i = from; i < word.size(); ++i) {
    const bool begins = i == 0 || std::string_view("(*&=<>+-/").find(word[i - 1]) != std::string_view::npos;
    if (word[i] == '#' && begins && i + 1 < word.size()) return i;
  }
  return std::string_view::npos;
}

std::size_t end_of_name(std::string_view word, std::size_t from) {
  return std::min(word.find_first_of(":=<>+-*/() ", from), word.size());
}

}  // namespace

/// Puts addresses for the names of variables, and says which, as of pointers.
Debugger::Error Debugger::with_local_variables(Arguments& words, std::optional<std::uint32_t> op) {
  const Program& program = simulation().cpu().program();
  const stl::Block* const block = op ? block_of(program, listing(), *op) : nullptr;
  for (std::string& word : words) {
    if (word.starts_with('\'') || word.starts_with('"')) continue;
    for (std::size_t at = find_local(word, 0); at != std::string::npos; at = find_local(word, at)) {
      const std::string name = word.substr(at, end_of_name(word, at) - at);
      const stl::Variable* const variable = block ? find_variable(*block, std::string_view(name).substr(1)) : nullptr;
      const std::string routine = op ? listing().routine_of(*op) : "a routine";
      if (!variable) return no_variable_text(name, routine, block);
      const std::string address = address_of(*variable);
      out_ << fmt::format("{} is {} in {}\n", stl::printable(name), address, routine);
      word.replace(at, name.size(), address);
      at += address.size();
    }
  }
  return {};
}

}  // namespace s7200::tools

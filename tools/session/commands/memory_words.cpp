#include "tools/session/commands/memory_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "interpreter/base/text/nearest.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/stops/stop_words.hpp"
#include "tools/session/words/bad_pointers.hpp"
#include "tools/session/words/force_words.hpp"
#include "tools/session/words/words.hpp"
#include "tools/views/state/machine_text.hpp"
#include "tools/views/state/memory.hpp"

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
  return fmt::format("{} is no variable of {}, which is executed now; {}", stl::shortened(name), routine,
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

Result<NamedRange> find_range(Session& session, const std::string& text) {
  const Cpu& cpu = session.cpu();
  const auto place = parse_place(text, cpu.program());
  if (!place) return place.trouble();
  const auto range = range_now(*place, cpu);
  const std::string written = stl::upper_case(text);
  if (!range) {
    const std::string address = address_name(cpu.program(), place->range, place->range.name_of(0));
    return Trouble{bad_pointer_text(cpu, place->range, written, address)};
  }
  if (!place->pointer) return NamedRange{*range, address_name(cpu.program(), *range, written)};
  const std::string count = range->count > 1 ? fmt::format(":{}", range->count) : "";
  const NamedRange named{*range, address_name(cpu.program(), *range, range->name_of(0) + count)};
  session.said << fmt::format("{} is {} now\n", written, named.name);
  return named;
}

Result<NamedRange> one_range(Session& session, const Words& arguments, std::string_view command) {
  if (arguments.size() == 1) return find_range(session, arguments[0]);
  return Trouble{expects(command, fmt::format("one address, or event and a number, for example: {} VW100", command))};
}

std::string ranges_of(Session& session, const Words& arguments, std::string_view command, std::vector<NamedRange>& ranges) {
  for (const std::string& text : arguments) {
    const auto range = find_range(session, text);
    if (!range && arguments.size() > 1 && Expression::parse(joined(arguments), session.program()))
      return fmt::format("{} takes addresses; 'print {}' computes an expression", command, joined(arguments));
    if (!range) return range.why();
    ranges.push_back(*range);
  }
  return {};
}

std::string address_name(const Program& program, const MemoryRange& range, std::string_view written) {
  const stl::Symbol* symbol = symbol_of(program, range);
  if (!symbol) return stl::upper_case(written);
  return fmt::format("{} ({})", range.name_of(0), stl::printable(symbol->name));
}

Result<std::uint32_t> find_op(Session& session, const Words& arguments, std::string_view command) {
  const auto place = find_place(arguments, session.program(), session.listing(), command);
  if (!place) return place.trouble();
  session.said << place->note;
  return place->op;
}

std::string with_local_variables(Session& session, Words& words, std::optional<std::uint32_t> op) {
  const Program& program = session.program();
  const stl::Block* const block = op ? block_of(program, session.listing(), *op) : nullptr;
  for (std::string& word : words) {
    if (word.starts_with('\'') || word.starts_with('"')) continue;
    for (std::size_t at = find_local(word, 0); at != std::string::npos; at = find_local(word, at)) {
      const std::string name = word.substr(at, end_of_name(word, at) - at);
      const stl::Variable* const variable = block ? find_variable(*block, std::string_view(name).substr(1)) : nullptr;
      const std::string routine = op ? session.listing().routine_of(*op) : "a routine";
      if (!variable) return no_variable_text(name, routine, block);
      const std::string address = address_of(*variable);
      session.said << fmt::format("{} is {} in {}\n", stl::printable(name), address, routine);
      word.replace(at, name.size(), address);
      at += address.size();
    }
  }
  return {};
}

std::string memory_text(const Session& session, std::size_t station, const MemoryRange& range) {
  const Cpu& cpu = session.stations[station].simulation->cpu();
  const std::string symbol = symbol_text(cpu.program(), range);
  return dump_text(cpu, range) + forced_line(session, cpu, range) + (symbol.empty() ? "" : "         " + symbol + "\n");
}

std::string forced_line(const Session& session, const Cpu& cpu, const MemoryRange& range) {
  const std::string forced = forced_text(session, cpu, {bits_of(range)});
  if (forced.empty()) return {};
  const Bytes in_program = range.bytes_in(cpu.state().image);
  const bool is_as_forced = in_program == forcing::seen_outside(cpu.state(), range);
  return fmt::format("       {}{}\n", forced,
                     is_as_forced ? "" : "; in this scan the program has " + value_text(cpu.program(), range, in_program));
}

std::string forced_text(const Session& session, const Cpu& cpu, const std::vector<Bits>& places) {
  std::string text;
  for (const Forced& forced : forced_in(cpu)) {
    const Bits bits = bits_of(forced.place);
    if (std::ranges::none_of(places, [&](const Bits& place) { return place.overlaps(bits); })) continue;
    text += fmt::format("{} {}={}", text.empty() ? "  forced:" : ",", forced.place.name_of(0), forced.value);
  }
  return session.red(std::move(text));
}

std::string value_of(const Cpu& cpu, const MemoryRange& range) {
  return value_text(cpu.program(), range, forcing::seen_outside(cpu.state(), range));
}

}  // namespace s7200::tools

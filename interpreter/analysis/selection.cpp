#include "interpreter/analysis/selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/nearest.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/operands/address.hpp"
#include "interpreter/stl/parser.hpp"
#include "interpreter/stl/tables/symbols.hpp"

namespace s7200 {
namespace {

/// A name without what people write in different ways: `SBR_3`, `SBR 3` and `sbr3` are the same.
std::string plain(std::string_view name) {
  std::string text = stl::upper_case(name);
  std::erase_if(text, [](char c) { return c == ' ' || c == '_' || c == '"'; });
  return text;
}

const Routine* find_routine(std::string_view name, const Facts& facts) {
  for (const Routine& routine : facts.flow.routines) {
    const stl::Block* block = block_of(facts.program, routine);
    const bool main = routine.kind == Routine::Kind::Main && plain(name) == "OB1";
    if (main || plain(routine_text(routine)) == plain(name) || (block && plain(block->name) == plain(name))) return &routine;
  }
  return nullptr;
}

std::string routines_text(const Facts& facts) { return stl::joined(facts.flow.routines, routine_text); }

/// The networks of a routine, by number.
std::map<std::uint32_t, Selection::Ops> networks_of(const Facts& facts, const Routine& routine) {
  std::map<std::uint32_t, Selection::Ops> all;
  for (std::uint32_t op = routine.first; op < routine.end; ++op) {
    const std::uint32_t number = facts.networks[op];
    all.try_emplace(number, Selection::Ops{"", op, op}).first->second.end = op + 1;
  }
  return all;
}

Result<Selection::Ops> find_network(const std::string& word, std::string_view number, const Routine& routine,
                                    const Facts& facts) {
  const auto networks = networks_of(facts, routine);
  const auto wanted = parse_decimal<std::uint32_t>(number);
  const auto found = wanted ? networks.find(*wanted) : networks.end();
  if (found != networks.end()) return Selection::Ops{word, found->second.first, found->second.end};
  return trouble("{} has no network '{}'; it has {}", routine_text(routine), stl::shortened(number),
                 stl::joined(networks, [](const auto& each) { return std::to_string(each.first); }));
}

/// Whether it can only be meant as an address, if not one of this CPU: `VB99999`, `VB0:99999`.
bool can_only_be_address(std::string_view word) {
  const std::string_view address = word.substr(0, word.find(':'));
  const auto operand = stl::parse_operand(address);
  return operand && std::holds_alternative<stl::Address>(operand->value) && !stl::may_be_name(operand->value, address);
}

/// What is probably meant by a word that is neither an address nor a routine.
std::string unknown_text(const std::string& word, const Facts& facts, const std::string& not_an_address) {
  if (can_only_be_address(word)) return not_an_address;
  std::vector<std::string_view> names;
  for (const stl::Symbol& symbol : facts.program.source.symbols) names.push_back(symbol.name);
  for (const stl::Block& block : facts.program.source.blocks) names.push_back(block.name);
  const std::string_view near = nearest(word, names);
  if (!near.empty())
    return fmt::format("'{}' is neither an address nor a name of this program; did you mean {}?", stl::shortened(word),
                       near);
  return fmt::format("{}; or a routine: {}", not_an_address, routines_text(facts));
}

Result<> add_word(const std::string& word, const Facts& facts, Selection& selection) {
  const std::size_t colon = word.rfind(':');
  if (const Routine* routine = find_routine(word, facts)) {
    selection.ops.push_back({word, routine->first, routine->end});
    return {};
  }
  const Routine* routine = colon == std::string::npos ? nullptr : find_routine(word.substr(0, colon), facts);
  if (routine) {
    const auto network = find_network(word, std::string_view(word).substr(colon + 1), *routine, facts);
    if (!network) return network.trouble();
    selection.ops.push_back(*network);
    return {};
  }
  const auto range = parse_range(word, facts.program);
  if (!range) return Trouble{unknown_text(word, facts, range.why())};
  const std::uint64_t first = std::uint64_t{range->at} * 8;
  const bool bit = range->width == Width::Bit;
  selection.memory.push_back(
      {word, as_named(bit ? Bits{first + range->bit, 1} : Bits{first, std::uint64_t{range->bytes()} * 8})});
  return {};
}

}  // namespace

bool Selection::has(const Bits& bits) const {
  return std::ranges::any_of(memory, [&](const Memory& each) { return each.bits.overlaps(bits); });
}

bool Selection::has_op(std::uint32_t op) const {
  return std::ranges::any_of(ops, [&](const Ops& each) { return op >= each.first && op < each.end; });
}

bool Selection::wants_memory(const std::vector<Bits>& bits) const {
  return memory.empty() || std::ranges::any_of(bits, [&](const Bits& each) { return has(each); });
}

bool Selection::wants_ops(const std::vector<std::uint32_t>& which) const {
  return ops.empty() || std::ranges::any_of(which, [&](std::uint32_t op) { return has_op(op); });
}

Result<Selection> parse_selection(std::span<const std::string> words, const Facts& facts) {
  Selection selection;
  for (const std::string& word : words)
    if (const auto done = add_word(word, facts, selection); !done) return done.trouble();
  return selection;
}

std::string routine_text(const Routine& routine) {
  switch (routine.kind) {
    case Routine::Kind::Subroutine:
      return fmt::format("SBR_{}", routine.number);
    case Routine::Kind::Interrupt:
      return fmt::format("INT_{}", routine.number);
    case Routine::Kind::Main:
      break;
  }
  return "MAIN";
}

const stl::Block* block_of(const Program& program, const Routine& routine) {
  const auto kind = static_cast<stl::Block::Kind>(routine.kind);
  const auto found = std::ranges::find_if(program.source.blocks, [&](const stl::Block& block) {
    return block.kind == kind && (kind == stl::Block::Kind::Main || block.number == routine.number);
  });
  return found == program.source.blocks.end() ? nullptr : &*found;
}

}  // namespace s7200

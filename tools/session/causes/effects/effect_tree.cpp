#include "tools/session/causes/effects/effect_tree.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/model/errors.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/session/causes/expression.hpp"
#include "tools/session/causes/memory_cause.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr std::uint8_t kTransmitted0 = 9, kTransmitted1 = 26;  // the events of a message that has been sent
constexpr std::size_t kMostCharacters = 8;                     // that are named

/// The event of an edge of I0.0 to I0.3: nothing of all others.
std::optional<std::uint64_t> input_of_edge(std::uint8_t event) {
  if (event >= 8) return {};
  return std::uint64_t{image::kInputs} * 8 + event / 2;
}

bool is_in(const Bits& bits, std::uint32_t from, std::uint32_t to) { return bits.first / 8 >= from && bits.first / 8 < to; }

/// What hands values on within the program, and is named only where it leads on to something.
bool hands_on(const Bits& bits) {
  return is_in(bits, image::kSM, image::kS) || is_in(bits, image::kAC, image::kTBits) ||
         is_in(bits, image::kInputs, image::kV) || is_in(bits, image::kL, image::kConstants);
}

std::string text_of_characters(const std::vector<std::uint16_t>& characters) {
  std::string text;
  for (std::size_t i = 0; i < std::min(characters.size(), kMostCharacters); ++i)
    text += fmt::format("{}{:02X}", i == 0 ? "" : " ", characters[i]);
  return characters.size() > kMostCharacters ? text + " …" : text;
}

std::string_view way_text(const Instruction& instruction, bool value) {
  switch (instruction.structure) {
    case Structure::Jump:
      return value ? "jumps" : "does not jump";
    case Structure::SegmentBegin:
      return value ? "is active" : "is not active";
    default:
      return value ? "is executed" : "is not executed";
  }
}

}  // namespace

EffectTree::EffectTree(const Program& program, const RunRecord& known, const RunRecord& without,
                       const RunDifferences& differences, const std::vector<Bits>& changed)
    : program_(program), known_(known), without_(without), differences_(differences) {
  std::uint32_t routine = 0;
  for (std::uint32_t op = 0; op < program.ops.size(); ++op) {
    if (begins_routine(program.ops[op].instruction->structure)) routine = op;
    routine_.push_back(routine);
  }
  nodes_.push_back({.bits = changed.front()});
  for (const Bits& place : changed)
    for (std::uint64_t bit = place.first; bit < place.end(); ++bit) {
      nodes_of_bit_[bit].push_back(kRoot);
      nodes_[kRoot].keys.push_back(bit);
    }
  for (const RunDifference& difference : differences.all()) add(difference);
}

const Happening& EffectTree::happening_of(const RunDifference& difference) const {
  return (difference.in_first ? known_ : without_).happenings[difference.happening];
}

EffectTree::Subject EffectTree::subject_of(const RunDifference& difference, const Happening& happening) {
  if (is_memory(difference.key)) return {0, happening.place.first, happening.place.count};
  if (is_decision(difference.key)) return {1, *happening.op, 0};
  const bool characters = happening.kind == TraceKind::CharacterSent;
  return {2, std::uint64_t{static_cast<std::uint8_t>(happening.kind)} << 8 | happening.where,
          characters ? 0 : happening.what};
}

void EffectTree::add(const RunDifference& difference) {
  const Happening& happening = happening_of(difference);
  const Subject subject = subject_of(difference, happening);
  const auto& of_root = nodes_[kRoot].keys;
  const bool is_root = std::ranges::find(of_root, difference.key) != of_root.end();
  const auto [found, is_new] = node_of_.try_emplace(subject, is_root ? kRoot : nodes_.size());
  const std::size_t number = found->second;
  if (is_new && !is_root) {
    nodes_.push_back({.bits = is_memory(difference.key) ? happening.place : Bits{0, 0}});
    describe(nodes_.back(), happening, difference);
  }
  Node& node = nodes_[number];
  node.last = std::max(node.last, difference.at);
  if (std::ranges::find(node.keys, difference.key) == node.keys.end()) {
    node.keys.push_back(difference.key);
    if (is_memory(difference.key)) nodes_of_bit_[difference.key].push_back(number);
  }
  if (happening.kind == TraceKind::CharacterSent && difference.key >= kFirstRecord)
    (difference.in_first ? node.known : node.without).push_back(happening.what);
  if (number == kRoot || node.parent) return;
  const auto parent = cause_of(happening, difference, number);
  if (!parent) return;
  std::string because = std::move(nodes_[number].effect.because);
  if (!is_new) describe(nodes_[number], happening, difference);
  nodes_[number].effect.because = std::move(because);
  nodes_[number].parent = parent;
}

/// The latest of the occasion and of what was looked at, then the way that the program has taken, then the interrupt.
std::optional<std::size_t> EffectTree::cause_of(const Happening& happening, const RunDifference& difference,
                                                std::size_t self) {
  Look by;
  const auto looked = looked_at(happening, difference.at, self, by);
  const auto occasion = occasion_of(happening);
  const bool by_occasion =
      occasion && *occasion != self && (!looked || nodes_[*occasion].effect.from >= nodes_[*looked].effect.from);
  if (by_occasion) return occasion;
  if (looked) {
    const bool other = happening.op && by.op != *happening.op;
    nodes_[self].effect.because = other ? place_of(by.op) : "";
    return looked;
  }
  if (happening.op)
    if (const auto way = way_to(*happening.op, difference.at); way && *way != self) return way;
  if (!happening.serving) return {};
  return record_node(TraceKind::ServiceBegin, *happening.serving);
}

/// The latest of those that differ then. The status that an instruction leaves in special memory is not what led to it.
std::optional<std::size_t> EffectTree::looked_at(const Happening& happening, Time at, std::size_t self, Look& by) const {
  std::optional<std::size_t> found;
  for (const Look& look : happening.looks)
    for (std::uint64_t bit = look.bits.first; bit < look.bits.end(); ++bit) {
      const auto nodes = nodes_of_bit_.find(bit);
      if (nodes == nodes_of_bit_.end() || !differences_.differ(bit, at)) continue;
      for (const std::size_t node : nodes->second) {
        if (node == self || (node != kRoot && !nodes_[node].parent)) continue;
        if (happening.op && nodes_[node].effect.op == happening.op && is_in({bit, 1}, image::kSM, image::kS)) continue;
        if (found && nodes_[*found].effect.from >= nodes_[node].effect.from) continue;
        found = node;
        by = look;
      }
    }
  return found;
}

/// The latest decision of the routine before the instruction, or to call the routine, that is another one in both runs.
std::optional<std::size_t> EffectTree::way_to(std::uint32_t op, Time at) const {
  std::optional<std::size_t> found;
  for (std::size_t node = 1; node < nodes_.size(); ++node) {
    const Effect& effect = nodes_[node].effect;
    if (effect.kind != "way" || !nodes_[node].parent || !differences_.differ(decision_key(*effect.op), at)) continue;
    const Op& decides = program_.ops[*effect.op];
    const bool calls = decides.instruction->structure == Structure::Call && decides.target == routine_[op];
    const bool before = routine_[*effect.op] == routine_[op] && *effect.op < op;
    if ((calls || before) && (!found || nodes_[*found].effect.from <= effect.from)) found = node;
  }
  return found;
}

/// The latest node of records of a kind that something led to.
std::optional<std::size_t> EffectTree::record_node(TraceKind kind, std::uint8_t where) const {
  const std::uint64_t which = std::uint64_t{static_cast<std::uint8_t>(kind)} << 8 | where;
  std::optional<std::size_t> found;
  for (auto node = node_of_.lower_bound({2, which, 0}); node != node_of_.end(); ++node) {
    if (std::get<1>(node->first) != which) break;
    if (nodes_[node->second].parent) found = node->second;
  }
  return found;
}

/// What a character, an interrupt or a STOP comes of.
std::optional<std::size_t> EffectTree::occasion_of(const Happening& happening) const {
  if (happening.kind == TraceKind::CharacterSent) return record_node(TraceKind::Transmit, happening.where);
  if (happening.kind == TraceKind::ModeChange) return record_node(TraceKind::FatalError, 0);
  if (happening.kind != TraceKind::ServiceBegin) return {};
  if (const auto input = input_of_edge(happening.where))
    if (const auto nodes = nodes_of_bit_.find(*input); nodes != nodes_of_bit_.end()) return nodes->second.front();
  const bool transmitted = happening.where == kTransmitted0 || happening.where == kTransmitted1;
  const std::uint8_t port = happening.where == kTransmitted1 ? 1 : 0;
  if (transmitted)
    if (const auto sent = record_node(TraceKind::Transmit, port)) return sent;
  for (const TraceKind kind : {TraceKind::Attach, TraceKind::Detach})
    if (const auto node = record_node(kind, happening.where)) return node;
  return record_node(TraceKind::Enable, 0);
}

// --- words ---

std::string EffectTree::place_of(std::uint32_t op) const {
  return fmt::format("{} in {}", short_text(program_.statement(op)), line_of(op, program_));
}

std::optional<MemoryRange> EffectTree::range_of(const Bits& bits) const {
  const auto at = static_cast<std::uint32_t>(bits.first / 8);
  const Width width = bits.count == 16 ? Width::Word : bits.count == 32 ? Width::Double : Width::Byte;
  auto range = range_at(at, width, *program_.model);
  if (range && bits.count == 1) {
    range->width = Width::Bit;
    range->bit = static_cast<std::uint8_t>(bits.first % 8);
  } else if (range && bits.count > 32) {
    range->count = static_cast<std::uint32_t>(bits.count / 8);
  }
  return range;
}

void EffectTree::describe(Node& node, const Happening& happening, const RunDifference& difference) const {
  node.effect.from = difference.at;
  node.effect.op = happening.op;
  if (happening.op) node.effect.place = place_of(*happening.op);
  if (is_memory(difference.key)) return describe_memory(node, happening, difference.at);
  if (is_decision(difference.key)) return describe_way(node, happening, difference);
  const std::string_view instead = difference.in_first ? "" : ", not so here";
  switch (happening.kind) {
    case TraceKind::ServiceBegin:
      node.effect.kind = "interrupt";
      node.effect.text = fmt::format("INT {} {} for {}", happening.what, difference.in_first ? "runs" : "does not run",
                                     event_text(happening.where));
      break;
    case TraceKind::CharacterSent:
      node.effect.kind = "sent";
      node.effect.name = fmt::format("port {}", happening.where);
      break;
    case TraceKind::RuntimeError:
      node.effect.kind = "error";
      node.effect.text =
          fmt::format("run-time error {:04X}, {}{}", happening.what, meaning_of(RunError{happening.what}), instead);
      break;
    case TraceKind::FatalError:
      node.effect.kind = "error";
      node.effect.text =
          fmt::format("fatal error {:04X}, {}{}", happening.what, meaning_of(FatalError{happening.what}), instead);
      break;
    case TraceKind::ModeChange:
      node.effect.kind = "mode";
      node.effect.text = fmt::format("{} to {}", difference.in_first ? "the CPU goes" : "the CPU does not go",
                                     happening.what == 1 ? "RUN" : "STOP");
      break;
    default:
      node.effect.kind = "way";
      node.effect.text = fmt::format("{} {}", node.effect.place, difference.in_first ? "is executed" : "is not executed");
      node.effect.place.clear();
  }
}

/// Bits of timers and counters have the names of their values.
void EffectTree::describe_memory(Node& node, const Happening& happening, Time at) const {
  const Bits& place = happening.place;
  const bool of_element = is_in(place, image::kTBits, image::kInputs);
  const Bits named_bits = as_named(place);
  const auto range = range_of(of_element || is_in(place, image::kInputs, image::kOutputs) ? named_bits : place);
  Effect& effect = node.effect;
  effect.kind = "memory";
  effect.name = range && range->count == 1 ? named(program_, *range) : memory_text(place);
  if (of_element) effect.name = fmt::format("the bit of {}", effect.name);
  const std::vector<std::uint8_t> value = known_.value(place, at), otherwise = without_.value(place, at);
  if (range && place.count > 1) {
    effect.value = value_text(program_, *range, value);
    effect.otherwise = value_text(program_, *range, otherwise);
  } else {
    effect.value = fmt::format("{}", value.front());
    effect.otherwise = fmt::format("{}", otherwise.front());
  }
  effect.text = fmt::format("{} is {}, not {}", effect.name, effect.value, effect.otherwise);
}

void EffectTree::describe_way(Node& node, const Happening& happening, const RunDifference& difference) const {
  const auto turns = known_.series.find(difference.key);
  bool value = false;
  if (turns != known_.series.end()) {
    const auto after = std::ranges::upper_bound(turns->second, difference.at, {}, &Turn::at);
    value = after != turns->second.begin() && (after - 1)->value;
  }
  node.effect.kind = "way";
  node.effect.text = fmt::format("{} {}", node.effect.place, way_text(*program_.ops[*happening.op].instruction, value));
  node.effect.place.clear();
}

// --- the tree ---

bool EffectTree::is_shown(const Node& node) const {
  return node.effect.kind == "memory" ? !hands_on(node.bits) : node.effect.kind != "way";
}

bool EffectTree::differs_at_the_end(const Node& node) const {
  return std::ranges::any_of(node.keys, [&](SeriesKey key) { return differences_.differ_at_the_end(key); });
}

/// What hands on only, and hands on to nothing, is left out.
std::vector<Effect> EffectTree::children_of(std::size_t parent) const {
  std::vector<Effect> effects;
  for (std::size_t number = 1; number < nodes_.size(); ++number) {
    const Node& node = nodes_[number];
    if (node.parent != parent) continue;
    Effect effect = node.effect;
    effect.effects = children_of(number);
    if (!is_shown(node) && effect.effects.empty()) continue;
    if (!differs_at_the_end(node)) effect.until = node.last;
    if (effect.kind == "sent") {
      effect.value = text_of_characters(node.known);
      effect.otherwise = text_of_characters(node.without);
      effect.text = node.without.empty() ? fmt::format("{} sends {}", effect.name, effect.value)
                    : node.known.empty() ? fmt::format("{} does not send {}", effect.name, effect.otherwise)
                                         : fmt::format("{} sends {}, not {}", effect.name, effect.value, effect.otherwise);
    }
    effects.push_back(std::move(effect));
  }
  return effects;
}

std::vector<std::string> EffectTree::by_timing() const {
  std::vector<std::string> names;
  for (std::size_t number = 1; number < nodes_.size(); ++number)
    if (const Node& node = nodes_[number]; !node.parent && is_shown(node))
      names.push_back(fmt::format("{} from {}", node.effect.name.empty() ? node.effect.text : node.effect.name,
                                  moment_text(node.effect.from)));
  return names;
}

std::optional<Time> EffectTree::alike_from(Time change) const {
  Time last = change;
  for (std::size_t number = 0; number < nodes_.size(); ++number) {
    const Node& node = nodes_[number];
    if (number != kRoot && !node.parent) continue;
    if (differs_at_the_end(node)) return {};
    last = std::max(last, node.last);
  }
  return last;
}

}  // namespace s7200::tools

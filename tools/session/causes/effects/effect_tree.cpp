#include "tools/session/causes/effects/effect_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

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

void add_once(std::vector<std::size_t>& nodes, std::size_t node) {
  if (std::ranges::find(nodes, node) == nodes.end()) nodes.push_back(node);
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
    : program_(program), known_(known), without_(without), differences_(differences), flow_(control_flow(program)) {
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
  if (is_memory(difference.key)) {
    const std::uint64_t writer = hands_on(happening.place) && happening.op ? *happening.op + 1 : 0;
    return {0, happening.place.first, writer << 32 | happening.place.count};
  }
  if (is_decision(difference.key)) return {1, *happening.op, 0};
  const bool characters = happening.kind == TraceKind::CharacterSent;
  return {2, std::uint64_t{static_cast<std::uint8_t>(happening.kind)} << 8 | happening.where,
          characters ? 0 : happening.what};
}

bool EffectTree::is_of_root(SeriesKey key) const {
  if (!is_memory(key)) return false;
  const auto& of_root = nodes_[kRoot].keys;  // between scans, where they are the bits themselves
  return std::ranges::find(of_root, bit_of(key)) != of_root.end();
}

void EffectTree::note_end(const RunDifference& difference) {
  const auto nodes = nodes_of_key_.find(difference.key);
  if (nodes == nodes_of_key_.end()) return;
  for (const std::size_t number : nodes->second) nodes_[number].last = std::max(nodes_[number].last, difference.at);
}

void EffectTree::add(const RunDifference& difference) {
  if (!difference.opens) return note_end(difference);
  const Happening& happening = happening_of(difference);
  const bool is_root = is_of_root(difference.key);
  const auto [found, is_new] = node_of_.try_emplace(subject_of(difference, happening), is_root ? kRoot : nodes_.size());
  const std::size_t number = found->second;
  if (is_new && !is_root) {
    nodes_.push_back({.bits = is_memory(difference.key) ? happening.place : Bits{0, 0}});
    describe(nodes_.back(), happening, difference);
  }
  Node& node = nodes_[number];
  node.last = std::max(node.last, difference.at);
  if (std::ranges::find(node.keys, difference.key) == node.keys.end()) {
    node.keys.push_back(difference.key);
    nodes_of_key_[difference.key].push_back(number);
    if (is_memory(difference.key)) add_once(nodes_of_bit_[bit_of(difference.key)], number);
  }
  if (happening.kind == TraceKind::CharacterSent && difference.key >= kFirstRecord)
    (difference.in_first ? node.known : node.without).push_back(happening.what);
  if (number == kRoot) return;
  if (node.parent) return settle(node, happening, difference);
  const auto parent = cause_of(happening, difference, number);
  if (!parent) return;
  std::string because = std::move(nodes_[number].effect.because);
  if (!is_new) describe(nodes_[number], happening, difference);
  nodes_[number].effect.because = std::move(because);
  nodes_[number].parent = parent;
}

/// A word that is written again in the same scan: what it has when the scan is over is what others see.
void EffectTree::settle(Node& node, const Happening& happening, const RunDifference& difference) const {
  const bool in_that_scan = difference.at <= node.effect.from + differences_.tolerance();
  if (node.settled || hands_on(node.bits) || !in_that_scan || !is_memory(difference.key) ||
      point_of(difference.key) != kBetweenScans)
    return;
  const Effect before = std::exchange(node.effect, {});
  describe(node, happening, difference);
  node.effect.from = before.from;
  node.effect.because = before.because.empty() && before.op != node.effect.op ? before.place : before.because;
}

/// The latest of the occasion and of what was looked at, then the way that the program has taken, then the interrupt.
std::optional<std::size_t> EffectTree::cause_of(const Happening& happening, const RunDifference& difference,
                                                std::size_t self) {
  Look by;
  const auto looked = looked_at(happening, difference, self, by);
  const auto occasion = occasion_of(happening);
  const bool by_occasion =
      occasion && *occasion != self && (!looked || nodes_[*occasion].effect.from >= nodes_[*looked].effect.from);
  if (by_occasion) return occasion;
  if (looked) {
    const bool other = happening.op && by.op && *by.op != *happening.op;
    nodes_[self].effect.because = other ? place_of(*by.op) : "";
    return looked;
  }
  if (happening.op)
    if (const auto way = way_to(*happening.op, difference.at); way && *way != self) return way;
  if (!happening.serving) return {};
  return record_node(TraceKind::ServiceBegin, *happening.serving);
}

/// The latest of those that differ where they were looked at.
std::optional<std::size_t> EffectTree::looked_at(const Happening& happening, const RunDifference& difference,
                                                 std::size_t self, Look& by) const {
  std::optional<std::size_t> found;
  for (const Look& look : happening.looks)
    for (std::uint64_t bit = look.bits.first; bit < look.bits.end(); ++bit) {
      const auto nodes = nodes_of_bit_.find(bit);
      if (nodes == nodes_of_bit_.end()) continue;
      for (const std::size_t node : nodes->second) {
        if (node == self || (node != kRoot && !nodes_[node].parent)) continue;
        if (found && nodes_[*found].effect.from >= nodes_[node].effect.from) continue;
        if (!hands_on_to(nodes_[node], look, bit, difference)) continue;
        found = node;
        by = look;
      }
    }
  return found;
}

/// Whether a bit differed where it was looked at, and had come from what the node is about.
bool EffectTree::hands_on_to(const Node& node, const Look& look, std::uint64_t bit, const RunDifference& difference) const {
  const RunRecord &run = difference.in_first ? known_ : without_, &other = difference.in_first ? without_ : known_;
  const Point point = look.op ? in_front_of(*look.op) : kBetweenScans;
  const SeriesKey key = memory_key(bit, point);
  if (!look.op || !run.is_looked_at({bit, 1}, point)) return differences_.differ_somewhere(bit, difference.at);
  if (!differences_.differ(key, difference.at)) return false;
  if (!hands_on(node.bits) || !node.effect.op) return true;
  for (const RunRecord* const each : {&run, &other}) {
    const auto turns = each->series.find(key);
    if (turns == each->series.end()) continue;
    const auto after = std::ranges::upper_bound(turns->second, difference.at, {}, &Turn::at);
    if (after != turns->second.begin()) return each->happenings[(after - 1)->happening].op == node.effect.op;
  }
  return true;
}

/// The latest decision of the routine before the instruction, or to call the routine, that is another one in both runs.
std::optional<std::size_t> EffectTree::way_to(std::uint32_t op, Time at) const {
  std::optional<std::size_t> found;
  for (std::size_t node = 1; node < nodes_.size(); ++node) {
    const Effect& effect = nodes_[node].effect;
    if (effect.kind != "way" || !nodes_[node].parent || !differences_.differ(decision_key(*effect.op), at)) continue;
    const Op& decides = program_.ops[*effect.op];
    const bool calls = decides.instruction->structure == Structure::Call && decides.target == flow_.routine_of(op).first;
    const bool before = flow_.nodes[*effect.op].routine == flow_.nodes[op].routine && *effect.op < op;
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
  if (is_memory(difference.key)) return describe_memory(node, happening, difference);
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
void EffectTree::describe_memory(Node& node, const Happening& happening, const RunDifference& difference) const {
  node.settled = point_of(difference.key) == kBetweenScans;
  const Bits& place = happening.place;
  const bool of_element = is_in(place, image::kTBits, image::kInputs);
  const Bits named_bits = as_named(place);
  const auto range = range_of(of_element || is_in(place, image::kInputs, image::kOutputs) ? named_bits : place);
  Effect& effect = node.effect;
  effect.kind = "memory";
  effect.name = range && range->count == 1 ? named(program_, *range) : memory_text(place);
  if (of_element) effect.name = fmt::format("the bit of {}", effect.name);
  const auto text = [&](const std::vector<std::uint8_t>& bytes) {
    return range && place.count > 1 ? value_text(program_, *range, bytes) : fmt::format("{}", bytes.front());
  };
  const RunRecord &run = difference.in_first ? known_ : without_, &other = difference.in_first ? without_ : known_;
  const Point point = told_at(run, happening, difference);
  const std::vector<std::uint8_t> own = run.value(place, point, difference.at);
  const std::vector<std::uint8_t> beside = value_beside(other, place, point, difference.at, own);
  effect.value = text(difference.in_first ? own : beside);
  effect.otherwise = text(difference.in_first ? beside : own);
  effect.text = fmt::format("{} is {}, not {}", effect.name, effect.value, effect.otherwise);
}

/// Between scans, or behind the instruction that has written it. What only hands on may be written again before the scan is
/// over.
Point EffectTree::told_at(const RunRecord& run, const Happening& happening, const RunDifference& difference) const {
  const bool passing = hands_on(happening.place) || point_of(difference.key) != kBetweenScans;
  const bool behind_it = passing && happening.op && run.is_looked_at(happening.place, behind(*happening.op));
  return behind_it ? behind(*happening.op) : kBetweenScans;
}

/// What the run has there that has not turned: that comes to the point a little later may give it its new value only then.
std::vector<std::uint8_t> EffectTree::value_beside(const RunRecord& run, const Bits& place, Point point, Time at,
                                                   const std::vector<std::uint8_t>& other) const {
  std::optional<Time> next;
  for (std::uint64_t bit = place.first; bit < place.end(); ++bit) {
    const auto turns = run.series.find(memory_key(bit, point));
    if (turns == run.series.end()) continue;
    const auto after = std::ranges::upper_bound(turns->second, at, {}, &Turn::at);
    if (after != turns->second.end() && after->at <= at + differences_.tolerance() / 2)
      next = std::min(next.value_or(kNever), after->at);
  }
  if (next)
    if (auto later = run.value(place, point, *next); later != other) return later;
  return run.value(place, point, at);
}

/// The run without the change has the opposite of what the other one has.
void EffectTree::describe_way(Node& node, const Happening& happening, const RunDifference& difference) const {
  const bool value = difference.value == difference.in_first;
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

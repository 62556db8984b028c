#include "tools/trials/vocabulary.hpp"

#include <algorithm>
#include <set>

#include "interpreter/analysis/cross_reference.hpp"
#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/memory_map.hpp"
#include "interpreter/model/contact_form.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "serial_sim/modbus/crc.hpp"
#include "tools/trials/trial_bench.hpp"

namespace s7200::tools {
namespace {

constexpr std::size_t kMostConstants = 4000;

template <class List, class Value>
void add_once(List& list, const Value& value) {
  if (std::ranges::find(list, value) == list.end()) list.push_back(value);
}

class Listener {
 public:
  explicit Listener(const Facts& facts) : facts_(facts), reference_(cross_reference(facts)) {}

  Vocabulary words() {
    for (const ReferenceEntry& entry : reference_.entries) look_at(entry);
    add_pointed_at();
    add_edges();
    add_constants();
    add_comparisons();
    add_presets();
    add_ports();
    return std::move(words_);
  }

 private:
  void look_at(const ReferenceEntry& entry) {
    const Area area = area_of(entry.bits);
    const bool reads = std::ranges::any_of(entry.uses, [](const Use& use) { return use.access.reads(); });
    if (!reads) return;
    if (area == Area::I)
      for (std::uint64_t bit = entry.bits.first; bit < entry.bits.end(); ++bit) add_input(static_cast<std::uint32_t>(bit));
    if (area == Area::AI) add_words(entry.bits);
    if (area != Area::V && area != Area::M) return;
    const Usage usage = usage_of(facts_.program, entry);
    if (usage == Usage::NeverWritten || usage == Usage::SetByData)
      for (const Bits& part : entry.parts)
        if (part.count <= 32) add_once(words_.commands, command_at(part));
  }

  /// Sorted, none next to another one.
  std::vector<Bits> all_written() const {
    std::vector<Bits> all, joined;
    for (const auto& effects : facts_.effects)
      for (const MemoryAccess& access : effects)
        if (access.writes() && access.bits.count != 0 && !is_anywhere(facts_.program, access)) all.push_back(access.bits);
    std::ranges::sort(all, {}, &Bits::first);
    for (const Bits& bits : all)
      if (joined.empty() || joined.back().end() < bits.first)
        joined.push_back(bits);
      else
        joined.back().count = std::max(joined.back().end(), bits.end()) - joined.back().first;
    return joined;
  }

  /// What is read through a pointer that leads to known addresses, and that nothing writes.
  void add_pointed_at() {
    const std::vector<Bits> written = all_written();
    const auto is_written = [&](const Bits& bits) {
      const auto first = std::ranges::upper_bound(written, bits.first, {}, &Bits::end);
      return first != written.end() && first->overlaps(bits);
    };
    for (const auto& effects : facts_.effects)
      for (const MemoryAccess& access : effects) {
        const Area area = area_of(access.bits);
        if (!access.reads() || !access.by_pointer || access.bits.count > 32 || (area != Area::V && area != Area::M) ||
            is_anywhere(facts_.program, access) || is_written(access.bits))
          continue;
        add_once(words_.commands, command_at(access.bits));
      }
  }

  static Vocabulary::Bytes command_at(const Bits& bits) {
    return {static_cast<std::uint32_t>(bits.first / 8),
            static_cast<std::uint8_t>(std::max<std::uint64_t>(1, bits.count / 8)), 0xFF};
  }

  void add_input(std::uint32_t bit) {
    const std::uint32_t byte = bit / 8 - image::kI;
    if (byte >= image::kPointBytes) return;
    auto found = std::ranges::find(words_.inputs, byte, &Vocabulary::Bytes::place);
    if (found == words_.inputs.end()) found = words_.inputs.insert(found, {byte, 1, 0});
    found->mask |= static_cast<std::uint8_t>(1u << bit % 8);
  }

  void add_words(const Bits& bits) {
    for (std::uint64_t at = bits.first / 8 & ~std::uint64_t{1}; at < (bits.end() + 7) / 8; at += 2)
      add_once(words_.analog, Vocabulary::Bytes{static_cast<std::uint32_t>(at), 2, 0xFF});
  }

  /// Edges of I0.0 to I0.3 are events; fast counters look at the first two bytes.
  void add_edges() {
    for (const Attachment& attachment : facts_.flow.attachments)
      if (attachment.event && *attachment.event <= 7) add_input(8 * image::kI + *attachment.event / 2);
    const auto counts = [](const Op& op) { return op.instruction->mnemonic == "HDEF"; };
    if (std::ranges::any_of(facts_.program.ops, counts))
      for (std::uint32_t bit = 0; bit < 16; ++bit) add_input(8 * image::kI + bit);
  }

  std::optional<std::uint32_t> constant(const s7200::Operand& operand) const {
    if (operand.pointer || operand.unread() || operand.at < image::kConstants) return {};
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < operand.width; ++i)
      value = value << 8 | facts_.program.constants[operand.at - image::kConstants + i];
    return value;
  }

  void add_constants() {
    std::set<std::uint32_t> all;
    for (const Op& op : facts_.program.ops)
      for (std::size_t i = 0; i < op.instruction->rules().size() && all.size() < kMostConstants; ++i)
        if (op.instruction->operand[i].kind == OperandKind::Memory)
          if (const auto value = constant(op[i])) all.insert(*value);
    words_.constants.assign(all.begin(), all.end());
  }

  void add_comparisons() {
    for (const Op& op : facts_.program.ops) {
      const ContactForm form = contact_form(*op.instruction);
      if (form.kind != ContactForm::Kind::Numbers || form.type == ContactForm::Type::Real) continue;
      const auto left = side(op[0]), right = side(op[1]);
      if (!left || !right || (!left->place && !right->place)) continue;
      add_once(words_.comparisons, Vocabulary::Comparison{*left, *right, static_cast<std::uint8_t>(op[0].width)});
    }
  }

  /// Nothing where a pointer leads.
  std::optional<Vocabulary::Comparison::Side> side(const s7200::Operand& operand) const {
    if (operand.pointer || operand.unread()) return {};
    if (const auto value = constant(operand)) return Vocabulary::Comparison::Side{{}, *value};
    return Vocabulary::Comparison::Side{operand.at};
  }

  /// The word that the data block sets there.
  std::optional<std::int32_t> data_word(const s7200::Operand& operand) const {
    for (const InitialData& data : facts_.program.data) {
      const std::int64_t from = std::int64_t{operand.at} - image::kV - data.offset;
      if (from < 0 || from + 2 > static_cast<std::int64_t>(data.bytes.size())) continue;
      return static_cast<std::int16_t>(load16(&data.bytes[static_cast<std::size_t>(from)]));
    }
    return {};
  }

  std::optional<std::int32_t> preset_of(const MemoryMap::Element& element, const s7200::Operand& operand) const {
    return element.preset ? element.preset : operand.pointer ? std::nullopt : data_word(operand);
  }

  void add_presets() {
    const MemoryMap map = memory_map(facts_, reference_);
    for (const MemoryMap::Element& timer : map.timers)
      if (const auto count = preset_of(timer, facts_.program.ops[timer.op][1]); count && *count > 0)
        add_once(words_.presets, *count * timer_base(timer.number).base);
    for (const MemoryMap::Element& counter : map.counters)
      if (const auto count = preset_of(counter, facts_.program.ops[counter.op][1]); count && *count > 0)
        add_once(words_.counts, static_cast<std::uint32_t>(*count));
  }

  /// Ports with RCV, or with a routine for received characters.
  void add_ports() {
    for (std::uint8_t port = 0; port < kPorts.size(); ++port) {
      const auto event = kPorts[port].received;
      const bool attached = std::ranges::any_of(facts_.flow.attachments, [&](const Attachment& attachment) {
        return attachment.event && *attachment.event == event;
      });
      if (!attached && !facts_.program.receives_messages[port]) continue;
      words_.both_ports = words_.port.has_value();
      if (!words_.port) words_.port = port;
    }
  }

  const Facts& facts_;
  CrossReference reference_;
  Vocabulary words_;
};

}  // namespace

std::uint32_t Vocabulary::Comparison::difference(std::span<const std::uint8_t> image) const {
  const auto value = [&](const Side& side) {
    std::uint32_t bytes = side.value;
    for (std::uint32_t i = 0; side.place && i < count; ++i) bytes = bytes << 8 | image[*side.place + i];
    return bytes;
  };
  return value(left) - value(right);
}

void Vocabulary::add(const Vocabulary& other) {
  for (const Bytes& input : other.inputs) {
    const auto found = std::ranges::find(inputs, input.place, &Bytes::place);
    if (found == inputs.end())
      inputs.push_back(input);
    else
      found->mask |= input.mask;
  }
  for (const Bytes& word : other.analog) add_once(analog, word);
  for (const Bytes& command : other.commands) add_once(commands, command);
  for (const std::uint32_t constant : other.constants) add_once(constants, constant);
  for (const Time preset : other.presets) add_once(presets, preset);
  for (const std::uint32_t count : other.counts) add_once(counts, count);
  for (const Comparison& comparison : other.comparisons) add_once(comparisons, comparison);
  for (const auto& request : other.requests) add_once(requests, request);
  if (!port) port = other.port;
}

Vocabulary vocabulary_of(const Facts& facts) { return Listener(facts).words(); }

std::vector<std::vector<std::uint8_t>> answered_requests(std::shared_ptr<const Program> program, const Vocabulary& words) {
  if (!words.port) return {};
  TrialBench bench(std::move(program), *words.port);
  bench.power_up();
  bench.run_until(kReady);
  const auto ready = bench.snapshot();
  std::set<std::uint8_t> stations{1, 2, 3};
  for (const std::uint32_t constant : words.constants)
    if (constant >= 1 && constant <= 247) stations.insert(static_cast<std::uint8_t>(constant));
  const std::vector<std::vector<std::uint8_t>> bodies{{3, 0, 0, 0, 2},           {4, 0, 0, 0, 2},
                                                      {1, 0, 0, 0, 8},           {2, 0, 0, 0, 8},
                                                      {6, 0, 1, 0x12, 0x34},     {5, 0, 1, 0xFF, 0},
                                                      {15, 0, 0, 0, 8, 1, 0x55}, {16, 0, 0, 0, 2, 4, 1, 2, 3, 4},
                                                      {8, 0, 0, 0x12, 0x34},     {7}};
  std::vector<std::vector<std::uint8_t>> answered;
  for (const std::uint8_t station : stations) {
    for (const auto& body : bodies) {
      std::vector<std::uint8_t> frame{station};
      frame.insert(frame.end(), body.begin(), body.end());
      modbus::add_crc(frame);
      bench.restore(ready);
      const std::size_t before = bench.done().sent.size();
      bench.apply({.what = Stimulus::What::Frame, .bytes = frame}, bench.time());
      if (bench.done().sent.size() > before)
        answered.push_back(std::move(frame));
      else if (answered.empty() && &body == &bodies.front())
        break;  // another station
    }
    if (!answered.empty()) break;
  }
  return answered;
}

}  // namespace s7200::tools

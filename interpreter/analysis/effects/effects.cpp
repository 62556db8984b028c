#include "interpreter/analysis/effects/effects.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <optional>

#include "interpreter/analysis/effects/fast_units.hpp"
#include "interpreter/base/bytes.hpp"
#include "interpreter/model/ports.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200 {
namespace {

constexpr std::int64_t kMostCounted = 255;
constexpr Bits kWholeImage{0, std::uint64_t{image::kConstants} * 8};

/// What is known of memory: its content at a moment, or where the pointers of the program may lead.
struct Known {
  std::span<const std::uint8_t> image{};
  const Pointers* pointers = nullptr;
};

std::uint64_t bit_at(std::uint32_t place, std::uint8_t bit = 0) { return std::uint64_t{place} * 8 + bit; }

std::optional<std::uint32_t> resolve(const Program& program, std::uint32_t pointer, std::uint32_t width) {
  const std::uint32_t code = pointer >> 24, offset = pointer & 0xFF'FFFF;
  if (code >= kReaches || offset + width > program.reach[code].size) return {};
  return program.reach[code].base + offset;
}

/// Collects the accesses of one op.
class Collector {
 public:
  Collector(const Program& program, const Op& op, const Known& known) : program_(program), op_(op), known_(known) {}

  std::vector<MemoryAccess> all() {
    if (is_unread(op_)) return {{kWholeImage, Role::InOut, Certainty::May}};
    const Instruction& form = form_of_operands();
    for (std::size_t i = 0; i < form.rules().size(); ++i) add_operand(form, i);
    add_hidden();
    add_flags();
    for (const Besides& each : op_.instruction->besides)
      if (each.bytes != 0 && !is_of_another_port(each))
        add({{bit_at(each.at), std::uint64_t{each.bytes} * 8}, each.role, Certainty::May});
    std::ranges::copy(accesses_of_fast_units(program_, op_, known_.image), std::back_inserter(all_));
    if (op_.instruction->structure == Structure::Call) add_parameters(op_);
    if (returns_from_subroutine()) add_results();
    return std::move(all_);
  }

  /// How far an operand reaches from its place, in bits: at least, and at most.
  struct Extent {
    std::uint64_t least = 0, most = 0;
  };
  Extent extent_of(const OperandRule& rule, std::uint32_t place) const {
    const std::uint64_t unit = rule.width == Width::Bit ? 1 : 8 * bytes_of(rule.width);
    if (rule.most != 0) return {rule.elements * unit, std::min(std::uint64_t{rule.most} * 8, bits_to_end(rule, place))};
    if (rule.counted == 0) return {rule.elements * unit, rule.elements * unit};
    const auto count = count_of();
    if (!count && !known_.image.empty()) return {};  // its pointer points nowhere
    const std::int64_t counted = count.value_or(kMostCounted);
    const std::uint64_t most = std::min(static_cast<std::uint64_t>(rule.reach(counted)) * unit, bits_to_end(rule, place));
    const std::uint64_t whole = static_cast<std::uint64_t>(counted / rule.counted) * unit;  // the last byte may be half used
    return {count ? std::min(whole, most) : 0, most};
  }

 private:
  void add(const MemoryAccess& access) {
    if (access.bits.count != 0) all_.push_back(access);
  }

  /// RCV works on the message bytes of its own port; its row names those of all ports.
  bool is_of_another_port(const Besides& each) const {
    if (op_.instruction->effect != Effect::Receives || op_[1].unread()) return false;
    for (std::size_t port = 0; port < kPorts.size(); ++port) {
      const std::uint32_t first = kPorts[port].message;
      if (each.at >= first && each.at <= first + sm::message::kMost) return port != op_[1].at;
    }
    return false;
  }

  /// NEXT works on the operands of its FOR.
  const Instruction& form_of_operands() const {
    const bool is_next = op_.instruction->structure == Structure::Next && op_.target > 0;
    return is_next ? *program_.ops[op_.target - 1].instruction : *op_.instruction;
  }

  /// NEXT reads what FOR has written.
  Role role_of(const OperandRule& rule) const {
    return op_.instruction->structure == Structure::Next && rule.role == Role::Out ? Role::InOut : rule.role;
  }

  void add_operand(const Instruction& form, std::size_t i) {
    const OperandRule& rule = form.operand[i];
    const auto number = static_cast<std::uint8_t>(i);
    const Operand& operand = op_[i];
    if (rule.kind != OperandKind::Memory) return;
    if (operand.unread()) return add({kWholeImage, role_of(rule), Certainty::May, number});
    if (operand.pointer) return add_pointed(rule, operand, number);
    if (operand.at >= image::kConstants) return;
    add_extent(bit_at(operand.at, rule.width == Width::Bit ? operand.bit : 0), extent_of(rule, operand.at), role_of(rule),
               number);
  }

  void add_extent(std::uint64_t first, const Extent& extent, Role role, std::uint8_t number, bool by_pointer = false) {
    const std::uint64_t surely = std::min(extent.least, extent.most);
    if (surely != 0) add({{first, surely}, role, Certainty::Must, number, by_pointer});
    if (extent.most > surely) add({{first + surely, extent.most - surely}, role, Certainty::May, number, by_pointer});
  }

  void add_pointed(const OperandRule& rule, const Operand& operand, std::uint8_t number) {
    add_pointed(rule, operand, number, number_of(op_));
  }
  /// `goes_through`: the op that finds the pointer.
  void add_pointed(const OperandRule& rule, const Operand& operand, std::uint8_t number, std::uint32_t goes_through) {
    add({{bit_at(operand.at), 32}, Role::In, Certainty::Must, number});
    if (!known_.image.empty()) {
      const auto place = resolve(program_, load32(&known_.image[operand.at]), operand.width);
      if (place) add_extent(bit_at(*place), extent_of(rule, *place), role_of(rule), number, true);
      return;
    }
    for (const PointerTarget& target : known_.pointers->targets(goes_through, operand.at)) {
      const std::uint64_t reach = bit_at(target.to - 1 - target.from) + extent_of(rule, target.from).most;
      add({{bit_at(target.from), std::min(reach, bits_to_end(rule, target.from))},
           role_of(rule),
           Certainty::May,
           number,
           true});
    }
  }

  /// From a place to the end of its area. Blocks go no further: that is a range error.
  std::uint64_t bits_to_end(const OperandRule& rule, std::uint32_t place) const {
    if (rule.width == Width::Bit) return op_.target;
    const AreaInfo& area = area_at(place);
    const std::uint32_t end = area.base + program_.model->size_of(area.area) * std::max(1u, area.element);
    return place < end ? bit_at(end - place) : 0;
  }

  /// The value of the operand that counts; nothing if it is not known. 1 without one.
  std::optional<std::int64_t> count_of() const {
    const auto rules = op_.instruction->rules();
    const auto rule = std::ranges::find_if(rules, &OperandRule::count);
    if (rule == rules.end()) return 1;
    const auto value = byte_of(op_[static_cast<std::size_t>(rule - rules.begin())]);
    if (!value) return {};
    return rule->sign == Sign::Signed ? std::abs(static_cast<std::int8_t>(*value)) : *value;
  }

  std::optional<std::uint8_t> byte_of(const Operand& operand) const {
    if (operand.unread()) return {};
    if (!operand.pointer && operand.at >= image::kConstants) return program_.constants[operand.at - image::kConstants];
    if (known_.image.empty()) return {};
    const auto place = operand.pointer ? resolve(program_, load32(&known_.image[operand.at]), 1) : operand.at;
    return place ? std::optional(known_.image[*place]) : std::nullopt;
  }

  void add_hidden() {
    const Operand &first = op_[0], &hidden = op_[2];
    switch (op_.instruction->hidden) {
      case Hidden::None:
      case Hidden::InputPoint:
        return;
      case Hidden::OutputPoint: {
        const Extent extent = extent_of(op_.instruction->operand[0], first.at);
        return add_extent(bit_at(hidden.at, hidden.bit), extent, Role::Out, kNoOperand);
      }
      case Hidden::RisingMemory:
      case Hidden::FallingMemory:
        return add({{bit_at(hidden.at, hidden.bit), 1}, Role::InOut});
      case Hidden::LoopMemory:
        return add({{bit_at(hidden.at, hidden.bit), 1}, Role::InOut, Certainty::May});
      case Hidden::SegmentBit:
        return add({{bit_at(hidden.at, hidden.bit), 1}, Role::Out});
      case Hidden::Number:
        break;
    }
    if (first.unread()) return;
    const bool timer = op_.instruction->operand[0].areas == set_of(Area::T);
    add({{bit_at(timer ? image::kTBits : image::kCBits) + hidden.at, 1}, Role::InOut, Certainty::May});
  }

  /// SM1, SM4.3 of run-time errors, and the current values that R clears.
  void add_flags() {
    for (std::uint8_t bit = 0; bit < 8; ++bit)
      if (op_.instruction->flags >> bit & 1) add({{bit_at(sm::kFlags, bit), 1}, Role::Out, Certainty::May});
    if (!op_.instruction->rules().empty() || op_.instruction->structure == Structure::Next ||
        op_.instruction->structure == Structure::Call)
      add({{bit_at(sm::kInterruptStatus, 3), 1}, Role::Out, Certainty::May});
    if (op_.instruction->effect == Effect::ResetsBits && !op_[0].unread()) {
      const Extent extent = extent_of(op_.instruction->operand[0], op_[0].at);
      add_cleared_values(op_[0], extent, image::kTBits, image::kT, image::kTimers);
      add_cleared_values(op_[0], extent, image::kCBits, image::kC, image::kCounters);
    }
  }

  void add_cleared_values(const Operand& first, const Extent& extent, std::uint32_t bits, std::uint32_t values,
                          std::uint32_t numbers) {
    if (first.at < bits || first.at >= bits + numbers / 8) return;
    const std::uint64_t number = bit_at(first.at - bits, first.bit);
    add_extent(bit_at(values) + 16 * number, {16 * extent.least, 16 * extent.most}, Role::Out, kNoOperand);
  }

  /// What the caller gives, and what it gets back.
  void add_parameters(const Op& call) {
    for (const Parameter& parameter : std::span(program_.parameters).subspan(call[1].at, call[2].at))
      add_actual(call, parameter, parameter.role);
  }

  void add_actual(const Op& call, const Parameter& parameter, Role role) {
    const OperandRule rule{.width = parameter.width, .role = role};
    const Operand& actual = parameter.actual;
    if (actual.pointer) return add_pointed(rule, actual, kNoOperand, number_of(call));
    if (actual.at >= image::kConstants) return;
    const std::uint64_t bits = parameter.width == Width::Bit ? 1 : 8 * bytes_of(parameter.width);
    const std::uint8_t bit = parameter.width == Width::Bit ? actual.bit : std::uint8_t{0};
    add({{bit_at(actual.at, bit), bits}, role, Certainty::May, kNoOperand});
  }

  std::uint32_t number_of(const Op& op) const { return static_cast<std::uint32_t>(&op - program_.ops.data()); }

  std::uint32_t head() const {
    std::uint32_t i = number_of(op_);
    while (i > 0 && program_.ops[i].instruction->structure != Structure::SubroutineHead) --i;
    return i;
  }

  bool returns_from_subroutine() const {
    const Instruction& instruction = *op_.instruction;
    if (instruction.structure == Structure::SubroutineEnd) return true;
    return instruction.effect == Effect::ConditionalEnd && instruction.allowed.parts == kSubroutine;
  }

  /// What the callers of the routine get back.
  void add_results() {
    const std::uint32_t routine = head();
    for (const Op& call : program_.ops) {
      if (call.instruction->structure != Structure::Call || call.target != routine) continue;
      for (const Parameter& parameter : std::span(program_.parameters).subspan(call[1].at, call[2].at))
        if (parameter.role != Role::In) add_actual(call, parameter, Role::Out);
    }
  }

  const Program& program_;
  const Op& op_;
  Known known_;
  std::vector<MemoryAccess> all_{};
};

}  // namespace

std::vector<MemoryAccess> effects_of(const Program& program, std::uint32_t op, const Pointers& pointers) {
  return Collector(program, program.ops[op], {{}, &pointers}).all();
}

std::vector<MemoryAccess> effects_now(const Program& program, std::uint32_t op, std::span<const std::uint8_t> image) {
  return Collector(program, program.ops[op], {image, nullptr}).all();
}

std::optional<std::uint32_t> pointer_of(const Program& program, std::uint32_t op, const MemoryAccess& access) {
  if (!access.by_pointer) return {};
  if (access.operand != kNoOperand) return program.ops[op][access.operand].at;
  return profile_pointer_of(program, program.ops[op]);
}

std::uint64_t reach_of(const Program& program, const Op& op, std::size_t operand, std::uint32_t place) {
  return Collector(program, op, {}).extent_of(op.instruction->operand[operand], place).most;
}

Bits bits_of(const Program& program, const Op& op, std::size_t operand) {
  const OperandRule& rule = op.instruction->operand[operand];
  const std::uint64_t first = bit_at(op[operand].at, rule.width == Width::Bit ? op[operand].bit : std::uint8_t{0});
  return {first, reach_of(program, op, operand, op[operand].at)};
}

}  // namespace s7200

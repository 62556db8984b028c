#include "interpreter/analysis/effects/pointers.hpp"

#include <algorithm>
#include <optional>

#include "interpreter/analysis/effects/effects.hpp"
#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/base/bytes.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200 {
namespace {

using Content = Pointers::Content;

constexpr std::uint32_t kOffset = 0xFF'FFFF;  ///< bits of a pointer that say where in its area

Bits bits_of_pointer(std::uint32_t at) { return {std::uint64_t{at} * 8, 32}; }

/// Memory that only the program and its users write.
bool is_plain_memory(std::uint32_t at) {
  const bool bit_memory = at >= image::kM && at + 4 <= image::kSM, accumulator = at >= image::kAC && at + 4 <= image::kTBits;
  return bit_memory || accumulator || (at >= image::kV && at + 4 <= image::kConstants);
}

/// The value of a direct operand that is a constant.
std::optional<std::uint32_t> constant(const Program& program, const Operand& operand) {
  if (operand.pointer || operand.unread() || operand.at < image::kConstants) return {};
  return load32(&program.constants[operand.at - image::kConstants]);
}

/// Some address in the areas of those that a pointer held before.
Content anywhere_in_areas(const Content& before) {
  Content content{.anything = before.anything, .addresses = {}, .areas = before.areas};
  for (const std::uint32_t address : before.addresses) content.areas.insert(static_cast<std::uint8_t>(address >> 24));
  return content;
}

/// The first op that counts a pointer.
std::optional<std::uint32_t> counting(const Program& program, std::uint32_t pointer) {
  for (std::uint32_t i = 0; i < program.ops.size(); ++i) {
    const Op& op = program.ops[i];
    if (!step_of(program, op)) continue;
    const Operand& to = op[value_box_of(*op.instruction)->to];
    if (!to.pointer && to.at == pointer) return i;
  }
  return {};
}

Content anything() { return {.anything = true, .addresses = {}, .areas = {}}; }

}  // namespace

bool is_set_by_data_block(const Program& program, const Bits& bits) {
  return std::ranges::any_of(program.data, [&](const InitialData& data) {
    return bits.overlaps({std::uint64_t{image::kV + data.offset} * 8, data.bytes.size() * 8});
  });
}

bool Pointers::Content::add(const Content& other) {
  const auto size = [this] { return addresses.size() + areas.size() + (anything ? 1 : 0); };
  const std::size_t before = size();
  anything |= other.anything;
  addresses.insert(other.addresses.begin(), other.addresses.end());
  areas.insert(other.areas.begin(), other.areas.end());
  return size() != before;
}

Pointers::Pointers(const Program& program, const ControlFlow& flow, const Waiter& waiter) : program_(program) {
  const auto find_contents = [&] {
    contents_.clear();
    given_up_.clear();
    for (const Op& op : program.ops)
      for (const Operand& operand : op.operand)
        if (operand.pointer) begin(operand.at);
    for (const Parameter& parameter : program.parameters)
      if (parameter.actual.pointer) begin(parameter.actual.at);
    do {
      while (!contents_.empty() && !waiter.asks_to_end() && add_writes()) {
      }
    } while (!waiter.asks_to_end() && give_up_unset());
    if (waiter.asks_to_end())
      for (auto& [at, content] : contents_) content.add(anything());
  };
  find_contents();
  if (has_unread(program) || waiter.asks_to_end()) return;
  // What is known of pointers tells what instructions write through them, and that tells more of pointers.
  for (int round = 0; round < (contents_.empty() ? 1 : 2); ++round) {
    if (round > 0) find_contents();
    std::vector<std::vector<MemoryAccess>> effects;
    for (std::uint32_t op = 0; op < program.ops.size(); ++op) effects.push_back(effects_of(program, op, *this));
    reaching_ = ReachingValues(program, flow, effects, *this, waiter);
  }
}

/// Nothing is known of what the program itself does not set. Whether there was any more of that.
bool Pointers::give_up_unset() {
  bool more = false;
  for (auto& [at, content] : contents_)
    if (content.addresses.empty() && content.areas.empty()) more |= content.add(anything());
  return more;
}

bool Pointers::begin(std::uint32_t at) {
  const bool unknown = !is_plain_memory(at) || is_set_by_data_block(program_, bits_of_pointer(at));
  return contents_.try_emplace(at, unknown ? anything() : Content{}).second;
}

bool Pointers::add_writes() {
  bool more = false;
  for (std::uint32_t i = 0; i < program_.ops.size(); ++i)
    for (const MemoryAccess& access : effects_of(program_, i, *this)) {
      const bool of_operand =
          access.operand != kNoOperand || access.by_pointer || access.bits.contains({0, image::kConstants * 8u});
      if (access.writes() && of_operand) more |= add_write(program_.ops[i], access);
    }
  for (const Parameter& parameter : program_.parameters) more |= add_parameter(parameter);
  return more;
}

bool Pointers::add_write(const Op& op, const MemoryAccess& access) {
  bool more = false;
  for (auto& [at, content] : contents_) {
    const Bits pointer = bits_of_pointer(at);
    if (!access.bits.overlaps(pointer)) continue;
    const bool whole = access.bits == pointer && !access.by_pointer;
    const bool moved = whole && op.instruction->operand[0].address_of;
    const bool in_area = (whole && step_of(program_, op)) || access.bits.first >= pointer.first + 8;
    const Content added = moved ? copied(op[0], more) : in_area ? anywhere_in_areas(content) : anything();
    if (added.anything) given_up_.try_emplace(at, static_cast<std::uint32_t>(&op - program_.ops.data()));
    more |= content.add(added);
  }
  return more;
}

/// What a double word that is moved may be. `more` becomes true if it is the first time that it is asked for.
Pointers::Content Pointers::copied(const Operand& from, bool& more) {
  if (const auto address = constant(program_, from)) return {.anything = false, .addresses = {*address}, .areas = {}};
  if (from.pointer || from.unread()) return anything();
  more |= begin(from.at);
  return contents_.at(from.at);
}

/// A subroutine gets the caller's operand and hands it back.
bool Pointers::add_parameter(const Parameter& parameter) {
  bool more = false;
  const auto pass = [&](const Operand& from, const Operand& to) {
    const Bits written{std::uint64_t{to.at} * 8, std::uint64_t{8} * bytes_of(parameter.width)};
    for (auto& [at, content] : contents_) {
      if (!written.overlaps(bits_of_pointer(at))) continue;
      const bool whole = written == bits_of_pointer(at);
      more |= content.add(whole ? copied(from, more) : anything());
    }
  };
  if (parameter.role != Role::Out) pass(parameter.actual, parameter.local);
  if (parameter.role != Role::In && !parameter.actual.pointer) pass(parameter.local, parameter.actual);
  return more;
}

bool Pointers::is_known(std::uint32_t at) const {
  const auto found = contents_.find(at);
  return found != contents_.end() && !found->second.anything;
}

std::optional<Pointers::Unknown> Pointers::unknown(std::uint32_t at) const {
  using Reason = Unknown::Reason;
  if (is_known(at)) return {};
  if (!is_plain_memory(at)) return Unknown{Reason::Elsewhere};
  if (is_set_by_data_block(program_, bits_of_pointer(at))) return Unknown{Reason::DataBlock};
  const auto found = given_up_.find(at);
  return found == given_up_.end() ? Unknown{Reason::NotSet} : Unknown{Reason::Written, found->second};
}

std::optional<ValueSet> Pointers::at_any_time(std::uint32_t at) const {
  const auto found = contents_.find(at);
  if (found == contents_.end()) return {};
  if (found->second.anything) return ValueSet::all_of(Width::Double);
  ValueSet values;
  for (const std::uint32_t address : found->second.addresses) {
    const std::int64_t value = static_cast<std::int32_t>(address);
    values.add({value, value});
  }
  for (const std::int64_t code : found->second.areas) values.add({code << 24, (code << 24) + kOffset});
  return values.fitted(Width::Double);
}

std::optional<Pointers::Unknown> Pointers::unknown(std::uint32_t op, std::uint32_t at) const {
  const auto all = targets(op, at);
  const bool anywhere = std::ranges::any_of(all, [&](const PointerTarget& target) {
    return std::ranges::any_of(program_.reach, [&](const Reach& reach) {
      return reach.size != 0 && target == PointerTarget{reach.base, reach.base + reach.size};
    });
  });
  if (!anywhere) return {};
  const auto value = reaching_ ? reaching_->pointer(op, at) : std::nullopt;
  if (!value || value->cause() == ValueSet::kNoCause) {
    const auto why = unknown(at);
    const auto goes_through_it = [at](const Operand& operand) { return operand.pointer && operand.at == at; };
    const bool by_itself = why && why->reason == Unknown::Reason::Written &&
                           std::ranges::any_of(program_.ops[why->op].operand, goes_through_it);
    if (why && !by_itself) return why;
    const auto counts = counting(program_, at);  // because of which it may lead anywhere, to itself too
    return counts ? Unknown{Unknown::Reason::Counted, *counts} : why;
  }
  const bool counted = step_of(program_, program_.ops[value->cause()]).has_value();
  return Unknown{counted ? Unknown::Reason::Counted : Unknown::Reason::Written, value->cause()};
}

std::vector<PointerTarget> Pointers::targets(std::uint32_t op, std::uint32_t at) const {
  const auto value = reaching_ ? reaching_->pointer(op, at) : std::nullopt;
  if (!value) return at_any_time_targets(at);
  const std::vector<PointerTarget> reached = places_of(program_, *value);
  const auto found = contents_.find(at);
  if (found->second.anything || !found->second.areas.empty()) return reached;
  std::vector<PointerTarget> all = at_any_time_targets(at);  // a few addresses, which the ranges may have joined
  std::erase_if(all, [&](const PointerTarget& target) {
    return std::ranges::none_of(reached,
                                [&](const PointerTarget& each) { return target.from >= each.from && target.to <= each.to; });
  });
  return all;
}

std::vector<PointerTarget> Pointers::at_any_time_targets(std::uint32_t at) const {
  const auto found = contents_.find(at);
  const bool anything = found == contents_.end() || found->second.anything;
  std::vector<PointerTarget> all;
  for (std::uint32_t code = 0; code < kReaches; ++code) {
    const Reach& reach = program_.reach[code];
    if (reach.size != 0 && (anything || found->second.areas.contains(static_cast<std::uint8_t>(code))))
      all.push_back({reach.base, reach.base + reach.size});
  }
  if (anything) return all;
  for (const std::uint32_t address : found->second.addresses) {
    const std::uint32_t code = address >> 24, offset = address & kOffset;
    if (code >= kReaches || offset >= program_.reach[code].size ||
        found->second.areas.contains(static_cast<std::uint8_t>(code)))
      continue;
    const std::uint32_t place = program_.reach[code].base + offset;
    all.push_back({place, place + 1});
  }
  return all;
}

}  // namespace s7200

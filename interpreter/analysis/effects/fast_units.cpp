#include "interpreter/analysis/effects/fast_units.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "interpreter/analysis/effects/facts.hpp"
#include "interpreter/base/bytes.hpp"
#include "interpreter/model/counters.hpp"

namespace s7200 {
namespace {

using namespace sm::pulses;

constexpr std::uint8_t kInputEvents = event::kI03Falls + 1;  ///< a rising and a falling edge of each of I0.0 to I0.3

constexpr Bits bytes_at(std::uint32_t place, std::uint32_t bytes) { return {std::uint64_t{place} * 8, bytes * 8u}; }

MemoryAccess possible(const Bits& bits, Role role) { return {.bits = bits, .role = role, .certainty = Certainty::May}; }

// In a program with errors the numbers may be any.
bool names_unit(const Op& op) {
  const std::size_t units = op.instruction->effect == Effect::ProgramsPulses ? kStatus.size() : kCounters.size();
  return !op[0].unread() && op[0].at < units;
}
bool is_mode(const Operand& mode) { return !mode.unread() && mode.at <= kLastMode; }

class UnitAccesses {
 public:
  UnitAccesses(const Program& program, const Op& op, std::span<const std::uint8_t> image)
      : program_(program), op_(op), image_(image) {}

  std::vector<MemoryAccess> all() {
    if (op_.instruction->structure == Structure::Attach && !op_[1].unread()) add_event(op_[1].at);
    if (op_.instruction->structure == Structure::DefineCounter && names_unit(op_)) add_definition(op_[0].at);
    if (op_.instruction->effect == Effect::ProgramsCounter && names_unit(op_)) add_counter(op_[0].at);
    if (op_.instruction->effect == Effect::ProgramsPulses && names_unit(op_)) add_pulses(op_[0].at);
    return std::move(all_);
  }

 private:
  void add(const MemoryAccess& access) { all_.push_back(access); }

  void add_points(std::uint32_t points) {
    for (std::uint32_t point = 0; points != 0; points >>= 1, ++point)
      if (points & 1) add({.bits = {image::kInputs * 8u + point, 1}, .role = Role::In});
  }

  void add_event(std::uint32_t event) {
    if (event < kInputEvents) add_points(1u << event / 2);
  }

  /// Takes the levels of reset and start, and the rate; nobody else may use its inputs from now on.
  void add_definition(std::uint32_t counter) {
    const CounterInfo& info = kCounters[counter];
    add({.bits = bytes_at(info.status + sm::counter::kControl, 1), .role = Role::In});
    if (is_mode(op_[1])) add_points(points_of(info, static_cast<std::uint8_t>(op_[1].at)));
  }

  void add_counter(std::uint32_t counter) {
    const CounterInfo& info = kCounters[counter];
    add(possible(bytes_at(info.status, 1), Role::InOut));
    add(possible(bytes_at(info.status + sm::counter::kControl, 9), Role::In));
    add(possible(bytes_at(image::kHC + 4 * counter, 4), Role::InOut));
    const CounterModes modes = program_.counter_modes[counter];
    std::uint32_t points = 0;
    for (std::uint8_t mode = 0; modes >> mode; ++mode)
      if (modes >> mode & 1) points |= points_of(info, mode);
    add_points(points);
  }

  void add_pulses(std::uint32_t output) {
    add(possible(bytes_at(kStatus[output], 1), Role::InOut));
    add(possible(bytes_at(kStatus[output] + kControl, 9), Role::In));
    add(possible({image::kOutputs * 8u + output, 1}, Role::InOut));
    for (std::uint32_t counter = 0; counter < kCounters.size(); ++counter)
      if (kCounters[counter].pulse_output == output && program_.counter_modes[counter] & kMode12) add_counted_pulse(counter);
    if (profile_pointer_of(program_, op_)) add_profile(output);
  }

  /// The first pulse of a train begins at once.
  void add_counted_pulse(std::uint32_t counter) {
    add(possible(bytes_at(kCounters[counter].status, 1), Role::InOut));
    add(possible(bytes_at(image::kHC + 4 * counter, 4), Role::InOut));
  }

  void add_profile(std::uint32_t output) {
    if (!image_.empty() && (image_[kStatus[output] + kControl] & (kProfile | kPwm)) != kProfile) return;
    add(possible(bytes_at(kSegment[output], 1), Role::Out));
    add(possible(bytes_at(kProfileTable[output], 2), Role::In));
    const std::uint32_t size = program_.model->size_of(Area::V);
    std::uint32_t first = 0, bytes = size;
    if (!image_.empty()) {
      first = std::min<std::uint32_t>(load16(&image_[kProfileTable[output]]), size);
      bytes = std::min(first < size ? 1 + kSegmentBytes * image_[image::kV + first] : 0, size - first);
    }
    if (bytes == 0) return;  // the table begins behind the V memory
    MemoryAccess table = possible(bytes_at(image::kV + first, bytes), Role::In);
    table.by_pointer = image_.empty();
    add(table);
  }

  const Program& program_;
  const Op& op_;
  std::span<const std::uint8_t> image_;
  std::vector<MemoryAccess> all_{};
};

bool is_table(const MemoryAccess& access) {
  return access.operand == kNoOperand && access.by_pointer && !access.writes() && access.bits.first >= image::kV * 8u;
}

/// The number of the segment in progress, and where the table begins.
bool is_of_profile(const MemoryAccess& access) { return bytes_at(kProfiles, kProfilesBytes).contains(access.bits); }

bool takes_profile(std::int64_t control) { return (control & (kProfile | kPwm)) == kProfile; }

/// What is known of the profiles of a pulse output.
class Profiles {
 public:
  Profiles(const Facts& facts, std::uint32_t output) : facts_(facts), output_(output) {
    const auto controls = constants_written(facts, kStatus[output] + kControl, Width::Byte);
    none_ = controls && !controls->empty() && std::ranges::none_of(*controls, takes_profile);
    offsets_ = constants_written(facts, kProfileTable[output], Width::Word);
    if (offsets_ && offsets_->empty()) offsets_.reset();
  }

  bool none() const { return none_; }

  /// The tables, as far as they may go; nothing if it is not known where they begin.
  const std::vector<MemoryAccess>& tables() {
    if (!tables_) find_tables();
    return *tables_;
  }

  /// Where the tables begin, offsets in V; nothing if that is not known.
  std::vector<std::uint32_t> offsets() const {
    std::vector<std::uint32_t> all;
    for (const std::int64_t offset : offsets_.value_or(std::vector<std::int64_t>{}))
      all.push_back(static_cast<std::uint16_t>(offset));
    return all;
  }

  /// How many segments the table at an offset may have; nothing if that is not known.
  std::optional<std::uint32_t> segments(std::uint32_t offset) const {
    auto counts = constants_written(facts_, image::kV + offset, Width::Byte);
    if (!counts) return {};
    for (const InitialData& data : facts_.program.data)
      if (offset >= data.offset && offset < data.offset + data.bytes.size())
        counts->push_back(data.bytes[offset - data.offset]);
    if (counts->empty()) return {};
    return static_cast<std::uint32_t>(std::ranges::max(*counts));
  }

  std::optional<Pointers::Unknown> unknown() const {
    using Reason = Pointers::Unknown::Reason;
    if (none_) return {};
    if (offsets().empty()) return of_offset();
    const auto is_unknown = [&](std::uint32_t offset) { return !segments(offset); };
    if (std::ranges::none_of(offsets(), is_unknown)) return {};
    return Pointers::Unknown{.reason = Reason::Length, .op = 0};
  }

 private:
  void find_tables() {
    const std::uint32_t size = facts_.program.model->size_of(Area::V);
    tables_.emplace();
    for (const std::uint32_t offset : offsets())
      if (offset < size) tables_->push_back(table_at(offset));
  }

  MemoryAccess table_at(std::uint32_t offset) const {
    constexpr std::uint32_t kMostSegments = 255;
    const std::uint32_t left = facts_.program.model->size_of(Area::V) - offset;
    const auto known = segments(offset);
    const std::uint32_t bytes = std::min(1 + kSegmentBytes * known.value_or(kMostSegments), left);
    MemoryAccess table = possible(bytes_at(image::kV + offset, bytes), Role::In);
    table.by_pointer = !known;
    return table;
  }

  Pointers::Unknown of_offset() const {
    const Bits word = bytes_at(kProfileTable[output_], 2);
    for (std::uint32_t op = 0; op < facts_.effects.size(); ++op)
      for (const MemoryAccess& access : facts_.effects[op])
        if (access.writes() && !access.by_pointer && access.bits.overlaps(word))
          return {.reason = Pointers::Unknown::Reason::Written, .op = op};
    return {};
  }

  const Facts& facts_;
  std::uint32_t output_;
  bool none_ = false;
  std::optional<std::vector<std::int64_t>> offsets_{};
  std::optional<std::vector<MemoryAccess>> tables_{};
};

void shorten(std::vector<MemoryAccess>& effects, Profiles& profiles) {
  if (!profiles.none() && profiles.offsets().empty()) return;
  std::erase_if(effects, is_table);
  if (profiles.none()) return void(std::erase_if(effects, is_of_profile));
  std::ranges::copy(profiles.tables(), std::back_inserter(effects));
}

}  // namespace

std::vector<MemoryAccess> accesses_of_fast_units(const Program& program, const Op& op, std::span<const std::uint8_t> image) {
  return UnitAccesses(program, op, image).all();
}

std::optional<std::uint32_t> profile_pointer_of(const Program& program, const Op& op) {
  if (op.instruction->effect != Effect::ProgramsPulses || !names_unit(op)) return {};
  if (!(program.model->pulse_control & kProfile)) return {};
  return kProfileTable[op[0].at];
}

void shorten_profiles(Facts& facts) {
  std::array<std::optional<Profiles>, kStatus.size()> of_output;
  for (std::uint32_t op = 0; op < facts.effects.size(); ++op) {
    const Op& starts = facts.program.ops[op];
    if (!profile_pointer_of(facts.program, starts)) continue;
    auto& profiles = of_output[starts[0].at];
    if (!profiles) profiles.emplace(facts, starts[0].at);
    shorten(facts.effects[op], *profiles);
  }
}

std::optional<Pointers::Unknown> unknown_profile(const Facts& facts, std::uint32_t op) {
  const Op& starts = facts.program.ops[op];
  return profile_pointer_of(facts.program, starts) ? Profiles(facts, starts[0].at).unknown() : std::nullopt;
}

}  // namespace s7200

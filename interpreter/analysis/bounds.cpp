#include "interpreter/analysis/bounds.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/numbers.hpp"
#include "interpreter/base/text.hpp"
#include "interpreter/model/events.hpp"
#include "interpreter/model/ports.hpp"

namespace s7200 {
namespace {

constexpr std::int64_t kMostUnits = 255;  ///< units of an instruction that memory counts: bytes, characters, entries
constexpr std::int64_t kMostShifted = 32;
constexpr Time kLongest = 100 * kSecond;  ///< a time above it is none

Structure kind_of(const Op& op) { return op.instruction->structure; }

/// The number in a comment such as `at most 8 times`.
std::optional<std::int64_t> limit_in(const std::string& comment) {
  constexpr std::string_view kSays = "AT MOST ";
  const std::string text = stl::upper_case(comment);
  const std::size_t found = text.find(kSays);
  if (found == std::string::npos) return {};
  const std::string_view rest = std::string_view(text).substr(found + kSays.size());
  const std::string_view digits = rest.substr(0, rest.find_first_not_of("0123456789"));
  if (!rest.substr(digits.size()).starts_with(" TIME")) return {};
  return parse_decimal<std::int64_t>(digits);
}

class BoundsBuilder {
 public:
  BoundsBuilder(const Facts& facts, const Calls& calls, const Program& timed, const StatedLoops& stated)
      : facts_(facts), calls_(calls), timed_(timed), stated_(stated) {}

  Bounds all() {
    for (std::uint32_t op = 0; op < timed_.ops.size(); ++op)
      if (is_loop(timed_, op)) bounds_.loops.push_back({op, times_of(op)});
    bounds_.routines.resize(facts_.flow.routines.size());
    for (std::uint32_t i = 0; i < facts_.flow.routines.size(); ++i) measure(i);
    bounds_.scan = bounds_.routines[0].time;
    for (const Time phase : timed_.scan_phase) bounds_.scan += phase;
    if (saves_to_eeprom()) bounds_.scan += timed_.eeprom_save;
    for (const EventUse& use : calls_.events)
      if (!use.attached.empty()) bounds_.events.push_back(event(use));
    for (Bounds::OfEvent& event : bounds_.events) event.latency = latency(event);
    bounds_.scan_with_interrupts = with_interrupts();
    return std::move(bounds_);
  }

 private:
  // --- loops ---

  std::optional<std::int64_t> times_of(std::uint32_t op) const {
    if (const auto stated = stated_.find(op); stated != stated_.end()) return stated->second;
    if (const auto said = limit_in(timed_.statement(op).comment)) return said;
    if (kind_of(timed_.ops[op]) != Structure::For) return {};
    if (!counts_its_passes(facts_.flow, facts_.program, facts_.effects, op)) return {};
    const auto first = least_and_most(timed_.ops[op][1]), last = least_and_most(timed_.ops[op][2]);
    if (!first || !last) return facts_.pointers.passes(op);
    return std::max<std::int64_t>(0, last->second - first->first + 1);
  }

  using Range = std::pair<std::int64_t, std::int64_t>;

  std::int16_t constant(const Operand& operand) const {
    return static_cast<std::int16_t>(load16(&timed_.constants[operand.at - image::kConstants]));
  }

  /// The values of a word: a constant, or memory that instructions only set to constants, and that is 0 before. Nothing for
  /// memory that no instruction sets: somebody else does.
  std::optional<Range> least_and_most(const Operand& operand) const {
    if (operand.pointer || operand.unread()) return {};
    if (operand.at >= image::kConstants) return Range{constant(operand), constant(operand)};
    if (operand.at < image::kV || operand.at >= image::kL) return {};
    const Bits word{operand.at * 8u, 16};
    if (is_set_by_data_block(timed_, word)) return {};
    Range range{0, 0};
    bool is_set = false;
    for (std::uint32_t op = 0; op < facts_.effects.size(); ++op)
      for (const MemoryAccess& access : facts_.effects[op]) {
        if (!access.writes() || !access.bits.overlaps(word)) continue;
        const Op& writer = timed_.ops[op];
        const bool moves = writer.instruction->mnemonic == "MOVW" && !access.by_pointer && access.bits == word;
        if (!moves || writer[0].pointer || writer[0].at < image::kConstants) return {};
        is_set = true;
        range = {std::min<std::int64_t>(range.first, constant(writer[0])),
                 std::max<std::int64_t>(range.second, constant(writer[0]))};
      }
    return is_set ? std::optional(range) : std::nullopt;
  }

  // --- routines ---

  Time cost(std::uint32_t number) const {
    const Op& op = timed_.ops[number];
    const Time powered = op.cost + (op.unit_cost == 0 ? 0 : op.unit_cost * units(op));
    return op.power_mask != 0 ? std::max(powered, timed_.no_power_flow) : powered;
  }

  std::int64_t units(const Op& op) const {
    const std::string_view name = op.instruction->mnemonic;
    const bool shifts = name.starts_with("SL") || name.starts_with("SR") || name.starts_with("RL") || name.starts_with("RR");
    const auto rules = op.instruction->rules();
    for (std::size_t i = 0; i < rules.size(); ++i) {
      const bool counts = rules[i].count || (shifts && rules[i].role == Role::In);
      if (!counts || op[i].pointer || op[i].at < image::kConstants) continue;
      const std::uint8_t count = timed_.constants[op[i].at - image::kConstants];
      return rules[i].sign == Sign::Signed ? std::abs(static_cast<std::int8_t>(count)) : count;
    }
    return shifts ? kMostShifted : kMostUnits;
  }

  void measure(std::uint32_t routine) {
    if (measured_[routine] != State::No) return;
    measured_[routine] = State::Begun;
    const Routine& of = facts_.flow.routines[routine];
    std::vector<std::uint32_t> loops;
    bounds_.routines[routine].time = longest(of.first, of.end, loops);
    std::ranges::sort(loops);
    loops.erase(std::unique(loops.begin(), loops.end()), loops.end());
    bounds_.routines[routine].loops = std::move(loops);
    measured_[routine] = State::Done;
  }

  Time call(std::uint32_t op, std::vector<std::uint32_t>& loops) {
    const std::uint32_t routine = facts_.flow.nodes[timed_.ops[op].target].routine;
    if (measured_[routine] == State::Begun) {
      loops.push_back(op);  // it recurs
      return 0;
    }
    measure(routine);
    const Bounds::OfRoutine& called = bounds_.routines[routine];
    loops.insert(loops.end(), called.loops.begin(), called.loops.end());
    return called.time;
  }

  /// How often a loop runs; 1 and a note if that is not known.
  std::int64_t repeats(std::uint32_t op, std::vector<std::uint32_t>& loops) {
    const auto found = std::ranges::find(bounds_.loops, op, &Bounds::Loop::op);
    if (found->times) return *found->times;
    loops.push_back(op);
    return 1;
  }

  /// The longest way from `from` until an op outside of [from, to).
  Time longest(std::uint32_t from, std::uint32_t to, std::vector<std::uint32_t>& loops) {
    std::vector<Time> best(to - from, 0);
    const auto after = [&](std::uint32_t op) { return op >= from && op < to ? best[op - from] : 0; };
    for (std::uint32_t op = to; op-- > from;) {
      const Op& now = timed_.ops[op];
      Time& time = best[op - from];
      if (kind_of(now) == Structure::For && now.target <= to) {
        Time leaves = after(now.target);
        for (std::uint32_t in = op + 1; in < now.target; ++in)
          for (const std::uint32_t next : facts_.flow.nodes[in].next)
            if (next >= now.target) leaves = std::max(leaves, after(next));
        time = cost(op) + repeats(op, loops) * longest(op + 1, now.target, loops) + leaves;
        continue;
      }
      for (const std::uint32_t next : facts_.flow.nodes[op].next)
        if (next > op) time = std::max(time, after(next));
      time += cost(op);
      if (kind_of(now) == Structure::Call) time += call(op, loops);
      if (kind_of(now) == Structure::Jump && now.target <= op && now.target >= from)
        time = std::max(time, cost(op) + after(op + 1)) +
               (repeats(op, loops) - 1) * (longest(now.target, op, loops) + cost(op));
    }
    return best.empty() ? 0 : best.front();
  }

  bool saves_to_eeprom() const {
    const Bits request{sm::kEepromRequest * 8u, 8};
    return std::ranges::any_of(facts_.effects, [&](const std::vector<MemoryAccess>& effects) {
      return std::ranges::any_of(effects, [&](const MemoryAccess& access) {
        return access.writes() && !access.by_pointer && access.bits.overlaps(request);
      });
    });
  }

  // --- interrupts ---

  /// The bytes that instructions move to a byte of special memory; nothing if one of them is not a constant.
  std::optional<std::vector<std::uint8_t>> constants_written(std::uint32_t at) const {
    std::vector<std::uint8_t> all;
    for (std::uint32_t op = 0; op < facts_.effects.size(); ++op)
      for (const MemoryAccess& access : facts_.effects[op]) {
        if (!access.writes() || access.by_pointer || !access.bits.overlaps({at * 8u, 8})) continue;
        const Op& writer = timed_.ops[op];
        if (writer.instruction->effect != Effect::CopiesByte || writer[0].pointer || writer[0].at < image::kConstants)
          return {};
        all.push_back(timed_.constants[writer[0].at - image::kConstants]);
      }
    return all;
  }

  Time timed_period(std::size_t timer) const {
    const Time shortest = timed_.model->shortest_timed_interval;
    const auto written = constants_written(sm::kTimedInterval[timer]);
    if (!written || written->empty()) return shortest;
    return std::max(shortest, *std::ranges::min_element(*written) * kMillisecond);
  }

  /// The time of a character in the fastest format that the port is given.
  Time character_time(std::size_t port) const {
    const auto written = constants_written(kPorts[port].control);
    const auto time = [&](std::uint8_t control) {
      const std::uint32_t baud = timed_.model->baud[(control & sm::kBaudRate) >> 2];
      const std::int64_t bits = (control & sm::kSevenBits ? 9 : 10) + (control & 0x40 ? 1 : 0);
      return baud == 0 ? kSecond : bits * kSecond / baud;
    };
    const std::uint32_t fastest = *std::ranges::max_element(timed_.model->baud);
    Time least = kSecond;
    if (!written) return 9 * kSecond / fastest;
    for (const std::uint8_t control : *written)
      if ((control & sm::kProtocol) == sm::kFreeport) least = std::min(least, time(control));
    return least;
  }

  std::optional<Time> period(std::uint8_t number) const {
    switch (number) {
      case event::kTimed0:
      case event::kTimed1:
        return timed_period(number - event::kTimed0);
      case event::kPort0Received:
      case event::kPort0Sent:
      case event::kPort0Message:
        return character_time(0);
      case event::kPort1Received:
      case event::kPort1Sent:
      case event::kPort1Message:
        return character_time(1);
      case event::kT32Reached:
      case event::kT96Reached:
        return kMillisecond;
      default:
        return {};
    }
  }

  Bounds::OfEvent event(const EventUse& use) const {
    Bounds::OfEvent of{use.number, period(use.number), 0, {}, {}};
    for (const Attachment& attachment : use.attached) {
      if (!attachment.routine) continue;
      const Bounds::OfRoutine& routine = bounds_.routines[*attachment.routine];
      of.longest_routine = std::max(of.longest_routine, timed_.interrupt_entry + routine.time);
      of.loops.insert(of.loops.end(), routine.loops.begin(), routine.loops.end());
    }
    return of;
  }

  /// The longest time between two places where an interrupt may come.
  std::optional<Time> longest_wait() {
    Time wait = 0;
    for (std::uint32_t op = 0; op < timed_.ops.size(); ++op)
      if (calls_.nodes[facts_.flow.nodes[op].routine].by_main) wait = std::max(wait, cost(op));
    for (const std::uint32_t disi : calls_.disabling) {
      const auto enabled = std::ranges::find_if(calls_.enabling, [&](std::uint32_t op) {
        return op > disi && facts_.flow.nodes[op].routine == facts_.flow.nodes[disi].routine;
      });
      if (enabled == calls_.enabling.end()) return {};
      std::vector<std::uint32_t> loops;
      wait = std::max(wait, longest(disi, *enabled + 1, loops));
      if (!loops.empty()) return {};
    }
    return wait;
  }

  /// The longest other routine may just have begun; events that are served before come as often as they can meanwhile, and
  /// so may the event itself.
  std::optional<Time> latency(const Bounds::OfEvent& event) {
    const auto wait = longest_wait();
    if (!wait) return {};
    std::vector<const Bounds::OfEvent*> before;
    Time begun = 0;
    bool earlier = true;
    for (const Bounds::OfEvent& other : bounds_.events) {
      earlier &= &other != &event;
      const bool same_queue = find_event(other.event)->queue == find_event(event.event)->queue;
      if (earlier || same_queue)
        before.push_back(&other);
      else
        begun = std::max(begun, other.longest_routine);
    }
    const Time alone = *wait + begun + timed_.interrupt_entry;
    return settled(alone, [&](const Bounds::OfEvent& other, Time time) -> std::int64_t {
      if (std::ranges::find(before, &other) == before.end()) return 0;
      return time / *other.period + (&other == &event ? 0 : 1);
    });
  }

  std::optional<Time> with_interrupts() const {
    return settled(bounds_.scan, [](const Bounds::OfEvent& event, Time time) { return time / *event.period + 1; });
  }

  /// The time that includes the routines of as many events as come in it; nothing if there is none or a period is not known.
  template <class Count>
  std::optional<Time> settled(Time alone, Count count) const {
    for (Time time = alone;;) {
      Time next = alone;
      for (const Bounds::OfEvent& event : bounds_.events) {
        if (!event.period || *event.period == 0) return {};
        next += count(event, time) * event.longest_routine;
      }
      if (next == time) return time;
      if (next > kLongest) return {};
      time = next;
    }
  }

  enum class State { No, Begun, Done };

  const Facts& facts_;
  const Calls& calls_;
  const Program& timed_;
  const StatedLoops& stated_;
  std::map<std::uint32_t, State> measured_{};
  Bounds bounds_{};
};

}  // namespace

bool is_loop(const Program& program, std::uint32_t op) {
  const Op& of = program.ops[op];
  return kind_of(of) == Structure::For || (kind_of(of) == Structure::Jump && of.target <= op);
}

Bounds bounds_of(const Facts& facts, const Calls& calls, const Program& timed, const StatedLoops& stated) {
  return BoundsBuilder(facts, calls, timed, stated).all();
}

}  // namespace s7200

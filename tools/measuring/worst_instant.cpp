#include "tools/measuring/worst_instant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/base/split_mix.hpp"
#include "interpreter/base/text/joined.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "interpreter/cpu/interrupts.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200::tools {
namespace {

constexpr EventOwner kOwner{1};
constexpr std::uint64_t kFirstScans = 3;
constexpr Time kLongestStart = 10 * kSecond;
constexpr std::size_t kMostSteps = 20'000;                    ///< instructions of a scan
constexpr std::size_t kMostOfInterrupt = 100'000;             ///< instructions of the rest of a scan with the interrupt
constexpr std::size_t kMostInstants = 200;                    ///< between two accesses
constexpr std::uint32_t kAttempts = 96;                       ///< each from other memory
constexpr std::uint32_t kWithInputs = 8, kWithContacts = 24;  ///< attempts from which on these are changed, too
constexpr std::size_t kMostWork = 4'000'000;                  ///< instructions of all attempts together
constexpr std::size_t kMostPlaces = 4;                        ///< that are named

/// A port with nobody on the line.
class QuietPort final : public SerialPort {
 public:
  void configure(const SerialFormat&, Time) override {}
  void enable_receiver(bool, Time) override {}
  void send(std::uint8_t, Time) override {}
  void send_break(int, Time) override {}
};

/// What the interrupt is.
struct Interrupt {
  std::uint8_t event = 0, routine = 0, byte = 0;
};

class Machine {
 public:
  explicit Machine(std::shared_ptr<const Program> program) : cpu_(std::move(program), queue_, kOwner, all_the(port_)) {
    cpu_.use_steady_scans(SteadyScansUse::Off);
  }

  /// The state at the begin of the program's part of a scan, after the first scans; nothing if it stops before.
  std::optional<State> started() {
    cpu_.power_up();
    cpu_.pause_at_scan_end(true);
    while (cpu_.state().scans < kFirstScans && cpu_.time() < kLongestStart && cpu_.state().mode == Mode::Run) {
      cpu_.run(kLongestStart);
      while (queue_.next() <= cpu_.time()) cpu_.handle(queue_.pop());
    }
    cpu_.pause_at_scan_end(false);
    for (std::size_t i = 0; i < kMostSteps && !in_program(); ++i) step(std::max<Time>(1, cpu_.state().phase_left));
    if (!in_program() || cpu_.state().mode != Mode::Run) return {};
    return cpu_.state();
  }

  /// Each instruction of a scan: its op, whether it does anything, and whether the interrupt would come in front of it.
  struct Step {
    std::uint32_t op = 0;
    bool powered = false, open = false;
  };
  std::vector<Step> steps(const State& from, const Interrupt& interrupt) {
    begin(from);
    std::vector<Step> all;
    while (in_program() && all.size() < kMostSteps) {
      const State& s = cpu_.state();
      const Op& op = cpu_.program().ops[s.pc];
      const bool open = s.interrupts_enabled && s.attached[interrupt.event] == interrupt.routine;
      all.push_back({s.pc, op.power_mask == 0 || s.stack.top(), open});
      step();
    }
    return all;
  }

  /// The state some instructions later.
  State after(const State& from, std::size_t instructions) {
    begin(from);
    for (std::size_t i = 0; i < instructions && in_program(); ++i) step();
    return cpu_.state();
  }

  /// The state after the scan, with the interrupt in front of the next instruction.
  State ended(const State& from, const Interrupt& interrupt) {
    begin(from);
    interrupts::occurred(cpu_.core(), interrupt.event, cpu_.time(), interrupt.byte);
    for (std::size_t i = 0; i < kMostOfInterrupt && (in_program() || cpu_.state().in_interrupt); ++i) step();
    return cpu_.state();
  }

  bool has_worked_enough() const { return work_ > kMostWork; }

 private:
  bool in_program() const {
    const State& s = cpu_.state();
    return s.mode == Mode::Run && (s.phase == Phase::Program && !s.in_interrupt);
  }

  /// Nothing but the one interrupt comes.
  void begin(const State& from) {
    cpu_.restore(from);
    queue_ = EventQueue();
  }

  /// An instruction, or up to `time` of the system's part of the scan.
  void step(Time time = 1) {
    ++work_;
    cpu_.run(cpu_.time() + time);
    while (queue_.next() <= cpu_.time()) queue_.pop();
  }

  static Ports all_the(QuietPort& port) {
    Ports ports{};
    ports.fill(&port);
    return ports;
  }

  EventQueue queue_;
  QuietPort port_;
  Cpu cpu_;
  std::size_t work_ = 0;
};

class Attempt {
 public:
  Attempt(const Inspection& inspection, const Race& race, const Interrupt& interrupt, const State& started,
          std::uint32_t number)
      : inspection_(inspection), race_(race), state_(started), number_(number), chance_(split_mix(number)) {
    State& s = state_;
    s.interrupts_enabled = true;
    s.attached[interrupt.event] = interrupt.routine;
    s.waiting = 0;
    s.queue = {};
    s.watchdog = kNever;
    if (number_ > 0) set(race_.bits);
    if (number_ >= kWithInputs)
      for (std::uint32_t i = 0; i < image::kPointBytes; ++i) s.image[image::kI + i] = byte();
    if (number_ >= kWithInputs)
      for (std::size_t i = 0; i < s.analog_terminals.size(); ++i) s.image[image::kAI + i] = s.analog_terminals[i] = byte();
    if (number_ >= kWithContacts) set_contacts();
    if (number_ >= kWithContacts) set_sources(race_.first), set_sources(race_.last);
  }

  const State& state() const { return state_; }

  std::string situation() const {
    std::string text = fmt::format("{} is {} before the scan", memory_text(race_.bits), value_in(state_, race_.bits));
    if (number_ >= kWithContacts) return text + fmt::format(", inputs and what contacts look at at random ({})", number_);
    return number_ >= kWithInputs ? text + fmt::format(", inputs at random ({})", number_) : text;
  }

  static std::string value_in(const State& state, const Bits& bits) {
    if (bits.count == 1) return state.image[bits.first / 8] >> bits.first % 8 & 1 ? "1" : "0";
    std::string text = "16#";
    const std::uint64_t bytes = std::max<std::uint64_t>(1, bits.count / 8);
    for (std::uint64_t i = 0; i < bytes && i < 8; ++i) text += fmt::format("{:02X}", state.image[bits.first / 8 + i]);
    return text;
  }

 private:
  std::uint8_t byte() { return static_cast<std::uint8_t>(draw_split_mix(chance_)); }

  /// Any value, one about to carry from some of its bytes to the next, one about what it is compared with, or a small one.
  void set(const Bits& bits) {
    if (bits.count == 1) {
      const auto mask = static_cast<std::uint8_t>(1u << bits.first % 8);
      std::uint8_t& cell = state_.image[bits.first / 8];
      cell = static_cast<std::uint8_t>(number_ % 2 == 1 ? cell | mask : cell & ~mask);
      return;
    }
    const std::uint64_t first = bits.first / 8, count = std::clamp<std::uint64_t>(bits.count / 8, 1, 4);
    const auto compared = constant_of(race_.first);
    const std::uint64_t low = count == 1 ? 4 : 8 * (1 + (count / 2 - 1 + number_ / 4) % (count - 1));
    const std::uint64_t carries = (std::uint64_t{1} << low) - 1, any = draw_split_mix(chance_);
    const std::uint64_t value = number_ % 4 == 1   ? carries
                                : number_ % 4 == 2 ? compared.value_or(any) + number_ / 4 % 3 - 1
                                : number_ % 4 == 3 ? any % 16
                                                   : any;
    for (std::uint64_t i = 0; i < count; ++i)
      state_.image[first + i] = static_cast<std::uint8_t>(value >> (8 * (count - 1 - i)));
  }

  /// The constant that an op has as an operand.
  std::optional<std::uint64_t> constant_of(std::uint32_t number) const {
    const Op& op = inspection_.program->ops[number];
    for (std::size_t i = 0; i < op.instruction->rules().size(); ++i) {
      if (op[i].pointer || op[i].unread() || op[i].at < image::kConstants) continue;
      std::uint64_t value = 0;
      for (std::uint32_t k = 0; k < op[i].width; ++k)
        value = value << 8 | inspection_.program->constants[op[i].at - image::kConstants + k];
      return value;
    }
    return {};
  }

  void set_contacts() {
    for (std::uint32_t op = 0; op < inspection_.program->ops.size(); ++op)
      if (inspection_.program->ops[op].is_contact) set_sources(op);
  }

  /// What an op looks at: any values, or small ones.
  void set_sources(std::uint32_t op) {
    constexpr Bits kClockBits{image::kSM * 8u + 4, 3};  // SM0.4, SM0.5, SM0.6
    const bool small = number_ % 2 == 1;
    for (const MemoryAccess& access : inspection_.facts.effects[op]) {
      const auto first = static_cast<std::uint32_t>(access.bits.first / 8);
      const bool memory =
          first >= image::kEdges || (first >= image::kM && first < image::kSM) || kClockBits.contains(access.bits);
      const bool accumulator = first >= image::kAC && first < image::kTBits;
      if (access.by_pointer || accumulator || !memory || !access.reads() || access.bits.count > 64) continue;
      const std::uint8_t mask = access.bits.count == 1 ? static_cast<std::uint8_t>(1u << access.bits.first % 8) : 0xFF;
      const std::uint64_t bytes = std::max<std::uint64_t>(1, access.bits.count / 8);
      for (std::uint64_t i = 0; i < bytes; ++i) {
        if (race_.bits.overlaps({(first + i) * 8, mask == 0xFF ? 8u : 1u})) continue;
        const bool high = small && access.bits.count <= 32 && i + 1 < bytes;
        const std::uint8_t value = high ? std::uint8_t{0} : small && access.bits.count != 1 ? byte() & 3 : byte();
        std::uint8_t& cell = state_.image[first + i];
        cell = static_cast<std::uint8_t>((cell & ~mask) | (value & mask));
      }
    }
  }

  const Inspection& inspection_;
  const Race& race_;
  State state_;
  std::uint32_t number_;
  std::uint64_t chance_;
};

/// Memory that programs keep: outputs, M, S, V.
bool is_kept(std::uint32_t place) {
  return (place >= image::kQ && place < image::kSM) || (place >= image::kS && place < image::kAI) ||
         (place >= image::kAQ && place < image::kAQ + 64) || (place >= image::kC && place < image::kHC) ||
         (place >= image::kV && place < image::kL);
}

/// A run with the interrupt at some instant, and those with it in front of both accesses and behind them.
struct Outcomes {
  const State &between, &before, &behind;
};

bool overlaps_any(const std::vector<Bits>& all, const Bits& bits) {
  return std::ranges::any_of(all, [&bits](const Bits& each) { return each.overlaps(bits); });
}

/// Returns the bytes that the run leaves otherwise than both others; if there are none, and the run is like neither of them
/// in `dependent` memory, the bytes there that tell it from either. Timers run on by themselves: they count only if they are
/// what is shared.
std::vector<std::uint32_t> bytes_lost(const Outcomes& run, const Bits& shared, const std::vector<Bits>& dependent) {
  std::vector<std::uint32_t> from_both, from_either;
  bool from_before = false, from_behind = false;
  for (std::uint32_t place = 0; place < image::kL; ++place) {
    if (!is_kept(place) && !Bits{place * 8u, 8}.overlaps(shared)) continue;
    const std::uint8_t value = run.between.image[place];
    const bool as_before = value == run.before.image[place], as_behind = value == run.behind.image[place];
    if (as_before && as_behind) continue;
    if (!as_before && !as_behind) from_both.push_back(place);
    if (!overlaps_any(dependent, {place * 8u, 8})) continue;
    from_before |= !as_before;
    from_behind |= !as_behind;
    from_either.push_back(place);
  }
  if (!from_both.empty()) return from_both;
  return from_before && from_behind ? from_either : std::vector<std::uint32_t>();
}

/// What the program names that a byte is part of: what is shared, or the widest that an instruction accesses.
Bits named_around(const Inspection& inspection, std::uint32_t byte, const Bits& shared) {
  const Bits bits{byte * 8u, 8};
  if (shared.overlaps(bits) && shared.count <= 32) return shared;
  Bits widest = bits;
  for (const auto& effects : inspection.facts.effects)
    for (const MemoryAccess& access : effects)
      if (access.bits.count <= 32 && access.bits.contains(bits) && access.bits.count > widest.count) widest = access.bits;
  return widest;
}

/// The memory that some bytes are part of, at most kMostPlaces.
std::vector<Bits> places_of(const Inspection& inspection, const std::vector<std::uint32_t>& bytes, const Bits& shared) {
  std::vector<Bits> all;
  for (const std::uint32_t byte : bytes) {
    if (std::ranges::any_of(all, [byte](const Bits& each) { return each.overlaps({byte * 8u, 8}); })) continue;
    const Bits place = named_around(inspection, byte, shared);
    const bool goes_on = !all.empty() && all.back().end() == place.first && all.back().count + place.count <= 32 &&
                         all.back().count == place.count && place.count >= 8;
    if (goes_on)
      all.back().count += place.count;
    else if (all.size() < kMostPlaces)
      all.push_back(place);
  }
  return all;
}

class Search {
 public:
  Search(const Inspection& inspection, const Race& race)
      : inspection_(inspection),
        race_(race),
        machine_(inspection.program),
        interrupt_{race.event, inspection.facts.flow.routines[race.routine].number, 0x55} {}

  std::optional<LostWord> found() {
    const auto started = machine_.started();
    if (!started) return {};
    for (std::uint32_t number = 0; number < kAttempts && !is_over(); ++number) {
      const Attempt attempt(inspection_, race_, interrupt_, *started, number);
      if (auto lost = in_scan(attempt)) return lost;
    }
    return {};
  }

 private:
  bool is_over() const { return machine_.has_worked_enough() || inspection_.waiter.asks_to_end(); }

  /// Each time that the scan comes to the two accesses, in loops too.
  std::optional<LostWord> in_scan(const Attempt& attempt) {
    const auto steps = machine_.steps(attempt.state(), interrupt_);
    for (std::size_t first = 0; first < steps.size() && !is_over(); ++first) {
      if (!executes(steps[first], race_.first)) continue;
      std::size_t last = first + 1;
      while (last < steps.size() && !executes(steps[last], race_.last) && last - first <= kMostInstants) ++last;
      if (last == steps.size() || last - first > kMostInstants) continue;
      if (auto lost = in_between(attempt, steps, first, last)) return lost;
    }
    return {};
  }

  /// A label or the head of a routine takes no time: the next instruction is executed with it.
  bool executes(const Machine::Step& step, std::uint32_t op) const {
    return step.powered && (step.op == op || (step.op + 1 == op && inspection_.program->ops[step.op].cost == 0));
  }

  std::optional<LostWord> in_between(const Attempt& attempt, const std::vector<Machine::Step>& steps, std::size_t first,
                                     std::size_t last) {
    std::size_t in_front = first, behind_both = last + 1;
    while (in_front > 0 && !steps[in_front].open) --in_front;
    while (behind_both < steps.size() && !steps[behind_both].open) ++behind_both;
    const std::vector<Bits> dependent = dependent_memory(steps, first);
    State now = machine_.after(attempt.state(), in_front);
    const State before = machine_.ended(now, interrupt_);
    const State behind = machine_.ended(machine_.after(now, behind_both - in_front), interrupt_);
    now = machine_.after(now, first - in_front);
    for (std::size_t at = first + 1; at <= last && !is_over(); ++at) {
      now = machine_.after(now, 1);
      if (!steps[at].open) continue;
      const State ended = machine_.ended(now, interrupt_);
      const auto bytes = bytes_lost({ended, before, behind}, race_.bits, dependent);
      if (bytes.empty()) continue;
      const auto places = places_of(inspection_, bytes, race_.bits);
      const auto values = [&places](const State& state) {
        return stl::joined(places, [&](const Bits& each) { return Attempt::value_in(state, each); });
      };
      return LostWord{attempt.situation(), steps[at - 1].op, stl::joined(places, memory_text),
                      values(ended),       values(before),   values(behind)};
    }
    return {};
  }

  /// What is shared, and the memory whose values the rest of the scan works out from it. Parts of a torn word go anywhere.
  /// Of two words one may well be new and the other old, unless a value comes of both.
  std::vector<Bits> dependent_memory(const std::vector<Machine::Step>& steps, std::size_t first) const {
    if (race_.kind == Race::Kind::MixedRead) return {};
    if (race_.kind == Race::Kind::TornRead || race_.kind == Race::Kind::TornWrite) return {{0, image::kL * 8u}};
    std::vector<Bits> all{race_.bits}, now;
    const auto is_dependent = [&](const MemoryAccess& access) {
      return access.reads() && (access.bits.overlaps(race_.bits) || overlaps_any(now, access.bits));
    };
    for (std::size_t i = first; i < steps.size(); ++i) {
      const std::uint32_t op = steps[i].op;
      if (!steps[i].powered || inspection_.program->ops[op].is_contact) continue;
      const auto& effects = inspection_.facts.effects[op];
      const bool depends = std::ranges::any_of(effects, is_dependent);
      for (const MemoryAccess& access : effects) {
        const auto is_part = [&access](const Bits& bits) { return access.bits.contains(bits); };
        const auto has_all = [&access](const Bits& bits) { return bits.contains(access.bits); };
        if (!depends && access.role == Role::Out && access.certainty == Certainty::Must && !access.by_pointer)
          std::erase_if(now, is_part);
        if (!depends || !access.writes()) continue;
        if (std::ranges::none_of(now, has_all)) now.push_back(access.bits);
        if (std::ranges::none_of(all, has_all)) all.push_back(access.bits);
      }
    }
    return all;
  }

  const Inspection& inspection_;
  const Race& race_;
  Machine machine_;
  Interrupt interrupt_;
};

}  // namespace

std::optional<LostWord> worst_instant(const Inspection& inspection, const Race& race) {
  if (inspection.has_errors || has_unread(*inspection.program)) return {};
  return Search(inspection, race).found();
}

}  // namespace s7200::tools

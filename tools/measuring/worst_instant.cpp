#include "tools/measuring/worst_instant.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/base/split_mix.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "interpreter/cpu/interrupts.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200::tools {
namespace {

constexpr EventOwner kOwner{1};
constexpr std::uint64_t kFirstScans = 3;
constexpr Time kLongestStart = 10 * kSecond;
constexpr std::size_t kMostSteps = 20'000;                    ///< instructions of a scan
constexpr std::size_t kMostInstants = 200;                    ///< between two accesses
constexpr std::uint32_t kAttempts = 96;                       ///< each from other memory
constexpr std::uint32_t kWithInputs = 8, kWithContacts = 24;  ///< attempts from which on these are changed, too

/// A port with nobody on the line.
class QuietPort final : public SerialPort {
 public:
  void configure(const SerialFormat&, Time) override {}
  void enable_receiver(bool, Time) override {}
  void send(std::uint8_t, Time) override {}
  void send_break(int, Time) override {}
};

/// What the interrupt is: where it comes, in instructions from the begin of the scan.
struct Interrupt {
  std::uint8_t event = 0, routine = 0, byte = 0;
  std::size_t at = 0;
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

  /// Each instruction of a scan: its op, and whether it does anything.
  struct Step {
    std::uint32_t op = 0;
    bool powered = false;
  };
  std::vector<Step> steps(const State& from) {
    begin(from);
    std::vector<Step> all;
    while (in_program() && all.size() < kMostSteps) {
      const Op& op = cpu_.program().ops[cpu_.state().pc];
      all.push_back({cpu_.state().pc, op.power_mask == 0 || cpu_.state().stack.top()});
      step();
    }
    return all;
  }

  /// Memory after the scan, with an interrupt.
  State ended(const State& from, const Interrupt& interrupt) {
    begin(from);
    for (std::size_t i = 0; i < interrupt.at && in_program(); ++i) step();
    cpu_.core().s.attached[interrupt.event] = interrupt.routine;
    interrupts::occurred(cpu_.core(), interrupt.event, cpu_.time(), interrupt.byte);
    for (std::size_t i = 0; i < kMostSteps && (in_program() || cpu_.state().in_interrupt); ++i) step();
    return cpu_.state();
  }

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
};

class Attempt {
 public:
  Attempt(const Inspection& inspection, const Race& race, const State& started, std::uint32_t number)
      : inspection_(inspection), race_(race), state_(started), number_(number), chance_(split_mix(number)) {
    State& s = state_;
    s.interrupts_enabled = true;
    s.waiting = 0;
    s.queue = {};
    s.watchdog = kNever;
    if (number_ > 0) set(race_.bits);
    if (number_ >= kWithInputs)
      for (std::uint32_t i = 0; i < image::kPointBytes; ++i) s.image[image::kI + i] = byte();
    if (number_ >= kWithContacts) set_contacts();
  }

  const State& state() const { return state_; }

  std::string situation() const {
    std::string text = fmt::format("{} is {} before the scan", memory_text(race_.bits), value_in(state_, race_.bits));
    if (number_ >= kWithContacts) return text + fmt::format(", inputs and what contacts look at at random ({})", number_);
    return number_ >= kWithInputs ? text + fmt::format(", inputs at random ({})", number_) : text;
  }

  static std::string value_in(const State& state, const Bits& bits) {
    std::string text = "16#";
    const std::uint64_t bytes = std::max<std::uint64_t>(1, bits.count / 8);
    for (std::uint64_t i = 0; i < bytes && i < 8; ++i) text += fmt::format("{:02X}", state.image[bits.first / 8 + i]);
    return text;
  }

 private:
  std::uint8_t byte() { return static_cast<std::uint8_t>(draw_split_mix(chance_)); }

  /// Any value, one about to carry from its low half to its high half, or one about what it is compared with.
  void set(const Bits& bits) {
    const std::uint64_t first = bits.first / 8, count = std::clamp<std::uint64_t>(bits.count / 8, 1, 4);
    const auto compared = constant_of(race_.first);
    const std::uint64_t carries = (std::uint64_t{1} << (4 * count)) - 1, any = draw_split_mix(chance_);
    const std::uint64_t value = number_ % 3 == 1   ? carries
                                : number_ % 3 == 2 ? compared.value_or(any) + number_ / 3 % 3 - 1
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
    const Program& program = *inspection_.program;
    for (std::uint32_t op = 0; op < program.ops.size(); ++op) {
      if (!program.ops[op].is_contact) continue;
      for (const MemoryAccess& access : inspection_.facts.effects[op]) {
        const auto first = static_cast<std::uint32_t>(access.bits.first / 8);
        const bool memory = first >= image::kV || (first >= image::kM && first < image::kSM);
        if (access.by_pointer || !memory || access.bits.count > 32 || access.bits.overlaps(race_.bits)) continue;
        const std::uint8_t mask = access.bits.count == 1 ? static_cast<std::uint8_t>(1u << access.bits.first % 8) : 0xFF;
        for (std::uint64_t i = 0; i < std::max<std::uint64_t>(1, access.bits.count / 8); ++i) {
          std::uint8_t& cell = state_.image[first + i];
          cell = static_cast<std::uint8_t>((cell & ~mask) | (byte() & mask));
        }
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
         (place >= image::kC && place < image::kHC) || (place >= image::kV && place < image::kL);
}

/// The memory that one run leaves otherwise than both others: the shared word if it is among it.
std::optional<Bits> lost(const State& run, const State& before, const State& behind, const Bits& shared) {
  bool from_before = false, from_behind = false;
  std::optional<std::uint32_t> other;
  for (std::uint32_t place = 0; place < image::kL; ++place) {
    if (!is_kept(place)) continue;
    const bool as_before = run.image[place] == before.image[place], as_behind = run.image[place] == behind.image[place];
    from_before |= !as_before;
    from_behind |= !as_behind;
    if (!as_before && !as_behind && Bits{place * 8u, 8}.overlaps(shared)) return shared;
    if (!other && (!as_before || !as_behind)) other = place;
  }
  if (!from_before || !from_behind) return {};
  return Bits{*other * 8u, 8};
}

}  // namespace

std::optional<LostWord> worst_instant(const Inspection& inspection, const Race& race) {
  if (has_unread(*inspection.program)) return {};
  Machine machine(inspection.program);
  const auto started = machine.started();
  if (!started) return {};
  Interrupt interrupt{race.event, inspection.facts.flow.routines[race.routine].number, 0x55, 0};
  for (std::uint32_t number = 0; number < kAttempts && !inspection.waiter.asks_to_end(); ++number) {
    const Attempt attempt(inspection, race, *started, number);
    const auto steps = machine.steps(attempt.state());
    // A label or the head of a routine takes no time: the next instruction is executed with it.
    const auto is = [&](std::uint32_t op) {
      return [op, &ops = inspection.program->ops](const Machine::Step& step) {
        return step.powered && (step.op == op || (step.op + 1 == op && ops[step.op].cost == 0));
      };
    };
    const auto first = std::ranges::find_if(steps, is(race.first));
    const auto last = std::find_if(first, steps.end(), is(race.last));
    if (last == steps.end() || last - first > static_cast<std::ptrdiff_t>(kMostInstants)) continue;
    const auto run = [&](auto step) {
      interrupt.at = static_cast<std::size_t>(step - steps.begin());
      return machine.ended(attempt.state(), interrupt);
    };
    const State before = run(first), behind = run(std::next(last));
    for (auto step = std::next(first); step <= last; ++step) {
      const State ended = run(step);
      const auto place = lost(ended, before, behind, race.bits);
      if (!place) continue;
      return LostWord{attempt.situation(),
                      std::prev(step)->op,
                      memory_text(*place),
                      Attempt::value_in(ended, *place),
                      Attempt::value_in(before, *place),
                      Attempt::value_in(behind, *place)};
    }
  }
  return {};
}

}  // namespace s7200::tools

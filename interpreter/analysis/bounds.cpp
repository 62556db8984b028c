#include "interpreter/analysis/bounds.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "interpreter/analysis/flow/kept_away.hpp"
#include "interpreter/analysis/longest_ways.hpp"
#include "interpreter/analysis/timed_interrupts.hpp"
#include "interpreter/analysis/times/interrupt_waits.hpp"
#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/contact_form.hpp"
#include "interpreter/model/events.hpp"
#include "interpreter/model/ports.hpp"

namespace s7200 {
namespace {

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
  BoundsBuilder(const Facts& facts, const Calls& calls, const Program& timed, const StatedLoops& stated,
                const Waiter& waiter)
      : facts_(facts),
        calls_(calls),
        timed_(timed),
        stated_(stated),
        waiter_(waiter),
        ways_(
            facts, timed, [this](std::uint32_t op) { return known_times(op); }, waiter) {
    for (const Calls::Node& node : calls.nodes) usual_.disturbing.push_back(node.by_interrupt);
  }

  Bounds all() {
    find_loops();
    Bounds interrupted;
    interrupted.loops = bounds_.loops;
    interrupted.is_complete = false;
    measure_all();
    return waiter_.stop.stop_requested() ? interrupted : std::move(bounds_);
  }

  std::vector<Bounds::OfEvent> timed() {
    find_loops();
    bounds_.routines.resize(facts_.flow.routines.size());
    std::vector<Bounds::OfEvent> all;
    for (const EventUse& use : calls_.events) {
      if (!event::is_timed(use.number) || use.attached.empty()) continue;
      const auto periods = timed_periods(use.number - event::kTimed0);
      if (!periods) continue;
      for (const Attachment& attachment : use.attached)
        if (attachment.routine) measure(*attachment.routine);
      all.push_back(event(use));
      all.back().period = periods->second;
    }
    if (waiter_.stop.stop_requested()) return {};
    return all;
  }

 private:
  void find_loops() {
    for (std::uint32_t op = 0; op < timed_.ops.size(); ++op)
      if (is_loop(timed_, op)) bounds_.loops.push_back({.op = op, .times = times_of(op)});
  }

  void measure_all() {
    measure_routines();
    bounds_.scan = bounds_.routines[0].time;
    for (const Time phase : timed_.scan_phase) bounds_.scan += phase;
    if (saves_to_eeprom()) bounds_.scan += timed_.eeprom_save;
    for (const EventUse& use : calls_.events)
      if (!use.attached.empty()) bounds_.events.push_back(event(use));
    if (!bounds_.events.empty()) find_disabled();
    for (Bounds::OfEvent& event : bounds_.events) find_latency(event);
    bounds_.load = load_of(sources_until(Queue::Timed));
    bounds_.scan_with_interrupts = with_interrupts();
    bounds_.loops_of_interrupts = with_loops_of_events(bounds_.routines[0].loops);
    for (std::size_t port = 0; port < timed_.model->ports; ++port)
      if (const auto found = answer(port)) bounds_.answers.push_back(*found);
    for (Bounds::Loop& loop : bounds_.loops) loop.times ? void() : explain(loop);
  }

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

  /// What is executed begins in the main program or an interrupt routine: all ways from there may have a limit.
  void explain(Bounds::Loop& loop) const {
    if (!open_.contains(loop.op)) {
      if (const auto most = passes_.find(loop.op); most != passes_.end()) loop.times = most->second;
      return;
    }
    if (kind_of(timed_.ops[loop.op]) != Structure::For) {
      loop.open = Bounds::Loop::Open::Jumps;
    } else if (!counts_its_passes(facts_.flow, facts_.program, facts_.effects, loop.op)) {
      loop.open = Bounds::Loop::Open::WritesItsIndex;
    } else {
      loop.open = Bounds::Loop::Open::NoLimit;
      find_origin(loop);
    }
  }

  /// The moves in front of a FOR, or of the calls of its routine, that put its final value, and what counts their sources.
  void find_origin(Bounds::Loop& loop) const {
    const Operand& last = timed_.ops[loop.op][2];
    if (last.pointer || last.at >= image::kConstants) return;
    const std::uint32_t routine = facts_.flow.nodes[loop.op].routine;
    if (const auto mover = last_writer(loop.op, last.at)) {
      add_origin(loop, *mover);
    } else {
      for (const CallSite& call : facts_.flow.calls)
        if (const auto put = call.routine == routine ? last_writer(call.op, last.at) : std::nullopt) add_origin(loop, *put);
    }
  }
  void add_origin(Bounds::Loop& loop, std::uint32_t mover) const {
    const Op& now = timed_.ops[mover];
    if (now.instruction->mnemonic != "MOVW" || now[0].pointer || now[0].at >= image::kConstants) return;
    loop.copied.push_back(mover);
    for (std::uint32_t op = 0; op < timed_.ops.size(); ++op) {
      const Op& counts = timed_.ops[op];
      const bool counts_up = counts.instruction->mnemonic == "INCW" && !counts[0].pointer && counts[0].at == now[0].at;
      if (counts_up && std::ranges::find(loop.counted, op) == loop.counted.end()) loop.counted.push_back(op);
    }
  }
  /// The nearest op in front of `before`, in its routine, that writes a word by its name.
  std::optional<std::uint32_t> last_writer(std::uint32_t before, std::uint32_t at) const {
    const Bits word{at * 8u, 16};
    for (std::uint32_t op = before; op-- > facts_.flow.routine_of(before).first;)
      for (const MemoryAccess& access : facts_.effects[op])
        if (access.writes() && !access.by_pointer && access.bits.overlaps(word)) return op;
    return {};
  }

  std::optional<std::int64_t> known_times(std::uint32_t op) const {
    const auto found = std::ranges::find(bounds_.loops, op, &Bounds::Loop::op);
    return found->times;
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

  void measure_routines() {
    std::vector<std::uint32_t> all(facts_.flow.routines.size());
    std::iota(all.begin(), all.end(), 0U);
    for (const LongestWay& way : ways_.of_routines(all, usual_)) {
      const Calls::Node& node = calls_.nodes[bounds_.routines.size()];
      if (bounds_.routines.empty()) longest_instruction_ = way.instruction;
      if (bounds_.routines.empty() || !node.events.empty()) {
        open_.insert(way.loops.begin(), way.loops.end());
        for (const auto& [loop, most] : way.passes) passes_[loop] = std::max(passes_[loop], most);
      }
      bounds_.routines.push_back({way.time, {way.loops.begin(), way.loops.end()}});
    }
  }

  void measure(std::uint32_t routine) {
    const LongestWay way = ways_.of_routines({routine}, usual_).front();
    bounds_.routines[routine] = {way.time, {way.loops.begin(), way.loops.end()}};
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

  /// Returns the shortest and the longest period that the program sets; nothing if they are unknown.
  std::optional<std::pair<Time, Time>> timed_periods(std::size_t timer) const {
    const auto written = constants_written(facts_, sm::kTimedInterval[timer], Width::Byte);
    if (!written || written->empty()) return {};
    const Time shortest = timed_.model->shortest_timed_interval;
    const auto [least, most] = std::ranges::minmax(*written);
    return std::pair(std::max(shortest, least * kMillisecond), std::max(shortest, most * kMillisecond));
  }

  /// The time of a character in the fastest format that the port is given.
  Time character_time(std::size_t port) const {
    const auto written = constants_written(facts_, kPorts[port].control, Width::Byte);
    const auto time = [&](std::int64_t control) {
      const std::uint32_t baud = timed_.model->baud[(control & sm::kBaudRate) >> 2];
      const std::int64_t bits = (control & sm::kSevenBits ? 9 : 10) + (control & 0x40 ? 1 : 0);
      return baud == 0 ? kSecond : bits * kSecond / baud;
    };
    const std::uint32_t fastest = *std::ranges::max_element(timed_.model->baud);
    Time least = kSecond;
    if (!written) return 9 * kSecond / fastest;
    for (const std::int64_t control : *written)
      if ((control & sm::kProtocol) == sm::kFreeport) least = std::min(least, time(control));
    return least;
  }

  std::optional<Time> period(std::uint8_t number) const {
    switch (static_cast<event::Number>(number)) {
      case event::kPort0Received:
      case event::kPort0Sent:
      case event::kPort0Message:
        return character_time(0);
      case event::kPort1Received:
      case event::kPort1Sent:
      case event::kPort1Message:
        return character_time(1);
      case event::kTimed0:
      case event::kTimed1: {
        const auto periods = timed_periods(number - event::kTimed0);
        return periods ? periods->first : timed_.model->shortest_timed_interval;
      }
      case event::kT32Reached:
      case event::kT96Reached:
        return kMillisecond;
      case event::kI00Rises:
      case event::kI00Falls:
      case event::kI01Rises:
      case event::kI01Falls:
      case event::kI02Rises:
      case event::kI02Falls:
      case event::kI03Rises:
      case event::kI03Falls:
      case event::kCounter0Reached:
      case event::kCounter1Reached:
      case event::kCounter1Turned:
      case event::kCounter1Reset:
      case event::kCounter2Reached:
      case event::kCounter2Turned:
      case event::kCounter2Reset:
      case event::kPulses0Complete:
      case event::kPulses1Complete:
      case event::kCounter0Turned:
      case event::kCounter0Reset:
      case event::kCounter4Reached:
      case event::kCounter4Turned:
      case event::kCounter4Reset:
      case event::kCounter3Reached:
      case event::kCounter5Reached:
        break;  // as often as inputs and pulses bring them
    }
    return {};
  }

  Bounds::OfEvent event(const EventUse& use) const {
    Bounds::OfEvent of{.event = use.number, .period = period(use.number)};
    for (const Attachment& attachment : use.attached) {
      if (!attachment.routine) continue;
      const Bounds::OfRoutine& routine = bounds_.routines[*attachment.routine];
      of.longest_routine = std::max(of.longest_routine, timed_.interrupt_entry + routine.time);
      of.loops.insert(of.loops.end(), routine.loops.begin(), routine.loops.end());
    }
    return of;
  }

  void find_disabled() {
    disabled_ = longest_of(disabled_stretches(facts_.program, facts_.flow, calls_.disabling));
    before_enabling_ = longest_of(stretches_before_enabling(facts_.program, facts_.flow));
    bounds_.enabled_late = !before_enabling_;
  }

  /// The longest time from a DISI, or the first ATCH, to its ENI. Nothing: interrupts may stay disabled for longer than is
  /// known.
  std::optional<Time> longest_of(const std::optional<std::vector<DisabledStretch>>& stretches) const {
    if (!stretches) return {};
    Time longest = 0;
    for (const DisabledStretch& stretch : *stretches) {
      const LongestWay way = ways_.of_stretch(stretch.first, stretch.end, usual_);
      if (!way.loops.empty()) return {};
      longest = std::max(longest, way.time);
    }
    return longest;
  }

  static Queue queue_of(const Bounds::OfEvent& event) { return find_event(event.event)->queue; }
  static bool has_period(const Bounds::OfEvent& event) { return event.period && *event.period != 0; }

  /// The events with a known period in a queue and those served before.
  std::vector<InterruptSource> sources_until(Queue queue) const {
    std::vector<InterruptSource> sources;
    for (const Bounds::OfEvent& event : bounds_.events)
      if (queue_of(event) <= queue && has_period(event))
        sources.push_back({queue_of(event), *event.period, event.longest_routine});
    return sources;
  }

  /// The longest routine of an event that is served after this one may just have begun. What comes before the first ENI
  /// waits for that alone.
  Time kept_away(const Bounds::OfEvent& event) const {
    Time begun = 0;
    bool come_early = false;
    for (const Bounds::OfEvent& other : bounds_.events) {
      if (queue_of(other) > queue_of(event)) begun = std::max(begun, other.longest_routine);
      if (queue_of(other) <= queue_of(event))
        come_early |= !event::is_timed(other.event) || other.period <= *before_enabling_;
    }
    const Time usual = std::max(longest_instruction_, *disabled_) + begun;
    return come_early ? std::max(usual, *before_enabling_) : usual;
  }

  std::vector<std::uint32_t> with_loops_of_events(const std::vector<std::uint32_t>& loops) const {
    std::set<std::uint32_t> all(loops.begin(), loops.end());
    for (const Bounds::OfEvent& event : bounds_.events) all.insert(event.loops.begin(), event.loops.end());
    return {all.begin(), all.end()};
  }

  /// Events that are served before come as often as they can meanwhile, and so may the event itself.
  void find_latency(Bounds::OfEvent& event) {
    event.may_stay_disabled = !disabled_ || !before_enabling_;
    if (event.may_stay_disabled) return;
    for (const Bounds::OfEvent& other : bounds_.events)
      if (queue_of(other) <= queue_of(event) && !has_period(other)) event.before.push_back(other.event);
    if (!event.before.empty()) return;
    const std::vector<InterruptSource> sources = sources_until(queue_of(event));
    event.load = load_of(sources);
    event.loops_before = with_loops_of_events({});  // that of any queue may just have begun
    const auto wait = interrupt_wait(sources, queue_of(event), event.longest_routine, kept_away(event));
    if (!wait) return;
    event.latency = wait->longest + timed_.interrupt_entry;
    event.may_be_lost = wait->waiting_in_queue > timed_.model->queue_depth[static_cast<std::size_t>(queue_of(event))];
  }

  /// Where interrupts do not stay disabled, none waits when a scan begins. Where the first ENI may come long after ATCH,
  /// the queues may be full then.
  std::optional<Time> with_interrupts() const {
    if (!disabled_) return {};
    const Time waiting = before_enabling_ ? 0 : full_queues();
    return settled(bounds_.scan + waiting, [](const Bounds::OfEvent& event, Time time) { return time / *event.period + 1; });
  }
  Time full_queues() const {
    std::array<Time, kQueues> longest{};
    for (const Bounds::OfEvent& event : bounds_.events) {
      Time& of_queue = longest[static_cast<std::size_t>(queue_of(event))];
      of_queue = std::max(of_queue, event.longest_routine);
    }
    return std::inner_product(longest.begin(), longest.end(), timed_.model->queue_depth.begin(), Time{0});
  }

  /// The time that includes the routines of as many events as come in it; nothing if there is none or a period is not known.
  template <class Count>
  std::optional<Time> settled(Time alone, Count count) const {
    return settled(alone, count, [](const Bounds::OfEvent&) { return true; });
  }
  template <class Count, class Comes>
  std::optional<Time> settled(Time alone, Count count, Comes comes) const {
    for (Time time = alone;;) {
      Time next = alone;
      for (const Bounds::OfEvent& event : bounds_.events) {
        if (!comes(event)) continue;
        if (!has_period(event)) return {};
        next += count(event, time) * event.longest_routine;
      }
      if (next == time) return time;
      if (next > kLongest) return {};
      time = next;
    }
  }

  // --- answers ---

  static bool is_of_port(std::uint8_t event, std::size_t port) {
    return event == kPorts[port].received || event == kPorts[port].sent || event == kPorts[port].received_message;
  }

  /// The routines that receive: those of a port's events, and of timed interrupts, which measure the silence after them.
  std::set<std::uint32_t> receiving(std::size_t port, bool by_time) const {
    std::set<std::uint32_t> all;
    for (const EventUse& use : calls_.events)
      for (const Attachment& attachment : use.attached)
        if (attachment.routine &&
            (by_time ? event::is_timed(use.number) : is_of_port(use.number, port) && use.number != kPorts[port].sent))
          all.insert(*attachment.routine);
    return all;
  }

  /// Routines with what they call.
  std::set<std::uint32_t> with_called(std::set<std::uint32_t> routines) const {
    std::vector<std::uint32_t> waiting(routines.begin(), routines.end());
    while (!waiting.empty()) {
      const std::uint32_t routine = waiting.back();
      waiting.pop_back();
      for (const CallSite& call : calls_.nodes[routine].calls)
        if (routines.insert(call.routine).second) waiting.push_back(call.routine);
    }
    return routines;
  }

  /// The bits that contacts of the main program look at and that these routines write.
  std::vector<Bits> flags_of(const std::set<std::uint32_t>& routines) const {
    std::vector<Bits> flags;
    for (std::uint32_t op = 0; op < timed_.ops.size(); ++op) {
      const Op& now = timed_.ops[op];
      if (!calls_.nodes[facts_.flow.nodes[op].routine].by_main || now[0].pointer) continue;
      if (contact_form(*now.instruction).kind != ContactForm::Kind::Bit) continue;
      const Bits bit{now[0].at * 8u + now[0].bit, 1};
      for (const std::uint32_t routine : routines)
        if (now[0].at != image::kSM && writes(routine, bit)) flags.push_back(bit);
    }
    return flags;
  }
  bool writes(std::uint32_t routine, const Bits& bit) const {
    const Routine& of = facts_.flow.routines[routine];
    for (std::uint32_t op = of.first; op < of.end; ++op)
      for (const MemoryAccess& access : facts_.effects[op])
        if (access.writes() && !access.by_pointer && access.bits.overlaps(bit)) return true;
    return false;
  }

  /// A program that is ready, whose receiving routines do not disturb the work on a request.
  LongestWays::Assumed ready(std::uint32_t port, const std::set<std::uint32_t>& receiving) const {
    LongestWays::Assumed assumed{.bits = {{Bits{image::kSM * 8u + 1, 1}, false}}, .port = port};
    std::set<std::uint32_t> others;
    for (const EventUse& use : calls_.events)
      for (const Attachment& attachment : use.attached)
        if (attachment.routine && !receiving.contains(*attachment.routine)) others.insert(*attachment.routine);
    assumed.disturbing.assign(facts_.flow.routines.size(), false);
    for (const std::uint32_t routine : with_called(others)) assumed.disturbing[routine] = true;
    return assumed;
  }

  Time longest_routine(const auto& of_event) const {
    Time longest = 0;
    for (const Bounds::OfEvent& event : bounds_.events)
      if (of_event(event.event)) longest = std::max(longest, event.longest_routine);
    return longest;
  }

  /// The longest time that a timed interrupt, or RCV, waits after the last character; nothing if that is not known.
  std::optional<Time> longest_silence(std::size_t port, bool timed) const {
    Time longest = 0;
    const auto take = [&](const std::optional<std::vector<std::int64_t>>& written, Time least) {
      longest = std::max(longest, least);
      if (written && !written->empty()) longest = std::max(longest, *std::ranges::max_element(*written) * kMillisecond);
      return written.has_value();
    };
    for (std::size_t timer = 0; timer < 2; ++timer) {
      const bool used = timed && std::ranges::any_of(calls_.events, [&](const EventUse& use) {
                          return use.number == event::kTimed0 + timer && !use.attached.empty();
                        });
      const auto interval = constants_written(facts_, sm::kTimedInterval[timer], Width::Byte);
      if (used && !take(interval, timed_.model->shortest_timed_interval)) return {};
    }
    const bool receives = timed_.receives_messages[port];
    const auto timeout = constants_written(facts_, kPorts[port].message + sm::message::kTimeout, Width::Word);
    if (receives && !take(timeout, 0)) return {};
    return longest;
  }

  /// The main program is in a scan that has not seen the request yet; the next one sees it.
  std::optional<Bounds::OfAnswer> answer(std::size_t port) {
    const std::set<std::uint32_t> by_characters = receiving(port, false), by_time = receiving(port, true);
    if (by_characters.empty() && !timed_.receives_messages[port]) return {};
    std::set<std::uint32_t> all = with_called(by_characters), timed = with_called(by_time);
    const bool waits = !flags_of(timed).empty() || transmits(timed, port);
    if (waits) all.merge(timed);
    LongestWays::Assumed assumed = ready(static_cast<std::uint32_t>(port), all);
    const LongestWay sends = ways_.of_routines({0}, assumed).front();
    for (const Bits& flag : flags_of(all)) assumed.bits.emplace_back(flag, false);
    const LongestWay idle = ways_.of_routines({0}, assumed).front();
    std::optional<Time> answers;
    if (sends.to_transmission) answers = bounds_.scan - bounds_.routines[0].time + idle.time + *sends.to_transmission;
    Bounds::OfAnswer answer{static_cast<std::uint8_t>(port), {}, {}};
    std::set<std::uint32_t> loops = sends.loops;
    for (const LongestWay& way : ways_.of_routines({all.begin(), all.end()}, assumed)) {
      loops.insert(way.loops.begin(), way.loops.end());
      if (!sends.to_transmission && way.to_transmission) answers = std::max(answers.value_or(0), *way.to_transmission);
    }
    if (!answers) return {};
    answer.loops = {loops.begin(), loops.end()};
    const std::set<std::uint8_t> own = of_answer(port, waits, with_called(by_characters));
    auto silence = longest_silence(port, waits);
    if (!std::ranges::all_of(own, [&](std::uint8_t event) { return !event::is_timed(event) || comes_once(event); }))
      silence.reset();
    answer.silence_is_known = silence.has_value();
    const auto is_other = [&](const Bounds::OfEvent& event) { return !own.contains(event.event); };
    for (const Bounds::OfEvent& event : bounds_.events)
      if (is_other(event) && !has_period(event)) answer.of_others.push_back(event.event);
    answer.loops = with_loops_of_events(answer.loops);
    if (!silence || !disabled_ || !before_enabling_) return answer;
    const auto is_received = [&](std::uint8_t event) { return is_of_port(event, port) && event != kPorts[port].sent; };
    const Time begins =
        std::max(idle.instruction, *disabled_) + longest_routine([&](std::uint8_t event) { return !own.contains(event); });
    Time time = *answers + *silence;
    if (!by_characters.empty()) time += begins + longest_routine(is_received);
    if (waits) time += begins + longest_routine(event::is_timed);
    answer.time = settled(  // with those that wait when the last character comes
        time,
        [begins](const Bounds::OfEvent& event, Time until) {
          const Time waiting = std::max(begins, event.latency.value_or(0) + event.longest_routine);
          return (until + waiting) / *event.period + 1;
        },
        is_other);
    return answer;
  }

  /// The events that do not disturb an answer: those of its port, and if the program waits for silence, the timed interrupts
  /// that measure it. These are the ones that the receiving routines attach; all, if they attach none.
  std::set<std::uint8_t> of_answer(std::size_t port, bool waits, const std::set<std::uint32_t>& by_characters) const {
    std::set<std::uint8_t> own, timed, restarted;
    for (const EventUse& use : calls_.events) {
      if (is_of_port(use.number, port)) own.insert(use.number);
      if (!waits || !event::is_timed(use.number)) continue;
      timed.insert(use.number);
      for (const Attachment& attachment : use.attached)
        if (by_characters.contains(facts_.flow.nodes[attachment.op].routine)) restarted.insert(use.number);
    }
    own.merge(restarted.empty() ? timed : restarted);
    return own;
  }
  /// Whether the routines of a timed interrupt surely detach it. Of one that comes again the program may wait for several.
  bool comes_once(std::uint8_t event) const {
    const auto use = std::ranges::find(calls_.events, event, &EventUse::number);
    const std::vector<bool> nothing(facts_.program.ops.size());
    const auto number_of = [&](const Op& op) { return static_cast<std::uint32_t>(&op - facts_.program.ops.data()); };
    KeptAway detached(facts_.program, facts_.flow, nothing,
                      {.opens = [](const Op&) { return false; },
                       .closes = [&](const Op& op) {
                         return std::ranges::find(use->detached, number_of(op)) != use->detached.end();
                       }});
    return std::ranges::all_of(use->attached, [&](const Attachment& one) {
      return one.routine && detached.behind({.routine = *one.routine});
    });
  }
  bool transmits(const std::set<std::uint32_t>& routines, std::size_t port) const {
    return std::ranges::any_of(routines, [&](std::uint32_t routine) {
      const Routine& of = facts_.flow.routines[routine];
      for (std::uint32_t op = of.first; op < of.end; ++op)
        if (timed_.ops[op].instruction->effect == Effect::Transmits && timed_.ops[op][1].at == port) return true;
      return false;
    });
  }

  const Facts& facts_;
  const Calls& calls_;
  const Program& timed_;
  const StatedLoops& stated_;
  const Waiter& waiter_;
  LongestWays ways_;
  LongestWays::Assumed usual_{};
  std::set<std::uint32_t> open_{};                  // loops without a bound that are executed
  std::map<std::uint32_t, std::int64_t> passes_{};  // the most of others, on ways from where the CPU begins
  Time longest_instruction_ = 0;                    // of the main program, with what it calls
  std::optional<Time> disabled_ = 0;                // for how long at most a DISI of a program with interrupts does
  std::optional<Time> before_enabling_ = 0;         // from the first ATCH to the first ENI
  Bounds bounds_{};
};

}  // namespace

bool is_loop(const Program& program, std::uint32_t op) {
  const Op& of = program.ops[op];
  return kind_of(of) == Structure::For || (kind_of(of) == Structure::Jump && of.target <= op);
}

Bounds bounds_of(const Facts& facts, const Calls& calls, const Program& timed, const StatedLoops& stated,
                 const Waiter& waiter) {
  return BoundsBuilder(facts, calls, timed, stated, waiter).all();
}

std::vector<Bounds::OfEvent> timed_interrupts(const Facts& facts, const Calls& calls, const Waiter& waiter) {
  const StatedLoops stated;
  return BoundsBuilder(facts, calls, facts.program, stated, waiter).timed();
}

}  // namespace s7200

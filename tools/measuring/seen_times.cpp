#include "tools/measuring/seen_times.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "interpreter/base/split_mix.hpp"
#include "interpreter/cpu/cpu.hpp"
#include "interpreter/program/loading/unread.hpp"

namespace s7200::tools {
namespace {

constexpr EventOwner kCpuOwner{1}, kPortOwner{0};
constexpr Time kRun = 2 * kSecond, kBetween = 3 * kMillisecond;

/// A port that takes the time of a character for each, with nobody on the line.
class TimedPort final : public SerialPort {
 public:
  TimedPort(EventQueue& queue, std::uint8_t number) : queue_(queue), number_(number) {}
  void configure(const SerialFormat& format, Time) override { format_ = format; }
  void enable_receiver(bool enabled, Time) override { receives_ = enabled; }
  void send(std::uint8_t, Time at) override { queue_.schedule(at + format_.character_time(), kPortOwner, number_); }
  void send_break(int bits, Time at) override { queue_.schedule(at + format_.bit_times(bits), kPortOwner, number_); }
  bool receives() const { return receives_; }

 private:
  EventQueue& queue_;
  std::uint8_t number_;
  SerialFormat format_{};
  bool receives_ = false;
};

class Watcher final : public TraceSink {
 public:
  explicit Watcher(SeenTimes& seen) : seen_(seen) {}
  void record(const TraceRecord& record) override {
    if (record.kind == TraceKind::ServiceBegin) waited_ = record.at - record.since;
    if (record.kind != TraceKind::ServiceEnd) return;
    SeenTimes::OfEvent& event = seen_.events[record.event];
    event.latency = std::max(event.latency, waited_);
    event.longest_routine = std::max(event.longest_routine, record.at - record.since);
  }

 private:
  Time waited_ = 0;  // of the interrupt that is served
  SeenTimes& seen_;
};

}  // namespace

TimeTable slowest(const TimeTable& times) {
  return times.with([](TimeRow& row) {
    row.base = static_cast<Time>(std::ceil(range_of_base(row).most));
    row.per_unit = static_cast<Time>(std::ceil(range_of_unit(row).most));
  });
}

std::optional<SeenTimes> seen_times(const Inspection& inspection) {
  if (inspection.has_errors || has_unread(*inspection.program)) return {};
  SeenTimes seen{kRun, 0, {}};
  Watcher watcher(seen);
  EventQueue queue;
  std::deque<TimedPort> ports;
  Ports of_cpu{};
  for (std::uint8_t number = 0; number < kPorts.size(); ++number) of_cpu[number] = &ports.emplace_back(queue, number);
  Cpu cpu(inspection.program, queue, kCpuOwner, of_cpu);
  cpu.set_sink(&watcher);
  cpu.power_up();
  std::uint64_t chance = 1;
  Time next = kBetween;
  while (cpu.time() < kRun && cpu.state().mode == Mode::Run) {
    if (inspection.waiter.asks_to_end()) return {};
    cpu.run(std::min(next, kRun));
    while (queue.next() <= cpu.time()) {
      const Event event = queue.pop();
      event.owner == kCpuOwner ? cpu.handle(event) : cpu.character_sent(event.at, event.what);
    }
    if (cpu.time() < next) continue;
    const std::uint64_t drawn = draw_split_mix(chance);
    cpu.set_input(0, static_cast<std::uint8_t>(drawn), cpu.time());
    cpu.set_input(1, static_cast<std::uint8_t>(drawn >> 8), cpu.time());
    const ReceivedCharacter character{
        .byte = static_cast<std::uint8_t>(drawn >> 16), .start = cpu.time(), .end = cpu.time()};
    for (std::uint8_t number = 0; number < kPorts.size(); ++number)
      if (ports[number].receives()) cpu.character_received(character, number);
    next += kBetween;
  }
  seen.scan = cpu.state().longest_scan;
  return seen;
}

}  // namespace s7200::tools

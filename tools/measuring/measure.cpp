#include "tools/measuring/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <ostream>
#include <stdexcept>
#include <streambuf>

#include "interpreter/analysis/effects/looks.hpp"
#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "serial_sim/modbus/request.hpp"
#include "serial_sim/peers/quiet_time.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/host/process.hpp"
#include "tools/measuring/long_listing.hpp"
#include "tools/measuring/mixed_program.hpp"
#include "tools/views/program/check_report.hpp"

namespace s7200::tools {
namespace {

struct HostClock {
  using duration = std::chrono::nanoseconds;

  static duration now() { return processor_time(); }
};

constexpr EventOwner kUart{0}, kCpu{1};

/// Work done and the processor time it took.
struct Lap {
  double work = 0;
  HostClock::duration time{};
};

template <class Work>
Lap timed(Work work) {
  const auto begin = HostClock::now();
  const double done = work();
  return {done, HostClock::now() - begin};
}

/// The result of the best round: it shows what the machine can do, not what else it was doing. There is one alone if it
/// takes as long as all of them should. Windows counts processor time in steps of 10 to 16 ms: a round ends when it has come
/// to one.
template <class Round>
double best_rate(const Effort& effort, Round round) {
  const std::chrono::nanoseconds each(effort.each / kRounds);
  double best = 0;
  Lap sum;
  for (int i = 0; i < kRounds && sum.time.count() < effort.each && !effort.stop.stop_requested(); ++i) {
    sum = {};
    const auto begin = HostClock::now();
    while ((HostClock::now() - begin < each || sum.time.count() <= 0) && !effort.stop.stop_requested()) {
      const Lap lap = round();
      sum.work += lap.work;
      sum.time += lap.time;
    }
    best = std::max(best, sum.work / std::chrono::duration<double>(sum.time).count());
  }
  return best;
}

/// Adds a figure, unless its measurement was stopped before all rounds.
void add(std::vector<Figure>& figures, Figure figure, const Effort& effort) {
  if (!effort.stop.stop_requested()) figures.push_back(std::move(figure));
}

const serial::Frame& ten_registers() {
  static const serial::Frame kRequest = serial::to_frame(modbus::rtu_frame(1, modbus::read_holding_registers(0, 10)));
  return kRequest;
}

/// Characters straight into the CPU, at the pace of the line but without its levels: what the interpreter alone costs.
class CharacterPort final : public SerialPort {
 public:
  explicit CharacterPort(EventQueue& queue) : queue_(queue) {}
  void configure(const SerialFormat& format, Time) override { format_ = format; }
  void enable_receiver(bool, Time) override {}
  void send(std::uint8_t, Time at) override { queue_.schedule(at + format_.character_time(), kUart, kSent); }
  void send_break(int, Time) override {}

  void request(Time at) {
    next_ = 0;
    queue_.schedule(at, kUart, kReceived);
  }

  /// Handles an event. Returns true when an answer has ended.
  bool handle(Cpu& cpu, const Event& event) {
    if (event.what == kSent) {
      cpu.character_sent(event.at);
      return !cpu.state().port[0].transmitting;
    }
    const std::uint8_t byte = ten_registers()[next_++].byte;
    if (next_ < ten_registers().size()) queue_.schedule(event.at + format_.character_time(), kUart, kReceived);
    cpu.character_received({.byte = byte, .start = event.at, .end = event.at});
    return false;
  }

 private:
  enum What : std::uint8_t { kReceived, kSent };
  EventQueue& queue_;
  SerialFormat format_;
  std::size_t next_ = 0;
};

/// A port with nothing connected to it.
class IdlePort final : public SerialPort {
  void configure(const SerialFormat&, Time) override {}
  void enable_receiver(bool, Time) override {}
  void send(std::uint8_t, Time) override {}
  void send_break(int, Time) override {}
};

/// A CPU that is asked for 10 registers again and again.
class Serving {
 public:
  /// The longest exchange: at 300 baud the request and the answer take 1.2 s.
  static constexpr Time kLongestExchange = 10 * kSecond;

  explicit Serving(std::shared_ptr<const Program> program)
      : port_(queue_), cpu_(std::move(program), queue_, kCpu, {&port_, &idle_port_}) {
    cpu_.power_up();
    run_until(kSecond);
  }

  /// Runs one exchange and returns the number of instructions, idle scans included.
  double operator()() {
    const std::uint64_t before = cpu_.state().instructions;
    port_.request(cpu_.time());
    answered_ = false;
    const Time latest = cpu_.time() + kLongestExchange;
    while (!answered_ && cpu_.time() < latest) step(latest);
    if (!answered_) throw std::runtime_error("the program did not answer a request for 10 registers");
    run_until(cpu_.time() + serial::default_quiet(cpu_.state().port[0].format));
    return static_cast<double>(cpu_.state().instructions - before);
  }

 private:
  void run_until(Time end) {
    while (cpu_.time() < end) step(end);
  }
  void step(Time end) {
    cpu_.run(end);
    while (queue_.next() <= cpu_.time()) {
      const Event event = queue_.pop();
      if (event.owner == kCpu)
        cpu_.handle(event);
      else
        answered_ |= port_.handle(cpu_, event);
    }
  }

  EventQueue queue_;
  CharacterPort port_;
  IdlePort idle_port_;
  Cpu cpu_;
  bool answered_ = false;
};

/// Runs an exchange on the whole line, with its master.
void exchange(serial::Simulation& simulation) {
  constexpr std::size_t kAnswer = 25;
  simulation.master().start({.frame = ten_registers()}, simulation.time());
  const Bytes answer = simulation.finish_exchange().response_bytes();
  if (answer.size() != kAnswer || !modbus::crc_ok(answer))
    throw std::runtime_error("the program did not answer a request for 10 registers");
  simulation.run_until(simulation.time() + serial::default_quiet(simulation.freeport().format));
}

/// Several first scans at once, so that reading the clock does not count; nor does the power-up in front of each, which
/// clears all memory: it is timed by itself and taken off.
Lap first_scans(serial::Simulation& simulation, const serial::Simulation::Snapshot& fresh) {
  constexpr int kScans = 32;
  const auto power_up = [&] {
    simulation.restore(fresh);  // the line is idle again
    simulation.power_up();
  };
  simulation.cpu().pause_at_scan_end(true);
  const Lap with = timed([&] {
    double work = 0;
    for (int i = 0; i < kScans; ++i) {
      power_up();
      simulation.run_until(10 * kSecond);
      work += static_cast<double>(simulation.cpu().state().instructions);
    }
    return work;
  });
  const Lap without = timed([&] {
    for (int i = 0; i < kScans; ++i) power_up();
    return 0.0;
  });
  simulation.cpu().pause_at_scan_end(false);
  return {with.work, with.time - without.time};
}

/// Measures idle scans, each of which is run.
double idle_scans(serial::Simulation& simulation) {
  const std::uint64_t before = simulation.cpu().state().instructions;
  simulation.run_until(simulation.time() + kSecond);
  return static_cast<double>(simulation.cpu().state().instructions - before);
}

/// Simulated seconds: 100 minutes, or fewer of a program whose scans cannot be passed over.
double idle_minutes(serial::Simulation& simulation) {
  constexpr Time kMinute = 60 * kSecond;
  const auto begin = HostClock::now();
  int minutes = 0;
  for (; minutes < 100 && HostClock::now() - begin < std::chrono::milliseconds(20); ++minutes)
    simulation.run_until(simulation.time() + kMinute);
  return minutes * static_cast<double>(kMinute) / static_cast<double>(kSecond);
}

/// A minute with an exchange in each second; its seconds.
double polled_minute(serial::Simulation& simulation) {
  constexpr int kPolls = 60;
  for (int poll = 0; poll < kPolls; ++poll) {
    const Time next = simulation.time() + kSecond;
    exchange(simulation);
    simulation.run_until(next);
  }
  return kPolls;
}

/// Takes what is written a block at a time, as a file does.
class Nowhere final : public std::streambuf {
 public:
  Nowhere() { setp(block_.data(), block_.data() + block_.size()); }

 protected:
  int_type overflow(int_type c) override {
    setp(block_.data(), block_.data() + block_.size());
    return traits_type::not_eof(c);
  }

 private:
  std::array<char, 8192> block_{};
};

/// Measures `work` while a trace of it is written and thrown away.
template <class Work>
double traced(serial::Simulation& simulation, const std::shared_ptr<const Program>& program, TraceDetail detail,
              const Effort& effort, Work work) {
  Nowhere nowhere;
  std::ostream out(&nowhere);
  TextTrace trace(out, program, detail);
  simulation.cpu().set_sink(&trace);
  const double rate = best_rate(effort, [&] { return timed([&] { return work(simulation); }); });
  simulation.cpu().set_sink(nullptr);
  return rate;
}

/// A second, in which an input changes ten times.
double mixed_scans(serial::Simulation& simulation) {
  Cpu& cpu = simulation.cpu();
  const std::uint64_t before = cpu.state().instructions;
  for (std::uint8_t inputs = 0; inputs < 10; ++inputs) {
    cpu.set_input(0, inputs, cpu.time());
    simulation.run_until(cpu.time() + 100 * kMillisecond);
  }
  return static_cast<double>(cpu.state().instructions - before);
}

}  // namespace

std::vector<Figure> measure(const std::shared_ptr<const Program>& program, const Effort& effort) {
  serial::Simulation simulation(program);
  const serial::Simulation::Snapshot fresh = simulation.snapshot();
  std::vector<Figure> figures;
  add(figures, {"first scan", "instructions", best_rate(effort, [&] { return first_scans(simulation, fresh); })}, effort);

  simulation.restore(fresh);
  simulation.power_up();
  const auto quiet = [&] { return serial::default_quiet(simulation.freeport().format); };
  simulation.run_until_ready(quiet, 60 * kSecond);
  simulation.configure_master(simulation.freeport().format);
  exchange(simulation);  // fails for a program that is not such a slave
  simulation.cpu().use_steady_scans(SteadyScansUse::Off);
  add(figures,
      {"idle scans", "instructions", best_rate(effort, [&] { return timed([&] { return idle_scans(simulation); }); })},
      effort);
  simulation.cpu().use_steady_scans(kUsualUse);
  add(figures,
      {"nobody talking", "seconds", best_rate(effort, [&] { return timed([&] { return idle_minutes(simulation); }); })},
      effort);

  Serving serving(program);
  add(figures, {"serving requests", "instructions", best_rate(effort, [&] { return timed([&] { return serving(); }); })},
      effort);

  const auto one_exchange = [](serial::Simulation& asked) { return exchange(asked), 1.0; };
  const double exchanges = best_rate(effort, [&] { return timed([&] { return one_exchange(simulation); }); });
  add(figures, {"10 registers, whole line", "exchanges", exchanges}, effort);
  const double with_events = traced(simulation, program, TraceDetail::Events, effort, one_exchange);
  add(figures, {"the same, events traced", "times as long", 0, exchanges / with_events}, effort);
  constexpr double kDay = 86'400;
  add(figures,
      {"a day, polled every second", "s", 0,
       kDay / best_rate(effort, [&] { return timed([&] { return polled_minute(simulation); }); })},
      effort);
  simulation.cpu().use_steady_scans(SteadyScansUse::Off);
  add(figures, {"instruction trace", "lines", traced(simulation, program, TraceDetail::Instructions, effort, idle_scans)},
      effort);
  return figures;
}

std::vector<Figure> measure_mixed(const Effort& effort) {
  const CpuModel& model = cpu226xm();
  std::vector<Figure> figures;
  for (const std::uint32_t instructions : kMixedLengths) {
    serial::Simulation simulation(check_text(mixed_program(instructions), "mixed.stl", model, default_times(model)).program);
    simulation.cpu().use_steady_scans(SteadyScansUse::Off);
    simulation.power_up();
    add(figures,
        {fmt::format("{} instructions, mixed", instructions), "instructions",
         best_rate(effort, [&] { return timed([&] { return mixed_scans(simulation); }); })},
        effort);
  }
  return figures;
}

std::vector<Figure> measure_tip_like(const Effort& effort, bool every_scan) {
  constexpr std::string_view kText = R"(
LD SM0.1
CALL 50
LD M31.7
CALL 51
R M31.7, 1
MEND
SBR 50
LD SM0.0
MOVB 16#49, SMB30
MOVD &VB3000, VD20
FOR VW10, 0, 255
LD SM0.0
WDR
MOVW VW10, VW12
FOR VW14, 1, 8
LD SM0.0
SRW VW12, 1
LD SM1.1
XORW 16#A001, VW12
NEXT
LD SM0.0
MOVW VW12, *VD20
+D 2, VD20
NEXT
LD SM0.0
ATCH 0, 8
ENI
RET
SBR 51
LD SM0.0
XMT VB0, 0
RET
INT 0
LD SM0.0
MOVB SMB2, VB1
MOVB 1, VB0
S M31.7, 1
RETI
)";
  const CpuModel& model = cpu214();
  const auto program = check_text(kText, "tip_like.stl", model, default_times(model)).program;
  serial::Simulation simulation(every_scan ? with_every_scan(*program) : program);
  simulation.power_up();
  simulation.run_until(10 * kSecond);
  assert(simulation.cpu().state().mode == Mode::Run);  // one in STOP costs nothing
  std::vector<Figure> figures;
  add(figures,
      {"nobody talking, tip-like", "seconds",
       best_rate(effort, [&] { return timed([&] { return idle_minutes(simulation); }); })},
      effort);
  return figures;
}

std::vector<Figure> measure_files(const Effort& effort) {
  constexpr std::uint32_t kLines = 100'000;
  const std::string listing = long_listing(kLines);
  const CpuModel& model = cpu226xm();
  const TimeTable times = default_times(model);
  const auto check_listing = [&] {
    const auto text = read_source(listing, "long.stl");
    const CheckResult result = check(text->parsed, model, times);
    return static_cast<double>(kLines * (fine_for(*text, result, model).empty() ? 1 : 0));
  };
  std::vector<Figure> figures;
  add(figures, {"check, 100000 lines", "lines", best_rate(effort, [&] { return timed(check_listing); })}, effort);
  return figures;
}

std::vector<Figure> measure_start(const std::string& command, const Effort& effort) {
  using Clock = std::chrono::steady_clock;
  using Milliseconds = std::chrono::duration<double, std::milli>;
  Milliseconds best = Milliseconds::max();
  const auto end = Clock::now() + std::chrono::nanoseconds(effort.each);
  do {
    const auto begin = Clock::now();
    const StartedProcess started({command, "instructions", "LD"});
    if (!started.wait_for_output() && !effort.stop.stop_requested())
      throw std::runtime_error(command + " was started and printed nothing");
    best = std::min<Milliseconds>(best, Clock::now() - begin);
  } while (Clock::now() < end && !effort.stop.stop_requested());
  std::vector<Figure> figures;
  add(figures, {"start to first output", "ms", 0, best.count()}, effort);
  return figures;
}

}  // namespace s7200::tools

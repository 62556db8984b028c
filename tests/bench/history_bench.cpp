// How fast the past is reached: `history_bench [MINUTES]`, from build/release. Our slave is asked for as long, simulated,
// and then visited at random moments, and backwards instruction by instruction.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <random>

#include "interpreter/analysis/warnings/check.hpp"
#include "serial_sim/modbus/request.hpp"
#include "tests/support/source_path.hpp"
#include "tools/host/files/files.hpp"
#include "tools/session/past/history.hpp"
#include "tools/session/stops/stepper.hpp"

namespace {

using namespace s7200;
using namespace s7200::tools;
using Clock = std::chrono::steady_clock;

struct StopAfter final : Observer {
  explicit StopAfter(const Cpu& watched) : cpu(watched) {}
  bool before(std::uint32_t) override { return cpu.time() < until; }
  bool wants_instructions() const override { return true; }
  const Cpu& cpu;
  Time until = 0;
};

struct Figures {
  double sum = 0, most = 0;
  int count = 0;

  template <class Work>
  void time(Work work) {
    const auto begin = Clock::now();
    work();
    const double took = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
    sum += took;
    most = std::max(most, took);
    ++count;
  }
  void print(std::string_view what) const {
    fmt::print("  {:<28} {:8.3f} ms on average, {:8.3f} ms at most, of {}\n", what, sum / count, most, count);
  }
};

}  // namespace

int main(int argc, char** argv) {
  const double minutes = argc > 1 ? std::atof(argv[1]) : 10;
  const Time end = static_cast<Time>(minutes * 60 * static_cast<double>(kSecond));
  const auto text = tools::read_file(test::source_path("stl_programs/modbus_slave.stl"));
  if (!text) return fmt::print(stderr, "{}\n", text.why()), 2;
  serial::Simulation simulation(check_text(*text, "slave", cpu214(), default_times(cpu214())).program);
  simulation.power_up();
  History history(simulation, {});
  StopAfter stop(simulation.cpu());
  const serial::Frame request = serial::to_frame(modbus::rtu_frame(1, modbus::read_holding_registers(0, 10)));
  Figures run;
  run.time([&] {
    for (stop.until = 100 * kMillisecond; stop.until < end; stop.until += 60 * kMillisecond) {
      history.run(stop);
      history.act(SendFrame{SerialFormat{9600, 8, Parity::Even, 1}, {.frame = request, .silence = {}}});
    }
  });
  const History::Usage usage = history.usage();
  fmt::print("{:.1f} min of a slave that is always asked: {} instructions, run in {:.1f} s\n", minutes,
             simulation.cpu().state().instructions, run.sum / 1e3);
  fmt::print("  {} checkpoints, one every {} or more, {:.1f} MB in all, {:.1f} KB each\n", usage.checkpoints,
             format_duration(usage.interval), static_cast<double>(usage.bytes) / 1e6,
             static_cast<double>(usage.bytes) / 1e3 / static_cast<double>(usage.checkpoints));
  std::mt19937_64 chance(1);
  const Time newest = history.newest().time;
  Figures random, back;
  for (int i = 0; i < 2000; ++i)
    random.time([&] { history.go_to(static_cast<Time>(chance() % static_cast<std::uint64_t>(newest))); });
  random.print("to a random moment");
  Stepper stepper(history, StopToken());
  for (int i = 0; i < 500; ++i) {
    if (i % 50 == 0) history.go_to(static_cast<Time>(chance() % static_cast<std::uint64_t>(newest)));
    back.time(
        [&] { stepper.run_back([](const State&, std::uint32_t, const Stepper::Progress&) { return true; }, 1, false); });
  }
  back.print("back by an instruction");
  return 0;
}

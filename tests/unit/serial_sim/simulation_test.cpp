// A simulation ends early when it is asked to, wherever it is.
#include "serial_sim/system/simulation.hpp"

#include <random>
#include <sstream>

#include "interpreter/trace/text/text_trace.hpp"
#include "tests/support/slave_bench.hpp"

namespace s7200::serial::simulation_test {
namespace {

constexpr const char* kSilent = "LD SM0.0\nMEND\n";
constexpr const char* kEndless = "LD SM0.0\nLBL 1\nWDR\nJMP 1\nMEND\n";

/// Asks to stop when the CPU has come so far.
class StopAt final : public TraceSink {
 public:
  StopAt(const Simulation& simulation, Time at) : simulation_(simulation), at_(at) {}
  void record(const TraceRecord&) override {}
  void instruction(const InstructionRecord&) override {}
  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t) override {
    if (simulation_.time() >= at_) request = true;
    return true;
  }
  std::atomic<bool> request = false;

 private:
  const Simulation& simulation_;
  Time at_;
};

struct Stopping {
  explicit Stopping(const char* text) : simulation(test::compile(text)), stop(simulation, 2 * kSecond) {
    simulation.cpu().set_sink(&stop);
    simulation.stop_when(StopToken(stop.request));
    simulation.power_up();
  }
  bool stopped_in_time() const { return simulation.time() >= 2 * kSecond && simulation.time() < 3 * kSecond; }

  Simulation simulation;
  StopAt stop;
};

TEST(SimulationStop, ARunWithoutEndComesBack) {
  Stopping s(kSilent);
  EXPECT_EQ(s.simulation.run_until(kNever), Halt::Request);
  EXPECT_TRUE(s.stopped_in_time());
  EXPECT_EQ(s.simulation.run_until(kNever), Halt::Request) << "as long as it is asked to";
}

TEST(SimulationStop, AnExchangeWhoseAnswerIsWaitedForForYearsComesBackUnfinished) {
  Stopping s(kSilent);
  s.simulation.master().start({.frame = serial::to_frame(Bytes{1, 2, 3}), .timeout = kNever / 2}, 0);
  s.simulation.finish_exchange();
  EXPECT_TRUE(s.stopped_in_time());
  EXPECT_TRUE(s.simulation.master().busy());
}

TEST(SimulationStop, AFirstScanThatNeverEndsComesBack) {
  Stopping s(kEndless);
  EXPECT_FALSE(s.simulation.run_until_ready(kMillisecond, kNever));
  EXPECT_TRUE(s.stopped_in_time());
}

TEST(SimulationStop, AsLongAsNoOneAsksNothingChanges) {
  const auto state_after = [](bool may_be_asked) {
    Simulation simulation(test::compile(test::slave_text()));
    const std::atomic<bool> never = false;
    if (may_be_asked) simulation.stop_when(StopToken(never));
    simulation.power_up();
    EXPECT_EQ(simulation.run_until(kSecond), Halt::Time);
    simulation.configure_master(simulation.cpu().state().port[0].format);
    simulation.master().start({.frame = serial::to_frame(Bytes{1, 3, 0, 0, 0, 1, 0x84, 0x0A})}, simulation.time());
    EXPECT_FALSE(simulation.finish_exchange().response.empty());
    return simulation.snapshot();
  };
  EXPECT_TRUE(state_after(true) == state_after(false));
}

TEST(SimulationTrace, ATraceWithItsReasonsChangesNothingOfTheRun) {
  const auto program = test::compile(test::slave_text());
  const auto state_after = [&](TraceSink* trace) {
    Simulation simulation(program);
    simulation.cpu().set_sink(trace);
    simulation.power_up();
    simulation.run_until(kSecond);
    simulation.configure_master(simulation.cpu().state().port[0].format);
    simulation.host_port().attach(simulation.cpu().state().port[0].format, simulation.time());
    const HostCharacter character{.byte = 0x55, .format = simulation.cpu().state().port[0].format};
    for (const std::uint8_t last : Bytes{0x0A, 0x0B, 0x0A}) {
      simulation.master().start({.frame = to_frame(Bytes{1, 3, 0, 0, 0, 1, 0x84, last})}, simulation.time());
      simulation.run_until(simulation.time() + 27 * kMillisecond);
      simulation.host_port().send({&character, 1}, simulation.time());  // while it sends
      simulation.finish_exchange();
    }
    simulation.run_until(simulation.time() + kSecond);
    return simulation.snapshot();
  };
  std::ostringstream out, all;
  TextTrace trace(out, program, TraceDetail::Way), instructions(all, program, TraceDetail::Instructions);
  const auto untraced = state_after(nullptr);
  EXPECT_TRUE(state_after(&trace) == untraced);
  EXPECT_TRUE(state_after(&instructions) == untraced);
  for (const char* said : {"main program: ", "no answer to 8 characters", "the receiver is off while the port sends"})
    EXPECT_NE(out.str().find(said), std::string::npos) << said << '\n' << out.str();
}

/// Requests at random, right and wrong ones, with and without a trace of events.
TEST(SimulationScans, EventsOfTheMasterThatAreHandledAheadOfAnIdleCpuChangeNothing) {
  const auto program = test::compile(test::slave_text());
  for (const bool traced : {false, true}) {
    std::ostringstream with_text, without_text;
    TextTrace with_trace(with_text, program, TraceDetail::Events), without_trace(without_text, program, TraceDetail::Events);
    Simulation with(program), without(program);
    if (traced) {
      with.cpu().set_sink(&with_trace);
      without.cpu().set_sink(&without_trace);
    }
    with.cpu().use_steady_scans(SteadyScansUse::Eager);
    without.cpu().use_steady_scans(SteadyScansUse::Off);
    std::mt19937 draw(7200);
    const auto below = [&](unsigned n) { return static_cast<std::uint8_t>(draw() % n); };
    const auto both = [&](auto what) { what(with), what(without); };
    both([](Simulation& each) {
      each.power_up();
      each.run_until(kSecond);
      each.configure_master(each.cpu().state().port[0].format);
    });
    int answered = 0;
    for (int i = 0; i < 200; ++i) {
      const Bytes pdu{static_cast<std::uint8_t>(1 + below(7)), 0, below(20), 0, below(12)};
      Request request{.frame = to_frame(modbus::rtu_frame(below(8) == 0 ? 2 : 1, pdu)), .timeout = 100 * kMillisecond};
      request.frame.back().wrong_parity = below(10) == 0;
      if (below(4) == 0) request.gap = below(200) * 50 * kMicrosecond;
      const Time pause = below(5) == 0 ? below(255) * 9 * kMillisecond : 4 * kMillisecond + below(255) * 13 * kMicrosecond;
      const bool stops_early = below(6) == 0;
      both([&](Simulation& each) {
        each.master().start(request, each.time());
        if (stops_early) each.run_until(each.time() + pause);
        each.finish_exchange();
      });
      ASSERT_TRUE(with.snapshot() == without.snapshot()) << "after exchange " << i;
      both([&](Simulation& each) { each.run_until(each.time() + pause); });
      ASSERT_TRUE(with.snapshot() == without.snapshot()) << "after the pause " << i;
      answered += !with.master().exchange().response.empty();
    }
    EXPECT_GT(answered, 100);
    EXPECT_EQ(with_text.str(), without_text.str());
    EXPECT_GT(with.cpu().passed_over(), 10 * kSecond);
  }
}

}  // namespace
}  // namespace s7200::serial::simulation_test

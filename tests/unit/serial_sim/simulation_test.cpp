// A simulation ends early when it is asked to, wherever it is.
#include "serial_sim/system/simulation.hpp"

#include <sstream>

#include "interpreter/trace/text_trace.hpp"
#include "tests/support/slave_bench.hpp"

namespace s7200::serial {
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

}  // namespace
}  // namespace s7200::serial

// The past of a system: all stations go back, and come again, in one time.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "interpreter/base/bytes.hpp"
#include "tests/unit/debugger/system_bench.hpp"
#include "tools/session/causes/last/last_write.hpp"
#include "tools/session/past/history.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/stops/stepper.hpp"

namespace s7200::tools::system_history_test {
namespace {

using Snapshot = serial::System::Snapshot;

SetMemory assignment(const std::string& text) { return {{*parse_assignment(text, cpu214())}}; }

struct Deed {
  std::uint64_t at;  ///< instructions of all stations
  std::size_t station;
  Action action;
};

const std::vector<Deed>& deeds() {
  static const std::vector<Deed> kDeeds{{2'000, kSlave1, assignment("VW20=16#1234")},
                                        {9'000, kMaster, assignment("VB100=7")},
                                        {9'000, kSlave2, assignment("VW20=5")},
                                        {30'000, kSlave1, InjectFault{serial::parse_fault("flip:character=3,bit=5").fault}},
                                        {40'000, kSlave2, InjectFault{}},
                                        {45'000, kSlave1, SetPower{false}},
                                        {52'000, kSlave1, SetPower{true}}};
  return kDeeds;
}
constexpr std::uint64_t kEnd = 90'000;

/// The parts that differ, in words.
std::string difference(const Snapshot& is, const Snapshot& expected) {
  std::string text;
  for (std::size_t i = 0; i < is.plcs.size(); ++i) {
    const auto &a = is.plcs[i], &b = expected.plcs[i];
    if (!(a.cpu == b.cpu))
      text += fmt::format("CPU {}: {} ns, {} instructions; expected {} ns, {}\n", i, a.cpu.time, a.cpu.instructions,
                          b.cpu.time, b.cpu.instructions);
    if (!(a.uart == b.uart)) text += fmt::format("UARTs {}\n", i);
    if (!(a.actions == b.actions)) text += fmt::format("actions of ports {}\n", i);
    if (!(a.field == b.field)) text += fmt::format("field {}\n", i);
    if (a.powered != b.powered || a.executed_before != b.executed_before) text += fmt::format("power {}\n", i);
  }
  for (std::size_t i = 0; i < is.queues.size(); ++i)
    if (!(is.queues[i] == expected.queues[i])) text += fmt::format("queue {}\n", i);
  if (!(is.lines == expected.lines)) text += "lines\n";
  if (!(is.requesters == expected.requesters)) text += "requesters\n";
  if (is.clock != expected.clock || is.done != expected.done) text += "what was scheduled\n";
  return text;
}

/// Runs forwards only, in step.
class Forwards {
 public:
  explicit Forwards(SystemBench& bench) : bench_(bench) {}

  void run_to(std::uint64_t instructions) {
    Sink sink(bench_, instructions);
    for (serial::Simulation* station : bench_.stations) station->cpu().set_sink(&sink);
    bench_.system().run_in_step(true);
    bench_.system().run_until(kNever);
    for (serial::Simulation* station : bench_.stations) station->cpu().set_sink(nullptr);
  }

  /// With all that is done there, once.
  void live_to(std::uint64_t instructions) {
    run_to(instructions);
    const std::size_t before = actions;
    for (; actions < deeds().size() && deeds()[actions].at == instructions; ++actions)
      perform(deeds()[actions].action, *bench_.stations[deeds()[actions].station]);
    if (actions != before) run_to(instructions);
  }

  std::size_t actions = 0;

 private:
  struct Sink final : TraceSink {
    Sink(const SystemBench& watched, std::uint64_t stop_at) : bench(watched), instructions(stop_at) {}
    bool before(std::uint32_t) override { return bench.executed() < instructions; }
    bool wants_instructions() const override { return true; }
    const SystemBench& bench;
    std::uint64_t instructions;
  };

  SystemBench& bench_;
};

struct StopAtSum final : Observer {
  StopAtSum(const SystemBench& watched, std::uint64_t stop_at) : bench(watched), instructions(stop_at) {}
  bool before(std::uint32_t) override { return bench.executed() < instructions; }
  bool wants_instructions() const override { return true; }
  const SystemBench& bench;
  std::uint64_t instructions;
};

struct Recorded : SystemBench {
  explicit Recorded(Time interval) : history(stations, {.interval = interval}) {}

  void run_to(std::uint64_t instructions) {
    StopAtSum stop(*this, instructions);
    history.run(stop);
  }
  void live_through_it() {
    for (const Deed& deed : deeds()) {
      run_to(deed.at);
      history.act(deed.action, deed.station);
    }
    run_to(kEnd);
  }

  History history;
};

/// Moments and states of a run that only goes forward: at each deed, and at others left to chance.
std::vector<std::pair<Moment, Snapshot>> plain_states(std::mt19937& chance) {
  SystemBench bench;
  Forwards forwards(bench);
  std::vector<std::pair<Moment, Snapshot>> states;
  for (std::uint64_t at = 1; at <= kEnd; ++at) {
    const bool deed_due = forwards.actions < deeds().size() && deeds()[forwards.actions].at == at;
    if (!deed_due && chance() % 300 != 0) continue;
    forwards.live_to(at);
    states.push_back({{at, forwards.actions, true, bench.system().time(), false}, bench.system().snapshot()});
  }
  return states;
}

TEST(SystemHistory, StationsInStepComeToTheStateOfStationsThatRunAheadOfEachOther) {
  SystemBench ahead, in_step;
  in_step.system().run_in_step(true);
  std::mt19937 chance(3);
  for (Time end = 0; end < 500 * kMillisecond; end += static_cast<Time>(1 + chance() % 3'000'000)) {
    ahead.system().run_until(end);
    in_step.system().run_until(end);
    ASSERT_TRUE(ahead.system().snapshot() == in_step.system().snapshot()) << end;
  }
}

TEST(SystemHistory, RandomWalksForwardsAndBackwardsStandWhereAPlainRunStands) {
  const char* const asked = std::getenv("S7200_WALKS");
  const int walks = asked ? std::atoi(asked) : 300;
  std::mt19937 chance(12);
  const auto plain = plain_states(chance);
  Recorded session(10 * kMillisecond);
  session.live_through_it();
  ASSERT_GT(session.system().time(), 400 * kMillisecond) << "power has gone off and come back";
  std::size_t played = 0;
  for (int i = 0; i < walks; ++i) {
    const auto& [moment, state] = plain[chance() % plain.size()];
    session.history.go_to(moment);
    ASSERT_EQ(difference(session.system().snapshot(), state), "")
        << "walk " << i << " to instruction " << moment.instructions;
    ASSERT_TRUE(session.system().snapshot() == state);
    const auto& [next, state_then] = plain[chance() % plain.size()];
    if (next < moment) continue;
    session.run_to(next.instructions);  // plays what has run, as 'continue' does
    if (session.history.now() != next) continue;
    ASSERT_EQ(difference(session.system().snapshot(), state_then), "") << "walk " << i << " on to " << next.instructions;
    ASSERT_TRUE(session.system().snapshot() == state_then);
    ++played;
  }
  EXPECT_GT(played, static_cast<std::size_t>(walks) / 10);
}

TEST(SystemHistory, StepsInBothDirectionsAtAnyStationStandWhereAPlainRunStands) {
  const char* const asked = std::getenv("S7200_WALKS");
  const int walks = asked ? std::atoi(asked) : 40;
  Recorded session(10 * kMillisecond);
  session.live_through_it();
  Stepper stepper(session.history, StopToken());
  std::mt19937 chance(7);
  for (int i = 0; i < walks; ++i) {
    if (i % 8 == 0) session.history.go_to(static_cast<Time>(60 + chance() % 150) * kMillisecond);
    const std::size_t station = chance() % 3;
    stepper.look_at(station);
    const State& state = session.stations[station]->cpu().state();
    const auto which = chance() % 6, count = 1 + chance() % 100;
    const std::uint64_t before = session.stations[station]->plc().executed();
    if (which == 0)
      stepper.run_back(goal::back_instruction(), count, false);
    else if (which == 1)
      stepper.run_back(goal::back_over(state), count, false);
    else if (which == 2)
      stepper.run_back(goal::back_scan(), 1, false);
    else if (which == 3)
      stepper.run(goal::over(state), kNever, false);
    else if (which == 4)
      stepper.run(goal::scan(state, 1), kNever, false);
    else
      stepper.run(goal::instructions(count), kNever, false);
    const std::uint64_t after = session.stations[station]->plc().executed();
    if (which == 0) {
      ASSERT_EQ(after + count, before) << "walk " << i;
    }
    if (which == 5) {
      ASSERT_EQ(after, before + count) << "walk " << i;
    }
    const Moment now = session.history.now();
    SystemBench bench;
    Forwards forwards(bench);
    for (const Deed& deed : deeds())
      if (forwards.actions < now.actions) forwards.live_to(deed.at);
    forwards.run_to(now.instructions);
    ASSERT_EQ(difference(session.system().snapshot(), bench.system().snapshot()), "")
        << "walk " << i << " to " << now.instructions;
    ASSERT_TRUE(session.system().snapshot() == bench.system().snapshot());
  }
}

TEST(SystemHistory, TheOrderOfMomentsGoesOnWhenPowerComesBack) {
  Recorded session(10 * kMillisecond);
  session.run_to(kEnd);
  Moment before;
  for (const Time time : {200, 260, 320, 331, 340, 400}) {
    session.history.go_to(time * kMillisecond);
    EXPECT_LT(before, session.history.now()) << time;
    EXPECT_GE(session.history.now().time, time * kMillisecond);
    before = session.history.now();
  }
}

TEST(SystemHistory, TheLastWriteIsOneOfTheStationItIsAskedOf) {
  Recorded session(10 * kMillisecond);
  session.run_to(20'000);
  session.history.act(assignment("VB100=7"), kSlave2);
  session.run_to(20'100);
  const MemoryRange range = *parse_range("VB100", cpu214());
  const Snapshot here = session.system().snapshot();
  const auto of_slave = find_last_write(session.history, kSlave2, range, StopToken());
  const auto of_other = find_last_write(session.history, kSlave1, range, StopToken());
  EXPECT_TRUE(session.system().snapshot() == here);
  ASSERT_TRUE(of_slave.write.has_value());
  EXPECT_EQ(of_slave.write->action, 0U);
  EXPECT_FALSE(of_other.write && of_other.write->action);
}

TEST(SystemHistory, ARunEndsAtItsLimitThoughNoCpuExecutesAProgram) {
  SystemBench bench(
      "plcs:\n  slave: {program: ../modbus_slave.stl, copies: 2, station: 1}\n"
      "lines:\n  bus: {stations: [slave]}\n"
      "events:\n  - {at: 100ms, power_off: slave1}\n  - {at: 150ms, power_off: slave2}\n  - {at: 5s, power_on: slave2}\n");
  History history(bench.stations, {});
  Stepper stepper(history, StopToken());
  const Stop stop = stepper.run(goal::none(), kSecond, false);
  EXPECT_EQ(stop.reason, StopReason::Limit);
  EXPECT_EQ(history.now().time, kSecond);
  const Moment idle = history.now();
  EXPECT_EQ(stepper.run(goal::none(), 6 * kSecond, false).reason, StopReason::Limit);
  EXPECT_TRUE(bench.stations[1]->plc().executes());
  history.go_to(idle);
  EXPECT_EQ(history.now(), idle);
  EXPECT_FALSE(bench.stations[1]->plc().executes());
}

}  // namespace
}  // namespace s7200::tools::system_history_test

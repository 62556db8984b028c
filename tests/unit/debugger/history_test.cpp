#include "tools/session/past/history.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <random>
#include <set>

#include "interpreter/base/bytes.hpp"
#include "serial_sim/field/field_script.hpp"
#include "serial_sim/modbus/crc.hpp"
#include "tests/support/slave_bench.hpp"
#include "tools/session/causes/last/last_write.hpp"
#include "tools/session/past/past_words.hpp"
#include "tools/session/stops/goals.hpp"
#include "tools/session/stops/stepper.hpp"
#include "tools/views/program/listing.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools::history_test {
namespace {

using Snapshot = serial::Simulation::Snapshot;

/// Stops in front of the instruction of that number.
struct StopAt final : Observer {
  explicit StopAt(const Cpu& watched, std::uint64_t number) : cpu(watched), instructions(number) {}
  bool before(std::uint32_t) override { return cpu.state().instructions < instructions; }
  bool wants_instructions() const override { return true; }
  Time idles_until(Time now) override { return now; }  // in STOP nothing more is executed
  const Cpu& cpu;
  std::uint64_t instructions;
};

struct CountRecords final : TraceSink {
  void record(const TraceRecord& record) override { times.push_back(record.at); }
  std::vector<Time> times;
};

SendFrame frame(const std::string& hex) {
  return {SerialFormat{9600, 8, Parity::Even, 1}, {.frame = serial::parse_hex_frame(hex).frame, .silence = {}}};
}

SetMemory assignment(const std::string& text) { return {{*parse_assignment(text, cpu214())}}; }

/// What a user may do in a session on the slave, by the instruction in front of which it is done.
const std::vector<std::pair<std::uint64_t, Action>>& deeds() {
  static const std::vector<std::pair<std::uint64_t, Action>> kDeeds{
      {2000, assignment("VW20=16#1234")},
      {6000, frame("0103000a0002e409")},
      {6000, assignment("I0.0=1")},
      {8999, InjectFault{serial::parse_fault("noise:ber=0.01").fault}},
      {9000, frame("0103000a0002e408")},
      {9001, assignment("VB100=7")},
      {12000, assignment("I0.1=1")},
      {13000, SetStack{LogicStack::from_bits(1)}},
      {13500, InjectFault{}}};
  return kDeeds;
}
constexpr std::uint64_t kEnd = 14000;

/// Runs forwards only; its states in front of the instructions asked for, and after each deed.
class Plain final : public Observer {
 public:
  explicit Plain(std::shared_ptr<const Program> program) : simulation(std::move(program)) { simulation.power_up(); }

  void run_to(std::uint64_t instructions) {
    stop_at_ = instructions;
    simulation.cpu().set_sink(this);
    simulation.run_until(kNever);
    simulation.cpu().set_sink(nullptr);
  }
  bool before(std::uint32_t) override { return simulation.cpu().state().instructions < stop_at_; }
  bool wants_instructions() const override { return true; }

  serial::Simulation simulation;

 private:
  std::uint64_t stop_at_ = 0;
};

struct Recorded {
  explicit Recorded(std::shared_ptr<const Program> program, History::Settings settings = {})
      : simulation(std::move(program)) {
    simulation.power_up();
    history = std::make_unique<History>(simulation, std::move(settings));
  }
  void run_to(std::uint64_t instructions) {
    StopAt stop(simulation.cpu(), instructions);
    history->run(stop);
  }
  void live_through_it() {
    for (const auto& [at, deed] : deeds()) {
      run_to(at);
      history->act(deed);
    }
    run_to(kEnd);
  }

  serial::Simulation simulation;
  std::unique_ptr<History> history;
};

std::shared_ptr<const Program> slave() { return test::compile(test::slave_text()); }

TEST(History, StateAtEveryEventOfASessionIsThatOfARunThatOnlyWentForward) {
  const auto program = slave();
  Recorded session(program, {.interval = 20 * kMillisecond});
  session.live_through_it();
  Plain plain(program);
  std::set<std::uint64_t> places;
  for (std::uint64_t at = 0; at <= kEnd; at += at > 5900 && at < 9100 ? 1 : 97) places.insert(at);
  for (const auto& [at, deed] : deeds()) places.insert(at);
  std::size_t actions = 0, compared = 0;
  for (const std::uint64_t at : places) {
    plain.run_to(at);
    const std::size_t before = actions;
    for (; actions < deeds().size() && deeds()[actions].first == at; ++actions)
      perform(deeds()[actions].second, plain.simulation);
    if (actions != before) plain.run_to(at);
    session.history->go_to({.instructions = plain.simulation.cpu().state().instructions,
                            .actions = actions,
                            .settled = true,
                            .time = plain.simulation.time()});
    ASSERT_EQ(session.simulation.snapshot(), plain.simulation.snapshot()) << "in front of instruction " << at;
    ++compared;
  }
  EXPECT_GT(compared, 3000U);
}

/// S7200_WALKS sets how many.
/// The deeds with their moments, and what else a report carries of it.
Recording recording_of_a_session() {
  Recorded session(slave(), {.interval = 20 * kMillisecond});
  session.live_through_it();
  return session.history->recording();
}

TEST(History, AnAdoptedRecordingIsPlayedOnlyAsFarAsOneGoes) {
  const Recording recording = recording_of_a_session();
  Recorded adopted(slave(), {.interval = 20 * kMillisecond});
  adopted.history->adopt(recording);
  EXPECT_EQ(adopted.history->now().time, 0);
  EXPECT_TRUE(adopted.history->in_the_past());
  EXPECT_EQ(adopted.history->newest(), recording.end);
  EXPECT_EQ(adopted.history->usage().checkpoints, 1U);
  adopted.history->go_to(100 * kMillisecond);
  const std::size_t some = adopted.history->usage().checkpoints;
  EXPECT_GE(some, 4U);
  EXPECT_LE(some, 6U);
}

TEST(History, AnAdoptedRecordingHasTheStatesOfTheRunInAnyOrder) {
  Recorded session(slave(), {.interval = 20 * kMillisecond});
  session.live_through_it();
  Recorded adopted(slave(), {.interval = 20 * kMillisecond});
  adopted.history->adopt(session.history->recording());
  const Time end = session.history->newest().time;
  for (const Time time : {end / 2, end, end / 7, end - 1, Time{0}, end / 3}) {
    session.history->go_to(time);
    adopted.history->go_to(time);
    EXPECT_EQ(adopted.history->now(), session.history->now()) << time;
    EXPECT_EQ(adopted.simulation.cpu().state(), session.simulation.cpu().state()) << time;
  }
}

/// What a report carries of a long run.
Recording recording_with_checkpoints(std::size_t most) {
  Recorded session(slave(), {.interval = 20 * kMillisecond});
  session.live_through_it();
  Recording recording = session.history->recording();
  recording.checkpoints = session.history->packed_checkpoints(most);
  return recording;
}

TEST(History, PackedCheckpointsLeaveTheSessionWhereItStands) {
  Recorded session(slave(), {.interval = 20 * kMillisecond});
  session.live_through_it();
  const Moment here = session.history->now();
  const std::vector<std::string> packed = session.history->packed_checkpoints(12);
  EXPECT_GE(packed.size(), 4U);
  EXPECT_LE(packed.size(), 12U);
  EXPECT_EQ(session.history->now(), here);
}

TEST(History, FromPackedCheckpointsARunGoesOnAsFromItsBeginning) {
  Recorded session(slave(), {.interval = 20 * kMillisecond});
  session.live_through_it();
  Recorded adopted(slave(), {.interval = 20 * kMillisecond});
  ASSERT_TRUE(adopted.history->adopt(recording_with_checkpoints(12)));
  const Time end = session.history->newest().time;
  for (Time time = end; time >= 0; time -= end / 97) {
    session.history->go_to(time);
    adopted.history->go_to(time);
    ASSERT_EQ(adopted.history->now(), session.history->now()) << time;
    ASSERT_EQ(adopted.simulation.cpu().state(), session.simulation.cpu().state()) << time;
    ASSERT_EQ(adopted.simulation.master().exchange(), session.simulation.master().exchange()) << time;
    ASSERT_EQ(adopted.simulation.faults().state().injected, session.simulation.faults().state().injected) << time;
  }
}

TEST(History, ARecordingWithCheckpointsIsPlayedFromTheOneBeforeWhatIsLookedAt) {
  Recorded adopted(slave(), {.interval = 5 * kMillisecond});
  const Recording recording = recording_with_checkpoints(12);
  ASSERT_TRUE(adopted.history->adopt(recording));
  const std::size_t given = adopted.history->usage().checkpoints;
  EXPECT_EQ(given, recording.checkpoints.size() + 1);
  adopted.history->go_to(adopted.history->newest().time - 1);
  const Time part = recording.end.time / 13;
  EXPECT_LE(adopted.history->usage().checkpoints, given + static_cast<std::size_t>(4 * part / (5 * kMillisecond)));
}

TEST(History, CheckpointsOfARecordingStayWhenOthersAreThinned) {
  Recorded adopted(slave(), {.bound = 1 << 20, .interval = kMillisecond / 2});
  const Recording recording = recording_with_checkpoints(6);
  ASSERT_TRUE(adopted.history->adopt(recording));
  adopted.history->go_to(adopted.history->newest().time - 1);
  EXPECT_GE(adopted.history->usage().checkpoints, recording.checkpoints.size() + 1);
  EXPECT_GT(adopted.history->usage().interval, kMillisecond / 2);
}

TEST(History, ADamagedCheckpointIsNotTaken) {
  Recording recording = recording_with_checkpoints(6);
  for (const std::size_t place : {std::size_t{0}, std::size_t{20}, recording.checkpoints[0].size() - 1}) {
    Recording damaged = recording;
    damaged.checkpoints[0][place] = static_cast<char>(damaged.checkpoints[0][place] ^ 1);
    Recorded adopted(slave(), {});
    EXPECT_FALSE(adopted.history->adopt(damaged)) << place;
  }
  std::swap(recording.checkpoints[0], recording.checkpoints[1]);
  Recorded adopted(slave(), {});
  EXPECT_FALSE(adopted.history->adopt(recording)) << "not in the order of time";
}

TEST(History, AnAdoptedRecordingKnowsWhoWroteLast) {
  Recorded session(slave(), {.interval = 20 * kMillisecond});
  session.live_through_it();
  Recorded adopted(slave(), {.interval = 20 * kMillisecond});
  adopted.history->adopt(session.history->recording());
  session.history->go_to(session.history->newest());
  adopted.history->go_to(adopted.history->newest());
  for (const char* const name : {"VB100", "VW20", "MB31", "VB4095"}) {
    const auto range = parse_range(name, cpu214());
    const auto expected = find_last_write(*session.history, 0, *range, StopToken()).write;
    const auto found = find_last_write(*adopted.history, 0, *range, StopToken()).write;
    ASSERT_EQ(found.has_value(), expected.has_value()) << name;
    EXPECT_TRUE(!found || found->at == expected->at) << name;
  }
}

TEST(History, FromAnAdoptedRecordingANewBranchBeginsAnywhere) {
  Recorded adopted(slave(), {.interval = 20 * kMillisecond});
  adopted.history->adopt(recording_of_a_session());
  const Time then = adopted.history->newest().time / 2;
  adopted.history->go_to(then);
  adopted.history->act(assignment("VW30=77"));
  EXPECT_FALSE(adopted.history->in_the_past());
  const std::uint64_t here = adopted.simulation.cpu().state().instructions;
  adopted.run_to(here + 3000);
  const State after = adopted.simulation.cpu().state();
  adopted.history->go_to(then / 2);
  adopted.history->go_to(adopted.history->newest());
  EXPECT_EQ(adopted.simulation.cpu().state(), after);
}

/// One that was replayed knows nothing of what was written where, and plays everything.
TEST(History, PartsThatCannotHoldALastWriteAreNotPlayedForItAndItIsTheSame) {
  const auto program = slave();
  std::size_t told = 0, told_of_all = 0;
  Recorded session(program, {.interval = 20 * kMillisecond, .progress = [&] { ++told; }});
  session.live_through_it();
  Recorded replayed(program, {.interval = 20 * kMillisecond, .progress = [&] { ++told_of_all; }});
  ASSERT_TRUE(replayed.history->replay(session.history->recording()));
  std::size_t found = 0;
  told = told_of_all = 0;
  for (const char* const address : {"SMB30", "SMB34", "VW20", "VB100", "VB3570", "VD3570", "VW3300", "VB3301", "VB3580",
                                    "VB3590", "M31.7", "MB0", "VB4090"}) {
    const auto range = parse_range(address, *program);
    ASSERT_TRUE(range) << range.why();
    for (const Time at : {5 * kMillisecond, 800 * kMillisecond, kNever}) {
      session.history->go_to(at);
      replayed.history->go_to(at);
      const auto write = find_last_write(*session.history, 0, *range, StopToken()).write;
      const auto expected = find_last_write(*replayed.history, 0, *range, StopToken()).write;
      ASSERT_EQ(write.has_value(), expected.has_value()) << address;
      if (!write) continue;
      ++found;
      EXPECT_EQ(write->moment, expected->moment) << address;
      EXPECT_EQ(write->at, expected->at);
      EXPECT_EQ(write->action, expected->action);
      EXPECT_EQ(write->by ? write->by->op : 0, expected->by ? expected->by->op : 0);
      EXPECT_EQ(write->after, expected->after);
    }
  }
  EXPECT_GT(found, 12U);
  EXPECT_LT(told, told_of_all * 2 / 3);
}

TEST(WrittenMemory, WhereAPointerACountOrAParameterLedIsKept) {
  const auto writes = [](std::string_view text, const char* address) {
    Recorded session(check_text(text, "test.stl", cpu224(), default_times(cpu224())).program,
                     {.interval = 20 * kMillisecond});
    StopAt stop(session.simulation.cpu(), 4000);
    session.history->run(stop);
    const auto range = parse_range(address, cpu224());
    return session.history->may_have_written(0, *range)(2);
  };
  constexpr std::string_view kPointer = "LD SM0.0\nMOVD &VB100, VD0\nMOVB 7, *VD0\nMEND\n";
  EXPECT_TRUE(writes(kPointer, "VB100"));
  EXPECT_TRUE(writes(kPointer, "VD0"));
  EXPECT_FALSE(writes(kPointer, "VB300"));
  EXPECT_TRUE(writes(kPointer, "VB101")) << "the same block";
  EXPECT_TRUE(writes("LD SM0.0\nBMB VB0, VB200, 100\nMEND\n", "VB290"));
  EXPECT_FALSE(writes("LD SM0.0\nBMB VB0, VB200, 100\nMEND\n", "VB400"));
  EXPECT_FALSE(writes("LD SM0.1\nMOVB 7, VB0\nMEND\n", "VB0")) << "without power flow";
  EXPECT_TRUE(writes("LD SM0.0\nATT VW0, VW100\nMEND\n", "VB900")) << "the entries of a table are not looked at";
  EXPECT_TRUE(writes("LD SM0.0\nRCV VB0, 0\nMEND\n", "VB900")) << "what comes is stored as it comes";
  EXPECT_TRUE(writes("LD SM0.0\nMOVB 7, VB0\nMEND\n", "SMB0")) << "the system writes it";
  EXPECT_FALSE(writes("LD SM0.0\nMOVB 7, VB0\nMEND\n", "SMB30"));
}

TEST(History, RandomWalksForwardsAndBackwardsStandWhereAPlainRunStands) {
  const char* const asked = std::getenv("S7200_WALKS");
  const int walks = asked ? std::atoi(asked) : 10'000;
  const auto program = slave();
  Recorded session(program, {.interval = 10 * kMillisecond});
  session.live_through_it();
  std::vector<std::pair<Moment, Snapshot>> plain;
  Plain forwards(program);
  std::size_t actions = 0;
  std::mt19937 chance(12);
  for (std::uint64_t at = 1; at <= kEnd; ++at) {
    const bool deed_due = actions < deeds().size() && deeds()[actions].first == at;
    if (!deed_due && chance() % 60 != 0) continue;
    forwards.run_to(at);
    for (; actions < deeds().size() && deeds()[actions].first == at; ++actions)
      perform(deeds()[actions].second, forwards.simulation);
    if (deed_due) forwards.run_to(at);
    plain.push_back({{at, actions, true, forwards.simulation.time(), false}, forwards.simulation.snapshot()});
  }
  for (int i = 0; i < walks; ++i) {
    const auto& [moment, state] = plain[chance() % plain.size()];
    session.history->go_to(moment);
    ASSERT_TRUE(session.simulation.snapshot() == state) << "walk " << i << " to instruction " << moment.instructions;
    const auto& [next, state_then] = plain[chance() % plain.size()];
    if (next < moment) continue;
    session.run_to(next.instructions);  // plays what has run, as 'continue' does
    if (session.history->now() != next) continue;
    ASSERT_TRUE(session.simulation.snapshot() == state_then) << "walk " << i << " on to " << next.instructions;
  }
}

/// Of a run that only goes forward, at a moment of the session.
Snapshot plain_state_at(const std::shared_ptr<const Program>& program, const Moment& moment) {
  Plain plain(program);
  for (std::size_t i = 0; i < moment.actions; ++i) {
    plain.run_to(deeds()[i].first);
    perform(deeds()[i].second, plain.simulation);
  }
  plain.run_to(moment.instructions);
  return plain.simulation.snapshot();
}

/// S7200_WALKS sets how many steps.
TEST(History, RandomWalksOfStepsInBothDirectionsStandWhereAPlainRunStands) {
  const char* const asked = std::getenv("S7200_WALKS");
  const int walks = asked ? std::atoi(asked) : 10'000;
  const auto program = slave();
  Recorded session(program, {.interval = 10 * kMillisecond});
  session.live_through_it();
  Stepper stepper(*session.history, StopToken());
  const Cpu& cpu = session.simulation.cpu();
  std::mt19937 chance(12);
  const Listing listing(*program);
  const Time last = session.history->newest().time;
  session.history->go_to(Time{100 * kMillisecond});
  for (int i = 0; i < walks; ++i) {
    const auto which = chance() % 16, count = 1 + chance() % 200;
    const bool ends_soon = session.history->now().instructions + 1000 > kEnd;
    const auto run = [&](const Stepper::Goal& goal) { stepper.run(goal, kNever, false); };
    const auto run_within = [&](const Stepper::Goal& goal) { stepper.run(goal, last, false); };
    const auto some_place = static_cast<std::uint32_t>(chance() % cpu.program().ops.size());
    if (which == 0 || ends_soon)
      stepper.run_back(goal::back_instruction(), ends_soon ? 2000 : count, false);
    else if (which == 1)
      stepper.run_back(goal::back_over(cpu.state()), count, false);
    else if (which == 2)
      stepper.run_back(goal::back_scan(), 1 + count % 3, false);
    else if (which == 3 && goal::is_in_routine(cpu.state()))
      stepper.run_back(goal::back_out(cpu.state()), 1, false);
    else if (which == 4)
      run(goal::over(cpu.state()));
    else if (which == 5)
      run(goal::scan(cpu.state(), 1 + count % 3));
    else if (which == 6 && goal::is_in_routine(cpu.state()))
      run(goal::out(cpu.state()));
    else if (which == 7)
      run_within(goal::network_over(cpu.state(), listing));
    else if (which == 8)
      stepper.run_back(goal::back_network_over(cpu.state(), listing), 1, false);
    else if (which == 9)
      run_within(goal::interrupt_begins(cpu.program()));
    else if (which == 10)
      stepper.run_back(goal::back_interrupt_ends(cpu.program()), 1, false);
    else if (which == 11)
      run_within(goal::place(some_place));
    else if (which == 12)
      stepper.run_back(goal::place(some_place), 1, false);
    else if (which == 13)
      session.history->go_to(static_cast<Time>(chance() % static_cast<std::uint64_t>(last)));
    else
      run(goal::instructions(count));
    if (!session.history->now().settled) run(goal::instructions(1));  // it is at the beginning
    const Moment now = session.history->now();
    ASSERT_TRUE(session.simulation.snapshot() == plain_state_at(program, now))
        << "walk " << i << " in front of instruction " << now.instructions;
  }
}

TEST(History, GoingForwardFromThePastPlaysWhatHasRunAndThenGoesOn) {
  Recorded session(slave());
  session.live_through_it();
  const Snapshot end = session.simulation.snapshot();
  session.history->go_to(Time{0});
  EXPECT_TRUE(session.history->in_the_past());
  session.run_to(kEnd);
  EXPECT_FALSE(session.history->in_the_past());
  EXPECT_TRUE(session.simulation.snapshot() == end);
  session.run_to(kEnd + 500);
  EXPECT_EQ(session.simulation.cpu().state().instructions, kEnd + 500);
}

TEST(History, AnActionInThePastBeginsABranchAndTheOldOneCanBeReturnedTo) {
  Recorded session(slave());
  session.live_through_it();
  const Snapshot end = session.simulation.snapshot();
  const History::Place place = session.history->here();
  session.history->go_to(session.history->action_moments()[0].time + kMillisecond);
  session.history->act(assignment("VW20=16#4321"));
  EXPECT_FALSE(session.history->in_the_past());
  EXPECT_EQ(session.history->actions().size(), 2U);
  session.run_to(kEnd);
  EXPECT_FALSE(session.simulation.snapshot() == end);
  session.history->return_to(place);
  EXPECT_TRUE(session.simulation.snapshot() == end);
}

TEST(History, WhatIsPlayedAgainIsNotRecordedAgain) {
  CountRecords records;
  Recorded session(slave(), {.records = {&records}});
  session.live_through_it();
  const std::size_t before = records.times.size();
  session.history->go_to(Time{0});
  session.run_to(kEnd);
  EXPECT_EQ(records.times.size(), before);
  session.run_to(kEnd + 3000);
  EXPECT_GT(records.times.size(), before);
  EXPECT_TRUE(std::ranges::is_sorted(records.times));
}

TEST(History, CheckpointsAreThinnedWithinTheirBoundAndEveryMomentStaysReachable) {
  constexpr std::size_t kBound = 1 << 20;
  Recorded session(slave(), {.bound = kBound, .interval = kMillisecond});
  session.live_through_it();
  const Snapshot end = session.simulation.snapshot();
  const History::Usage usage = session.history->usage();
  EXPECT_LE(usage.bytes, kBound);
  EXPECT_GT(usage.checkpoints, 5U);
  EXPECT_GT(usage.interval, kMillisecond);
  EXPECT_EQ(usage.oldest.time, 0);
  const Moment newest = session.history->newest();
  session.history->go_to(usage.oldest);
  EXPECT_EQ(session.simulation.time(), 0);
  session.history->go_to(newest);
  EXPECT_TRUE(session.simulation.snapshot() == end);
}

TEST(History, AStoppedCpuIsPartOfThePast) {
  const auto program = test::compile("LD SM0.0\nINCW VW0\nLDW= VW0, 5\nSTOP\nMEND\n");
  Recorded session(program, {.interval = kMillisecond});
  session.run_to(1'000'000);
  ASSERT_EQ(session.simulation.cpu().state().mode, Mode::Stop);
  const Snapshot stopped = session.simulation.snapshot();
  const Moment end = session.history->newest();
  session.history->go_to(Time{2 * kMillisecond});
  EXPECT_EQ(session.simulation.cpu().state().mode, Mode::Run);
  session.run_to(1'000'000);
  EXPECT_TRUE(session.simulation.snapshot() == stopped);
  session.history->go_to(Time{0});
  session.history->go_to(end);
  EXPECT_TRUE(session.simulation.snapshot() == stopped);
}

TEST(History, TheFieldGoesBackTooAndComesAgain) {
  const auto program = test::compile("LD I0.0\nEU\nINCW VW0\nMEND\n");
  std::vector<std::string> errors;
  const auto field = serial::parse_field_script("5ms,I0.0,1\n10ms,I0.0,pulses,200Hz,100ms\n", "field.csv", cpu214(), errors);
  ASSERT_TRUE(errors.empty());
  serial::Simulation plain(program, field);
  plain.power_up();
  plain.run_until(200 * kMillisecond);
  serial::Simulation simulation(program, field);
  simulation.power_up();
  History history(simulation, {.interval = 10 * kMillisecond});
  StopAt end(simulation.cpu(), plain.cpu().state().instructions);
  history.run(end);
  const Snapshot newest = simulation.snapshot();
  const auto count = [&] { return load16(&simulation.cpu().state().image[image::kV]); };
  const auto all = count();
  EXPECT_GT(all, 15U);
  history.go_to(Time{50 * kMillisecond});
  EXPECT_LT(count(), all);
  history.go_to(Time{kMillisecond});
  EXPECT_EQ(count(), 0U);
  history.run(end);
  EXPECT_EQ(count(), all);
  EXPECT_TRUE(simulation.snapshot() == newest);
}

TEST(History, TheWatchdogOfThePastNamesTheSameInstruction) {
  Recorded session(test::compile("LBL 1\nLD SM0.0\nJMP 1\nMEND\n"), {.interval = 10 * kMillisecond});
  session.run_to(100'000'000);
  const Snapshot stopped = session.simulation.snapshot();
  ASSERT_NE(session.simulation.cpu().state().fatal_code, 0);
  session.history->go_to(Time{290 * kMillisecond});
  session.run_to(100'000'000);
  EXPECT_TRUE(session.simulation.snapshot() == stopped);
}

TEST(History, WhatCameOverTheHostPortComesAgainWhenItIsPlayed) {
  Recorded* running = nullptr;
  int turn = 0;
  // A bridge: it looks every millisecond, and something comes in now and then.
  const auto drive = [&](Time end, const auto&) {
    serial::Simulation& simulation = running->simulation;
    while (simulation.time() < end) {
      const serial::Halt halt = simulation.run_until(std::min(end, simulation.time() + kMillisecond));
      if (halt != serial::Halt::Time) return halt;
      serial::HostPort& port = simulation.host_port();
      if (!port.state().attached) port.attach({9600, 8, Parity::Even, 1}, simulation.time());
      if (++turn % 150 == 0)
        for (const std::uint8_t byte : Bytes{0x01, 0x03, 0x00, 0x0a, 0x00, 0x02, 0xe4, 0x09}) {
          const serial::HostCharacter character{.byte = byte, .format = {9600, 8, Parity::Even, 1}};
          port.send({&character, 1}, simulation.time());
        }
      port.take_received();
    }
    return serial::Halt::Time;
  };
  Recorded session(slave(), {.drive = drive, .interval = 20 * kMillisecond});
  running = &session;
  session.run_to(30'000);
  const Snapshot end = session.simulation.snapshot();
  const Moment newest = session.history->newest();
  EXPECT_GT(session.history->actions().size(), 20U);
  for (const Time to : {Time{0}, 170 * kMillisecond, 400 * kMillisecond}) {
    session.history->go_to(to);
    session.history->go_to(newest);
    ASSERT_TRUE(session.simulation.snapshot() == end) << to;
  }
}

/// A character comes over a bridge every 10 ms, and no more than 20 of them are kept.
struct Flooded {
  Flooded()
      : session(slave(), {.drive = [this](Time end, const auto&) { return drive(end); },
                          .log_bound = 20 * (sizeof(Action) + sizeof(Moment)),
                          .interval = 20 * kMillisecond}) {}

  serial::Halt drive(Time end) {
    serial::Simulation& simulation = session.simulation;
    const serial::HostCharacter character{.byte = 0x55, .format = {9600, 8, Parity::Even, 1}};
    serial::Halt halt = serial::Halt::Time;
    if (!simulation.host_port().state().attached) simulation.host_port().attach(character.format, simulation.time());
    while (halt == serial::Halt::Time && simulation.time() < end) {
      halt = simulation.run_until(std::min(end, simulation.time() + 10 * kMillisecond));
      if (halt == serial::Halt::Time) simulation.host_port().send({&character, 1}, simulation.time());
    }
    return halt;
  }

  Recorded session;
};

TEST(History, WhatCameOverTheHostPortIsForgottenFromItsBeginningWhenItTakesTooMuch) {
  Flooded flooded;
  Recorded& session = flooded.session;
  session.run_to(30'000);
  const Snapshot end = session.simulation.snapshot();
  const Moment newest = session.history->newest();
  const History::Usage usage = session.history->usage();
  EXPECT_GT(usage.forgotten, 0U);
  EXPECT_GT(usage.oldest.time, 0);
  EXPECT_LT(session.history->actions().size(), 25U);
  EXPECT_FALSE(session.history->recording().complete);
  EXPECT_EQ(since_oldest_text(*session.history),
            fmt::format("since {}, where the past begins", moment_text(usage.oldest.time)));
  EXPECT_TRUE(
      at_oldest_text(*session.history).starts_with("this is the oldest moment: before which what came over the bridge"));
  EXPECT_EQ(parse_moment("start", *session.history), usage.oldest.time);
  std::string why = parse_moment("1us", *session.history).why();
  EXPECT_TRUE(why.starts_with("the oldest moment is ")) << why;
  session.history->go_to(usage.oldest);
  EXPECT_EQ(session.history->now(), usage.oldest);
  session.history->go_to(newest);
  EXPECT_TRUE(session.simulation.snapshot() == end);
}

TEST(History, ABranchCountsOnlyWhatCameOverTheHostPortUpToItsBeginning) {
  Flooded flooded;
  Recorded& session = flooded.session;
  session.run_to(30'000);
  const History::Usage usage = session.history->usage();
  session.history->go_to(usage.oldest);
  session.history->act(assignment("VW4=7"));
  ASSERT_EQ(session.history->actions().size(), 1U);
  session.run_to(session.simulation.cpu().state().instructions + 1'000);
  EXPECT_EQ(session.history->usage().forgotten, usage.forgotten) << session.history->actions().size();
}

TEST(History, OfARecordingThatWasReplayedWhatCameOverTheHostPortIsForgottenToo) {
  Flooded flooded;
  Recorded& session = flooded.session;
  session.run_to(1'000);
  ASSERT_EQ(session.history->usage().forgotten, 0U);
  ASSERT_GT(session.history->actions().size(), 8U);
  ASSERT_TRUE(session.history->replay(session.history->recording()));
  session.run_to(30'000);
  EXPECT_GT(session.history->usage().forgotten, 0U);
  EXPECT_LT(session.history->actions().size(), 25U);
  EXPECT_GT(session.history->actions().size(), 8U) << "the newer half stays";
}

TEST(History, ATimeIsNotReachedAfterAStopRequest) {
  std::atomic<bool> stop = false;
  Recorded session(slave(), {.interval = kSecond, .stop_request = StopToken(stop)});
  session.live_through_it();
  const Snapshot here = session.simulation.snapshot();
  stop = true;
  EXPECT_FALSE(session.history->go_to(Time{300 * kMillisecond}));
  EXPECT_TRUE(session.simulation.snapshot() == here);
  stop = false;
  EXPECT_TRUE(session.history->go_to(Time{300 * kMillisecond}));
}

TEST(History, TheLastWriteIsFoundAlsoOfAnEqualValueThroughAPointerAndInABlock) {
  const auto program = test::compile(
      "LD SM0.0\nMOVD &VB100, AC1\nMOVW 7, *AC1\nMOVW 7, *AC1\nFILL 5, VW200, 4\nR M1.0, 8\nLD SM0.1\nMOVW 9, "
      "VW300\nMEND\n");
  Recorded session(program);
  session.run_to(36);
  const auto line_of = [&](const char* address) -> std::uint32_t {
    const Snapshot before = session.simulation.snapshot();
    const auto search = find_last_write(*session.history, 0, *parse_range(address, cpu214()), StopToken());
    EXPECT_TRUE(session.simulation.snapshot() == before);
    return search.write && search.write->by ? program->statement(search.write->by->op).position.line : 0;
  };
  EXPECT_EQ(line_of("VW100"), 4U);
  EXPECT_EQ(line_of("VB101"), 4U);
  EXPECT_EQ(line_of("VW206"), 5U);
  EXPECT_EQ(line_of("M1.7"), 6U);
  EXPECT_EQ(line_of("AC1"), 2U);
  EXPECT_EQ(line_of("VW300"), 8U);
  EXPECT_EQ(line_of("VW208"), 0U);
}

TEST(History, KnowsWhetherARecordingNeedsAHostPortThatIsNotHere) {
  Recorded session(slave());
  Recording recording = session.history->recording();
  recording.actions.emplace_back(serial::HostCall{});
  recording.moments.push_back(recording.end);
  recording.stations.push_back(0);
  EXPECT_TRUE(session.history->has_hosts_of(recording));
  recording.stations.back() = 1;
  EXPECT_FALSE(session.history->has_hosts_of(recording));
}

TEST(History, TheLastWriteMayBeAnActionOrTheSystem) {
  Recorded session(test::compile("LD SM0.0\nMOVW 1, VW0\nMEND\n"));
  session.run_to(10);
  session.history->act(assignment("VW50=3"));
  session.run_to(20);
  const auto by_action = find_last_write(*session.history, 0, *parse_range("VW50", cpu214()), StopToken());
  ASSERT_TRUE(by_action.write.has_value());
  EXPECT_EQ(by_action.write->action, 0U);
  const auto by_system = find_last_write(*session.history, 0, *parse_range("SM0.6", cpu214()), StopToken());
  ASSERT_TRUE(by_system.write.has_value());
  EXPECT_FALSE(by_system.write->by.has_value() || by_system.write->action.has_value());
}

/// Each look in front of an instruction that is executed; of the first one at or after a time the state.
class PlainUntil final : public Observer {
 public:
  explicit PlainUntil(std::shared_ptr<const Program> program) : simulation(std::move(program)) { simulation.power_up(); }

  void run_to(Time time) {
    stop_at_ = time;
    simulation.cpu().set_sink(this);
    simulation.run_until(kNever);
    simulation.cpu().set_sink(nullptr);
  }
  bool before(std::uint32_t) override { return simulation.time() < stop_at_; }
  bool wants_instructions() const override { return true; }

  serial::Simulation simulation;

 private:
  Time stop_at_ = 0;
};

TEST(History, AStopForgetsItsHitsOfBranchesThatNobodyCanReturnTo) {
  Recorded session(test::compile("LD SM0.0\nINCW VW2\nMEND\n"));
  Stepper stepper(*session.history, StopToken());
  stepper.add({.on = StopPoint::On::Place, .op = 1, .from_hit = kNever});
  for (int i = 0; i < 20; ++i) {
    stepper.run(goal::instructions(9), kNever, false);
    stepper.run_back(goal::back_instruction(), 3, false);
    session.history->act(assignment("VW4=7"));
    stepper.count_hits();
  }
  EXPECT_GT(stepper.stops()[0].hits, 20U);
  EXPECT_LE(stepper.stops()[0].counted.size(), 2U);
}

TEST(History, ScansThatAreAllAlikeTakeNoCheckpointsAndAreReachedAgainBitByBit) {
  constexpr Time kLimit = 100 * kSecond;
  const auto program = test::compile("LD SM0.0\nMOVW 1, VW2\nMEND\n");
  Recorded session(program);
  session.simulation.cpu().use_steady_scans(SteadyScansUse::On);
  Stepper stepper(*session.history, StopToken());
  EXPECT_EQ(stepper.run(goal::none(), kLimit, false).reason, StopReason::Limit);
  EXPECT_GT(session.simulation.cpu().passed_over(), 90 * kSecond);
  EXPECT_LT(session.history->usage().checkpoints, 20U);
  EXPECT_GE(session.history->now().time, kLimit);
  const Moment idle = session.history->now();
  const Snapshot after = session.simulation.snapshot();

  session.history->act(assignment("VW4=7"));
  stepper.add({.on = StopPoint::On::Change, .range = assignment("VW6=1").assignments[0].place});
  EXPECT_EQ(stepper.run(goal::none(), kLimit + 5 * kSecond, false).reason, StopReason::Limit);
  EXPECT_GT(session.history->usage().checkpoints, 10U) << "where every scan is executed";

  PlainUntil plain(program);
  for (const Time to : {100 * kMillisecond, 37 * kSecond, 99'999 * kMillisecond}) {
    plain.run_to(to);
    ASSERT_TRUE(session.history->go_to(to));
    ASSERT_TRUE(session.simulation.snapshot() == plain.simulation.snapshot()) << to;
  }
  session.history->go_to(idle);
  EXPECT_TRUE(session.simulation.snapshot() == after);
  const Stop back = stepper.run_back(goal::back_instruction(), 1, false);
  EXPECT_EQ(back.reason, StopReason::Goal);
  EXPECT_LT(session.history->now(), idle);
}

TEST(History, ALimitAmongScansThatAreAllAlikeEndsInFrontOfTheFirstInstructionAfterIt) {
  const auto program = test::compile("LD SM0.0\nMOVW 1, VW2\nMEND\n");
  Recorded session(program);
  session.simulation.cpu().use_steady_scans(SteadyScansUse::On);
  Stepper stepper(*session.history, StopToken());
  PlainUntil plain(program);
  for (const Time limit : {50 * kSecond, 50 * kSecond + 100 * kMicrosecond, 50'300 * kMillisecond, 90 * kSecond}) {
    EXPECT_EQ(stepper.run(goal::none(), limit, false).reason, StopReason::Limit);
    plain.run_to(limit);
    ASSERT_TRUE(session.simulation.snapshot() == plain.simulation.snapshot()) << limit;
  }
}

TEST(History, ALimitEndsARunThatBeganWithAFrameUnderWayAndGoesOverAlikeScansAfterIt) {
  const auto program =
      test::compile("LD SM0.1\nMOVB 16#09, SMB30\nMOVB 2, VB100\nMOVB 65, VB101\nMOVB 66, VB102\nXMT VB100, 0\nMEND\n");
  Recorded session(program);
  session.simulation.cpu().use_steady_scans(SteadyScansUse::On);
  Stepper stepper(*session.history, StopToken());
  PlainUntil plain(program);
  for (const Time limit : {kMillisecond, 200 * kMillisecond, 260 * kMillisecond}) {
    EXPECT_EQ(stepper.run(goal::none(), limit, false).reason, StopReason::Limit);
    plain.run_to(limit);
    EXPECT_EQ(session.simulation.time(), plain.simulation.time()) << limit;
  }
}

}  // namespace
}  // namespace s7200::tools::history_test

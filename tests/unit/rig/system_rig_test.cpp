// Systems as their files describe them: PLC against PLC, peers, gateways, and what befalls them in the field.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "serial_sim/modbus/request.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/source_path.hpp"
#include "tools/host/files/files.hpp"
#include "tools/plan/reading/system_reader.hpp"
#include "tools/rig/files/recorded_rig.hpp"

namespace s7200::tools::system_rig_test {
namespace {

std::string example(const std::string& name) { return test::source_path("stl_programs/systems/" + name); }

std::unique_ptr<RecordedRig> rig_of(const std::string& text) {
  SystemFile file = read_system(text, example("test.yaml"), host_files());
  for (const stl::Diagnostic& d : file.file.diagnostics)
    if (d.severity == stl::Severity::Error) ADD_FAILURE() << d.position.line << ": " << d.message;
  std::vector<std::string> problems;
  auto rig = file.ok() ? RecordedRig::assemble(std::move(file.plan), {.path = example("test.yaml")}, problems) : nullptr;
  for (const std::string& problem : problems) ADD_FAILURE() << problem;
  if (rig) rig->power_up();
  return rig;
}

std::unique_ptr<RecordedRig> rig_of_file(const std::string& name) {
  const auto text = read_text(example(name));
  EXPECT_TRUE(text) << text.why();
  return rig_of(text.value_or(""));
}

std::uint32_t double_word(const Rig& rig, std::size_t plc, std::uint32_t number) {
  return load32(&rig.plc(plc).cpu().state().image[image::kV + number]);
}
std::uint16_t word(const Rig& rig, std::size_t plc, std::uint32_t number) {
  return load16(&rig.plc(plc).cpu().state().image[image::kV + number]);
}

/// So many requests, answers and wrong answers from now on until `end`.
serial::Poller::State polls_until(Rig& rig, Time end, std::size_t peer = 0) {
  const serial::Poller::State before = rig.poller(peer)->state();
  rig.system().run_until(end);
  serial::Poller::State polls = rig.poller(peer)->state();
  polls.asked -= before.asked;
  polls.answered -= before.answered;
  polls.refused -= before.refused;
  polls.wrong -= before.wrong;
  return polls;
}

serial::System::Snapshot end_of(Rig& rig, Time end, Time slice) {
  while (rig.system().time() < end) rig.system().run_until(std::min(end, rig.system().time() + slice));
  return rig.system().snapshot();
}

TEST(SystemRig, AMasterProgramPollsThirtyOneSlaves) {
  const auto rig = rig_of_file("polled_slaves.yaml");
  ASSERT_TRUE(rig);
  rig->system().run_until(3 * kSecond);
  EXPECT_EQ(double_word(*rig, 0, 3846), 0U) << "failures";
  EXPECT_GE(double_word(*rig, 0, 3842), 31U) << "answers: each station has been asked once";
  for (std::size_t plc = 0; plc < rig->plan().plcs.size(); ++plc)
    EXPECT_EQ(rig->plc(plc).cpu().state().error_count, 0U) << rig->plan().plcs[plc].name;
}

/// What three seconds of a line cost where all slaves are polled: each station hears every character, and each step looks at
/// every PLC.
struct Cost {
  double events = 0, looks = 0;
};
Cost cost_of(int slaves) {
  const auto rig =
      rig_of(fmt::format("plcs:\n"
                         "  master: {{program: ../modbus_master.stl, cpu: 224, set: {{I0.2: 1, VB3840: {0}}}}}\n"
                         "  slave: {{program: ../modbus_slave.stl, copies: {0}, station: 1}}\n"
                         "lines: {{bus: {{stations: [master, slave]}}}}\n",
                         slaves));
  if (!rig) return {};
  serial::System& system = rig->system();
  std::uint64_t steps = 0;
  for (; system.time() < 3 * kSecond; ++steps) system.step(3 * kSecond);
  EXPECT_EQ(double_word(*rig, 0, 3846), 0U) << "failures";
  return {.events = static_cast<double>(system.events_handled()), .looks = static_cast<double>(steps) * (slaves + 1)};
}

TEST(SystemRig, WhatALineCostsGrowsAsItsStationsDo) {
  const Cost eight = cost_of(7), sixteen = cost_of(15), all = cost_of(31);
  for (const auto of : {&Cost::events, &Cost::looks}) {
    EXPECT_LT(sixteen.*of, 2.2 * eight.*of);
    EXPECT_LT(all.*of, 2.2 * sixteen.*of);
  }
}

TEST(SystemRig, TwoMastersCollideAndRecover) {
  const auto rig = rig_of_file("two_masters.yaml");
  ASSERT_TRUE(rig);
  rig->system().run_until(5 * kSecond);
  const serial::Poller::State panel = rig->poller(0)->state(), recorder = rig->poller(1)->state();
  const std::uint64_t failures =
      panel.asked - panel.answered + panel.wrong + recorder.asked - recorder.answered + recorder.wrong;
  EXPECT_GT(failures, 2U) << "they have collided";
  EXPECT_GT(std::min(panel.least_latency, recorder.least_latency), 3 * kMillisecond) << "a foreign request is no answer";
  EXPECT_EQ(recorder.refused, 0U);
  EXPECT_GT(panel.answered - panel.wrong, panel.asked / 2) << "and come to their answers all the same";
  EXPECT_GE(recorder.answered - recorder.wrong, recorder.asked / 3);
  EXPECT_EQ(word(*rig, 0, 20), 99U);
}

/// What a master program has come to: jobs that ended well and otherwise, and how often it has asked again.
struct Jobs {
  int right = 0, failed = 0, repeated = 0;
};

/// Both ask every second, one of them 20 ms later: while the other one's request or answer is on the line. Each hears that,
/// takes it for a wrong answer, and asks again after its own time-out; those differ.
TEST(SystemRig, ARefusalIsCountedApartFromWhatIsWrong) {
  const auto rig = rig_of(
      "plcs: {pump: {program: ../modbus_slave.stl, station: 7}}\n"
      "peers: {panel: {polls: [{station: 7, read: 40001}, {station: 7, read: 49999}]}}\n"
      "lines: {field: {stations: [panel, pump]}}\n");
  ASSERT_TRUE(rig);
  rig->system().run_until(2 * kSecond);
  const serial::Poller::State polls = rig->poller(0)->state();
  EXPECT_EQ(polls.wrong, 0U);
  EXPECT_GT(polls.refused, 2U);
  EXPECT_GE(polls.answered, 2 * polls.refused);
}

TEST(SystemRig, TwoMasterProgramsThatStartApartCollideAndRecover) {
  const auto rig = rig_of(
      "plcs:\n"
      "  one: {program: ../modbus_master.stl, cpu: 224, set: {I0.1: 1}, constants: {VW3014: 30}}\n"
      "  other: {program: ../modbus_master.stl, cpu: 224, set: {I0.1: 1}, starts: 20ms}\n"
      "  slave: {program: ../modbus_slave.stl, station: 1, set: {VW0: 16#1234}}\n"
      "lines: {bus: {stations: [one, slave, other]}}\n");
  ASSERT_TRUE(rig);
  std::array<Jobs, 2> jobs;
  std::array<bool, 2> done{};
  std::array<std::uint16_t, 2> left{};  // how often it may still ask
  while (rig->system().time() < 10 * kSecond) {
    rig->system().run_until(rig->system().time() + kMillisecond);
    for (std::size_t plc = 0; plc < jobs.size(); ++plc) {
      const auto& memory = rig->plc(plc).cpu().state().image;
      const bool is_done = (memory[image::kM + 31] >> 2 & 1) != 0;
      if (is_done && !done[plc]) ++(memory[image::kV + 3013] == 0 ? jobs[plc].right : jobs[plc].failed);
      done[plc] = is_done;
      jobs[plc].repeated += word(*rig, plc, 3016) < left[plc];
      left[plc] = word(*rig, plc, 3016);
    }
  }
  EXPECT_GT(jobs[0].repeated + jobs[1].repeated, 5) << "they have collided";
  for (std::size_t plc = 0; plc < jobs.size(); ++plc) {
    EXPECT_GE(jobs[plc].right, 9) << "and come to their answers all the same";
    EXPECT_EQ(jobs[plc].failed, 0);
    EXPECT_EQ(word(*rig, plc, 100), 0x1234U);
  }
}

/// What two equal master programs come to that are started together: answers and failures of both. They ask two slaves, each
/// another one first, so that what they send at the same time differs.
struct Outcome {
  std::uint32_t answers = 0, failures = 0;
};
Outcome outcome_of_masters(const std::string& clock_of_one, const std::string& clock_of_other) {
  const auto rig = rig_of(fmt::format(
      "plcs:\n"
      "  one: {{program: ../modbus_master.stl, cpu: 224, set: {{I0.2: 1, VB3840: 2, VB3841: 0}}, clock_error: {}}}\n"
      "  other: {{program: ../modbus_master.stl, cpu: 224, set: {{I0.2: 1, VB3840: 2, VB3841: 1}}, clock_error: {}}}\n"
      "  slave: {{program: ../modbus_slave.stl, copies: 2, station: 1}}\n"
      "lines: {{bus: {{stations: [one, slave, other]}}}}\n",
      clock_of_one, clock_of_other));
  if (!rig) return {};
  rig->system().run_until(240 * kSecond);
  return {double_word(*rig, 0, 3842) + double_word(*rig, 1, 3842), double_word(*rig, 0, 3846) + double_word(*rig, 1, 3846)};
}

TEST(SystemRig, TwoMastersWithEqualTimeOutsRecoverWhenTheirClocksHaveDriftedApart) {
  const Outcome in_step = outcome_of_masters("0ppm", "0ppm");
  EXPECT_LE(in_step.answers, 1U) << "with exactly the same clock they collide for ever, but for chance";
  EXPECT_GT(in_step.failures, 100U);
  const Outcome apart = outcome_of_masters("50ppm", "-50ppm");
  EXPECT_GT(apart.failures, 0U) << "they have collided";
  EXPECT_GT(apart.answers, 100U) << "and recovered";
}

TEST(SystemRig, TheRequestOfAMasterProgramIsNoAnswerToAnotherMaster) {
  const auto rig = rig_of(
      "plcs:\n"
      "  master: {program: ../modbus_master.stl, cpu: 224, set: {I0.2: 1, VB3840: 1}}\n"
      "  slave: {program: ../modbus_slave.stl, station: 5}\n"
      "peers: {panel: {polls: [{station: 9, read: 40001}], timeout: 310ms}}\n"
      "lines: {bus: {stations: [master, slave, panel]}}\n");
  ASSERT_TRUE(rig);
  rig->system().run_until(10 * kSecond);
  EXPECT_GT(double_word(*rig, 0, 3846), 1U) << "the program asks station 1, which is not there";
  EXPECT_GT(rig->poller(0)->state().asked, 10U);
  EXPECT_EQ(rig->poller(0)->state().answered, 0U);
}

TEST(SystemRig, APlcThatStartsLaterHasItsFirstScanThen) {
  const auto rig = rig_of(
      "plcs: {a: {program: ../edge_counter.stl, copies: 2, starts: 37ms, set: {VW20: 5}}}\nlines: {bus: {stations: [a]}}\n");
  ASSERT_TRUE(rig);
  rig->system().run_until(36 * kMillisecond);
  for (std::size_t plc : {0U, 1U}) EXPECT_FALSE(rig->plc(plc).powered());
  const serial::System::Snapshot before = rig->system().snapshot();
  for ([[maybe_unused]] const int again : {1, 2}) {
    rig->system().restore(before);
    rig->system().run_until(70 * kMillisecond);
    EXPECT_GT(rig->plc(0).cpu().state().scans, 0U);
    EXPECT_EQ(word(*rig, 0, 20), 5U) << "with the memory that it has before its first scan";
    EXPECT_FALSE(rig->plc(1).powered()) << "of several copies each as much later";
    rig->system().run_until(100 * kMillisecond);
    EXPECT_GT(rig->plc(1).cpu().state().scans, 0U);
  }
}

/// A PLC that starts at 5 s, with the memory of one whose VW100 was 7 when its power went off.
std::unique_ptr<RecordedRig> late_starter(const std::string& memory, const std::string& events) {
  const auto before = rig_of(fmt::format(
      "plcs: {{a: {{program: ../edge_counter.stl, memory: {}, set: {{VW100: 7}}}}}}\nlines: {{bus: {{stations: [a]}}}}\n",
      memory));
  if (!before) return nullptr;
  before->system().run_until(kSecond);
  EXPECT_TRUE(before->finish().empty());
  return rig_of(fmt::format(
      "plcs: {{a: {{program: ../edge_counter.stl, memory: {}, starts: 5s, set: {{VW20: 5}}, clock: 2026-11-21 10:00:00}}}}\n"
      "lines: {{bus: {{stations: [a]}}}}\n"
      "events: [{}]\n",
      memory, events));
}

std::string text_of(const std::string& path) {
  const auto text = read_text(path);
  return text.value_or(text.why());
}

TEST(SystemRig, TheMemoryOfAPlcThatNeverHadPowerIsLeftAsItIs) {
  const std::string memory = test::scratch_folder() + "never_powered.json";
  const auto rig = late_starter(memory, "");
  ASSERT_TRUE(rig);
  const std::string kept = text_of(memory);
  rig->system().run_until(3 * kSecond);
  EXPECT_TRUE(rig->finish().empty());
  EXPECT_EQ(text_of(memory), kept);
  rig->system().run_until(6 * kSecond);
  EXPECT_TRUE(rig->finish().empty());
  EXPECT_NE(text_of(memory), kept) << "it has had power since";
}

TEST(SystemRig, APlcBeginsWithItsSettingsWhenAnEventPowersItUpBeforeItStarts) {
  const auto rig = late_starter(test::scratch_folder() + "powered_early.json", "{at: 2s, power_on: a}");
  ASSERT_TRUE(rig);
  for (const Time end : {3 * kSecond, 6 * kSecond}) {
    rig->system().run_until(end);
    ASSERT_TRUE(rig->plc(0).powered());
    EXPECT_EQ(word(*rig, 0, 20), 5U);
    EXPECT_EQ(word(*rig, 0, 100), 7U) << "of its memory";
    EXPECT_EQ(rig->plc(0).cpu().clock().year, 26);
    EXPECT_EQ(rig->plc(0).cpu().clock().second, (end - 2 * kSecond) / kSecond);
  }
}

TEST(SystemRig, APlcHearsNothingBeforeItStarts) {
  const auto rig = rig_of(
      "plcs: {slave: {program: ../modbus_slave.stl, station: 1, starts: 2500ms}}\n"
      "peers: {master: {polls: [{station: 1, read: 40001}], every: 250ms, timeout: 50ms, starts: 500ms}}\n"
      "lines: {bus: {stations: [master, slave], baud: 9600, parity: even}}\n");
  ASSERT_TRUE(rig);
  const serial::Poller::State before = polls_until(*rig, 2400 * kMillisecond);
  EXPECT_EQ(before.asked, 8U) << "from 500 ms on";
  EXPECT_EQ(before.answered, 0U);
  const serial::Poller::State after = polls_until(*rig, 4400 * kMillisecond);
  EXPECT_GE(after.answered, 6U);
}

TEST(SystemRig, AGatewayWithBothPortsOfACpu226PassesRequestsAndAnswersOn) {
  const auto rig = rig_of_file("gateway.yaml");
  ASSERT_TRUE(rig);
  rig->system().run_until(2 * kSecond);
  const serial::Poller::State master = rig->poller(0)->state();
  EXPECT_GE(master.answered, 8U);
  EXPECT_EQ(master.wrong, 0U);
  EXPECT_LE(master.asked - master.answered, 1U) << "but for one under way";
  EXPECT_EQ(word(*rig, 0, 2), word(*rig, 0, 0)) << "as many answers as requests";
}

std::string three_slaves(const std::string& faults) {
  return "plcs: {slave: {program: ../modbus_slave.stl, copies: 3, station: 1}}\n"
         "peers: {master: {polls: [{station: 1..3, read: 40001}], timeout: 50ms, every: 250ms}}\n"
         "lines: {bus: {stations: [master, slave], faults: [" +
         faults + "]}}\n";
}
const std::string kThreeSlaves = three_slaves("");

/// Rounds begin every quarter of a second from the first one on: an instant in between, when the one before is over.
constexpr Time kSecondRounds = 2240 * kMillisecond, kThirdRounds = kSecondRounds + kSecond,
               kFourthRounds = kThirdRounds + kSecond, kFifthRounds = kFourthRounds + kSecond;

TEST(SystemRig, ASlaveThatIsSwitchedOffIsSilentAndAnswersWhenItIsOnAgain) {
  const auto rig = rig_of(kThreeSlaves + "events: [{at: 2240ms, power_off: slave2}, {at: 3240ms, power_on: slave2}]\n");
  ASSERT_TRUE(rig);
  const auto all = polls_until(*rig, kSecondRounds);
  EXPECT_FALSE(rig->plc(1).powered());
  EXPECT_EQ(all.answered, all.asked);
  const auto without = polls_until(*rig, kThirdRounds);
  EXPECT_EQ(without.asked, 12U);
  EXPECT_EQ(without.answered, 8U);
  polls_until(*rig, kFourthRounds);  // its first scan
  const auto again = polls_until(*rig, kFifthRounds);
  EXPECT_EQ(again.answered, 12U);
  EXPECT_EQ(rig->plc(1).cpu().state().error_count, 0U);
}

TEST(SystemRig, APlcWhoseModeSwitchIsInTermStaysInStopWhenItsPowerComesBack) {
  const auto rig =
      rig_of(kThreeSlaves +
             "events: [{at: 1s, set: {SM0.7: 0}, plc: slave2}, {at: 2s, power_off: slave2}, {at: 2s, power_off: slave3},\n"
             "  {at: 3s, power_on: slave2}, {at: 3s, power_on: slave3}]\n");
  ASSERT_TRUE(rig);
  rig->system().run_until(1900 * kMillisecond);
  EXPECT_EQ(rig->plc(1).cpu().state().mode, Mode::Run) << "TERM lets it run on";
  rig->system().run_until(4 * kSecond);
  EXPECT_EQ(rig->plc(1).cpu().state().mode, Mode::Stop);
  EXPECT_EQ(rig->plc(2).cpu().state().mode, Mode::Run);
}

TEST(SystemRig, NothingIsSetInAPlcWithoutPower) {
  const auto rig = rig_of(kThreeSlaves +
                          "events:\n"
                          "  - {at: 1s, plc: slave1, set: {VW100: 7}}\n"
                          "  - {at: 2s, power_off: slave1}\n"
                          "  - {at: 2500ms, plc: slave1, set: {VW100: 8}}\n"
                          "  - {at: 3s, power_on: slave1}\n");
  ASSERT_TRUE(rig);
  rig->system().run_until(4 * kSecond);
  EXPECT_EQ(word(*rig, 0, 100), 7U);
}

TEST(SystemRig, ACutCableDividesTheLineUntilItIsMended) {
  const auto rig = rig_of(kThreeSlaves + "events: [{at: 2240ms, cut: bus, after: slave1}, {at: 3240ms, mend: bus}]\n");
  ASSERT_TRUE(rig);
  polls_until(*rig, kSecondRounds);
  const auto divided = polls_until(*rig, kThirdRounds);
  EXPECT_EQ(divided.asked, 12U);
  EXPECT_EQ(divided.answered, 4U) << "slave1 is on the master's side";
  const auto whole = polls_until(*rig, kFourthRounds);
  EXPECT_EQ(whole.answered, 12U);
}

TEST(SystemRig, AStationAtTheWrongRateIsNotUnderstoodAndComesBack) {
  const auto rig = rig_of(kThreeSlaves +
                          "events:\n"
                          "  - {at: 2240ms, plc: slave3, set: {SMB30: 16#45}}\n"
                          "  - {at: 3240ms, plc: slave3, set: {SMB30: 16#49}}\n");
  ASSERT_TRUE(rig);
  polls_until(*rig, kSecondRounds);
  const auto wrong_rate = polls_until(*rig, kThirdRounds);
  EXPECT_EQ(wrong_rate.answered - wrong_rate.wrong, 8U);
  polls_until(*rig, kFourthRounds);
  const auto right_rate = polls_until(*rig, kFifthRounds);
  EXPECT_EQ(right_rate.answered, 12U);
}

TEST(SystemRig, APortCountsTheCharactersWithFramingErrorsThatItReceives) {
  const auto rig = rig_of(kThreeSlaves + "events: [{at: 1500ms, plc: slave2, set: {SMB30: 16#45}}]\n");
  ASSERT_TRUE(rig);
  rig->system().run_until(1500 * kMillisecond);
  EXPECT_EQ(rig->plc(1).framing_errors(), 0U);
  const serial::System::Snapshot before = rig->system().snapshot();
  rig->system().run_until(3 * kSecond);
  EXPECT_GT(rig->plc(1).framing_errors(), 0U) << "it is at 19200 baud, the master at 9600";
  EXPECT_EQ(rig->plc(0).framing_errors(), 0U);
  rig->system().restore(before);
  EXPECT_EQ(rig->plc(1).framing_errors(), 0U);
}

TEST(SystemRig, AFaultFromAnInstantOnIsThereUntilItIsCleared) {
  const auto rig = rig_of(kThreeSlaves +
                          "events: [{at: 2240ms, line: bus, fault: \"noise:ber=0.2\"}, {at: 3240ms, clear_faults: bus}]\n");
  ASSERT_TRUE(rig);
  polls_until(*rig, kSecondRounds);
  const auto noisy = polls_until(*rig, kThirdRounds);
  EXPECT_EQ(noisy.answered - noisy.wrong, 0U);
  polls_until(*rig, kFourthRounds);
  const auto quiet = polls_until(*rig, kFifthRounds);
  EXPECT_EQ(quiet.answered - quiet.wrong, 12U);
}

TEST(SystemRig, AnAnswerOfRightBytesWithWrongParityIsCountedAsWrong) {
  const auto rig = rig_of(
      "plcs: {slave: {program: ../modbus_slave.stl, station: 1}}\n"
      "peers: {master: {polls: [{station: 1, read: 40001}]}}\n"
      "lines: {bus: {stations: [master, slave], faults: [\"parity:character=each,of=answer\"]}}\n");
  ASSERT_TRUE(rig);
  const auto polls = polls_until(*rig, 2 * kSecond);
  EXPECT_GT(polls.answered, 10U);
  EXPECT_EQ(polls.wrong, polls.answered);
}

TEST(SystemRig, AFaultOfOneStationDisturbsWhatThisOneSends) {
  for (const char* const fault : {"parity:character=each", "flip", "missing", "baud:error=20%", "cut:character=2,for=3ms"}) {
    const auto rig = rig_of(three_slaves(fmt::format("{{fault: \"{}\", station: slave2}}", fault)));
    ASSERT_TRUE(rig) << fault;
    const auto polls = polls_until(*rig, kSecondRounds);
    EXPECT_EQ(polls.asked, 15U) << fault;
    EXPECT_EQ(polls.answered - polls.wrong, 10U) << fault;
  }
  const auto of_master = rig_of(three_slaves("{fault: flip, station: master}"));
  ASSERT_TRUE(of_master);
  EXPECT_EQ(polls_until(*of_master, kSecondRounds).answered, 0U) << "no slave gets a right request";
}

TEST(SystemRig, AFaultOfRequestsStrikesWhatAProgramAsksAgainAndAgain) {
  const auto rig = rig_of(
      "plcs:\n  master: {program: ../modbus_master.stl, cpu: 224, set: {I0.2: 1, VB3840: 3}}\n"
      "  slave: {program: ../modbus_slave.stl, copies: 2, station: 1}\n"
      "lines: {bus: {stations: [master, slave], faults: [\"parity:character=3\", \"parity:character=3,of=answer\"]}}\n");
  ASSERT_TRUE(rig);
  rig->system().run_until(5 * kSecond);
  const auto& injected = rig->faults(0).state().injected;
  EXPECT_GE(injected[0].count, 5U) << "requests";
  EXPECT_EQ(injected[0].count, injected[0].exchanges);
  EXPECT_EQ(double_word(*rig, 0, 3842), 0U) << "no slave gets a right request";
  EXPECT_EQ(injected[1].count, 0U) << "nor answers one";
}

TEST(SystemRig, AFaultOfOneStationComesAsAnEventAndGoes) {
  const auto rig = rig_of(kThreeSlaves +
                          "events: [{at: 2240ms, line: bus, fault: \"parity:character=each\", station: slave3}, "
                          "{at: 3240ms, clear_faults: bus}]\n");
  ASSERT_TRUE(rig);
  EXPECT_EQ(polls_until(*rig, kSecondRounds).wrong, 0U);
  EXPECT_EQ(polls_until(*rig, kThirdRounds).wrong, 4U);
  EXPECT_EQ(polls_until(*rig, kFourthRounds).wrong, 0U);
}

TEST(SystemRig, WhatIsDoneToAPlcAndItsLinesIsToldOfIt) {
  const auto rig = rig_of(
      "plcs: {a: {program: ../modbus_slave.stl}, b: {program: ../modbus_slave.stl, station: 2}}\n"
      "peers: {m: {polls: [{read: 40001}]}}\n"
      "lines: {bus: {stations: [m, a]}, other: {stations: [b]}}\n"
      "events:\n  - {at: 1ms, power_off: a}\n  - {at: 2ms, cut: bus, after: m}\n  - {at: 3ms, plc: a, set: {VB0: 1}}\n"
      "  - {at: 4ms, power_on: a}\n  - {at: 5ms, plc: b, set: {VB0: 1}}\n  - {at: 6ms, power_off: m}\n"
      "  - {at: 7ms, mend: bus}\n  - {at: 8ms, line: other, fault: flip}\n  - {at: 9ms, clear_faults: other}\n");
  ASSERT_TRUE(rig);
  std::vector<std::string> told;
  rig->tell_of_events([&](std::size_t plc, Time at, const std::string& what) {
    told.push_back(fmt::format("{} {} {}", rig->plan().plcs[plc].name, at / kMillisecond, what));
  });
  rig->system().run_until(10 * kMillisecond);
  EXPECT_EQ(told, (std::vector<std::string>{"a 1 power off", "a 2 line bus: cable cut after m",
                                            "a 3 a programming device sets VB0 to 16#01: no effect, the PLC has no power",
                                            "a 4 power on", "b 5 a programming device sets VB0 to 16#01",
                                            "a 7 line bus: cable whole again", "b 8 line other: fault flip",
                                            "b 9 line other: no fault any more"}));
}

TEST(SystemRig, ASimulatedPlcOfAnotherMakeAnswersOnTheLine) {
  const auto rig = rig_of(
      "plcs: {slave: {program: ../modbus_slave.stl, station: 2}}\n"
      "peers:\n"
      "  old: {westinghouse: modbus, model: pc1200, settings: [slave=05, baud=9600, parity=even]}\n"
      "  master: {polls: [{station: 5, read: 40001}, {station: 2, read: 40001}]}\n"
      "lines: {bus: {stations: [master, slave, old]}}\n");
  ASSERT_TRUE(rig);
  rig->system().run_until(2 * kSecond);
  EXPECT_GT(rig->poller(1)->state().answered, 5U);
}

TEST(SystemRig, AHundredAndFiftyMastersOnSixLinesAllAsk) {
  constexpr std::size_t kLines = 6, kMastersOnALine = 25;
  std::string masters = "peers:\n", lines = "lines:\n";
  for (std::size_t line = 0; line < kLines; ++line) {
    lines += fmt::format("  l{}: {{stations: [", line);
    for (std::size_t i = 0; i < kMastersOnALine; ++i) {
      const std::string name = fmt::format("m{}_{}", line, i);
      masters += fmt::format("  {}: {{polls: [{{read: 40001}}], timeout: 20ms}}\n", name);
      lines += fmt::format("{}{}", i == 0 ? "" : ", ", name);
    }
    lines += "]}\n";
  }
  const auto rig = rig_of(masters + lines);
  ASSERT_TRUE(rig);
  rig->system().run_until(1200 * kMillisecond);
  for (std::size_t peer = 0; peer < kLines * kMastersOnALine; ++peer)
    EXPECT_GE(rig->poller(peer)->state().asked, 2U) << rig->plan().peers[peer].name;
}

/// Master and slave of other makes on the line of a PLC that asks nothing.
constexpr const char* kPeers =
    "plcs: {slave: {program: ../modbus_slave.stl, station: 2}}\n"
    "peers:\n"
    "  old: {westinghouse: modbus, model: pc1200, settings: [slave=05, parity=even, HR1=1234]}\n"
    "  master: {polls: [{station: 5, read: 40001}], timeout: 50ms, every: 250ms}\n"
    "lines: {bus: {stations: [master, slave, old]}}\n";

TEST(SystemRig, APlcOfAnotherMakeThatIsSwitchedOffIsSilentAndComesBackWithItsMemory) {
  const auto rig = rig_of(std::string(kPeers) + "events: [{at: 2240ms, power_off: old}, {at: 3240ms, power_on: old}]\n");
  ASSERT_TRUE(rig);
  const auto before = polls_until(*rig, kSecondRounds, 1);
  EXPECT_EQ(before.answered, before.asked);
  const auto without = polls_until(*rig, kThirdRounds, 1);
  EXPECT_EQ(without.asked, 4U);
  EXPECT_EQ(without.answered, 0U);
  const auto again = polls_until(*rig, kFourthRounds, 1);
  EXPECT_EQ(again.answered, again.asked);
  EXPECT_EQ(again.wrong, 0U);
}

TEST(SystemRig, APeerThatLosesPowerFallsSilentInTheMiddleOfACharacter) {
  const auto rig = rig_of(std::string(kPeers) + "events: [{at: 1020ms, power_off: old}]\n");
  ASSERT_TRUE(rig);
  polls_until(*rig, 1019 * kMillisecond, 1);
  const auto cut_off = polls_until(*rig, 1200 * kMillisecond, 1);
  EXPECT_EQ(cut_off.answered, 1U) << "its answer had begun";
  EXPECT_EQ(cut_off.wrong, 1U);
}

TEST(SystemRig, AMasterThatIsSwitchedOffAsksNothingAndBeginsItsRoundAgainASecondAfterItIsOn) {
  const auto rig =
      rig_of(std::string(kPeers) + "events: [{at: 2240ms, power_off: master}, {at: 3240ms, power_on: master}]\n");
  ASSERT_TRUE(rig);
  polls_until(*rig, kSecondRounds, 1);
  EXPECT_EQ(polls_until(*rig, kThirdRounds + 990 * kMillisecond, 1).asked, 0U);
  const auto again = polls_until(*rig, kThirdRounds + 1990 * kMillisecond, 1);
  EXPECT_EQ(again.asked, 4U);
  EXPECT_EQ(again.answered, 4U);
}

TEST(SystemRig, APeerWithoutPowerIsTheSameInSlicesAndFromASnapshot) {
  const std::string text = std::string(kPeers) +
                           "events: [{at: 1020ms, power_off: old}, {at: 1030ms, power_off: master}, {at: 1100ms, power_on: "
                           "old}, {at: 1200ms, power_on: master}]\n";
  constexpr Time kEnd = 3 * kSecond;
  const auto whole = rig_of(text), again = rig_of(text);
  ASSERT_TRUE(whole && again);
  whole->system().run_until(kEnd);
  again->system().run_until(1050 * kMillisecond);
  const serial::System::Snapshot off = again->system().snapshot();
  again->system().run_until(2500 * kMillisecond);
  again->system().restore(off);
  again->system().run_until(kEnd);
  EXPECT_TRUE(again->system().snapshot() == whole->system().snapshot());
}

// --- the sync signal of the PC1000 LAN ---

std::string lan(std::string_view sync) {
  return "plcs: {gateway: {program: ../gateway_pc1200_lan.stl, cpu: 226, station: 1}}\n"
         "peers:\n"
         "  panel: {polls: [{station: 1, read: 40001, count: 2}], every: 200ms, timeout: 2s}\n"
         "  pc1200: {westinghouse: pc1000-lan, settings: [\"W[0]=1234,5678\"], sync: " +
         std::string(sync) +
         "}\n"
         "lines: {office: {stations: [panel, gateway]}, field: {stations: [gateway.1, pc1200]}}\n";
}

TEST(SystemRig, AnOutputOfAPlcDrivesTheSyncSignalOfThePc1000Lan) {
  const auto rig = rig_of(lan("gateway.Q0.0")), other = rig_of(lan("gateway.Q0.1"));
  ASSERT_TRUE(rig && other);
  const auto polls = polls_until(*rig, 3 * kSecond), without = polls_until(*other, 3 * kSecond);
  EXPECT_GE(polls.answered, 5U);
  EXPECT_EQ(polls.wrong, 0U);
  EXPECT_EQ(without.answered - without.wrong - without.refused, 0U) << "an output that stays off: the PC1200 hears nothing";
}

TEST(SystemRig, ASystemWithASyncSignalIsTheSameInSlicesInStepAndFromASnapshot) {
  constexpr Time kEnd = 2 * kSecond;
  const auto whole = rig_of(lan("gateway.Q0.0")), sliced = rig_of(lan("gateway.Q0.0")), again = rig_of(lan("gateway.Q0.0"));
  ASSERT_TRUE(whole && sliced && again);
  sliced->system().run_in_step(true);
  const serial::System::Snapshot end = end_of(*whole, kEnd, kEnd);
  EXPECT_TRUE(end == end_of(*sliced, kEnd, 377 * kMicrosecond));
  const serial::System::Snapshot middle = end_of(*again, 1234 * kMillisecond, kSecond);
  again->system().run_until(1500 * kMillisecond);
  again->system().restore(middle);
  EXPECT_TRUE(end == end_of(*again, kEnd, kEnd));
}

TEST(SystemRig, WithoutPowerOfThePlcThatDrivesItTheSyncSignalIsLow) {
  const auto rig = rig_of(lan("gateway.Q0.0"));
  ASSERT_TRUE(rig);
  rig->system().run_until(1500 * kMillisecond);
  const EventPlan off{.what = EventPlan::What::PowerOff, .station = {StationPlan::Kind::Plc, 0}};
  const EventPlan on{.what = EventPlan::What::PowerOn, .station = {StationPlan::Kind::Plc, 0}};
  rig->carry_out(off);
  rig->system().run_until(2 * kSecond);
  rig->carry_out(on);
  rig->system().run_until(4 * kSecond);
  const auto polls = polls_until(*rig, 6 * kSecond);
  EXPECT_GE(polls.answered, 3U);
  EXPECT_EQ(polls.wrong, 0U);
}

// --- PPI ---

/// At its station: fetches 4 bytes from VB200 of station 3 with the table at VB100, once, in a scan.
std::string netr_at(int station, int scan = 3) {
  const std::string name = test::scratch_folder() + fmt::format("netr{}_{}.stl", station, scan);
  std::ofstream(name) << fmt::format(
      "LD SM0.1\nMOVB {}, VB0\nSPA VB0, 0\nMOVB 2, SMB30\nMOVB 3, VB101\nMOVD &VB200, VD102\nMOVB 4, VB106\nLD SM0.0\nINCW "
      "VW1000\nLDW= VW1000, {}\nNETR VB100, 0\nMEND\n",
      station, scan);
  return name;
}

/// Station 3.
std::string ppi_slave() {
  const std::string name = test::scratch_folder() + "ppi_slave.stl";
  std::ofstream(name) << "LD SM0.1\nMOVB 3, VB0\nSPA VB0, 0\nMOVD 16#01020304, VD200\nMEND\n";
  return name;
}

std::string ppi_line(std::uint32_t of_master, std::uint32_t of_slave) {
  return fmt::format(
      "plcs:\n  master: {{program: {}, cpu: 224, ppi_baud: {}}}\n  slave: {{program: {}, cpu: 224, ppi_baud: {}}}\n"
      "lines: {{bus: {{stations: [master, slave]}}}}\n",
      netr_at(4), of_master, ppi_slave(), of_slave);
}

unsigned job_status(const Rig& rig, std::size_t plc) { return word(rig, plc, 100) >> 8; }

TEST(SystemRig, NetrReadsAnotherCpuAtEachRateOfPpiThatBothHave) {
  for (const std::uint32_t baud : {9600U, 19200U, 187500U}) {
    const auto rig = rig_of(ppi_line(baud, baud));
    ASSERT_TRUE(rig);
    rig->system().run_until(baud == 187500 ? 20 * kMillisecond : 200 * kMillisecond);
    EXPECT_EQ(job_status(*rig, 0), 0x80U) << baud;
    EXPECT_EQ(double_word(*rig, 0, 107), 0x01020304U) << baud;
  }
  const auto apart = rig_of(ppi_line(19200, 9600));
  ASSERT_TRUE(apart);
  apart->system().run_until(2 * kSecond);
  EXPECT_EQ(job_status(*apart, 0) & 0xA0U, 0xA0U) << "done, with an error";
}

/// A CPU 214 has no SPA: its station is that of its system block, before and after it was without power.
TEST(SystemRig, NetrReadsACpuAtThePpiStationOfItsSystemBlock) {
  const auto rig = rig_of(
      fmt::format("plcs:\n  master: {{program: {}, cpu: 224}}\n"
                  "  slave: {{program: ../edge_counter.stl, copies: 2, ppi_station: 3, set: {{VD200: 16#01020304}}}}\n"
                  "lines: {{bus: {{stations: [master, slave]}}}}\n",
                  netr_at(4, 300)));
  ASSERT_TRUE(rig);
  EXPECT_EQ(rig->plc(2).cpu().state().station[0], 4) << "the next copy";
  for (const bool on : {false, true})
    rig->carry_out(
        {.what = on ? EventPlan::What::PowerOn : EventPlan::What::PowerOff, .station = {StationPlan::Kind::Plc, 1}});
  rig->carry_out({.what = EventPlan::What::PowerOff, .station = {StationPlan::Kind::Plc, 2}});
  rig->system().run_until(2 * kSecond);
  EXPECT_EQ(job_status(*rig, 0), 0x80U);
  EXPECT_EQ(double_word(*rig, 0, 107), 0x01020304U);
}

/// As on a real network: both accept the request at once, which looks like one, and their answers are driven one over the
/// other. They differ in so many bits that chance makes no answer of them.
TEST(SystemRig, TwoPlcsAtOnePpiStationAnswerAtTheSameTime) {
  for (const bool alike : {true, false}) {
    const auto rig =
        rig_of(fmt::format("plcs:\n  master: {{program: {}, cpu: 224}}\n"
                           "  a: {{program: ../edge_counter.stl, cpu: 224, ppi_station: 3, set: {{VD200: 16#01020304}}}}\n"
                           "  b: {{program: ../edge_counter.stl, cpu: 224, ppi_station: 3, set: {{VD200: {}}}}}\n"
                           "lines: {{bus: {{stations: [master, a, b], contention: 1}}}}\n",
                           netr_at(4), alike ? "16#01020304" : "16#FEFDFCFB"));
    ASSERT_TRUE(rig);
    rig->system().run_until(2 * kSecond);
    EXPECT_EQ(job_status(*rig, 0) & 0xA0U, alike ? 0x80U : 0xA0U) << "done, with an error if the answers differ";
  }
}

/// Counts what is not modelled.
struct Unmodelled final : TraceSink {
  void record(const TraceRecord& record) override { count += record.kind == TraceKind::PpiNotModelled; }
  bool wants_scans() const override { return false; }
  int count = 0;
};

/// The other one asks in that scan.
std::unique_ptr<RecordedRig> two_masters_of_ppi(int scan) {
  return rig_of(fmt::format(
      "plcs:\n  one: {{program: {}, cpu: 224}}\n  other: {{program: {}, cpu: 224}}\n  slave: {{program: {}, cpu: 224}}\n"
      "lines: {{bus: {{stations: [one, other, slave], contention: 1}}}}\n",
      netr_at(4), netr_at(5, scan), ppi_slave()));
}

TEST(SystemRig, AMasterOfPpiThatHearsAnotherOneSaysSo) {
  const auto rig = two_masters_of_ppi(2000);
  ASSERT_TRUE(rig);
  Unmodelled told;
  rig->plc(1).cpu().set_sink(&told);
  rig->system().run_until(5 * kSecond);
  rig->plc(1).cpu().set_sink(nullptr);
  EXPECT_GE(told.count, 2) << "the request and the poll of the first one";
  for (std::size_t plc = 0; plc < 2; ++plc) EXPECT_EQ(double_word(*rig, plc, 107), 0x01020304U);
}

TEST(SystemRig, JobsOfTwoMastersOfPpiThatCollideEnd) {
  const auto rig = two_masters_of_ppi(3);
  ASSERT_TRUE(rig);
  rig->system().run_until(5 * kSecond);
  for (std::size_t plc = 0; plc < 2; ++plc) EXPECT_EQ(job_status(*rig, plc) & 0xE0U, 0xA0U) << "done, with an error";
}

/// Master and slave are PLCs, and the slave answers within 3.5 characters.
TEST(SystemRig, AFaultOfAStationThatAnswersAProgramCountsItsOwnCharacters) {
  const auto ends_with = [](std::string_view fault) {
    const auto rig =
        rig_of(fmt::format("{}    faults: [{{fault: \"{}\", station: slave}}]\n",
                           fmt::format("plcs:\n  master: {{program: {}, cpu: 224}}\n  slave: {{program: {}, cpu: 224}}\n"
                                       "lines:\n  bus:\n    stations: [master, slave]\n",
                                       netr_at(4), ppi_slave()),
                           fault));
    if (!rig) return 0U;
    rig->system().run_until(2 * kSecond);
    return job_status(*rig, 0) & 0xE0U;
  };
  EXPECT_EQ(ends_with("flip:character=1"), 0xA0U) << "its E5, and not a character of the request: done, with an error";
  EXPECT_EQ(ends_with("flip:character=40"), 0x80U) << "it sends no such character in an exchange";
}

/// No answer has 33 characters; the request for four bytes has.
TEST(SystemRig, AFaultOfAnswersIsOfAllButTheMasterThatTheLineNames) {
  const auto disturbed = [](std::string_view master) {
    const auto rig =
        rig_of(fmt::format("plcs:\n  master: {{program: {}, cpu: 224}}\n  slave: {{program: {}, cpu: 224}}\n"
                           "lines:\n  bus:\n    stations: [master, slave]\n    master: {}\n"
                           "    faults: [\"parity:character=33,of=answer\"]\n",
                           netr_at(4), ppi_slave(), master));
    if (!rig) return std::uint64_t{0};
    rig->system().run_until(2 * kSecond);
    return rig->faults(0).state().injected.front().count;
  };
  EXPECT_EQ(disturbed("master"), 0U);
  EXPECT_GT(disturbed("slave"), 0U) << "what the other sends are answers then";
}

TEST(SystemRig, ALineOfPpiIsAtTheRateOfItsFirstPlc) {
  const auto rig = rig_of(
      "plcs: {a: {program: ../character_echo.stl, cpu: 224, constants: {SMB30: 0}, ppi_baud: 187500}}\n"
      "lines: {bus: {stations: [a]}}\n");
  ASSERT_TRUE(rig);
  rig->system().run_until(100 * kMillisecond);
  EXPECT_EQ(rig->plc(0).line_format(), (SerialFormat{187500, 8, Parity::Even, 1}));
  EXPECT_EQ(rig->plc(0).port_format(), (SerialFormat{187500, 8, Parity::Even, 1}));
}

// --- one time ---

TEST(SystemRig, TheSameFileGivesTheSameRunInSlicesAndFromASnapshot) {
  constexpr Time kEnd = 4500 * kMillisecond;
  const auto whole = rig_of_file("faults.yaml"), sliced = rig_of_file("faults.yaml"), again = rig_of_file("faults.yaml");
  ASSERT_TRUE(whole && sliced && again);
  const serial::System::Snapshot end = end_of(*whole, kEnd, kEnd);
  EXPECT_TRUE(end == end_of(*sliced, kEnd, 377 * kMicrosecond));
  const serial::System::Snapshot middle = end_of(*again, 1234 * kMillisecond, kSecond);
  again->system().run_until(1900 * kMillisecond);
  again->system().restore(middle);
  EXPECT_TRUE(again->system().snapshot() == middle);
  EXPECT_TRUE(end == end_of(*again, kEnd, kEnd));
}

/// Two that are of one mind about when to speak, and not about what.
std::string contention(const std::string& seed) {
  return "plcs: {slave: {program: ../modbus_slave.stl, station: 1}}\n"
         "peers:\n"
         "  one: {polls: [{station: 1, read: 40001}], every: 100ms, timeout: 30ms}\n"
         "  other: {polls: [{station: 2, read: 40011}], every: 100ms, timeout: 30ms}\n"
         "lines: {bus: {stations: [one, slave, other], contention: " +
         seed + "}}\n";
}

TEST(SystemRig, DriversThatDisagreeGiveTheSameLevelsForTheSameSeedOnly) {
  const auto first = rig_of(contention("1")), same = rig_of(contention("1")), different = rig_of(contention("2"));
  ASSERT_TRUE(first && same && different);
  const auto end = end_of(*first, 2 * kSecond, kSecond);
  EXPECT_TRUE(end == end_of(*same, 2 * kSecond, kSecond));
  const auto heard = [](const serial::System::Snapshot& snapshot) { return snapshot.plcs[0].cpu; };
  EXPECT_FALSE(heard(end) == heard(end_of(*different, 2 * kSecond, kSecond)));
}

TEST(SystemRig, DriversThatDisagreeAreLeftToChanceUnlessSpaceIsToWin) {
  const auto written = [](const std::string& settings) {
    const auto rig = rig_of(
        "plcs: {slave: {program: ../modbus_slave.stl, station: 1}}\n"
        "peers:\n"
        "  one: {polls: [{station: 1, read: 40001}], every: 100ms, timeout: 30ms}\n"
        "  other: {polls: [{station: 2, read: 40011}], every: 100ms, timeout: 30ms}\n"
        "lines: {bus: {stations: [one, slave, other]" +
        settings + "}}\n");
    return rig ? end_of(*rig, 2 * kSecond, kSecond).plcs[0].cpu : State{};
  };
  const State usual = written("");
  EXPECT_TRUE(usual == written(", contention: 1"));
  EXPECT_FALSE(usual == written(", contention: space"));
}

// --- who joins ---

TEST(SystemRig, ASpotIsALineOrAPlcOrOneOfItsPorts) {
  const auto rig = rig_of_file("gateway.yaml");
  ASSERT_TRUE(rig);
  const auto spot = [&](std::string_view name) { return find_spot(rig->plan(), name).value_or(Spot{99, 99, 9}); };
  EXPECT_EQ(spot("office"), (Spot{0, 0, 0}));
  EXPECT_EQ(spot("gateway"), (Spot{0, 0, 0}));
  EXPECT_EQ(spot("field"), (Spot{1, 0, 1})) << "beside the first PLC along the cable";
  EXPECT_EQ(spot("gateway.1"), (Spot{1, 0, 1}));
  EXPECT_EQ(spot("pump"), (Spot{1, 1, 0}));
  for (const char* const wrong : {"", "attic", "pump.1", "gateway.2", "master"})
    EXPECT_FALSE(find_spot(rig->plan(), wrong)) << wrong;
}

/// The three slaves and who joins beside one of them, 100 ms after the cable was cut after slave1.
std::unique_ptr<RecordedRig> cut_after_slave1(std::size_t beside) {
  SystemFile file = read_system(kThreeSlaves, example("test.yaml"), host_files());
  file.plan.events.push_back({.what = EventPlan::What::Cut, .at = 100 * kMillisecond, .line = 0, .near = 2});
  std::vector<std::string> problems;
  auto rig = RecordedRig::assemble(std::move(file.plan), {.seen = {.spots = {Spot{0, beside, 0}}}}, problems);
  if (!rig) return rig;
  rig->power_up();
  rig->system().run_until(200 * kMillisecond);
  return rig;
}

TEST(SystemRig, ABridgeAtAPlcIsOnItsPartOfACutLine) {
  for (std::size_t beside = 0; beside < 3; ++beside) {
    const auto rig = cut_after_slave1(beside);
    ASSERT_TRUE(rig);
    serial::HostPort& port = rig->simulation().host_port();
    const SerialFormat format = rig->simulation().port_format();
    port.attach(format, rig->system().time());
    for (int station = 1; station <= 3; ++station) {
      std::vector<serial::HostCharacter> request;
      for (const std::uint8_t byte :
           modbus::rtu_frame(static_cast<std::uint8_t>(station), modbus::read_holding_registers(0, 1)))
        request.push_back({.byte = byte, .format = format});
      port.send(request, rig->system().time());
      rig->system().run_until(rig->system().time() + 60 * kMillisecond);
      const bool answered = !port.take_received().empty();
      EXPECT_EQ(answered, (station == 1) == (beside == 0)) << "beside slave" << beside + 1 << ", station " << station;
    }
  }
}

TEST(SystemRig, WhoJoinsAtAPlcIsOnItsPartOfACutLine) {
  for (const auto& [beside, reached] : {std::pair<std::size_t, int>{0, 1}, {1, 2}, {2, 3}}) {
    const auto rig = cut_after_slave1(beside);
    ASSERT_TRUE(rig);
    serial::Simulation& simulation = rig->simulation();
    for (int station = 1; station <= 3; ++station) {
      const Bytes frame = modbus::rtu_frame(static_cast<std::uint8_t>(station), modbus::read_holding_registers(0, 1));
      simulation.configure_master(simulation.port_format());
      simulation.master().start({.frame = serial::to_frame(frame), .timeout = 60 * kMillisecond}, simulation.time());
      const bool answered = !simulation.finish_exchange().response.empty();
      EXPECT_EQ(answered, (station == 1) == (reached == 1)) << "beside slave" << beside + 1 << ", station " << station;
      rig->system().run_until(rig->system().time() + 60 * kMillisecond);
    }
  }
}

}  // namespace
}  // namespace s7200::tools::system_rig_test

// Programs tried by chance: the bench, what is seen of contacts, shorter trials.
#include "serial_sim/modbus/crc.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tests/support/inspected.hpp"
#include "tools/trials/chance.hpp"
#include "tools/trials/shortened.hpp"
#include "tools/trials/trial_bench.hpp"
#include "tools/trials/trial_text.hpp"
#include "tools/trials/vocabulary.hpp"

namespace s7200::tools::trials_test {
namespace {

using test::inspected;
using What = Stimulus::What;

std::shared_ptr<const Program> checked(std::string_view text) { return inspected(text, {}, *find_cpu("214")).program; }

TEST(TrialBench, ACharacterComesAndIsAnsweredWhenItDoesOnALine) {
  const auto program =
      checked("LD SM0.1\nMOVB 9, SMB30\nMOVB 1, VB0\nATCH 0, 8\nENI\nMEND\nINT 0\nMOVB SMB2, VB1\nXMT VB0, 0\nRETI\n");
  TrialBench bench(program, 0);
  bench.power_up();
  bench.apply({.what = What::Frame, .bytes = {0x5A}}, 200 * kMillisecond);
  ASSERT_EQ(bench.done().sent.size(), 1U);

  serial::Simulation line(program);
  line.power_up();
  line.let_master_follow([](const SerialFormat& port) { return port; });
  line.run_until(200 * kMillisecond);
  line.master().start({.frame = serial::parse_hex_frame("5a").frame}, line.time());
  const auto exchange = line.finish_exchange();
  ASSERT_EQ(exchange.response_bytes(), Bytes{0x5A});
  EXPECT_EQ(exchange.response_start, bench.done().sent[0].at);
}

TEST(TrialBench, ASnapshotGoesOnAsTheRunItIsFrom) {
  TrialBench bench(checked("LD I0.0\nTON T37, 3\nLD T37\n= Q0.0\nMEND\n"), 0);
  bench.power_up();
  bench.apply({.what = What::Input, .bytes = {1}}, 50 * kMillisecond);
  const auto snapshot = bench.snapshot();
  bench.run_until(kSecond);
  ASSERT_EQ(bench.done().outputs.size(), 1U);
  const Time at = bench.done().outputs[0].at;
  bench.restore(snapshot);
  EXPECT_TRUE(bench.done().outputs.empty());
  bench.run_until(kSecond);
  ASSERT_EQ(bench.done().outputs.size(), 1U);
  EXPECT_EQ(bench.done().outputs[0].at, at);
}

TEST(ContactsSeen, AContactCountsWhenItWasSeenClosedAndOpen) {
  TrialBench bench(checked("LD SM0.0\nA I0.0\nAW>= VW0, 5\n= Q0.0\nMEND\n"), 0);
  bench.watch_contacts(true);
  bench.power_up();
  bench.run_until(100 * kMillisecond);
  EXPECT_TRUE(bench.contacts().add_run());
  EXPECT_EQ(bench.contacts().contacts(), 2U);  // SM0.0 is always 1
  EXPECT_EQ(bench.contacts().never().size(), 2U);
  EXPECT_TRUE(bench.contacts().never()[1].open);  // whatever reaches it
  bench.apply({.what = What::Input, .bytes = {1}}, 0);
  bench.run_until(200 * kMillisecond);
  EXPECT_TRUE(bench.contacts().add_run());
  EXPECT_EQ(bench.contacts().both_ways(), 1U);
  bench.apply({.what = What::Memory, .place = image::kV, .bytes = {0, 9}}, 0);
  bench.run_until(300 * kMillisecond);
  EXPECT_TRUE(bench.contacts().add_run());
  EXPECT_TRUE(bench.contacts().all_both_ways());
}

TEST(Vocabulary, IsWhatReachesAProgramFromOutside) {
  const auto inspection = inspected(
      "LD I0.3\nAW>= AIW4, 100\nTON T37, 20\nLDW= VW6, 7\nMOVW VW8, VW10\nMOVW VW10, VW12\nMEND\n", {}, *find_cpu("214"));
  const Vocabulary words = vocabulary_of(inspection.facts);
  ASSERT_EQ(words.inputs.size(), 1U);
  EXPECT_EQ(words.inputs[0].mask, 8);
  ASSERT_EQ(words.analog.size(), 1U);
  EXPECT_EQ(words.presets, std::vector<Time>{2 * kSecond});
  EXPECT_EQ(words.commands.size(), 2U);  // VW6 and VW8; VW10 is the program's own
  EXPECT_FALSE(words.port);
}

TEST(Vocabulary, KnowsWhatPointersReadAndWhatDecides) {
  const auto inspection = inspected(
      "LD SM0.1\nMOVD &VB100, VD50\nLD SM0.0\nMOVW *VD50, VW60\nLDW>= VW60, 50\nLD I0.0\nLD I0.1\nCTU C1, 3\nMEND\n", {},
      *find_cpu("214"));
  const Vocabulary words = vocabulary_of(inspection.facts);
  ASSERT_EQ(words.commands.size(), 1U);
  EXPECT_EQ(words.commands[0].place, image::kV + 100);
  EXPECT_EQ(words.counts, std::vector<std::uint32_t>{3});
  ASSERT_EQ(words.comparisons.size(), 1U);
  std::vector<std::uint8_t> image(image::kSize);
  image[image::kV + 61] = 48;
  EXPECT_EQ(words.comparisons[0].difference(image), std::uint32_t(-2));
}

/// Of so many values that VW10 is set to, those at the boundary of VW20 > 12345, as if VW10 decided that.
int at_the_boundary(TrialMaker& maker, const State& now, int draws) {
  int hits = 0;
  for (; draws > 0; --draws) {
    const std::uint16_t value = load16(maker.next(now).front().bytes.data());
    hits += value >= 12344 && value <= 12346;
  }
  return hits;
}

TEST(TrialMaker, WhatIsLearntByCoincidenceIsForgottenAgain) {
  const auto before = std::make_unique<State>(), after = std::make_unique<State>();
  TrialMaker maker({.inputs = {},
                    .analog = {},
                    .commands = {{image::kV + 10, 2, 0xFF}},
                    .comparisons = {{.left = {image::kV + 20, 0}, .right = {{}, 12345}, .count = 2}},
                    .constants = {},
                    .presets = {}},
                   1);
  EXPECT_EQ(at_the_boundary(maker, *before, 60), 0);
  store16(&after->image[image::kV + 20], load16(maker.next(*before).front().bytes.data()));
  maker.learn(*after);
  EXPECT_GT(at_the_boundary(maker, *before, 60), 20);
  for (int i = 0; i < 10; ++i) {
    maker.next(*before);
    maker.learn(*before);
  }
  EXPECT_EQ(at_the_boundary(maker, *before, 60), 0);
}

TEST(Vocabulary, WhatOverlappingWritesReachIsNotSet) {
  const Inspection inspected_program = inspected(
      "LD SM0.0\nMOVD &VB10, VD0\nMOVW *VD0, VW20\nMOVD &VB30, VD4\nMOVW *VD4, VW22\nMOVB 1, VB8\nMOVD 2, VD7\nMEND\n", {},
      *find_cpu("214"));
  const Vocabulary words = vocabulary_of(inspected_program.facts);
  const auto sets = [&](std::uint32_t place) {
    return std::ranges::find(words.commands, image::kV + place, &Vocabulary::Bytes::place) != words.commands.end();
  };
  EXPECT_FALSE(sets(10)) << "its first byte is the last of VD7";
  EXPECT_TRUE(sets(30));
}

TEST(Shortened, LeavesOutWhatDoesNotMatter) {
  Trial trial;
  for (std::uint8_t i = 0; i < 20; ++i)
    trial.push_back({.wait = 7 * kMillisecond, .what = What::Input, .place = i, .bytes = {0xFF}});
  const auto holds = [](const Trial& of) {
    bool third = false, ninth = false;
    for (const Stimulus& stimulus : of) {
      third |= stimulus.place == 3 && (stimulus.bytes[0] & 4) != 0;
      ninth |= third && stimulus.place == 9 && stimulus.wait >= 3 * kMillisecond;
    }
    return ninth;
  };
  const Trial shortest = shortened(trial, holds, 2000);
  ASSERT_EQ(shortest.size(), 2U);
  EXPECT_EQ(shortest[0].bytes[0], 4);
  EXPECT_EQ(shortest[0].wait, 0);
}

TEST(Shortened, WhatOnlyLetsTimePassBecomesNothing) {
  const auto holds = [](const Trial& of) {
    Time passed = 0;
    for (const Stimulus& stimulus : of) passed += stimulus.wait;
    return of.size() > 1 && of[0].bytes[0] == 1 && passed >= 2 * kSecond;
  };
  const Trial trial{{.what = What::Input, .bytes = {1}},
                    {.wait = 2001 * kMillisecond, .what = What::Memory, .place = image::kM, .bytes = {7}}};
  const Trial shortest = shortened(trial, holds, 2000);
  ASSERT_EQ(shortest.size(), 2U);
  EXPECT_EQ(shortest[1], (Stimulus{.wait = shortest[1].wait, .what = What::Input, .bytes = {1}}));
  EXPECT_NE(trial_text(shortest, {0, 2 * kSecond}).find("2 s  nothing more: time passes\n"), std::string::npos);
}

TEST(Shortened, ACharacterWithWrongParityStaysTheOneThatItWas) {
  const auto holds = [](const Trial& of) {
    return of.size() == 1 && of[0].damaged != 0 && of[0].bytes[of[0].damaged - 1u] == 0x55;
  };
  const Trial shortest = shortened({{.what = What::Frame, .bytes = {1, 2, 0x55, 3}, .damaged = 3}}, holds, 2000);
  EXPECT_EQ(shortest[0].bytes, std::vector<std::uint8_t>{0x55});
  EXPECT_EQ(shortest[0].damaged, 1);
}

TEST(TrialText, PulsesThatComeAgainAndAgainAreInThreeLines) {
  Trial trial;
  std::vector<Time> begun;
  for (std::uint8_t i = 0; i < 11; ++i) {
    trial.push_back({.what = What::Input, .bytes = {static_cast<std::uint8_t>(i % 2 == 0 ? 1 : 0)}});
    begun.push_back(i * 10 * kMillisecond);
  }
  EXPECT_EQ(trial_text(trial, begun),
            "          0 ns  I0.0 = 1\n         10 ms  I0.0 = 0\n             …  both 4 times more, until 90 ms\n"
            "        100 ms  I0.0 = 1\n");
  trial.resize(9);
  EXPECT_EQ(std::ranges::count(trial_text(trial, begun), '\n'), 9) << "few are all shown";
}

TEST(TrialBench, APowerFailureKeepsRetentiveMemoryAndTheLevelsOfInputs) {
  TrialBench bench(checked("LD SM0.1\nINCW VW4000\nLD I0.0\nS M20.0, 1\n= Q0.0\nMEND\n"), 0);
  bench.power_up();
  bench.apply({.what = What::Input, .bytes = {1}}, 50 * kMillisecond);
  bench.run_until(100 * kMillisecond);
  bench.poke(image::kM + 3, {7});
  bench.apply({.what = What::Power}, 100 * kMillisecond);
  EXPECT_EQ(bench.powered_up_at(), bench.cpu().state().time - kReady);
  EXPECT_EQ(bench.cpu().state().image[image::kM + 20], 1);
  EXPECT_EQ(bench.cpu().state().image[image::kM + 3], 0);
  EXPECT_EQ(bench.cpu().state().image[image::kQ], 1);
}

TEST(TrialBench, ABreakIsACharacterOfZerosWithoutItsStopBit) {
  TrialBench bench(checked("LD SM0.1\nMOVB 16#C9, SMB30\nATCH 0, 8\nENI\nMEND\n"
                           "INT 0\nLD SM3.0\nMOVB 1, VB1\nLD SM0.0\nMOVB SMB2, VB0\nINCW VW2\nRETI\n"),
                   0);
  bench.power_up();
  bench.poke(image::kV, {0xFF});
  bench.apply({.what = What::Break}, 100 * kMillisecond);
  EXPECT_EQ(bench.cpu().state().image[image::kV], 0);
  EXPECT_EQ(bench.cpu().state().image[image::kV + 1], 1);  // odd parity wants a parity bit of 1
  EXPECT_EQ(bench.cpu().state().image[image::kV + 3], 1);
}

TEST(Shortened, AFrameKeepsItsCrcWhereThatMatters) {
  Stimulus frame{.what = What::Frame, .bytes = {1, 3, 0x12, 0x34, 0, 9}};
  modbus::add_crc(frame.bytes);
  const auto holds = [](const Trial& of) {
    return of.size() == 1 && of[0].bytes.size() >= 4 && modbus::crc_ok(of[0].bytes) && of[0].bytes[1] == 3;
  };
  const Trial shortest = shortened({frame}, holds, 2000);
  EXPECT_EQ(shortest[0].bytes.size(), 4U);
  EXPECT_TRUE(modbus::crc_ok(shortest[0].bytes));
}

}  // namespace
}  // namespace s7200::tools::trials_test

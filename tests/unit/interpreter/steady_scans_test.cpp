// Scans that are all alike are passed over, and nothing shows it but the speed.
#include "interpreter/cpu/steady_scans.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <new>
#include <random>
#include <set>
#include <utility>

#include "interpreter/cpu/units.hpp"
#include "tests/support/with_and_without.hpp"

namespace s7200::test::steady_scans_test {
namespace {

constexpr std::string_view kContactsOnly = "LD I0.0\nA M0.0\n= Q0.0\nMEND\n";

TEST(SteadyScans, AreNearlyAllOfAMinuteInWhichNothingHappens) {
  Both both(kContactsOnly);
  both.run_until(60 * kSecond);
  EXPECT_GT(both.passed(), 59 * kSecond);
}

TEST(SteadyScans, ArePassedOverWithAClockThatIsOff) {
  for (const std::int32_t clock_error : {50, -50, 977}) {
    Both both("LD SM0.5\n= Q0.0\nLD SM0.0\nTON T37, 100\nTON T33, 555\nA T33\nTON T101, 2000\nMEND\n");
    both.each([clock_error](Plc& plc) {
      plc.cpu.set_clock_error(clock_error);
      plc.cpu.power_up();
    });
    for (int end = 1; end < 20; ++end) both.run_until(end * 1100 * ms);
    EXPECT_GT(both.passed(), 15 * kSecond);
  }
}

TEST(SteadyScans, AreNotPassedOverIfTheyAreOff) {
  PlcThat plc(SteadyScansUse::Off, kContactsOnly);
  plc.run_until(60 * kSecond);
  EXPECT_EQ(plc.cpu.passed_over(), 0);
}

TEST(SteadyScans, DoNotDependOnWhatWasInTheirMemoryBefore) {
  alignas(Plc) std::array<std::byte, sizeof(Plc)> memory{};
  std::set<Time> passed;
  for (std::uint8_t rest = 0; rest < 4; ++rest) {
    memory.fill(std::byte{rest});
    const std::unique_ptr<Plc, void (*)(Plc*)> plc{new (memory.data()) Plc(kContactsOnly), std::destroy_at};
    plc->run_until(kSecond);
    passed.insert(plc->cpu.passed_over());
  }
  EXPECT_EQ(passed.size(), 1u);
}

TEST(SteadyScans, AreNotPassedOverForAWatcherOfScans) {
  PlcThat plc(SteadyScansUse::Eager, kContactsOnly);
  plc.records.scans = true;
  plc.run_until(60 * kSecond);
  EXPECT_EQ(plc.cpu.passed_over(), 0);
  EXPECT_EQ(plc.records.of(TraceKind::ScanBegin).size(), plc.cpu.state().scans);  // not that of power-up
}

TEST(SteadyScans, AScanThatIsPausedForIsNotPassedOver) {
  PlcThat plc(SteadyScansUse::Eager, kContactsOnly);
  plc.run_until(kSecond);
  plc.cpu.pause_at_scan_end(true);
  const std::uint64_t before = plc.cpu.state().scans;
  for (std::uint64_t scan = before + 1; scan < before + 8; ++scan) {
    plc.cpu.run(kNever);
    EXPECT_TRUE(plc.cpu.paused());
    EXPECT_EQ(plc.cpu.state().scans, scan);
  }
}

TEST(SteadyScans, OfTwoHundredAndFiftyYearsOverflowNothing) {
  PlcThat plc(SteadyScansUse::Eager, kContactsOnly);
  const Time years = Time{250} * 365 * 24 * 3600 * kSecond;
  plc.cpu.run(years);
  EXPECT_EQ(plc.cpu.state().mode, Mode::Run);
  EXPECT_GE(plc.cpu.time(), years);
}

TEST(SteadyScans, AreSeldomLookedForWhereNoneAreFound) {
  for (const char* text : {"LDN Q0.0\n= Q0.0\nMEND\n", "LD SM0.6\n= Q0.0\nMEND\n", "LD SM0.0\nINCW VW0\nMEND\n",
                           "LD SM0.6\nTON T37, 100\nMEND\n", "LD SM0.0\nINCW VW0\nTON T37, VW0\nMEND\n"}) {
    PlcThat plc(SteadyScansUse::On, text);
    plc.run_until(600 * kSecond);
    EXPECT_EQ(plc.cpu.passed_over(), 0) << text;
    EXPECT_GT(plc.cpu.looks_at_scans(), 0u) << text;
    EXPECT_LT(plc.cpu.looks_at_scans(), 20u) << text;
  }
}

TEST(SteadyScans, ACountingProgramHasNone) {
  Both both("LD SM0.0\nINCW VW0\nMEND\n");
  both.run_until(20 * kSecond);
  EXPECT_EQ(both.passed(), 0);
}

TEST(SteadyScans, AnInputIsSeenInItsScan) {
  Both both("LD I0.0\nEU\nINCW VW0\nMEND\n");
  both.each([](Plc& plc) {
    for (int i = 1; i <= 10; ++i) plc.input_at(i * 7'123'456 * us, "I0.0", i % 2);
  });
  for (int i = 1; i <= 80; ++i) both.run_until(i * kSecond);
  EXPECT_EQ(both.plc().value("VW0"), 5);
  EXPECT_GT(both.passed(), 60 * kSecond);
}

TEST(SteadyScans, AreKnownUntilSomethingComesFromOutside) {
  PlcThat plc(SteadyScansUse::Eager, kContactsOnly);
  plc.run_until(kSecond);
  EXPECT_EQ(plc.cpu.alike_until(), kNever);
  plc.cpu.set_input(0, 1, plc.cpu.time());
  EXPECT_EQ(plc.cpu.alike_until(), plc.cpu.time());
}

TEST(SteadyScans, EndWithWhateverIsDoneToTheCpu) {
  struct Deed {
    const char* what;
    void (*do_to)(Cpu& cpu);
  };
  static constexpr MemoryRange kI00{.area = Area::I, .width = Width::Bit, .at = image::kI};
  constexpr Deed kDeeds[] = {
      {"memory written", [](Cpu& cpu) { cpu.poke(image::kM, std::array<std::uint8_t, 1>{}); }},
      {"a point forced", [](Cpu& cpu) { cpu.force(kI00, 1); }},
      {"and unforced", [](Cpu& cpu) { cpu.unforce(kI00); }},
      {"an input", [](Cpu& cpu) { cpu.set_input(1, 1, cpu.time()); }},
      {"the clock set", [](Cpu& cpu) { cpu.set_clock({}); }},
      {"a state restored", [](Cpu& cpu) { cpu.restore(State(cpu.state())); }},
      {"someone else to be told", [](Cpu& cpu) { cpu.set_sink(nullptr); }},
      {"an instruction skipped", [](Cpu& cpu) { cpu.go_to(cpu.state().pc); }},
      {"the logic stack set", [](Cpu& cpu) { cpu.set_stack(cpu.state().stack); }},
      {"a character received", [](Cpu& cpu) { cpu.character_received({}); }},
      {"a character sent", [](Cpu& cpu) { cpu.character_sent(cpu.time()); }},
      {"one of its events", [](Cpu& cpu) { cpu.handle({.at = cpu.time(), .owner = kCpu, .what = kTick1ms}); }},
      {"power switched on", [](Cpu& cpu) { cpu.power_up(true, nullptr, cpu.time()); }},
  };
  PlcThat plc(SteadyScansUse::Eager, kContactsOnly);
  plc.run_until(kSecond);
  for (const Deed& deed : kDeeds) {
    plc.run_until(plc.cpu.time() + kSecond);
    ASSERT_GT(plc.cpu.alike_until(), plc.cpu.time()) << "before: " << deed.what;
    deed.do_to(plc.cpu);
    EXPECT_EQ(plc.cpu.alike_until(), plc.cpu.time()) << deed.what;
  }
}

TEST(SteadyScans, AreKnownInARunOfManyShortOnesToo) {
  PlcThat plc(SteadyScansUse::Eager, kContactsOnly);
  for (Time end = 0; end < kSecond; end += kMillisecond) plc.run_until(end);
  EXPECT_EQ(plc.cpu.alike_until(), kNever);
}

TEST(SteadyScans, OfAProgramThatReadsAClockBitAreAlikeUntilItChanges) {
  PlcThat plc(SteadyScansUse::Eager, "LD SM0.5\n= Q0.0\nMEND\n");
  plc.run_until(1200 * kMillisecond);
  EXPECT_GT(plc.cpu.alike_until(), 1450 * kMillisecond);
  EXPECT_LE(plc.cpu.alike_until(), 1500 * kMillisecond);
}

TEST(SteadyScans, OfAProgramThatCountsAreNeverKnown) {
  PlcThat plc(SteadyScansUse::Eager, "LD SM0.0\nINCW VW0\nMEND\n");
  plc.run_until(kSecond);
  EXPECT_EQ(plc.cpu.alike_until(), plc.cpu.time());
}

TEST(SteadyScans, AWriteFromOutsideEndsThem) {
  Both both("LD M0.0\nEU\nINCW VW0\nMEND\n");
  both.run_until(10 * kSecond);
  both.each([](Plc& plc) { plc.set("M0.0", 1); });
  both.run_until(20 * kSecond);
  EXPECT_EQ(both.plc().value("VW0"), 1);
}

TEST(SteadyScans, ClockBitsChangeOnTime) {
  for (const char* read : {"LD SM0.5\n= Q0.0\nMEND\n", "LD SM0.0\nMOVB SMB0, VB0\nMEND\n", "LD SM0.4\n= M0.0\nMEND\n"}) {
    Both both(read);
    for (int i = 1; i <= 70; ++i) both.run_until(i * 777 * ms);
    EXPECT_GT(both.passed(), 20 * kSecond) << read;
  }
}

TEST(SteadyScans, ClockBitsThatNobodyReadsAreRightAllTheSame) {
  Both both(kContactsOnly);
  for (int i = 1; i <= 50; ++i) both.run_until(i * 1'333 * ms);
}

TEST(SteadyScans, ATimerReachesItsPresetOnTime) {
  for (const char* timer : {"T33", "T37", "T1", "T5"}) {
    const char* const on = timer[1] == '3' ? "TON" : "TONR";
    Both both(fmt::format("LD I0.0\n{} {}, 250\nLD {}\n= Q0.0\nEU\nINCW VW0\nMEND\n", on, timer, timer));
    both.each([](Plc& plc) {
      plc.input_at(3 * kSecond, "I0.0", true);
      plc.input_at(60 * kSecond, "I0.0", false);
    });
    for (int i = 1; i <= 100; ++i) both.run_until(i * 999 * ms);
    EXPECT_EQ(both.plc().value("VW0"), 1) << timer;
    EXPECT_GT(both.passed(), 50 * kSecond) << timer;
  }
}

TEST(SteadyScans, ATimerThatIsOffDoesNotKeepScansFromBeingAlike) {
  struct Off {
    std::string_view timer;
    bool input;
  };
  for (const auto& [timer, input] :
       {Off{"TON T32", false}, Off{"TON T33", false}, Off{"TON T37", false}, Off{"TONR T0", false}, Off{"TONR T5", false},
        Off{"TOF T32", false}, Off{"TOF T37", false}, Off{"TOF T37", true}}) {
    Both both(fmt::format("LD I0.0\n{}, 100\nMEND\n", timer), *find_cpu("224"));
    both.each([level = input](Plc& plc) { plc.input("I0.0", level); });
    both.run_until(60 * kSecond);
    EXPECT_GT(both.passed(), 59 * kSecond) << timer;
  }
}

/// It looks off between scans.
TEST(SteadyScans, ATimerExecutedThreeTimesInAScanAndLastOffCountsInBetween) {
  for (const char* timer : {"TONR T5", "TON T37", "TONR T1", "TON T33", "TONR T0", "TON T32"}) {
    Both both(fmt::format("LD SM0.0\n{0}, 40\nLD SM0.0\n{0}, 40\nLD {1}\nEU\nINCW VW0\nLDN SM0.0\n{0}, 40\nMEND\n", timer,
                          std::string(timer).substr(std::string(timer).find('T', 1))),
              *find_cpu("224"));
    for (int i = 1; i <= 60; ++i) both.run_until(i * 333 * ms);
    if (std::string_view(timer) == "TONR T5") {
      EXPECT_EQ(both.plc().value("T5"), 199);
      EXPECT_GT(both.passed(), 10 * kSecond);
    }
  }
}

TEST(SteadyScans, ATimerThatIsOnInEverySecondScanCountsTheTicksBetweenThem) {
  Both both("LD SM0.6\nTONR T1, 1\nMEND\n");
  for (int i = 1; i <= 60; ++i) both.run_until(i * 333 * ms);
  EXPECT_GT(both.plc().value("T1"), 500);
}

TEST(SteadyScans, APresetThatDiffersFromScanToScanIsReachedInItsScan) {
  Both both(
      "LD SM0.6\nMOVW 300, VW2\nNOT\nMOVW 100, VW2\nLD I0.0\nTON T37, VW2\nLD T37\nEU\nINCW VW0\nLD SM0.5\n= Q0.0\nMEND\n");
  both.each([](Plc& plc) { plc.input("I0.0", true); });
  for (int i = 1; i <= 120; ++i) both.run_until(i * 333 * ms);
  EXPECT_GT(both.plc().value("VW0"), 100);
}

TEST(SteadyScans, ATableThatIsSearchedIsSeenTickByTick) {
  Both both("LD SM0.0\nTON T37, 1000\nMOVW 10, T30\nMOVW 0, VW0\nFND> T30, 50, VW0\nMEND\n");
  for (int i = 1; i <= 60; ++i) both.run_until(i * 333 * ms);
  EXPECT_EQ(both.plc().value("VW0"), 6);
}

TEST(SteadyScans, AnOffDelayEndsOnTime) {
  Both both("LD I0.0\nTOF T37, 100\nLD T37\n= Q0.0\nMEND\n", *find_cpu("224"));
  both.each([](Plc& plc) {
    plc.input_at(2 * kSecond, "I0.0", true);
    plc.input_at(5 * kSecond, "I0.0", false);
  });
  for (int i = 1; i <= 40; ++i) both.run_until(i * 500 * ms);
  EXPECT_GT(both.passed(), 8 * kSecond);
}

TEST(SteadyScans, ATimerThatCountsOnAfterItsPresetEndsAt32767) {
  Both both("LD SM0.0\nTON T33, 10\nLD T33\n= Q0.0\nMEND\n");
  both.run_until(400 * kSecond);
  EXPECT_EQ(both.plc().value("T33"), 32767);
  EXPECT_GT(both.passed(), 390 * kSecond);
}

// What makes every tick matter.
TEST(SteadyScans, ATimerWhoseValueIsReadIsSeenTickByTick) {
  for (const char* rest : {"LD SM0.0\nMOVW T37, VW0\n", "LDW>= T37, 77\n= Q0.1\n", "LD SM0.0\nMOVW *VD100, VW0\n",
                           "LD SM0.0\nBMW T30, VW0, 20\n"}) {
    Both both(fmt::format("LD SM0.0\nTON T37, 1000\nLD SM0.1\nMOVD &T37, VD100\n{}MEND\n", rest));
    for (int i = 1; i <= 60; ++i) both.run_until(i * 333 * ms);
  }
}

TEST(SteadyScans, ATimerThatIsJumpedOverDoesNotCount) {
  Both both("LD M0.0\nJMP 1\nLD SM0.0\nTON T37, 100\nLBL 1\nLD T37\n= Q0.0\nMEND\n");
  both.run_until(3 * kSecond);
  both.each([](Plc& plc) { plc.set("M0.0", 1); });
  for (int i = 1; i <= 60; ++i) both.run_until(3 * kSecond + i * 333 * ms);
}

TEST(SteadyScans, ATimerThatIsResetAgainAndAgainStaysAtZero) {
  Both both("LD SM0.0\nTON T37, 100\nLD M0.0\nR T37, 1\nLD T37\n= Q0.0\nMEND\n");
  both.run_until(3 * kSecond);
  both.each([](Plc& plc) { plc.set("M0.0", 1); });
  for (int i = 1; i <= 60; ++i) both.run_until(3 * kSecond + i * 333 * ms);
}

TEST(SteadyScans, ATimerExecutedTwiceInAScanCountsTwice) {
  Both both("LD SM0.0\nTON T37, 1000\nLD SM0.0\nTON T37, 1000\nLD T37\n= Q0.0\nMEND\n");
  for (int i = 1; i <= 60; ++i) both.run_until(i * 1'234 * ms);
}

TEST(SteadyScans, ATimerInALoopOfABackwardJumpCountsInEachRound) {
  Both both(
      "LD SM0.0\nMOVW 0, VW0\nLBL 1\nLD SM0.0\nTON T37, 300\nLD SM0.0\nINCW VW0\nLDW<= VW0, 2\nJMP 1\nLD T37\n= Q0.0\n"
      "MEND\n");
  for (int i = 1; i <= 40; ++i) both.run_until(i * 999 * ms);
}

TEST(SteadyScans, ATimerInASubroutineCountsWhenItIsCalled) {
  Both both("LD M0.0\nCALL 0\nLD T37\n= Q0.0\nMEND\nSBR 0\nLD SM0.0\nTON T37, 200\nRET\n");
  both.each([](Plc& plc) { plc.set("M0.0", 1); });
  for (int i = 1; i <= 10; ++i) both.run_until(i * kSecond);
  both.each([](Plc& plc) { plc.set("M0.0", 0); });
  for (int i = 10; i <= 60; ++i) both.run_until(i * kSecond);
}

TEST(SteadyScans, TheTimeOfDayIsReadSecondBySecond) {
  Both both("LD SM0.0\nTODR VB0\nMEND\n");
  for (int i = 1; i <= 90; ++i) both.run_until(i * 777 * ms);
  EXPECT_GT(both.passed(), 30 * kSecond);
}

TEST(SteadyScans, SecondsBeginWhenTheClockWasSet) {
  Both both("LD SM0.0\nTODR VB0\nMEND\n");
  both.run_until(7'700 * ms);
  both.each([](Plc& plc) { plc.cpu.set_clock({.year = 26, .month = 1, .day = 1}); });
  for (int i = 8; i <= 30; ++i) both.run_until(i * kSecond);
  EXPECT_GT(both.passed(), 20 * kSecond);
}

TEST(SteadyScans, AProgramThatReadsMillisecondsHasNone) {
  Both both("LD SM0.0\nBITIM VD0\nCITIM VD0, VD4\nMEND\n", *find_cpu("224"));
  both.run_until(20 * kSecond);
  EXPECT_EQ(both.passed(), 0);
}

TEST(SteadyScans, AProgramOfWhichEveryScanIsWantedHasNone) {
  EventQueue queue;
  Port port(queue), port1(queue, 1);
  const auto program = std::make_shared<Program>(*program_of(kContactsOnly));
  program->looks.every_scan = true;
  Cpu cpu(program, queue, kCpu, {&port, &port1});
  cpu.use_steady_scans(SteadyScansUse::Eager);
  cpu.power_up();
  cpu.run(10 * kSecond);
  EXPECT_EQ(cpu.passed_over(), 0);
}

// SM0.6 makes every second scan 5 ms longer.
TEST(SteadyScans, ScansThatDifferInTurnArePassedOverInPairs) {
  Both both("LD SM0.6\nSQRT VD100, VD104\nLD SM0.0\nTON T37, 1000\nLD T37\n= Q0.0\nMEND\n");
  for (int i = 1; i <= 300; ++i) both.run_until(i * 334 * ms + i % 7 * ms);
  EXPECT_GT(both.passed(), 50 * kSecond);
}

/// The ticks of the scan before are those of a long one, or of a short one.
TEST(SteadyScans, OfWhichTheLastOneHasATickAreRightToo) {
  Both both("LD SM0.6\nSQRT VD100, VD104\nLD SM0.0\nTON T37, 30000\nMEND\n");
  for (int i = 1; i <= 600; ++i) both.run_until(i * 700 * ms + i % 60 * 150 * us);
  EXPECT_GT(both.passed(), 300 * kSecond);
}

TEST(SteadyScans, AreNotPassedOverOnceTheyAreOff) {
  PlcThat plc(SteadyScansUse::Eager, kContactsOnly);
  plc.run_until(kSecond);
  const Time passed = plc.cpu.passed_over();
  EXPECT_GT(passed, 0);
  plc.cpu.use_steady_scans(SteadyScansUse::Off);
  plc.run_until(2 * kSecond);
  EXPECT_EQ(plc.cpu.passed_over(), passed);
}

TEST(SteadyScans, AreNotKnownOnceEachIsWatched) {
  PlcThat plc(SteadyScansUse::Eager, kContactsOnly);
  plc.run_until(kSecond);
  plc.records.scans = true;
  plc.run_until(kSecond + 10 * kMillisecond);
  EXPECT_EQ(plc.cpu.alike_until(), plc.cpu.time());
}

/// Each run ends in the middle of some part of a scan.
TEST(SteadyScans, AreKnownInRunsShorterThanAnyPartOfAScan) {
  PlcThat plc(SteadyScansUse::Eager, kContactsOnly);
  for (Time end = 0; end < 100 * kMillisecond; end += 70 * us) plc.run_until(end);
  EXPECT_EQ(plc.cpu.alike_until(), kNever);
}

TEST(SteadyScans, LooksThatAreInVainLeaveTheEndOfARunWhereItIs) {
  const auto check = [](SteadyScansUse use, std::string_view text, bool scans) {
    PlcThat with(use, text), without(SteadyScansUse::Off, text);
    with.records.scans = without.records.scans = scans;
    for (int i = 0; i < 2000; ++i) {
      with.cpu.run(kNever, 3070 * us);
      without.cpu.run(kNever, 3070 * us);
      ASSERT_EQ(with.cpu.time(), without.cpu.time()) << text << i;
    }
  };
  check(SteadyScansUse::Eager, "LD SM0.0\nINCW VW0\nMEND\n", false);
  check(SteadyScansUse::Eager, kContactsOnly, true);
  check(SteadyScansUse::Check, kContactsOnly, false);
}

TEST(SteadyScans, ATimerOf10msOfASubroutineThatIsOffHoldsNothingUp) {
  Both both("LD I0.0\nCALL 0\nMEND\nSBR 0\nLD I0.1\nTON T33, 100\nRET\n");
  both.each([](Plc& plc) { plc.input("I0.0", true); });
  both.run_until(60 * kSecond);
  EXPECT_GT(both.passed(), 59 * kSecond);
}

TEST(SteadyScans, ATimerOf1msThatIsOffAgainTicksNoMore) {
  Both both("LD I0.0\nTON T32, 100\nMEND\n");
  both.each([](Plc& plc) {
    plc.input_at(kSecond, "I0.0", true);
    plc.input_at(2 * kSecond, "I0.0", false);
  });
  both.run_until(60 * kSecond);
  EXPECT_GT(both.passed(), 57 * kSecond);
}

TEST(SteadyScans, ATimerWithANegativeValueCountsUpFromThere) {
  Both both("LD SM0.1\nMOVW -20, T5\nMOVW -20, T1\nLD SM0.0\nTONR T5, 30\nTONR T1, 300\nMEND\n");
  for (int i = 1; i <= 101; ++i) both.run_until(i * 51 * ms);
  EXPECT_EQ(both.plc().value("T5"), 51 - 20);
  EXPECT_EQ(both.plc().value("T1"), 515 - 20);
}

TEST(SteadyScans, ATimedInterruptComesOnTime) {
  Both both("LD SM0.1\nMOVB 250, SMB34\nATCH 0, 10\nENI\nMEND\nINT 0\nINCW VW0\nRETI\n");
  for (int i = 1; i <= 60; ++i) both.run_until(i * 777 * ms);
  EXPECT_GT(both.plc().value("VW0"), 180);
}

TEST(SteadyScans, CharactersAreReceivedInTheScanTheyEndIn) {
  Both both("LD SM0.1\nMOVB 16#09, SMB30\nATCH 0, 8\nENI\nMEND\nINT 0\nINCW VW0\nMOVB SMB2, VB4\nRETI\n");
  both.each([](Plc& plc) {
    for (int i = 1; i <= 12; ++i) plc.character_at(i * 4'321'987 * us, static_cast<std::uint8_t>(i));
  });
  for (int i = 1; i <= 60; ++i) both.run_until(i * kSecond);
  EXPECT_EQ(both.plc().value("VW0"), 12);
  EXPECT_GT(both.passed(), 40 * kSecond);
}

/// What it has counted in the second scan of a pair is gone in the next one.
TEST(SteadyScans, ATimerThatIsResetInEachScanHasCountedInOneScanOnly) {
  Both both("LD SM0.0\nR T37, 1\nLDN I0.2\nTON T37, 95\nMEND\n");
  for (int tick = 1; tick <= 60; ++tick) {  // a look begins anew some time before each
    const Time at = tick * 100 * kMillisecond;
    both.each([&](Plc& plc) { plc.input_at(at - tick * 50 * us, "I0.0", tick % 2 != 0); });
    both.run_until(at + 20 * kMillisecond);
  }
  EXPECT_GT(both.passed(), kSecond);
}

/// A program about everything that goes on by itself, for a CPU 214 or a CPU 224.
class AboutTime {
 public:
  explicit AboutTime(std::mt19937& draw) : draw_(draw), is_224_(below(2) != 0) {}

  const CpuModel& model() const { return is_224_ ? *find_cpu("224") : cpu214(); }

  std::string text() {
    for (unsigned n = 3 + below(6); n > 0; --n) {
      const bool in_main = below(8) != 0;
      (in_main ? main_ : subroutine_) += network(n, in_main);
    }
    main_ += "LD SM0.1\nMOVB 16#09, SMB30\nATCH 0, 8\nENI\n";
    const std::string interrupt = "LD SM0.0\nINCW VW8\n";
    if (!is_224_) return main_ + "MEND\nSBR 0\n" + subroutine_ + "RET\nINT 0\n" + interrupt + "RETI\n";
    return "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\n" + main_ +
           "END_ORGANIZATION_BLOCK\nSUBROUTINE_BLOCK Work:SBR0\nVAR_INPUT\n on : BOOL;\n n : INT;\nEND_VAR\n"
           "VAR_OUTPUT\n y : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nLD #on\nMOVW #n, #y\n" +
           subroutine_ + "END_SUBROUTINE_BLOCK\nINTERRUPT_BLOCK Count:INT0\nBEGIN\nNETWORK 1\n" + interrupt +
           "END_INTERRUPT_BLOCK\n";
  }

 private:
  unsigned below(unsigned n) { return static_cast<unsigned>(draw_() % n); }
  template <std::size_t count>
  std::string one_of(const std::string_view (&names)[count]) {
    return std::string(names[below(count)]);
  }

  std::string timer() {
    static constexpr std::string_view kTimers[] = {"T37", "T38", "T33", "T34", "T1", "T5"}, kOfOneMs[] = {"T32", "T96"};
    return below(30) ? one_of(kTimers) : one_of(kOfOneMs);
  }
  std::string bit() {
    static constexpr std::string_view kBits[] = {"I0.0",  "I0.1",  "I0.2",  "M0.0",  "M1.0",  "M2.0",
                                                 "SM0.0", "SM0.1", "SM0.4", "SM0.5", "SM0.6", "Q0.0"};
    return below(3) ? one_of(kBits) : timer();
  }
  std::string load() { return fmt::format("LD{} {}\n", below(2) ? "N" : "", bit()); }
  std::string preset() { return below(8) ? std::to_string(1 + below(300)) : "VW2"; }
  /// A network's own timer, or any; executed as what it is.
  std::string on_delay(const std::string& t) {
    return fmt::format("{} {}, {}\n", t == "T1" || t == "T5" ? "TONR" : "TON", t, preset());
  }
  std::string place() {
    static constexpr std::string_view kPlaces[] = {"VW0", "VW2", "VW4", "MW0", "T37", "T33", "T5"};
    return one_of(kPlaces);
  }
  std::string pointer() { return fmt::format("LD SM0.1\nMOVD &{}, VD40\n{}EU\n+D 2, VD40\n", place(), load()); }

  /// `n` is a number of its own.
  std::string network(unsigned n, bool in_main) {
    static constexpr std::string_view kOffDelayTimers[] = {"T36", "T50", "T51", "T100"};
    switch (below(25)) {
      default:
        return load() + on_delay(timer());
      case 3:
        return fmt::format("{}A {}\n= Q0.{}\n", load(), bit(), below(4));
      case 4:
        return fmt::format("{}EU\nINCW VW{}\n", load(), 2 * below(4));
      case 5:
        return load() + (below(2) ? fmt::format("R {}, {}\n", timer(), 1 + below(2)) : "TODR VB20\n");
      case 6:
        return fmt::format("{}JMP {}\n{}TON T4{}, 50\nLBL {}\n", load(), n, load(), below(4), n);
      case 7:
        return fmt::format("LDW>= {}, {}\n= M0.{}\n", below(3) ? place() : timer(), below(100), below(8));
      case 8:
        return fmt::format("{}{}CTU C{}, {}\n", load(), load(), below(4), preset());
      case 9:
        return fmt::format("LD SM0.0\nMOVW 0, VW10\nLBL {}\n{}TON T4{}, {}\n", n, load(), below(4), preset()) +
               fmt::format("LD SM0.0\nINCW VW10\nLDW<= VW10, {}\nA {}\nJMP {}\n", 1 + below(3), bit(), n);
      case 10:
      case 11:
        main_ += call();
        return {};
      case 12:
      case 13:
        return fmt::format("{}FOR VW12, 1, {}\n{}{}NEXT\n", load(), below(5), load(), on_delay(timer()));
      case 14:
      case 15:
        return segment(n);
      case 16:
        return pointer() + load() +
               fmt::format("MOVW *VD40, VW{}\nLDW>= *VD40, {}\n= M1.{}\n", 2 * below(4), below(100), below(8));
      case 17:
        return pointer() + load() + fmt::format("EU\nMOVW {}, *VD40\n", below(300));
      case 18:
        return load() + pulses();
      case 19:
        return high_speed_counter() + load() + "EU\nHSC 0\nLDD>= HC0, 2\n= M0.7\n";
      case 20:
        return load() + (is_224_ ? receive() : "EU\nXMT VB200, 0\n");
      case 21:
        return load() + (is_224_ ? fmt::format("TOF {}, {}\n", one_of(kOffDelayTimers), preset()) : "EU\nMOVW 7, VW2\n");
      case 22: {
        const std::string t = below(3) ? "T5" : timer();
        return load() + on_delay(t) + load() + on_delay(t) + load() + on_delay(t);
      }
      case 23:
        return below(2) ? fmt::format("{}MOVW {}, VW2\n", load(), 1 + below(50))
                        : fmt::format("LD SM0.0\nMOVW 0, VW14\nMOVW 5, T35\nFND> T35, {}, VW14\n", below(100));
      case 24:
        return rare(in_main);
    }
  }

  std::string call() {
    if (!is_224_) return load() + "CALL 0\n";
    return fmt::format("{}CALL Work, {}, {}, {}\n", load(), bit(), below(2) ? place() : "*VD40",
                       below(3) ? place() : "*VD44");
  }
  std::string segment(unsigned n) {
    std::string text = fmt::format("LD SM0.1\nS S0.{}, 1\nLSCR S0.{}\n{}{}", n % 8, n % 8, load(), on_delay(timer()));
    if (is_224_ && below(2)) text += fmt::format("{}CSCRE\n{}{}", load(), load(), on_delay(timer()));
    return text + fmt::format("{}SCRT S0.{}\nSCRE\n", load(), below(8));
  }
  std::string pulses() {
    const bool widths = below(2) != 0;
    return fmt::format("EU\nMOVB 16#{}, SMB67\nMOVW {}, SMW68\nMOVW {}, SMW70\nMOVD {}, SMD72\nPLS 0\n",
                       widths ? "CB" : "8D", 50 + below(900), below(500), 1 + below(5));
  }
  std::string high_speed_counter() {
    if (std::exchange(has_counter_, true)) return {};
    return "LD SM0.1\nMOVB 16#F8, SMB37\nMOVD 0, SMD38\nMOVD 3, SMD42\nHDEF 0, 0\nHSC 0\n";
  }
  std::string receive() {
    return fmt::format(
        "EU\nMOVB 16#{}, SMB87\nMOVB 65, SMB89\nMOVW {}, SMW90\nMOVW {}, SMW92\nMOVB {}, SMB94\nRCV VB100, 0\n",
        below(2) ? "B0" : "94", below(9), 1 + below(3000), 1 + below(4));
  }
  /// What keeps scans from being passed over for long, or ends them early.
  std::string rare(bool in_main) {
    switch (below(4)) {
      case 0:
        return load() + "EU\nMOVW 100, SMW32\nMOVB 16#81, SMB31\n";
      case 1:
        return is_224_ ? load() + "BITIM VD60\n" : load() + "EU\nTODW VB20\n";
      case 2:
        return load() + "WDR\n";
      default:
        return load() + (in_main ? "END\n" : "CRET\n");
    }
  }

  std::mt19937& draw_;
  const bool is_224_;
  bool has_counter_ = false;
  std::string main_, subroutine_;
};

/// S7200_STEADY_PROGRAMS sets how many.
TEST(SteadyScans, ChangeNothingInRandomProgramsWithInputsAndCharactersAtRandomInstants) {
  const char* const wanted = std::getenv("S7200_STEADY_PROGRAMS");
  std::mt19937 draw(static_cast<unsigned>(wanted ? std::stoul(wanted) : 7200));
  const int programs = wanted ? std::stoi(wanted) : 80;
  Time passed = 0, simulated = 0;
  for (int i = 0; i < programs; ++i) {
    AboutTime about_time(draw);
    Both both(about_time.text(), about_time.model());
    Time at = 0;
    std::vector<Time> instants;
    for (int k = 0; k < 12; ++k) {
      at += static_cast<Time>(std::exp(std::uniform_real_distribution<>(std::log(1e6), std::log(2e10))(draw)));
      const auto what = static_cast<unsigned>(draw() % 4);
      const bool level = draw() % 2;
      both.each([&](Plc& plc) {
        if (what == 3) return plc.character_at(at, 65);
        plc.input_at(at, fmt::format("I0.{}", what), level);
      });
      instants.push_back(at);
    }
    for (const Time instant : instants) {
      both.run_until(instant - static_cast<Time>(draw() % 1000));
      both.run_until(instant + static_cast<Time>(draw() % kMillisecond));
      if (testing::Test::HasFatalFailure()) return;
    }
    passed += both.passed();
    simulated += at;
  }
  EXPECT_GT(passed, simulated / 4) << "or else this shows nothing";
}

TEST(SteadyScans, AreLookedForWhereItPays) {
  PlcThat plc(SteadyScansUse::On, kContactsOnly);
  plc.run_until(100 * kMillisecond);
  EXPECT_EQ(plc.cpu.passed_over(), 0) << "a hundred scans are not worth a look";
  plc.run_until(10 * kSecond);
  EXPECT_GT(plc.cpu.passed_over(), 9 * kSecond) << "ten thousand are, however short they are";
  plc.run_until(600 * kSecond);
  EXPECT_GT(plc.cpu.passed_over(), 595 * kSecond);
}

TEST(SteadyScans, TheCheckAgreesWithWhatTheCpuDoes) {
  for (const char* text :
       {"LD SM0.5\n= M0.0\nLD I0.0\nTON T37, 50\nTON T33, 70\nLD T37\n= Q0.0\nMEND\n", "LD I0.0\n= Q0.0\nMEND\n"}) {
    PlcThat plc(SteadyScansUse::Check, text);
    for (int i = 1; i <= 20; ++i) plc.input_at(i * 1'234 * ms, "I0.0", i % 2);
    EXPECT_NO_THROW(plc.run_until(60 * kSecond)) << text;
    EXPECT_EQ(plc.cpu.passed_over(), 0);
  }
}

TEST(SteadyScans, TheCheckForgetsWhatItExpectedOnceItIsOff) {
  PlcThat plc(SteadyScansUse::Check, kContactsOnly);
  plc.cpu.run(100 * kSecond, 50 * kSecond);
  plc.cpu.use_steady_scans(SteadyScansUse::Off);
  plc.run_until(200 * kSecond);
  plc.cpu.use_steady_scans(SteadyScansUse::Check);
  plc.run_until(300 * kSecond);
}

TEST(SteadyScans, TheCheckForgetsWhatItExpectedOnceEachIsWatched) {
  PlcThat plc(SteadyScansUse::Check, kContactsOnly);
  plc.cpu.run(100 * kSecond, 50 * kSecond);
  plc.records.scans = true;
  plc.run_until(200 * kSecond);
  plc.records.scans = false;
  plc.run_until(300 * kSecond);
}

TEST(SteadyScans, TheCheckFindsAPredictionThatIsWrong) {
  PlcThat plc(SteadyScansUse::Check, kContactsOnly);
  plc.cpu.run(100 * kSecond, 50 * kSecond);
  plc.cpu.core().s.image[image::kV] ^= 1;  // behind the CPU's back
  EXPECT_DEATH(plc.cpu.run(100 * kSecond), "");
}

}  // namespace
}  // namespace s7200::test::steady_scans_test

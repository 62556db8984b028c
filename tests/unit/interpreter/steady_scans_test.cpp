// Scans that are all alike are passed over, and nothing shows it but the speed.
#include "interpreter/cpu/steady_scans.hpp"

#include <cmath>
#include <random>

#include "tests/support/plc.hpp"

namespace s7200::test {
namespace {

struct PlcThat : Plc {
  PlcThat(SteadyScansUse use, std::string_view text, const CpuModel& model = cpu214()) : Plc(text, model) {
    cpu.use_steady_scans(use);
  }
};

/// The same program twice: with and without.
class Both {
 public:
  explicit Both(std::string_view text, const CpuModel& model = cpu214())
      : text_(text), with_(SteadyScansUse::Eager, text, model), without_(SteadyScansUse::Off, text, model) {}

  template <class What>
  void each(What what) {
    what(with_);
    what(without_);
  }

  /// Whether both are in the same state there, and have done the same to the outside.
  void run_until(Time end) {
    each([end](Plc& plc) { plc.run_until(end); });
    ASSERT_EQ(with_.cpu.state(), without_.cpu.state()) << "at " << end << " ns of\n" << text_;
    ASSERT_EQ(with_.queue, without_.queue) << text_;
    ASSERT_EQ(with_.records.all.size(), without_.records.all.size()) << text_;
  }

  const Plc& plc() const { return with_; }
  /// Simulated time that was passed over.
  Time passed() const { return with_.cpu.passed_over(); }

 private:
  std::string text_;
  PlcThat with_, without_;
};

constexpr std::string_view kContactsOnly = "LD I0.0\nA M0.0\n= Q0.0\nMEND\n";

TEST(SteadyScans, AreNearlyAllOfAMinuteInWhichNothingHappens) {
  Both both(kContactsOnly);
  both.run_until(60 * kSecond);
  EXPECT_GT(both.passed(), 59 * kSecond);
}

TEST(SteadyScans, AreNotPassedOverIfTheyAreOff) {
  PlcThat plc(SteadyScansUse::Off, kContactsOnly);
  plc.run_until(60 * kSecond);
  EXPECT_EQ(plc.cpu.passed_over(), 0);
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

/// Networks about everything that goes on by itself.
std::string about_time(std::mt19937& draw) {
  const auto below = [&](unsigned n) { return static_cast<unsigned>(draw() % n); };
  static constexpr std::string_view kTimers[] = {"T37", "T38", "T33", "T34", "T1", "T5"};
  const auto timer = [&] { return std::string(below(30) ? kTimers[below(6)] : "T32"); };
  std::string text, subroutine = "SBR 0\n";
  for (unsigned networks = 3 + below(6); networks > 0; --networks) {
    std::string& to = below(8) ? text : subroutine;
    const std::string t = timer();
    const auto source = [&]() -> std::string {
      static constexpr std::string_view kBits[] = {"I0.0", "I0.1", "M0.0", "SM0.0", "SM0.5", "M1.0", "I0.2"};
      return below(3) ? std::string(kBits[below(7)]) : timer();
    };
    switch (below(11)) {
      case 0:
      case 1:
      case 2:
        to += fmt::format("LD{} {}\n{} {}, {}\n", below(2) ? "N" : "", source(), t == "T1" || t == "T5" ? "TONR" : "TON", t,
                          1 + below(300));
        break;
      case 3:
        to += fmt::format("LD {}\nA {}\n= Q0.{}\n", source(), source(), below(4));
        break;
      case 4:
        to += fmt::format("LD {}\nEU\nINCW VW{}\n", source(), 2 * below(4));
        break;
      case 5:
        to += below(2) ? fmt::format("LD {}\nR {}, 1\n", source(), timer()) : fmt::format("LD {}\nTODR VB20\n", source());
        break;
      case 6:
        to += fmt::format("LD {}\nJMP {}\n", source(), networks);
        to += fmt::format("LD {}\nTON T4{}, 50\nLBL {}\n", source(), below(4), networks);
        break;
      case 7:
        if (below(3) == 0) to += fmt::format("LDW>= {}, {}\n= M0.{}\n", timer(), below(100), below(8));
        break;
      case 8:
        to += fmt::format("LD {}\nLD {}\nCTU C{}, 3\n", source(), source(), below(4));
        break;
      case 9:
        to += fmt::format("LD SM0.0\nMOVW 0, VW10\nLBL {}\nLD {}\nTON T4{}, {}\n", networks, source(), below(4),
                          1 + below(300));
        to += fmt::format("LD SM0.0\nINCW VW10\nLDW<= VW10, {}\nA {}\nJMP {}\n", 1 + below(3), source(), networks);
        break;
      default:
        text += fmt::format("LD {}\nCALL 0\n", source());
    }
  }
  return text + "LD SM0.1\nMOVB 16#09, SMB30\nATCH 0, 8\nENI\nMEND\n" + subroutine + "RET\nINT 0\nINCW VW8\nRETI\n";
}

/// S7200_STEADY_PROGRAMS sets how many.
TEST(SteadyScans, ChangeNothingInRandomProgramsWithInputsAndCharactersAtRandomInstants) {
  const char* const wanted = std::getenv("S7200_STEADY_PROGRAMS");
  std::mt19937 draw(static_cast<unsigned>(wanted ? std::stoul(wanted) : 7200));
  const int programs = wanted ? std::stoi(wanted) : 80;
  Time passed = 0, simulated = 0;
  for (int i = 0; i < programs; ++i) {
    Both both(about_time(draw));
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

TEST(SteadyScans, TheCheckFindsAPredictionThatIsWrong) {
  PlcThat plc(SteadyScansUse::Check, kContactsOnly);
  plc.cpu.run(100 * kSecond, 50 * kSecond);
  plc.cpu.core().s.image[image::kV] ^= 1;  // behind the CPU's back
  EXPECT_THROW(plc.cpu.run(100 * kSecond), std::logic_error);
}

}  // namespace
}  // namespace s7200::test

// Scans in which the program changes nothing are passed over between events too, and nothing shows it but the speed.
#include "interpreter/cpu/idle/idle_scans.hpp"

#include <random>

#include "interpreter/model/memory_alone.hpp"
#include "tests/support/with_and_without.hpp"

namespace s7200::test::idle_scans_test {
namespace {

constexpr Time kCharacter = 1'145'833;  // of 11 bits at 9600 baud

/// A main program, and an interrupt routine for each character.
std::string with_interrupt(std::string_view main, std::string_view interrupt) {
  return fmt::format("{}LD SM0.1\nMOVB 16#49, SMB30\nATCH 0, 8\nENI\nMEND\nINT 0\nLD SM0.0\n{}RETI\n", main, interrupt);
}

/// Characters in close succession from `from` on, which all come in the middle of scans that nothing else ends.
void characters(Both& both, int count, Time from = 100 * ms) {
  both.each([&](Plc& plc) {
    for (int i = 0; i < count; ++i) plc.character_at(from + i * kCharacter, static_cast<std::uint8_t>(i));
  });
}

TEST(IdleScans, ArePassedOverBetweenInterruptsThatTouchNothingOfTheProgram) {
  Both both(with_interrupt("LD M0.0\n= Q0.0\n", "INCW VW0\nMOVB SMB2, VB2\n"));
  characters(both, 200);
  both.run_until(100 * ms);
  const Time before = both.passed();
  both.run_until(100 * ms + 200 * kCharacter);
  EXPECT_EQ(both.plc().value("VW0"), 200);
  EXPECT_GT(both.passed() - before, 150 * kCharacter);
}

TEST(IdleScans, AreTheSameWhereverARunEnds) {
  Both both("LD M0.0\nA I0.0\n= Q0.0\nMEND\n");
  for (Time at = 50 * ms; at < 60 * ms; at += 7 * us) both.run_until(at);
  for (Time at = 60 * ms; at < 100 * ms; at += 10 * us) both.run_until(at);
  for (Time at = 100 * ms; at < 110 * ms; at += 1234567 * us / 1000) both.run_until(at);
  EXPECT_GT(both.passed(), 5 * ms);
}

/// Most characters come while it is being executed.
TEST(IdleScans, AProgramThatTakesLongerThanACharacterIsPassedOverInPieces) {
  std::string main = "LDN M0.0\nS M0.1, 1\nLD M0.1\n= M0.2\nLD SM0.0\nR M0.1, 1\n";
  for (int i = 0; i < 100; ++i) main += "LD M0.0\nA I0.0\n= Q0.0\n";
  main += "LD SM0.0\nFOR VW20, 1, 3\nLD SM0.0\nMOVW 7, VW22\nNEXT\nLBL 1\nLBL 2\nLD SM0.0\nMOVW 8, VW24\n";
  Both both(with_interrupt(main, "INCW VW0\n"));
  characters(both, 200);
  both.run_until(100 * ms);
  const Time before = both.passed();
  for (Time at = 100 * ms; at < 100 * ms + 200 * kCharacter; at += 777'777 * us / 1000) both.run_until(at);
  both.run_until(100 * ms + 200 * kCharacter);
  EXPECT_EQ(both.plc().value("VW0"), 200);
  EXPECT_GT(both.passed() - before, 150 * kCharacter);
}

TEST(IdleScans, WhoWatchesInstructionsIsToldOfWholeProgramsOnly) {
  struct Watcher final : TraceSink {
    void instruction(const InstructionRecord& record) override {
      if (record.op == 0) whole &= std::exchange(next, 0U) == 3U;
      if (record.op == 0) ++programs;
      whole &= record.op == next++;
    }
    bool wants_instructions() const override { return true; }
    bool wants_scans() const override { return false; }
    std::uint32_t next = 3;
    int programs = 0;
    bool whole = true;
  } watcher;
  PlcThat plc(SteadyScansUse::Eager, "LD M0.0\n= Q0.0\nMEND\n");
  plc.run_until(50 * ms);
  while (plc.cpu.state().phase == Phase::Program) plc.run_until(plc.cpu.time() + 10 * us);
  plc.cpu.set_sink(&watcher);
  const Time before = plc.cpu.passed_over();
  for (int i = 0; i < 1000; ++i) plc.run_until(plc.cpu.time() + 123 * us);
  EXPECT_EQ(plc.cpu.passed_over(), before) << "it may have to see what has happened between two runs";
  for (int i = 0; i < 10; ++i) {
    watcher.programs = 0;
    plc.run_until(plc.cpu.time() + 50 * ms);
    EXPECT_GE(watcher.programs, 1);
  }
  plc.cpu.set_sink(&plc.records);
  EXPECT_TRUE(watcher.whole);
  EXPECT_GT(plc.cpu.passed_over(), before + 400 * ms);
}

/// A session watches from power-up on.
TEST(IdleScans, AreLearntWhereInstructionsAreWatchedFromTheBeginning) {
  struct Watcher final : TraceSink {
    void instruction(const InstructionRecord&) override { ++instructions; }
    bool wants_instructions() const override { return true; }
    bool wants_scans() const override { return false; }
    std::uint64_t instructions = 0;
  } watcher;
  const std::string text = with_interrupt("LD M0.0\n= Q0.0\nLD SM0.0\nMOVW VW0, VW10\n", "INCW VW0\nMOVB SMB2, VB2\n");
  PlcThat watched(SteadyScansUse::On, text), plain(SteadyScansUse::Off, text);
  watched.cpu.set_sink(&watcher);
  for (PlcThat* const plc : {&watched, &plain}) {
    for (int i = 0; i < 20; ++i) plc->character_at(kSecond + i * 700 * ms, static_cast<std::uint8_t>(i));
    plc->run_until(20 * kSecond);
  }
  EXPECT_EQ(watched.cpu.state(), plain.cpu.state());
  EXPECT_EQ(watched.value("VW10"), 20);
  EXPECT_GT(watched.cpu.passed_over(), 10 * kSecond);
  EXPECT_LT(watcher.instructions, watched.cpu.state().instructions / 2);
}

/// In the scan in which a program is learnt it may do something to the outside: that happens once, and at its instant.
TEST(IdleScans, WhatAWatchedProgramDoesWhileItIsLearntHappensOnce) {
  struct Watcher final : TraceSink {
    bool wants_instructions() const override { return true; }
    bool wants_scans() const override { return false; }
  } watcher;
  for (const char* does : {"MOVB 16#05, SMB30\n", "XMT VB100, 0\n", "ATCH 0, 10\nENI\n", "STOP\n", "WDR\nMOVD 16#03000000, AC1\nMOVB *AC1, VB20\n",
                           "FOR VW8, 1, 9999\nSQRT VD60, VD64\nNEXT\n", "= Q0.3\n"}) {
    for (int scan = 100; scan < 145; ++scan) {
      const std::string text = fmt::format(
          "LD SM0.1\nMOVB 9, SMB30\nMOVB 3, VB100\nMOVB 7, SMB34\nLD SM0.0\nINCW VW0\nLDW= VW0, {}\n{}MEND\nINT 0\nLD SM0.0\nINCW VW4\nRETI\n", scan, does);
      PlcThat watched(SteadyScansUse::On, text), plain(SteadyScansUse::Off, text);
      watched.cpu.set_sink(&watcher);
      for (PlcThat* const plc : {&watched, &plain}) plc->run_until(400 * ms);
      ASSERT_EQ(watched.cpu.state(), plain.cpu.state()) << text;
      ASSERT_EQ(watched.queue, plain.queue) << text;
      ASSERT_EQ(watched.port.sent, plain.port.sent) << text;
      ASSERT_EQ(watched.port.format, plain.port.format) << text;
      ASSERT_EQ(watched.port.configured_at, plain.port.configured_at) << text;
      ASSERT_EQ(watched.port.switched_at, plain.port.switched_at) << text;
    }
  }
}

TEST(IdleScans, AnInterruptThatWritesWhatTheProgramReadsIsSeenInTheNextScan) {
  Both both(with_interrupt("LDW>= VW0, 50\n= Q0.0\nLDB= SMB2, 77\nEU\nINCW VW4\n", "INCW VW0\n"));
  characters(both, 200);
  for (int i = 0; i < 200; ++i) both.run_until(100 * ms + i * kCharacter + i * 5 * us);
  EXPECT_EQ(both.plc().value("Q0.0"), 1);
  EXPECT_EQ(both.plc().value("VW4"), 1);
  EXPECT_GT(both.passed(), 100 * ms);
}

TEST(IdleScans, WhatTheProgramWritesAgainAndAgainIsRestoredAfterAnInterrupt) {
  Both both(with_interrupt("LD SM0.0\nMOVW 5, VW2\n", "INCW VW2\nINCW VW4\n"));
  characters(both, 100);
  for (int i = 0; i < 100; ++i) both.run_until(100 * ms + i * kCharacter + i * 9 * us);
  both.run_until(kSecond);
  EXPECT_EQ(both.plc().value("VW2"), 5);
  EXPECT_EQ(both.plc().value("VW4"), 100);
}

TEST(IdleScans, WhatTheSystemWritesInEachScanIsSeen) {
  for (const char* reads :
       {"LD SM0.6\n= M0.0\n", "LDW>= SMW22, 1\n= M0.0\n", "LD SM0.5\n= M0.0\n", "LD SM0.4\nEU\nINCW VW10\n",
        "LD SM0.0\nMOVB SMB0, VB10\n", "LD SM4.4\n= M0.0\n", "LDW>= SMW26, 2\n= M0.0\n"}) {
    Both both(with_interrupt(reads, "INCW VW0\n"));
    characters(both, 50, 480 * ms);
    for (int i = 0; i < 100; ++i) both.run_until(100 * ms + i * 10'123 * us);
    both.run_until(40 * kSecond);
  }
}

TEST(IdleScans, AProgramWithSubroutinesIsIdleToo) {
  Both both(
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL Work, I0.0, VW20, VW22\nLD SM0.1\nMOVB 16#49, SMB30\n"
      "ATCH Count:INT0, 8\nENI\nEND_ORGANIZATION_BLOCK\nSUBROUTINE_BLOCK Work:SBR0\nVAR_INPUT\n on : BOOL;\n n : INT;\n"
      "END_VAR\nVAR_OUTPUT\n y : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nLD SM0.0\nMOVW #n, #y\nCALL Twice:SBR1\n"
      "END_SUBROUTINE_BLOCK\nSUBROUTINE_BLOCK Twice:SBR1\nBEGIN\nNETWORK 1\nLD SM0.0\nMOVW 7, LW10\n"
      "END_SUBROUTINE_BLOCK\nSUBROUTINE_BLOCK Add:SBR2\nBEGIN\nNETWORK 1\nLD SM0.0\nINCW LW12\nINCW VW0\n"
      "END_SUBROUTINE_BLOCK\nINTERRUPT_BLOCK Count:INT0\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL Add:SBR2\nEND_INTERRUPT_BLOCK\n",
      *find_cpu("224"));
  characters(both, 100);
  both.each([](Plc& plc) { plc.set("VW20", 1234); });
  for (int i = 0; i < 100; ++i) both.run_until(100 * ms + i * kCharacter + i * 9 * us);
  both.run_until(kSecond);
  EXPECT_EQ(both.plc().value("VW0"), 100);
  EXPECT_EQ(both.plc().value("VW22"), 1234);
  EXPECT_GT(both.passed(), 850 * ms);
}

TEST(IdleScans, TimersThatAreOffAndCountersArePartOfTheFootprint) {
  Both both(with_interrupt("LD M0.0\nTON T33, 3\nLD M0.1\nTOF T37, 2\nLD M0.2\nLD M0.3\nCTU C1, 5\nLD M0.4\nTONR T5, 2\n"
                           "LD C1\nO T33\nO T37\n= Q0.0\n",
                           "INCB MB0\n"),
            *find_cpu("224"));
  characters(both, 64, 200 * ms);
  for (int i = 0; i < 64; ++i) both.run_until(200 * ms + i * kCharacter + i * 9 * us);
  for (int i = 0; i < 40; ++i) both.run_until(300 * ms + i * 33 * ms);
  EXPECT_GT(both.passed(), 500 * ms);
}

TEST(IdleScans, AnInterruptMayResetATimerOrACounterOfTheProgram) {
  Both both(with_interrupt("LD I0.0\nTOF T37, 100\nLD I0.1\nLD I0.2\nCTU C1, 5\nLD T37\n= Q0.0\n",
                           "R T37, 1\nR C1, 1\nLD SM0.0\nINCW VW0\n"),
            *find_cpu("224"));
  both.each([](Plc& plc) {
    plc.input_at(30 * ms, "I0.0", true);
    plc.input_at(40 * ms, "I0.1", true);
    for (int i = 0; i < 20; ++i) plc.character_at(100 * ms + i * kCharacter, 0);
    plc.input_at(150 * ms, "I0.0", false);
  });
  for (int i = 0; i < 500; ++i) both.run_until(i * 1'234 * us);
  EXPECT_EQ(both.plc().value("VW0"), 20);
}

TEST(IdleScans, ATimerThatLooksOffAtTheEndOfTheProgramMayHaveCounted) {
  for (const char* timer : {"TONR T5", "TON T37", "TONR T1", "TON T33", "TONR T0", "TON T32"}) {
    Both both(fmt::format("LD SM0.0\n{0}, 40\nLD SM0.0\n{0}, 40\nLDN SM0.0\n{0}, 40\nMEND\n", timer), *find_cpu("224"));
    for (int i = 1; i <= 60; ++i) both.run_until(i * 33 * ms + i * us);
  }
}

TEST(IdleScans, TheWatchdogBarksAtTheSameInstant) {
  Both both(
      "LD M0.0\n= Q0.0\nLD SM0.1\nMOVB 255, SMB34\nATCH 0, 10\nENI\nMEND\nINT 0\nLD SM0.0\nDIV VW2, VD4\nDIV VW2, VD4\n"
      "DIV VW2, VD4\nRETI\n");
  both.each([](Plc& plc) { plc.set("VW2", 1); });
  for (int i = 1; i <= 100; ++i) both.run_until(i * 7 * ms);
  EXPECT_TRUE(both.plc().stopped());
}

TEST(IdleScans, AScanThatAnInterruptMadeLongerIsTheLongestOne) {
  Both both(with_interrupt("LD M0.0\n= Q0.0\n", "SQRT VD100, VD104\n"));
  characters(both, 3, 500 * ms);
  for (int i = 1; i <= 60; ++i) both.run_until(480 * ms + i * ms + i * us);
  EXPECT_GE(both.plc().value("SMW26"), 5);
}

TEST(IdleScans, WithAClockThatIsOffTheSystemsPartIsNotAlike) {
  Both both("LD M0.0\n= Q0.0\nMEND\n");
  both.each([](Plc& plc) {
    plc.cpu.set_clock_error(50);
    plc.cpu.power_up();
  });
  for (int i = 1; i <= 100; ++i) both.run_until(i * ms + i * us);
}

TEST(IdleScans, WhatTheSystemHasToDoIsDoneInItsScan) {
  struct Deed {
    const char* what;
    void (*do_to)(Plc& plc);
  };
  constexpr Deed kDeeds[] = {
      {"an input", [](Plc& plc) { plc.input("I0.3", true); }},
      {"a point forced", [](Plc& plc) { plc.cpu.force(plc.place("I0.4"), 1); }},
      {"an output forced", [](Plc& plc) { plc.cpu.force(plc.place("Q0.4"), 1); }},
      {"and unforced", [](Plc& plc) { plc.cpu.unforce(plc.place("I0.4")); }},
      {"a value to be saved", [](Plc& plc) { plc.set("SMB31", 0x81); }},
      {"an output written", [](Plc& plc) { plc.set("QB0", 0x50); }},
      {"memory written", [](Plc& plc) { plc.set("MB0", 1); }},
      {"a timer that runs", [](Plc& plc) { plc.set("M0.7", 1); }},
      {"a stop", [](Plc& plc) { plc.set("M0.6", 1); }},
      {"the logic stack set", [](Plc& plc) { plc.cpu.set_stack(LogicStack::from_bits(0x1FF)); }},
  };
  for (const Deed& deed : kDeeds) {
    Both both("LD M0.0\nO I0.3\n= Q0.0\nLD M0.7\nTON T37, 3\nLD M0.6\nSTOP\nMEND\n");
    for (Time at = 50 * ms; at < 400 * ms; at += 35'789 * us) {
      both.run_until(at);
      if (at > 150 * ms && at < 190 * ms) both.each(deed.do_to);
      ASSERT_FALSE(testing::Test::HasFatalFailure()) << deed.what;
    }
  }
}

TEST(IdleScans, AnAnalogOutputThatChangesWithinAScanKeepsItFromBeingIdle) {
  Both both("LD SM0.0\nMOVW 1, AQW0\nMOVW 2, AQW0\nMEND\n", *find_cpu("224"));
  both.run_until(kSecond);
  EXPECT_EQ(both.passed(), 0);
  EXPECT_GT(both.plc().records.of(TraceKind::AnalogChanged).size(), 1000U);
}

TEST(IdleScans, ALogicStackThatIsSetWithinTheProgramIsSeen) {
  Both both("LD M0.0\nLD M0.1\nNOP 0\nNOP 0\nALD\n= Q0.0\nMEND\n");
  for (int i = 1; i <= 200; ++i) {
    both.run_until(i * 1'234 * us + i * i * us);
    if (both.plc().cpu.state().phase == Phase::Program)
      both.each([](Plc& plc) { plc.cpu.set_stack(LogicStack::from_bits(0x1FF)); });
  }
  EXPECT_GT(both.plc().records.of(TraceKind::OutputChanged).size(), 4U);
  EXPECT_GT(both.passed(), 50 * ms);
}

TEST(IdleScans, OfWhatAWatcherWantsEachIsExecuted) {
  PlcThat plc(SteadyScansUse::Eager, "LD M0.0\n= Q0.0\nMEND\n");
  plc.run_until(100 * ms);
  const Time passed = plc.cpu.passed_over();
  EXPECT_GT(passed, 50 * ms);
  plc.records.scans = true;
  plc.run_until(200 * ms);
  EXPECT_EQ(plc.cpu.passed_over(), passed);
  EXPECT_GT(plc.records.of(TraceKind::ScanBegin).size(), 100U);
}

TEST(IdleScans, TheCheckFindsAPredictionThatIsWrong) {
  PlcThat plc(SteadyScansUse::Check, "LD M0.0\n= Q0.0\nMEND\n");
  plc.cpu.run(100 * kSecond, 50 * kSecond);
  plc.cpu.core().s.image[image::kV] ^= 1;  // behind the CPU's back
  EXPECT_DEATH(plc.cpu.run(100 * kSecond), "");
}

TEST(IdleScans, TheCheckAgreesBetweenCharactersToo) {
  PlcThat plc(SteadyScansUse::Check, with_interrupt("LD M0.0\n= Q0.0\n", "INCW VW0\n"));
  for (int i = 0; i < 500; ++i) plc.character_at(50 * ms + i * kCharacter, 0);
  plc.run_until(kSecond);
  EXPECT_EQ(plc.value("VW0"), 500);
  EXPECT_EQ(plc.cpu.passed_over(), 0);
}

TEST(IdleScans, AreLearntSeldomWhereTheProgramIsNeverIdle) {
  for (const char* text : {"LDN Q0.0\n= Q0.0\nMEND\n", "LD SM0.0\nINCW VW0\nMEND\n"}) {
    PlcThat plc(SteadyScansUse::On, text);
    plc.run_until(600 * kSecond);
    EXPECT_EQ(plc.cpu.passed_over(), 0) << text;
  }
}

TEST(MemoryAlone, IsWhatNoInstructionWorksOnThatHasAnOperandOfAnotherKindOrDependsOnTime) {
  for (const Instruction& row : all_instructions()) {
    if (!works_on_memory_alone(row)) continue;
    for (const OperandRule& rule : row.rules())
      EXPECT_TRUE(rule.kind != OperandKind::Interrupt && rule.kind != OperandKind::Event && rule.kind != OperandKind::Port &&
                  rule.kind != OperandKind::Counter)
          << row.mnemonic;
    EXPECT_TRUE(row.effect != Effect::EnablesInterrupts && row.effect != Effect::Transmits &&
                row.effect != Effect::Receives && row.effect != Effect::SetsStation &&
                row.effect != Effect::ReadsTimeOfDay && row.effect != Effect::ReadsMilliseconds &&
                row.hidden != Hidden::Number)
        << row.mnemonic;
  }
}

TEST(MemoryAlone, IsSaidOfContactsCoilsAndBoxesThatCompute) {
  for (const char* yes :
       {"LD", "=", "S", "R", "EU", "MOVW", "BMB", "+I", "SLW", "LDW>=", "JMP", "CALL", "FOR", "LSCR", "FND="})
    EXPECT_TRUE(works_on_memory_alone(*find_instruction(yes))) << yes;
  for (const char* no : {"=I", "SI", "BIW", "WDR", "STOP", "DLED", "ENI", "ATCH", "XMT", "TODR", "TON", "CTU", "PLS", "PID"})
    EXPECT_FALSE(works_on_memory_alone(*find_instruction(no))) << no;
}

/// A program that is idle now and then, with an interrupt for each character.
class NowAndThenIdle {
 public:
  explicit NowAndThenIdle(std::mt19937& draw) : draw_(draw) {}

  std::string text() {
    std::string main;
    for (unsigned n = 2 + below(6); n > 0; --n) main += network(n);
    std::string interrupt;
    for (unsigned n = 1 + below(3); n > 0; --n) interrupt += fmt::format("LD {}\n{}", bit(), deed());
    return fmt::format(
        "LD SM0.1\nMOVB 16#49, SMB30\nMOVD &VB0, VD40\nATCH 0, 8\nATCH 1, 0\nENI\n{}MEND\nSBR 0\nLD {}\n{}{}RET\nSBR 1\n"
        "LD SM0.0\nINCW VW30\nRET\nINT 0\nLD SM0.0\n{}CALL 1\nRETI\nINT 1\n{}RETI\n",
        main, bit(), deed(), timer(), interrupt, interrupt);
  }

 private:
  unsigned below(unsigned n) { return static_cast<unsigned>(draw_() % n); }
  template <std::size_t count>
  std::string one_of(const std::string_view (&names)[count]) {
    return std::string(names[below(count)]);
  }

  std::string bit() {
    static constexpr std::string_view kBits[] = {"I0.0",  "I0.1",  "M0.0",  "M0.1",  "M0.2", "Q0.0", "SM0.0",
                                                 "SM0.1", "SM0.5", "SM0.6", "SM3.0", "T33",  "T37",  "C1"};
    return below(12) ? one_of(kBits) : "V1.3";
  }
  std::string word() {
    static constexpr std::string_view kWords[] = {"VW0", "VW2", "VW4", "VW6", "MW0", "AC0", "T37", "C1", "SMW22"};
    return below(8) ? std::string(kWords[below(6)]) : one_of(kWords);
  }
  std::string target() {
    static constexpr std::string_view kTargets[] = {"VW0", "VW2", "VW4", "VW6", "VW8", "MW0", "AC0"};
    return below(6) ? one_of(kTargets) : "*VD40";
  }
  std::string timer() {
    static constexpr std::string_view kTimers[] = {"TON T33", "TON T37", "TONR T5", "TON T32", "TOF T38"};
    return fmt::format("LD {}\n{}, {}\n", bit(), one_of(kTimers), 1 + below(40));
  }
  std::string deed() {
    switch (below(9)) {
      default:
        return fmt::format("MOVW {}, {}\n", word(), target());
      case 2:
        return fmt::format("INCW {}\n", target());
      case 3:
        return fmt::format("S M0.{}, {}\n", below(4), 1 + below(3));
      case 4:
        return fmt::format("R M0.{}, {}\n", below(4), 1 + below(3));
      case 5:
        return fmt::format("+I {}, VW8\n", below(100));
      case 6:
        return below(3) ? "MOVB SMB2, VB1\n" : "R T33, 5\n";
      case 7:
        return "BMB VB0, VB10, 6\n";
      case 8:
        return below(3) ? "XORW 16#0F, VW0\n"
                        : one_of({"WDR\n", "R C1, 1\n", "=I Q0.1\n", "DIV VW2, VD50\n", "MOVB 129, SMB31\n"});
    }
  }
  std::string network(unsigned n) {
    switch (below(12)) {
      default:
        return fmt::format("LD {}\nA {}\n= Q0.{}\n", bit(), bit(), below(4));
      case 1:
        return fmt::format("LDW>= {}, {}\n= M0.{}\n", word(), below(60), below(4));
      case 2:
        return fmt::format("LD {}\n{}", bit(), deed());
      case 3:
        return fmt::format("LD {}\nEU\n{}", bit(), deed());
      case 4:
        return timer();
      case 5:
        return fmt::format("LD {}\nLD {}\nCTU C1, {}\n", bit(), bit(), 1 + below(9));
      case 6:
        return fmt::format("LD {}\nCALL 0\n", bit());
      case 7:
        return fmt::format("LD {}\nJMP {}\nLD {}\n{}LBL {}\n", bit(), n, bit(), deed(), n);
      case 8:
        return fmt::format("LD {}\nFOR VW20, 1, {}\nLD SM0.0\nMOVW VW20, VW22\nNEXT\n", bit(), below(4));
      case 9:
        return fmt::format("LSCR S0.{}\nLD {}\n{}LD {}\nSCRT S0.{}\nSCRE\n", n, bit(), deed(), bit(), below(8));
    }
  }

  std::mt19937& draw_;
};

/// S7200_STEADY_PROGRAMS sets how many.
TEST(IdleScans, ChangeNothingInRandomProgramsWithCharactersInCloseSuccession) {
  const char* const wanted = std::getenv("S7200_STEADY_PROGRAMS");
  std::mt19937 draw(static_cast<unsigned>(wanted ? std::stoul(wanted) : 7200));
  const int programs = wanted ? std::stoi(wanted) : 100;
  Time passed = 0, simulated = 0;
  for (int i = 0; i < programs; ++i) {
    Both both(NowAndThenIdle(draw).text(), *find_cpu("224"));
    Time at = 20 * ms;
    std::vector<Time> instants;
    for (int k = 0; k < 60; ++k) {
      at += static_cast<Time>(draw() % (k % 20 == 19 ? 400'000'000U : 3'000'000U));
      const auto what = static_cast<unsigned>(draw() % 8), byte = static_cast<unsigned>(draw() % 256);
      both.each([&](Plc& plc) {
        if (what > 2) return plc.character_at(at, static_cast<std::uint8_t>(byte));
        plc.input_at(at, fmt::format("I0.{}", what), byte % 2 != 0);
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

}  // namespace
}  // namespace s7200::test::idle_scans_test

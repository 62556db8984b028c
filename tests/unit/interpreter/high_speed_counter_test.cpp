// HSC0–HSC2: modes, events, status byte, errors. HSC1: clock I0.6, second input I0.7, reset I1.0, start I1.1, SMB46–55.
#include "interpreter/cpu/scan.hpp"
#include "interpreter/cpu/units/high_speed_counters.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::high_speed_counter_test {
namespace {

using enum TraceKind;

enum Status { kUp = 0x20, kEqual = 0x40, kGreater = 0x80 };

/// HSC1 in a mode, counting up, preset 3, events 13–15 attached.
std::string counter1(int mode, int control = 0xF8) {
  return fmt::format(
      "LD SM0.1\nMOVB {}, SMB47\nMOVD 3, SMD52\nHDEF 1, {}\nHSC 1\nATCH 0, 13\nATCH 0, 14\nATCH 0, 15\nENI\nMEND\n"
      "INT 0\nRETI\n",
      control, mode);
}

struct Hsc1 : Plc {
  explicit Hsc1(int mode, int control = 0xF8, std::initializer_list<const char*> inputs = {})
      : Plc(counter1(mode, control)) {
    for (const char* point : inputs) input(point, true);
    run_scans(1);
  }
  Ints events() const { return records.events(EventOccurred); }
};

TEST(HighSpeedCounter, Mode0CountsRisingEdgesUpAndReportsWhenItReachesItsPreset) {
  Hsc1 plc(0);
  EXPECT_EQ(plc.value("SMB46"), kUp) << "0 is below the preset";
  plc.pulse("I0.6", 2);
  EXPECT_EQ(plc.value("HC1"), 2);
  EXPECT_TRUE(plc.events().empty());
  plc.input("I0.6", true);
  EXPECT_EQ(plc.value("HC1"), 3);
  EXPECT_EQ(plc.value("SMB46"), kUp | kEqual);
  EXPECT_EQ(plc.events(), Ints{13});
  plc.input("I0.6", false);
  plc.pulse("I0.6");
  EXPECT_EQ(plc.value("SMB46"), kUp | kGreater);
  EXPECT_EQ(plc.events(), Ints{13});
}

TEST(HighSpeedCounter, Mode0TakesItsDirectionFromTheControlByteAndPassesBelowZero) {
  Hsc1 plc(0, 0xF0);
  plc.pulse("I0.6", 2);
  EXPECT_EQ(plc.value("HC1"), -2);
  EXPECT_EQ(plc.value("SMB46"), 0);
  EXPECT_TRUE(plc.events().empty()) << "the internal direction gives no event";
}

TEST(HighSpeedCounter, HscTakesOnlyWhatTheControlByteSays) {
  Hsc1 plc(0);
  plc.set("SMD48", 100);
  plc.set("SMD52", 200);
  plc.set("SMB47", 0x80);
  high_speed_counters::program(plc.cpu.core(), 1);
  EXPECT_EQ(plc.value("HC1"), 0);
  plc.set("SMB47", 0xC0);
  high_speed_counters::program(plc.cpu.core(), 1);
  EXPECT_EQ(plc.value("HC1"), 100);
  EXPECT_EQ(plc.cpu.state().counter[1].preset, 3);
  plc.set("SMB47", 0x00);
  high_speed_counters::program(plc.cpu.core(), 1);
  plc.pulse("I0.6", 5);
  EXPECT_EQ(plc.value("HC1"), 100) << "disabled";
}

TEST(HighSpeedCounter, LoadingThePresetOrTheCurrentValueGivesNoEvent) {
  Hsc1 plc(0);
  plc.set("SMD48", 3);  // the preset
  high_speed_counters::program(plc.cpu.core(), 1);
  EXPECT_EQ(plc.value("SMB46"), kUp | kEqual);
  plc.set("SMD48", 7);
  plc.set("SMD52", 7);
  high_speed_counters::program(plc.cpu.core(), 1);
  EXPECT_EQ(plc.value("SMB46"), kUp | kEqual);
  EXPECT_TRUE(plc.events().empty());
}

TEST(HighSpeedCounter, TheControlByteGivesModes6To11TheirInitialDirection) {
  for (const int mode : {6, 9}) {
    Hsc1 up(mode, 0xF8), down(mode, 0xF0);
    EXPECT_EQ(up.value("SMB46"), kUp) << mode;
    EXPECT_EQ(down.value("SMB46"), 0) << mode;
    for (Hsc1* plc : {&up, &down}) plc->input("I0.6", true);
    EXPECT_TRUE(up.events().empty()) << mode;
    EXPECT_EQ(down.events(), Ints{14}) << mode << ": the first count goes up";
  }
}

TEST(HighSpeedCounter, Mode1ResetHoldsTheCounterAtZeroAndIsAnEventWhenItComes) {
  Hsc1 plc(1);
  plc.pulse("I0.6", 2);
  plc.input("I1.0", true);
  EXPECT_EQ(plc.value("HC1"), 0);
  EXPECT_EQ(plc.events(), Ints{15});
  plc.pulse("I0.6", 2);
  EXPECT_EQ(plc.value("HC1"), 0);
  plc.input("I1.0", false);
  plc.pulse("I0.6", 2);
  EXPECT_EQ(plc.value("HC1"), 2);
  EXPECT_EQ(plc.events(), Ints{15});
}

TEST(HighSpeedCounter, ResetActiveLow) {
  Hsc1 plc(1, 0xF9, {"I1.0"});
  plc.pulse("I0.6", 2);
  EXPECT_EQ(plc.value("HC1"), 2);
  plc.input("I1.0", false);
  EXPECT_EQ(plc.value("HC1"), 0);
  EXPECT_EQ(plc.events(), Ints{15});
}

TEST(HighSpeedCounter, ACounterEnabledDuringResetStaysAtZero) {
  Plc plc("LD SM0.1\nMOVB 16#F8, SMB47\nMOVD 50, SMD48\nHDEF 1, 1\nHSC 1\nMEND\n");
  plc.input("I1.0", true);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("HC1"), 0);
}

TEST(HighSpeedCounter, Mode2WithoutStartClocksAndResetAreIgnored) {
  Hsc1 plc(2);
  plc.pulse("I0.6", 2);
  EXPECT_EQ(plc.value("HC1"), 0);
  plc.input("I1.1", true);
  plc.pulse("I0.6", 2);
  EXPECT_EQ(plc.value("HC1"), 2);
  plc.input("I1.1", false);
  plc.pulse("I0.6", 2);
  plc.input("I1.0", true);
  EXPECT_EQ(plc.value("HC1"), 2);
  EXPECT_TRUE(plc.events().empty());
  plc.input("I1.1", true);
  EXPECT_EQ(plc.value("HC1"), 0) << "start comes while reset is active";
  EXPECT_EQ(plc.events(), Ints{15});
}

TEST(HighSpeedCounter, StartActiveLow) {
  Hsc1 plc(2, 0xFA);
  plc.pulse("I0.6", 2);
  EXPECT_EQ(plc.value("HC1"), 2);
}

TEST(HighSpeedCounter, Modes3To5TakeTheirDirectionFromAnInputEvenBeforeItChanges) {
  for (const int mode : {3, 4, 5}) {
    Hsc1 plc(mode);
    plc.input("I1.1", true);
    plc.pulse("I0.6", 2);
    EXPECT_EQ(plc.value("HC1"), -2) << "I0.7 = 0: down, whatever the control byte says";
    EXPECT_EQ(plc.value("SMB46"), 0);
    EXPECT_TRUE(plc.events().empty());
    plc.input("I0.7", true);
    EXPECT_EQ(plc.events(), Ints{14});
    plc.pulse("I0.6", 5);
    EXPECT_EQ(plc.value("HC1"), 3);
    EXPECT_EQ(plc.events(), (Ints{14, 13}));
    plc.input("I0.7", false);
    EXPECT_EQ(plc.events(), (Ints{14, 13, 14}));
  }
}

TEST(HighSpeedCounter, Modes6To8HaveAnUpAndADownClock) {
  for (const int mode : {6, 7, 8}) {
    Hsc1 plc(mode);
    plc.input("I1.1", true);
    plc.pulse("I0.6", 2);
    EXPECT_TRUE(plc.events().empty());
    plc.pulse("I0.7", 3);
    EXPECT_EQ(plc.value("HC1"), -1);
    EXPECT_EQ(plc.events(), Ints{14});
    plc.pulse("I0.6");
    EXPECT_EQ(plc.value("HC1"), 0);
    EXPECT_EQ(plc.events(), (Ints{14, 14}));
  }
}

void quarter_turns(Plc& plc, std::initializer_list<const char*> toggled) {
  for (const char* point : toggled) {
    const auto range = plc.place(point);
    plc.input(point, !(plc.cpu.state().image[image::kInputs + range.number] >> range.bit & 1));
  }
}

TEST(HighSpeedCounter, Modes9To11CountFourTimesAPeriod) {
  for (const int mode : {9, 10, 11}) {
    Hsc1 plc(mode, 0xF8, {"I1.1"});
    quarter_turns(plc, {"I0.6", "I0.7", "I0.6", "I0.7"});  // A ahead of B
    EXPECT_EQ(plc.value("HC1"), 4);
    EXPECT_EQ(plc.events(), Ints{13});
    quarter_turns(plc, {"I0.7", "I0.6", "I0.7", "I0.6"});
    EXPECT_EQ(plc.value("HC1"), 0);
    EXPECT_EQ(plc.events(), (Ints{13, 14, 13})) << "back over the preset";
    quarter_turns(plc, {"I0.7", "I0.6"});
    EXPECT_EQ(plc.value("HC1"), -2);
  }
}

TEST(HighSpeedCounter, Modes9To11CountOnceAPeriodIfAsked) {
  Hsc1 plc(9, 0xFC);
  quarter_turns(plc, {"I0.6", "I0.7", "I0.6", "I0.7", "I0.6", "I0.7", "I0.6", "I0.7"});
  EXPECT_EQ(plc.value("HC1"), 2);
  quarter_turns(plc, {"I0.7", "I0.6", "I0.7", "I0.6", "I0.7", "I0.6", "I0.7", "I0.6", "I0.7", "I0.6", "I0.7", "I0.6"});
  EXPECT_EQ(plc.value("HC1"), -1);
}

TEST(HighSpeedCounter, Counter0AndCounter2HaveTheirOwnInputsAndEvents) {
  Plc plc(
      "LD SM0.1\nMOVB 16#F8, SMB37\nMOVD 1, SMD42\nHDEF 0, 0\nHSC 0\nMOVB 16#F8, SMB57\nMOVD 1, SMD62\nHDEF 2, 1\nHSC 2\n"
      "ATCH 0, 12\nATCH 0, 16\nATCH 0, 18\nENI\nMEND\nINT 0\nRETI\n");
  plc.run_scans(1);
  plc.pulse("I0.0", 1);
  plc.pulse("I1.2", 1);
  plc.input("I1.4", true);
  EXPECT_EQ(plc.value("HC0"), 1);
  EXPECT_EQ(plc.value("SMB36"), kUp | kEqual);
  EXPECT_EQ(plc.value("HC2"), 0);
  EXPECT_EQ(plc.records.events(EventOccurred), (Ints{12, 16, 18}));
}

TEST(HighSpeedCounter, EdgesDuringAnInstructionAreCountedWithTheirOwnTimes) {
  Plc plc(
      "LD SM0.1\nMOVB 16#F8, SMB47\nMOVD 3, SMD52\nHDEF 1, 0\nHSC 1\nATCH 0, 13\nENI\nLD SM0.0\nSQRT VD0, VD4\nMEND\n"
      "INT 0\nRETI\n");
  for (int i = 1; i <= 4; ++i) {
    plc.input_at(i * ms, "I0.6", true);
    plc.input_at(i * ms + 500 * us, "I0.6", false);
  }
  plc.run_until(6 * ms);
  EXPECT_EQ(plc.records.times(EventOccurred), Times{3 * ms});
  EXPECT_EQ(plc.records.times(ServiceBegin), Times{5280 * us});  // 200 us + 8 * 10 us + 5 ms
  EXPECT_EQ(plc.value("HC1"), 4);
}

TEST(HighSpeedCounter, InStopTheCounterGoesOnWithoutEvents) {
  Hsc1 plc(0);
  scan::stop(plc.cpu.core());
  plc.pulse("I0.6", 4);
  EXPECT_EQ(plc.value("HC1"), 4);
  EXPECT_TRUE(plc.events().empty());
}

// --- CPUs 22x (facts 10.4) ---

TEST(HighSpeedCounter, Counters0And3To5Of22xHaveTheirOwnInputsAndEvents) {
  struct Case {
    int number, mode, sm;
    const char *clock, *second, *reset;
    Ints events;  // preset reached, direction changed, reset
  };
  const Case cases[] = {
      {0, 7, 36, "I0.0", "I0.1", "I0.2", {12, 27, 28}}, {1, 7, 46, "I0.6", "I0.7", "I1.0", {13, 14, 15}},
      {3, 0, 136, "I0.1", nullptr, nullptr, {32}},      {4, 7, 146, "I0.3", "I0.4", "I0.5", {29, 30, 31}},
      {5, 0, 156, "I0.4", nullptr, nullptr, {33}},
  };
  for (const Case& c : cases) {
    std::string attach;
    for (const int event : c.events) attach += fmt::format("ATCH 0, {}\n", event);
    Plc plc(fmt::format("LD SM0.1\nMOVB 16#F8, SMB{}\nMOVD 2, SMD{}\nHDEF {}, {}\nHSC {}\n{}ENI\nMEND\nINT 0\nRETI\n",
                        c.sm + 1, c.sm + 6, c.number, c.mode, c.number, attach),
            cpu224());
    plc.run_scans(1);
    plc.pulse(c.clock, 2);
    EXPECT_EQ(plc.value(fmt::format("HC{}", c.number)), 2) << c.number;
    EXPECT_EQ(plc.value(fmt::format("SMB{}", c.sm)), kUp | kEqual);
    if (c.second) plc.pulse(c.second);
    if (c.reset) plc.input(c.reset, true);
    EXPECT_EQ(plc.value(fmt::format("HC{}", c.number)), c.reset ? 0 : 2);
    EXPECT_EQ(plc.records.events(EventOccurred), c.events);
  }
}

TEST(HighSpeedCounter, Counter0Of22xCountsQuadrature) {
  Plc plc("LD SM0.1\nMOVB 16#F8, SMB37\nHDEF 0, 9\nHSC 0\nMEND\n", cpu224());
  plc.run_scans(1);
  for (const auto& [point, level] : {std::pair{"I0.0", true}, {"I0.1", true}, {"I0.0", false}, {"I0.1", false}})
    plc.input(point, level);
  EXPECT_EQ(plc.value("HC0"), 4);
}

TEST(HighSpeedCounter, CountersDoNotShareAnInput) {
  const auto errors = [](const char* statements) {
    Plc plc(fmt::format("LD SM0.1\n{}MEND\nINT 0\nRETI\n", statements), cpu224());
    plc.run_scans(1);
    return plc.records.errors();
  };
  EXPECT_EQ(errors("HDEF 0, 3\nHDEF 3, 0\n"), Ints{0x03}) << "both use I0.1";
  EXPECT_EQ(errors("HDEF 0, 0\nHDEF 3, 0\n"), Ints{}) << "mode 0 uses the clock only";
  EXPECT_EQ(errors("HDEF 4, 3\nHDEF 5, 0\n"), Ints{0x03}) << "both use I0.4";
  EXPECT_EQ(errors("ATCH 0, 6\nHDEF 4, 0\n"), Ints{0x03}) << "event 6 is the rising edge of I0.3";
  EXPECT_EQ(errors("HDEF 0, 1\nATCH 0, 5\n"), Ints{0x02}) << "event 5 is the falling edge of I0.2, the reset";
  EXPECT_EQ(errors("HDEF 0, 0\nATCH 0, 5\n"), Ints{});
}

TEST(HighSpeedCounter, Errors) {
  Plc undefined("LD SM0.1\nHSC 1\nMEND\n");
  undefined.run_scans(1);
  EXPECT_EQ(undefined.records.errors(), Ints{0x01});
  Plc twice("LD SM0.1\nHDEF 1, 0\nHDEF 1, 3\nMEND\n");
  twice.run_scans(1);
  EXPECT_EQ(twice.records.errors(), Ints{0x0A});
  EXPECT_EQ(twice.cpu.state().counter[1].mode, 0);
  for (const int event : {0, 1}) {
    Plc taken(fmt::format("LD SM0.1\nATCH 0, {}\nHDEF 0, 0\nMEND\nINT 0\nRETI\n", event));
    taken.run_scans(1);
    EXPECT_EQ(taken.records.errors(), Ints{0x03});
    EXPECT_FALSE(taken.cpu.state().counter[0].defined);
  }
}

// Facts 10.4: on late CPUs 22x HSC0 counts the pulses of PTO0, HSC3 those of PTO1, without an input.
TEST(HighSpeedCounter, Mode12CountsThePulsesOfAnOutput) {
  for (const auto& [counter, control, preset, output, pulses] :
       {std::tuple{0, "SMB37", "SMD42", 0, 67}, std::tuple{3, "SMB137", "SMD142", 1, 77}}) {
    Plc plc(fmt::format("LD SM0.1\nMOVB 16#F8, {1}\nMOVD 5, {2}\nHDEF {0}, 12\nHSC {0}\nATCH 0, {5}\nENI\n"
                        "MOVW 10, SMW{6}\nMOVD 7, SMD{7}\nMOVB 16#8D, SMB{4}\nPLS {3}\nMEND\nINT 0\nINCW VW0\nRETI\n",
                        counter, control, preset, output, pulses, counter == 0 ? 12 : 32, pulses + 1, pulses + 5),
            cpu224());
    plc.run_until(45 * ms);
    EXPECT_EQ(plc.value(fmt::format("HC{}", counter)), 5) << "the fifth has begun";
    EXPECT_EQ(plc.value("VW0"), 1) << "current = preset";
    plc.run_until(100 * ms);
    EXPECT_EQ(plc.value(fmt::format("HC{}", counter)), 7);
    plc.pulse("I0.0", 3);
    plc.pulse("I0.1", 3);
    EXPECT_EQ(plc.value(fmt::format("HC{}", counter)), 7) << "it has no input";
    EXPECT_EQ(plc.records.errors(), Ints{});
  }
}

TEST(HighSpeedCounter, Mode12DoesNotCountTheCyclesOfAPwm) {
  Plc plc("LD SM0.1\nMOVB 16#F8, SMB37\nHDEF 0, 12\nHSC 0\nMOVW 10, SMW68\nMOVW 5, SMW70\nMOVB 16#CB, SMB67\nPLS 0\nMEND\n",
          cpu224());
  plc.run_until(100 * ms);
  EXPECT_EQ(plc.value("HC0"), 0);
}

}  // namespace
}  // namespace s7200::test::high_speed_counter_test

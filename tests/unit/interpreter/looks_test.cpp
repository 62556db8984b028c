// What programs look at of the things that change by themselves.
#include "interpreter/analysis/effects/looks.hpp"

#include "tests/support/plc.hpp"

namespace s7200::test::looks_test {
namespace {

Looks looks(std::string_view network, const CpuModel& model = *find_cpu("224")) {
  return program_of(std::string(network) + "MEND\n", model)->looks;
}

TEST(Looks, AtTheClockBitsIsAReadOfOneOfThemOrOfTheirByte) {
  EXPECT_TRUE(looks("LD SM0.5\n= Q0.0\n").clock_bits);
  EXPECT_TRUE(looks("LD SM0.0\nAN SM0.4\n= Q0.0\n").clock_bits);
  EXPECT_TRUE(looks("LD SM0.0\nMOVB SMB0, VB0\n").clock_bits);
  EXPECT_TRUE(looks("LD SM0.0\nBMB SMB0, VB0, 2\n").clock_bits);
  EXPECT_FALSE(looks("LD SM0.0\nA SM0.1\nAN SM0.6\nMOVB SMB2, VB0\n").clock_bits);
}

TEST(Looks, ACountReachesNoFurtherThanItsArea) {
  const Looks found = looks("LD SM0.0\nS M31.0, 8\nR M0.0, VB0\nBMB MB0, VB0, VB1\nTON T33, 5\nFILL 0, VW0, 10\n");
  EXPECT_FALSE(found.clock_bits);
  EXPECT_TRUE(found.every_tick.none());
}

TEST(Looks, APointerReachesWhatPointersCanReachOnThatCpu) {
  const Looks found = looks("LD SM0.0\nTON T33, 5\nMOVB *VD0, VB4\n");
  EXPECT_TRUE(found.clock_bits) << "one may reach special memory";
  EXPECT_FALSE(looks_of(*program_of("LD SM0.0\nMOVB *VD0, VB4\nMEND\n", cpu214())).clock_bits) << "only on late CPUs 22x";
  EXPECT_TRUE(found.every_tick.test(33));
}

TEST(Looks, ATimerThatIsExecutedOnceInEachScanMattersOnlyAtItsPreset) {
  EXPECT_TRUE(looks("LD I0.0\nTON T37, 100\nLD T37\n= Q0.0\n").every_tick.none());
  EXPECT_TRUE(looks("LD I0.0\nTON T37, 100\nLDW>= T37, 5\n= Q0.0\n").every_tick.test(37));
  EXPECT_TRUE(looks("LD I0.0\nTON T37, 100\nLD I0.1\nR T37, 1\n").every_tick.test(37));
  EXPECT_TRUE(looks("LD I0.0\nJMP 1\nLBL 1\nLD I0.0\nTON T37, 100\n").every_tick.test(37));
  EXPECT_TRUE(looks("LBL 1\nLD I0.0\nTON T37, 100\nLD I0.1\nJMP 1\n").every_tick.test(37)) << "a jump back may do it again";
  EXPECT_TRUE(looks("LD I0.0\nTON T37, 100\nLBL 1\nLD I0.1\nJMP 1\n").every_tick.none()) << "nothing jumps back to it";
}

/// The timers of which every tick matters.
std::string every_tick(std::string_view network) {
  const Looks found = looks(network);
  std::string numbers;
  for (std::size_t timer = 0; timer < found.every_tick.size(); ++timer)
    if (found.every_tick.test(timer)) numbers += std::to_string(timer) + " ";
  return numbers;
}

TEST(Looks, AValueOrABitIsThatOfOneTimer) {
  EXPECT_EQ(every_tick("LD SM0.0\nMOVW T0, VW0\nMOVW T36, VW0\nMOVW 5, T255\n"), "0 36 255 ");
  EXPECT_EQ(every_tick("LD I0.0\n= T0\n= T36\n= T255\n"), "0 36 255 ");
  EXPECT_EQ(every_tick("LD T36\nMOVW VW0, AQW62\nMOVW C0, VW0\nMOVD HC0, VD0\nMOVD AC3, AC0\n= C0\n= I0.0\n"), "");
}

TEST(Looks, ABlockOfTimersGoesAsFarAsItsCountMaySay) {
  for (const char* block : {"BMW T253, VW0, VB9\n", "BMW VW0, T253, VB9\n", "FILL 5, T253, VB9\n", "R T253, VB9\n",
                            "ATT VW0, T253\n", "FIFO T253, VW0\n", "FND> T253, 50, VW0\n"})
    EXPECT_EQ(every_tick(std::string("LD I0.0\n") + block), "253 254 255 ") << block;
  for (const char* block : {"BMW T253, VW0, 2\n", "BMW VW0, T253, 2\n", "FILL 5, T253, 2\n", "R T253, 2\n"})
    EXPECT_EQ(every_tick(std::string("LD I0.0\n") + block), "253 254 ") << block;
  EXPECT_EQ(every_tick("LD I0.0\nINCW T253\n+I 5, T30\nAW>= T40, 7\n= Q0.0\n"), "30 40 253 ");
}

TEST(Looks, ATimerThatMayBeLeftOutOrDoneTwiceMattersTickByTick) {
  EXPECT_EQ(every_tick("LD I0.0\nTON T37, 100\nLD I0.1\nTON T37, 100\n"), "37 ");
  EXPECT_EQ(every_tick("LD I0.0\nTOF T37, 100\nLD I0.1\nTOF T37, 100\n"), "37 ");
  EXPECT_EQ(every_tick("LD I0.0\nFOR VW0, 1, 3\nLD I0.0\nTON T37, 100\nNEXT\n"), "37 ");
  EXPECT_EQ(every_tick("LSCR S0.0\nLD I0.0\nTON T38, 100\nSCRT S0.0\nLD I0.0\nCSCRE\nLD I0.0\nTON T37, 100\nSCRE\n"), "37 ");
  EXPECT_EQ(every_tick("LD I0.0\nTON T38, 100\nEND\nLD I0.0\nTON T37, 100\n"), "37 ");
}

TEST(Looks, ATimerOfASubroutineMattersTickByTick) {
  const auto program = program_of("LD I0.0\nCALL 0\nLD I0.0\nTON T38, 100\nMEND\nSBR 0\nLD I0.0\nTON T37, 100\nRET\n");
  EXPECT_TRUE(program->looks.every_tick.test(37));
  EXPECT_FALSE(program->looks.every_tick.test(38)) << "CALL comes back";
}

TEST(Looks, AtItsPresetAndNoFurtherIsALookAtAnotherTimer) {
  EXPECT_EQ(every_tick("LD I0.0\nTON T37, T38\n"), "38 ");
  EXPECT_EQ(every_tick("LD I0.0\nLD I0.1\nCTU C0, T38\n"), "38 ");
}

TEST(Looks, ANumberIsNoPlace) {
  static_assert(sm::kScanStatus == 64, "or another label");
  EXPECT_FALSE(looks("LD I0.0\nJMP 64\nLBL 64\n").clock_bits);
  EXPECT_FALSE(looks("LD I0.0\nTONR T64, 5\n").clock_bits);
  EXPECT_EQ(every_tick("LBL 1\nLD I0.0\nLD I0.1\nCTU C0, 5\n"), "") << "the counter of a timer's number";
}

TEST(Looks, WithEveryScanNothingElseIsDifferent) {
  const auto program = program_of("LD SM0.5\n= Q0.0\nMEND\n");
  Looks wanted = program->looks;
  wanted.every_scan = true;
  EXPECT_EQ(with_every_scan(*program)->looks, wanted);
}

TEST(Looks, ACallLooksAtWhatItHandsOver) {
  const auto call = [](std::string_view parameters) {
    return program_of(
               fmt::format("ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD I0.0\nCALL Work, {}\n"
                           "END_ORGANIZATION_BLOCK\nSUBROUTINE_BLOCK Work:SBR0\nVAR_INPUT\n on : BOOL;\n n : INT;\nEND_VAR\n"
                           "VAR_OUTPUT\n done : BOOL;\n y : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nLD #on\n= #done\n"
                           "END_SUBROUTINE_BLOCK\n",
                           parameters),
               *find_cpu("224"))
        ->looks;
  };
  EXPECT_TRUE(call("SM0.5, 7, M0.0, VW0").clock_bits);
  EXPECT_FALSE(call("SM0.1, 7, M0.0, VW0").clock_bits);
  EXPECT_TRUE(call("T33, 7, M0.0, VW0").every_tick.none());
  EXPECT_TRUE(call("I0.0, T33, M0.0, VW0").every_tick.test(33));
  EXPECT_TRUE(call("I0.0, 7, T33, VW0").every_tick.test(33));
  EXPECT_TRUE(call("I0.0, 7, M0.0, T33").every_tick.test(33));
  EXPECT_FALSE(call("I0.0, T32, M0.0, T34").every_tick.test(33));
  EXPECT_TRUE(call("I0.0, *VD0, M0.0, VW0").every_tick.test(33));
}

TEST(Looks, AtTheTimeAreTodrAndTheMillisecondsOfTheCpu) {
  EXPECT_TRUE(looks("LD SM0.0\nTODR VB0\n").time_of_day);
  EXPECT_TRUE(looks("LD SM0.0\nBITIM VD0\n").every_scan);
  const Looks none = looks("LD I0.0\n= Q0.0\n");
  EXPECT_FALSE(none.time_of_day || none.every_scan);
}

}  // namespace
}  // namespace s7200::test::looks_test

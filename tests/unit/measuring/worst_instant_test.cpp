// The instant at which a race loses a word.
#include "tools/measuring/worst_instant.hpp"

#include "tests/support/inspected.hpp"
#include "tools/views/inspection/races_view.hpp"

namespace s7200::tools::worst_instant_test {
namespace {

std::string races_of(std::string_view main, std::string_view interrupt) {
  Inspection inspection = test::inspected("LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\n" + std::string(main) +
                                          "MEND\nINT 0\nLD SM0.0\n" + std::string(interrupt) + "RETI\n");
  inspection.lose_word = worst_instant;
  return races_text(inspection);
}

TEST(WorstInstant, IsBetweenTheReadAndTheWriteOfALostUpdate) {
  const std::string text = races_of("LD SM0.0\nMOVW VW10, AC0\n+I 5, AC0\nMOVW AC0, VW10\n", "INCW VW10\n");
  EXPECT_NE(text.find("INT_0 comes after MOVW VW10, AC0"), std::string::npos) << text;
  EXPECT_NE(text.find("16#0014, but 16#0015 if it comes before"), std::string::npos) << text;
}

TEST(WorstInstant, NeedsAValueThatCarriesToTearADoubleWord) {
  const std::string text = races_of("LD SM0.0\nMOVW VW10, VW20\nMOVW VW12, VW22\n", "INCD VD10\n");
  EXPECT_NE(text.find("lost: VD10 is 16#0000FFFF before the scan"), std::string::npos) << text;
}

TEST(WorstInstant, IsFoundInARungThatOnlySomeInputsReach) {
  const std::string text = races_of("LD I0.3\nAN I0.4\nMOVW VW10, AC0\n+I 5, AC0\nMOVW AC0, VW10\n", "INCW VW10\n");
  EXPECT_NE(text.find("inputs at random"), std::string::npos) << text;
}

TEST(WorstInstant, IsNotThereIfWhatIsWrittenIsRightEitherWay) {
  const std::string text = races_of("LDW>= VW10, 9\nMOVW 0, VW10\n", "INCW VW10\n");
  EXPECT_EQ(text, "no races found\n");
}

TEST(WorstInstant, IsNotOneThatOnlyOtherMemoryTellsFromBothOrders) {
  EXPECT_EQ(races_of("LDW>= VW10, 5\nMOVW VW30, VW32\nMOVW 0, VW10\n", "INCW VW10\nINCW VW30\n"), "no races found\n");
  const std::string text =
      races_of("LDW>= VW10, 5\nMOVW VW30, AC0\nMOVW AC0, VW32\nMOVW 0, VW10\n", "INCW VW10\nINCW VW30\n");
  EXPECT_NE(text.find("no run of it was found in which the word is lost"), std::string::npos) << text;
}

TEST(WorstInstant, ReadAndClearedIsWhatNobodyHasRead) {
  const std::string text = races_of("LD SM0.0\nMOVW VW10, VW20\nMOVW 0, VW10\n", "INCW VW10\n");
  EXPECT_NE(text.find("overwritten update of VW10"), std::string::npos) << text;
  EXPECT_NE(text.find("16#0000, 16#0000, but 16#0000, 16#0001 if it comes before, 16#0001, 16#0000"), std::string::npos)
      << text;
}

TEST(WorstInstant, ShowsAllThatDiffersFromBothOrders) {
  const std::string text = races_of("LD SM0.0\nMOVW VW10, VW20\nMOVW VW12, VW22\n", "INCD VD10\n");
  EXPECT_NE(text.find("VD20 = 16#00000000, but 16#00010000 if it comes before, 16#0000FFFF"), std::string::npos) << text;
}

TEST(WorstInstant, MayBeAnyBetweenTheTwo) {
  const std::string early = races_of("LD SM0.0\nDISI\nMOVW VW10, VW20\nENI\n+I 7, VW20\nMOVW VW20, VW10\n", "INCW VW10\n");
  EXPECT_NE(early.find("INT_0 comes after ENI"), std::string::npos) << early;
  const std::string carries = races_of("LD SM0.0\nMOVB VB10, VB20\nMOVW VW11, VW21\n", "INCD VD10\n");
  EXPECT_NE(carries.find("lost: VD10 is 16#00FFFFFF before the scan"), std::string::npos) << carries;
  const std::string timer = races_of("LD SM0.0\nTONR T5, 1000\nMOVW T5, VW0\n+I 5, VW0\nMOVW VW0, T5\n", "MOVW 0, T5\n");
  EXPECT_NE(timer.find("lost: T5 is"), std::string::npos) << timer;
}

TEST(WorstInstant, MixesTwoWordsToAValueThatComesOfNeitherOrder) {
  const std::string text = races_of("LD SM0.0\nMOVW VW10, AC0\n-I VW14, AC0\nMOVW AC0, VW20\n", "+I 5, VW10\n-I 3, VW14\n");
  EXPECT_NE(text.find("mixed read of VW10 and VW14: the main program works out one value from both"), std::string::npos)
      << text;
  EXPECT_NE(text.find("16#0003, but 16#0008 if it comes before, 16#0000"), std::string::npos) << text;
  EXPECT_EQ(races_of("LD SM0.0\nMOVW VW10, AC0\n-I VW14, AC0\nMOVW AC0, VW20\n", "MOVW 5, VW10\nMOVW VW14, VW14\n"),
            "no races found\n")
      << "the second does not change";
}

TEST(WorstInstant, IsFoundInALaterPassOfALoop) {
  const std::string text = races_of(
      "LD SM0.0\nMOVD &VB100, AC1\nFOR VW0, 1, 5\nLD SM0.0\nMOVW *AC1, AC0\nINCW AC0\nMOVW AC0, *AC1\n+D 2, AC1\nNEXT\n",
      "INCW VW106\n");
  EXPECT_NE(text.find("lost update of VW106"), std::string::npos) << text;
}

TEST(WorstInstant, IsNotLookedForInAProgramWithErrors) {
  Inspection inspection = test::inspected(
      "LD SM0.1\nATCH 0, 10\nENI\nLDD> VD804, &VB540\nMOVD &VB500, VD804\nLD SM0.0\n"
      "MOVW VW100, AC0\n+I 5, AC0\nMOVW AC0, VW100\nMEND\nINT 0\nLD SM0.0\nINCW VW100\n"
      "FOR VW910, 1, 3\nLD SM0.0\nINCW VW912\nNEXT\nRETI\n");
  inspection.has_errors = true;
  inspection.lose_word = worst_instant;
  const std::string text = races_text(inspection);
  EXPECT_NE(text.find("a program with errors is not run"), std::string::npos) << text;
}

}  // namespace
}  // namespace s7200::tools::worst_instant_test

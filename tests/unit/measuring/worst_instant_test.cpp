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
  EXPECT_NE(text.find("no run of it was found in which the word is lost"), std::string::npos) << text;
}

}  // namespace
}  // namespace s7200::tools::worst_instant_test

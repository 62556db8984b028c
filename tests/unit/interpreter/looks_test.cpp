// What programs look at of the things that change by themselves.
#include "interpreter/program/looks.hpp"

#include "tests/support/plc.hpp"

namespace s7200::test {
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
  EXPECT_FALSE(found.clock_bits) << "no pointer reaches special memory";
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

TEST(Looks, AtTheTimeAreTodrAndTheMillisecondsOfTheCpu) {
  EXPECT_TRUE(looks("LD SM0.0\nTODR VB0\n").time_of_day);
  EXPECT_TRUE(looks("LD SM0.0\nBITIM VD0\n").every_scan);
  const Looks none = looks("LD I0.0\n= Q0.0\n");
  EXPECT_FALSE(none.time_of_day || none.every_scan);
}

}  // namespace
}  // namespace s7200::test

// Choices of "Not documented, modelled so" that belong to no other group of tests.
#include "tests/support/plc.hpp"

namespace s7200::test::choices_test {
namespace {

TEST(Choices, SM43StaysUntilTheNextRun) {
  Plc plc("LDN M0.0\nS M0.0, 1\nMOVB 0, VB10\nFILL 0, VW20, VB10\nMEND\n");  // N = 0 in the first scan only
  plc.run_scans(20);
  EXPECT_EQ(plc.records.errors(), std::vector<int>{0x92});
  EXPECT_EQ(plc.value("SM4.3"), 1);
  plc.cpu.power_up();
  EXPECT_EQ(plc.value("SM4.3"), 0);
}

TEST(Choices, AnInterruptRoutineStartsWithTheTopOfTheStackAtOne) {
  // The main program leaves 0 at the top. INT 0 has no LD: its box runs all the same.
  Plc plc("LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nLDN SM0.0\n= M0.0\nMEND\nINT 0\nINCW VW0\n= M1.0\nRETI\n");
  plc.run_until(6 * ms);
  EXPECT_EQ(plc.value("VW0"), 1);
  EXPECT_EQ(plc.value("M1.0"), 1);
}

TEST(Choices, ABadStopBitIsNotAParityError) {
  Plc plc("LD SM0.1\nMOVB 16#49, SMB30\nATCH 0, 8\nENI\nMEND\nINT 0\nINCW VW0\nMOVB SMB2, VB2\nMOVB SMB3, VB3\nRETI\n");
  plc.at(1 * ms, [&] { plc.cpu.character_received({.byte = 0x55, .framing_error = true, .start = 0, .end = 1 * ms}); });
  plc.run_until(3 * ms);
  EXPECT_EQ(plc.value("VW0"), 1);
  EXPECT_EQ(plc.value("VB2"), 0x55);
  EXPECT_EQ(plc.value("VB3") & 1, 0);
}

TEST(Choices, WhatComesUpAtTheBottomOfTheStackIsZero) {
  LogicStack stack;
  for (int i = 0; i < LogicStack::kLevels; ++i) stack.push(true);
  stack.pop();
  EXPECT_EQ(stack.bits(), 0b0'1111'1111);
  EXPECT_FALSE(stack.level(LogicStack::kLevels - 1));
}

TEST(Choices, TheFirstExecutionOfEuAndEdFindsNoEdge) {
  // The input of EU is 1 and that of ED is 0 from the first execution on; then each changes once.
  Plc plc("LDN M5.0\nEU\nINCW VW0\nLD M5.0\nED\nINCW VW2\nLD M5.1\nS M5.0, 1\nMEND\n");
  plc.run_scans(3);
  EXPECT_EQ(plc.value("VW0"), 0);
  EXPECT_EQ(plc.value("VW2"), 0);
  plc.set("M5.1", 0);
  plc.set("MB5", 1);
  plc.run_scans(5);
  plc.set("MB5", 0);
  plc.run_scans(7);
  EXPECT_EQ(plc.value("VW0"), 1) << "1 at first, 0, and 1 again: one rising edge";
  EXPECT_EQ(plc.value("VW2"), 1) << "0 at first, 1, and 0 again: one falling edge";
}

TEST(Choices, AnEdgeInstructionThatIsJumpedOverKeepsItsMemory) {
  Plc plc("LD M0.0\nJMP 1\nLD M0.1\nEU\nINCW VW0\nLBL 1\nMEND\n");
  plc.run_scans(2);
  plc.set("MB0", 0b11);  // the edge comes while it is jumped over
  plc.run_scans(4);
  EXPECT_EQ(plc.value("VW0"), 0);
  plc.set("MB0", 0b10);
  plc.run_scans(6);
  EXPECT_EQ(plc.value("VW0"), 1);
}

TEST(Choices, ATimersPresetIsTheOneItsLastExecutionFound) {
  // In every scan VW0 is 2 at the timer's execution and 500 after it.
  Plc plc("LD SM0.0\nMOVW 2, VW0\nTON T33, VW0\nMOVW 500, VW0\nMEND\n");
  plc.run_until(25 * ms);
  EXPECT_EQ(plc.value("T33"), 2);
  EXPECT_EQ(plc.cpu.state().image[image::kTBits + 33 / 8] >> (33 % 8) & 1, 1);
}

TEST(Choices, ForAndNextStoreTheIndexBeforeTheyReadTheFinalValue) {
  // INDX is FINAL. The index that NEXT tests is always below the one it has just stored, until that wraps.
  Plc plc("LD SM0.0\nFOR VW0, 32760, VW0\nINCW VW10\nNEXT\nMEND\n");
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW10"), 8);
  EXPECT_EQ(plc.value("VW0"), -32768);
}

TEST(Choices, NextFollowsThePointersOfItsForAgain) {
  Plc plc("LD SM0.0\nMOVD &VB100, VD20\nFOR VW0, *VD20, 3\nINCW VW10\nMOVD 16#03000000, VD20\nNEXT\nINCW VW12\nMEND\n");
  plc.set("VW100", 1);
  plc.run_scans(1);
  EXPECT_EQ(plc.records.errors(), std::vector<int>{0x06});
  EXPECT_EQ(plc.value("VW10"), 1) << "one pass";
  EXPECT_EQ(plc.value("VW0"), 1) << "NEXT has not counted";
  EXPECT_EQ(plc.value("VW12"), 1) << "the program goes on after the loop";
}

TEST(Choices, ABadPointerIsReportedBeforeABadCountOrRange) {
  // N = 0 and a destination beyond V memory would be 0092 and 0091; the pointer of the source is bad too.
  for (const char* box :
       {"BMB *VD20, VB100, VB30", "BMB *VD20, VB4095, VB31", "SHRB M0.0, V100.0, *VD20", "ATH *VD20, VB4095, VB31"}) {
    Plc plc(fmt::format("LD SM0.1\n{}\nMEND\n", box));
    plc.set("VD20", 0x03000000);
    plc.set("VB31", 9);
    plc.run_scans(1);
    EXPECT_EQ(plc.records.errors(), Ints{0x06}) << box;
  }
}

TEST(Choices, ATransitionToItsOwnSegmentLeavesItOn) {
  Plc plc("LSCR S0.3\nLD SM0.0\nINCW VW0\nSCRT S0.3\nSCRE\nMEND\n");
  plc.set("SB0", 0x08);
  plc.run_scans(3);
  EXPECT_EQ(plc.value("VW0"), 3);
  EXPECT_EQ(plc.value("SB0"), 0x08);
}

// LD ends at 210 us, the DIVs at 100.21, 200.21 and 300.21 ms; the watchdog runs out at 300 ms.
TEST(Choices, TheWatchdogNamesTheInstructionDuringWhichItRanOut) {
  Plc plc("LD SM0.0\nDIV VW100, VD104\nDIV VW100, VD104\nDIV VW100, VD104\nINCW VW0\nMEND\n");
  plc.set("VW100", 1);
  plc.run_until(1 * kSecond);
  EXPECT_EQ(plc.cpu.state().fatal_code, 0x03);
  EXPECT_EQ(plc.cpu.state().fatal_op, 3u);
  EXPECT_EQ(plc.value("VW0"), 0);
}

TEST(Choices, PointerCodesOfTheAreas) {
  Plc plc(
      "LD SM0.0\nMOVD &IB1, VD0\nMOVD &QB2, VD4\nMOVD &MB3, VD8\nMOVD &SB4, VD12\nMOVD &T5, VD16\nMOVD &C6, VD20\n"
      "MOVD &VB100, VD24\nMEND\n");
  plc.run_scans(1);
  const std::uint32_t expected[] = {0x00000001, 0x01000002, 0x02000003, 0x04000004, 0x0700000A, 0x0600000C, 0x08000064};
  for (std::uint32_t i = 0; i < std::size(expected); ++i)
    EXPECT_EQ(static_cast<std::uint32_t>(plc.value(fmt::format("VD{}", 4 * i))), expected[i]);
}

TEST(Choices, NoExpansionModuleTellsItsIdentity) {
  Plc plc("LD SM0.0\nBMB SMB8, VB0, 14\nMEND\n", cpu224());
  plc.run_scans(1);
  for (int module = 0; module < 7; ++module) {
    EXPECT_EQ(plc.value(fmt::format("VB{}", 2 * module)), 0x80) << "not there";
    EXPECT_EQ(plc.value(fmt::format("VB{}", 2 * module + 1)), 0) << "no error";
  }
}

TEST(Choices, All64InputAndOutputPointsExist) {
  Plc plc("LD SM0.0\nBMB IB0, QB0, 8\nMEND\n");
  for (int byte = 0; byte < 8; ++byte)
    for (int bit = 0; bit < 8; ++bit) plc.input(fmt::format("I{}.{}", byte, bit), (byte + bit) % 3 == 0);
  plc.run_scans(1);
  for (std::uint32_t byte = 0; byte < 8; ++byte)
    EXPECT_EQ(plc.cpu.state().image[image::kOutputs + byte], plc.cpu.state().image[image::kInputs + byte]) << byte;
}

}  // namespace
}  // namespace s7200::test::choices_test

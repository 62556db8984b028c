#include "interpreter/cpu/units/forcing.hpp"

#include "tests/support/plc.hpp"

namespace s7200::forcing_test {
namespace {

using test::ms;
using test::Plc;

MemoryRange place_of(std::string_view text, const CpuModel& model = cpu214()) {
  const auto range = parse_range(text, model);
  EXPECT_TRUE(range.has_value()) << range.why();
  return range.value_or(MemoryRange{});
}

void force(Plc& plc, std::string_view place, std::uint32_t value) {
  EXPECT_TRUE(plc.cpu.force(place_of(place, *plc.cpu.program().model), value));
}

void run_more(Plc& plc, std::uint64_t scans) { plc.run_scans(plc.cpu.state().scans + scans); }

constexpr std::string_view kFollow =
    "LD I0.0\n"
    "= Q0.0\n"
    "LDI I0.1\n"
    "=I Q0.1\n"
    "MEND\n";

TEST(Forcing, AnInputIsForcedWhenTheScanReadsIt) {
  Plc plc(kFollow);
  run_more(plc, 1);
  force(plc, "I0.0", 1);
  EXPECT_EQ(plc.cpu.state().image[image::kI], 0) << "not before the inputs are read";
  run_more(plc, 1);
  EXPECT_EQ(plc.cpu.state().image[image::kI], 1);
  EXPECT_EQ(plc.cpu.state().image[image::kQ], 1);
}

TEST(Forcing, AnImmediateContactReadsTheForcedInputAtOnce) {
  Plc plc(kFollow);
  force(plc, "I0.1", 1);
  run_more(plc, 1);
  EXPECT_EQ(plc.cpu.state().image[image::kOutputs], 2);
}

TEST(Forcing, AnUnforcedInputIsWhatIsWiredAgain) {
  Plc plc(kFollow);
  force(plc, "I0.0", 0);
  plc.input("I0.0", true);
  run_more(plc, 2);
  EXPECT_EQ(plc.cpu.state().image[image::kI], 0);
  EXPECT_TRUE(plc.cpu.unforce(place_of("I0.0")));
  EXPECT_FALSE(plc.cpu.unforce(place_of("I0.0"))) << "nothing is forced any more";
  run_more(plc, 1);
  EXPECT_EQ(plc.cpu.state().image[image::kI], 1);
}

TEST(Forcing, AnOutputAndItsImageAreForcedAtTheEndOfTheScan) {
  Plc plc("LD SM0.0\n= Q0.0\nMEND\n");
  force(plc, "Q0.0", 0);
  force(plc, "Q0.5", 1);
  run_more(plc, 1);
  EXPECT_EQ(plc.cpu.state().image[image::kQ], 0x20);
  EXPECT_EQ(plc.cpu.state().image[image::kOutputs], 0x20);
}

TEST(Forcing, OverridesImmediateCoilsAndTheStateForStop) {
  Plc plc("LD SM0.0\n=I Q0.1\nSTOP\nMEND\n");
  force(plc, "Q0.1", 0);
  force(plc, "Q0.2", 1);
  plc.run_until(5 * ms);
  EXPECT_EQ(plc.cpu.state().mode, Mode::Stop);
  EXPECT_EQ(plc.cpu.state().image[image::kOutputs], 4);
}

TEST(Forcing, MemoryIsForcedAgainAfterTheProgramHasChangedIt) {
  Plc plc("LD SM0.0\nMOVW 9, VW10\nMOVW VW10, VW20\nMEND\n");
  force(plc, "VW10", 5);
  EXPECT_EQ(load16(&plc.cpu.state().image[image::kV + 10]), 5);
  run_more(plc, 1);
  EXPECT_EQ(load16(&plc.cpu.state().image[image::kV + 20]), 9) << "within the scan the program's value holds";
  EXPECT_EQ(load16(&plc.cpu.state().image[image::kV + 10]), 5);
}

TEST(Forcing, IsSeenFromOutsideWhateverTheProgramHasPutThereInThisScan) {
  Plc plc("MEND\n");
  force(plc, "Q0.1", 1);
  force(plc, "I0.2", 1);
  force(plc, "VW10", 0x1234);
  State state = plc.cpu.state();
  state.image[image::kQ] = 0x80;
  state.image[image::kI] = 0;
  for (std::uint32_t byte = 9; byte < 13; ++byte) state.image[image::kV + byte] = 0xEE;
  const auto seen = [&](std::string_view place) { return forcing::seen_outside(state, place_of(place)); };
  EXPECT_EQ(seen("Q0.1"), Bytes{1});
  EXPECT_EQ(seen("Q0.7"), Bytes{1}) << "what is not forced is what the program has";
  EXPECT_EQ(seen("QB0:2"), (Bytes{0x82, 0}));
  EXPECT_EQ(seen("IB0"), Bytes{4}) << "before the inputs are read";
  EXPECT_EQ(seen("VW10"), (Bytes{0x12, 0x34}));
  EXPECT_EQ(seen("VB11:2"), (Bytes{0x34, 0xEE}));
  EXPECT_EQ(seen("VB9:2"), (Bytes{0xEE, 0x12}));
  EXPECT_EQ(seen("V11.2"), Bytes{1});
  EXPECT_EQ(seen("MB0:32"), Bytes(32)) << "which lies behind the outputs";
}

TEST(Forcing, WhatAProgrammingDeviceWritesDoesNotChangeForcedMemory) {
  Plc plc("MEND\n");
  force(plc, "MB3", 7);
  const std::uint8_t written = 1;
  plc.cpu.poke(image::kM + 3, {&written, 1});
  EXPECT_EQ(plc.cpu.state().image[image::kM + 3], 7);
  EXPECT_TRUE(plc.cpu.unforce(place_of("MB3")));
  EXPECT_EQ(plc.cpu.state().image[image::kM + 3], 7) << "memory keeps what it has";
}

TEST(Forcing, SixteenValuesOfMemoryAndAnyNumberOfPointsCanBeForced) {
  Plc plc("MEND\n");
  for (int byte = 0; byte < 16; ++byte) force(plc, fmt::format("VB{}", byte), 1);
  EXPECT_FALSE(plc.cpu.force(place_of("VB100"), 1));
  force(plc, "VW2", 16 * 256);  // takes the place of two of them
  force(plc, "VB100", 1);
  force(plc, "QW0", 0xFFFF);
  EXPECT_EQ(plc.cpu.state().forcing.outputs.mask[1], 0xFF);
}

TEST(Forcing, ListsPointsBitByBitAndThenValuesOfMemory) {
  Plc plc("MEND\n");
  force(plc, "VW10", 5);
  force(plc, "Q0.1", 1);
  force(plc, "I1.7", 0);
  std::string text;
  for (const Assignment& forced : forcing::listed(plc.cpu.state().forcing))
    text += fmt::format("{}={} ", forced.place.name_of(0), forced.value);
  EXPECT_EQ(text, "I1.7=0 Q0.1=1 VW10=5 ");
}

TEST(Forcing, OnlyPointsAndWholeValuesOfVMAIAndAQCanBeForced) {
  for (const std::string_view can : {"I0.3", "IB1", "QW0", "VB1", "VD4", "MB0", "MW2", "AIW0", "AQW2"})
    EXPECT_TRUE(forcing::possible(place_of(can))) << can;
  for (const std::string_view cannot : {"V3.1", "M0.0", "SMB30", "T5", "C1", "AC0", "S0.1", "VB0:2"})
    EXPECT_FALSE(forcing::possible(place_of(cannot))) << cannot;
}

TEST(Forcing, EdgesAndCountersSeeTheTerminal) {
  Plc plc("LD SM0.1\nATCH 0, 0\nENI\nMEND\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n");
  run_more(plc, 1);
  force(plc, "I0.0", 1);
  run_more(plc, 2);
  EXPECT_EQ(load16(&plc.cpu.state().image[image::kV]), 0) << "forcing is no edge";
  plc.input("I0.0", true);
  run_more(plc, 1);
  EXPECT_EQ(load16(&plc.cpu.state().image[image::kV]), 1);
}

TEST(Forcing, AnalogValuesAreForcedAtOnce) {
  Plc plc("LD SM0.0\nMOVW AIW0, VW0\nMOVW 3, AQW0\nMEND\n");
  const std::uint8_t wired[2] = {0, 50};
  plc.cpu.poke(image::kAI, wired);
  force(plc, "AIW0", 1000);
  force(plc, "AQW0", 2000);
  plc.cpu.poke(image::kAI, wired);
  run_more(plc, 1);
  EXPECT_EQ(load16(&plc.cpu.state().image[image::kV]), 1000);
  EXPECT_EQ(load16(&plc.cpu.state().image[image::kAQ]), 2000);
  EXPECT_TRUE(plc.cpu.unforce(place_of("AIW0")));
  EXPECT_EQ(load16(&plc.cpu.state().image[image::kAI]), 50) << "what is wired";
}

TEST(Forcing, PowerOffDoesNotEndIt) {
  Plc before("MEND\n");
  force(before, "I0.0", 1);
  force(before, "VW2000", 7);
  RetentiveMemory memory = before.cpu.retentive_memory();
  memory.ram_lost = true;
  Plc after(kFollow, &memory);
  EXPECT_EQ(load16(&after.cpu.state().image[image::kV + 2000]), 7);
  run_more(after, 1);
  EXPECT_EQ(after.cpu.state().image[image::kQ], 1);
}

TEST(Forcing, SM47OfACpu22xSaysThatSomethingIsForced) {
  Plc plc("MEND\n", cpu224());
  force(plc, "I0.0", 0);
  run_more(plc, 2);
  EXPECT_TRUE(plc.cpu.state().image[sm::kInterruptStatus] & sm::kForced);
  plc.cpu.unforce(place_of("I0.0", cpu224()));
  EXPECT_FALSE(plc.cpu.state().image[sm::kInterruptStatus] & sm::kForced);
  Plc older("MEND\n");
  force(older, "I0.0", 0);
  EXPECT_FALSE(older.cpu.state().image[sm::kInterruptStatus] & sm::kForced) << "reserved in a CPU 21x";
}

}  // namespace
}  // namespace s7200::forcing_test

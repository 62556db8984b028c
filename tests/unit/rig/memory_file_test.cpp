// What survives power off: retentive ranges, EEPROM, clock, and the file that keeps them.
#include "tools/rig/files/memory_file.hpp"

#include "tests/support/plc.hpp"
#include "tools/rig/memory_json.hpp"

namespace s7200::test::memory_file_test {
namespace {

using tools::memory_from_json, tools::memory_to_json;

constexpr std::string_view kIdle = "LD SM0.2\nMOVB 1, VB4095\nLD SM0.0\nMEND\n";

RetentiveMemory filled() {
  Plc plc(kIdle);
  plc.run_scans(1);
  for (const char* address : {"VB0", "VB2000", "VB4090", "MB0", "MB13", "MB14", "MB31", "SB3"}) plc.set(address, 0x5A);
  for (const char* address : {"T0", "T31", "T32", "T64", "T95", "T96", "C0", "C127"}) plc.set(address, 0x1234);
  plc.set("VD4", 0x01020304);
  plc.cpu.set_clock({26, 11, 21, 10, 0, 0, 7});
  return plc.cpu.retentive_memory();
}

TEST(RetentiveMemoryTest, RetentiveRangesKeepTheirValuesAndAllElseIsZero) {
  const RetentiveMemory memory = filled();
  Plc plc(kIdle, &memory);
  for (const char* address : {"VB0", "VB2000", "VB4090", "MB14", "MB31"}) EXPECT_EQ(plc.value(address), 0x5A) << address;
  for (const char* address : {"MB0", "MB13", "SB3", "T32", "T96"}) EXPECT_EQ(plc.value(address), 0) << address;
  for (const char* address : {"T0", "T31", "T64", "T95", "C0", "C127"}) EXPECT_EQ(plc.value(address), 0x1234) << address;
  EXPECT_EQ(plc.cpu.clock(), (ClockTime{26, 11, 21, 10, 0, 0, 7}));
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB4095"), 0) << "SM0.2 is 0";
}

TEST(RetentiveMemoryTest, BitsOfTimersAndCountersAreNotKept) {
  const auto counted = "LD I0.0\nLD SM0.2\nCTU C5, 1\nLD I0.7\nTONR T0, 1\nMEND\n";
  Plc before(counted);
  before.run_scans(1);
  before.input("I0.0", true);
  before.run_scans(2);
  EXPECT_NE(before.cpu.state().image[image::kCBits], 0);
  const RetentiveMemory memory = before.cpu.retentive_memory();
  Plc after(counted, &memory);
  EXPECT_EQ(after.value("C5"), 1);
  EXPECT_EQ(after.cpu.state().image[image::kCBits], 0) << "until it is executed";
  after.run_scans(1);
  EXPECT_NE(after.cpu.state().image[image::kCBits], 0);
}

/// Saves VW10 once; SMW32 says from where.
std::string save(int offset, int size) {
  return fmt::format("LD SM0.1\nMOVD 16#11223344, VD{}\nMOVW {}, SMW32\nMOVB {}, SMB31\nMEND\n", std::min(offset, 4092),
                     offset, 0x80 | size);
}

TEST(Eeprom, ASaveTakesPlaceAtTheEndOfTheScanAndResetsItsRequest) {
  const int kSizes[] = {0, 1, 2, 3}, kBytes[] = {1, 1, 2, 4};
  for (const int size : kSizes) {
    Plc plc(save(10, size));
    plc.run_until(400 * us);
    EXPECT_EQ(plc.value("SM31.7"), 1);
    plc.run_scans(1);
    EXPECT_EQ(plc.value("SM31.7"), 0);
    const std::uint8_t value[] = {0x11, 0x22, 0x33, 0x44};
    for (int i = 0; i < 4; ++i)
      EXPECT_EQ(plc.cpu.state().eeprom[10 + static_cast<std::size_t>(i)], i < kBytes[size] ? value[i] : 0)
          << size << ' ' << i;
    EXPECT_TRUE(plc.records.errors().empty());
  }
}

// LD, MOVD, MOVW, MOVB and MEND: 850 us.
TEST(Eeprom, ASaveProlongsItsScanByTheTimeInTheTable) {
  Plc plc(save(10, 3));
  plc.run_scans(1);
  EXPECT_EQ(plc.cpu.time(), 850 * us + 10 * ms);
  EXPECT_EQ(plc.value("SMW22"), 10);
  plc.run_scans(2);
  EXPECT_EQ(plc.cpu.time(), 2 * 850 * us + 10 * ms);
  for (const CpuModel* model : {&cpu212(), &cpu214(), &cpu215(), &cpu216()})
    EXPECT_EQ(default_times(*model)[SystemTime::EepromSave], 17'500 * us);
}

// The save lasts from 930 us to 10.93 ms; the timed interrupt comes 5 ms after 270 us and takes 40 us to enter.
TEST(Eeprom, InterruptsAreServedDuringASaveOfTheValueAtItsStart) {
  Plc plc(
      "LD SM0.1\nMOVB 5, SMB34\nMOVB 16#11, VB10\nMOVW 10, SMW32\nMOVB 16#81, SMB31\nATCH 0, 10\nENI\nMEND\n"
      "INT 0\nMOVB 16#22, VB10\nMOVW 9999, SMW32\nRETI\n");
  plc.run_scans(1);
  ASSERT_EQ(plc.records.times(TraceKind::ServiceBegin).size(), 2u);
  EXPECT_EQ(plc.records.times(TraceKind::ServiceBegin)[0], 5260 * us);
  EXPECT_EQ(plc.value("VB10"), 0x22);
  EXPECT_EQ(plc.cpu.state().eeprom[10], 0x11);
  EXPECT_EQ(plc.value("SM31.7"), 0);
  EXPECT_TRUE(plc.records.errors().empty());
}

TEST(Eeprom, OutputsAreWrittenBeforeASave) {
  Plc plc("LD SM0.1\n= Q0.0\nMOVB 16#81, SMB31\nMEND\n");
  plc.run_scans(1);
  EXPECT_EQ(plc.records.times(TraceKind::OutputChanged), Times{840 * us});
}

TEST(Eeprom, ARefusedSaveTakesNoTime) {
  Plc plc(save(1021, 3));
  plc.run_scans(1);
  EXPECT_EQ(plc.cpu.time(), 850 * us);
}

TEST(Eeprom, TheLastAddressIsV1023AndBeyondItIs0094) {
  Plc last(save(1020, 3)), beyond(save(1021, 3)), far(save(4092, 0));
  for (Plc* plc : {&last, &beyond, &far}) plc->run_scans(1);
  EXPECT_TRUE(last.records.errors().empty());
  EXPECT_EQ(last.cpu.state().eeprom[1023], 0x44);
  EXPECT_EQ(beyond.records.errors(), Ints{0x94});
  EXPECT_EQ(far.records.errors(), Ints{0x94});
  EXPECT_EQ(beyond.records.of(TraceKind::RuntimeError)[0].op, kNoRoutine)
      << "no instruction is to blame: it is the scan's end";
  EXPECT_EQ(beyond.value("SM31.7"), 0);
  EXPECT_EQ(beyond.value("SM4.3"), 1);
}

TEST(RetentiveMemoryTest, TheClockRunsOnWhilePowerIsOff) {
  RetentiveMemory memory = filled();
  memory.power_off = 26 * 3600 * kSecond + 1999 * ms;
  const Plc plc(kIdle, &memory);
  EXPECT_EQ(plc.cpu.clock(), (ClockTime{26, 11, 22, 12, 0, 1, 1}));
  memory.ram_lost = true;
  const Plc lost(kIdle, &memory);
  EXPECT_EQ(lost.cpu.clock(), ClockTime{}) << "the capacitor was empty";
}

TEST(RetentiveMemoryTest, WithRamLostVComesFromTheEepromAndSM02IsOneForOneScan) {
  Plc before(save(10, 3));
  before.run_scans(1);
  before.set("VB2000", 0x5A);
  before.set("MB14", 0x5A);
  RetentiveMemory memory = before.cpu.retentive_memory();
  memory.ram_lost = true;
  Plc plc("LD SM0.2\nINCW VW100\nMEND\n", &memory);
  EXPECT_EQ(plc.value("VD10"), 0x11223344);
  EXPECT_EQ(plc.value("VB2000"), 0);
  EXPECT_EQ(plc.value("MB14"), 0);
  EXPECT_EQ(plc.cpu.clock(), ClockTime{});
  plc.run_scans(3);
  EXPECT_EQ(plc.value("VW100"), 1);
  EXPECT_EQ(plc.cpu.retentive_memory().eeprom[10], 0x11) << "the EEPROM stays";
}

TEST(MemoryFile, WhatIsWrittenReadsBackAsItself) {
  RetentiveMemory memory = filled();
  memory.eeprom[0] = 1;
  memory.eeprom[1023] = 2;
  const auto read = memory_from_json(memory_to_json(memory, cpu214()), cpu214());
  ASSERT_TRUE(read) << read.why();
  EXPECT_TRUE(*read == memory);
}

TEST(MemoryFile, TheBytesAreListedUnderTheirAddresses) {
  const std::string json = memory_to_json(filled(), cpu214());
  EXPECT_NE(json.find("\"VB0\": \"5a00000001020304"), std::string::npos);
  EXPECT_NE(json.find("\"MB0\": \"00000000000000000000000000005a"), std::string::npos);
  EXPECT_NE(json.find("\"T64\": \"1234"), std::string::npos);
  EXPECT_NE(json.find("\"C112\": \"0000"), std::string::npos) << "rows of 16 counters";
}

TEST(MemoryFile, AFileThatIsNotMemoryOfThisCpuIsRefusedWithTheReason) {
  const std::string good = memory_to_json(filled(), cpu214());
  const auto changed = [&](std::string_view from, std::string_view to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const auto with_forced = [&](const std::string& values) {
    return changed("\"eeprom\"", "\"forced\": {" + values + "}, \"eeprom\"");
  };
  std::string too_many = "\"VB0\": 1";
  for (int i = 1; i <= 16; ++i) too_many += fmt::format(", \"VB{}\": 1", i);
  const std::pair<std::string, std::string_view> kCases[] = {
      {"", "no JSON object"},
      {"MEND\n", "no JSON object"},
      {"{}", "no \"format\""},
      {"[1]", "no JSON object"},
      {good.substr(0, good.size() / 2), "no JSON object"},
      {changed("memory 1", "memory 2"), "no \"format\""},
      {changed("\"cpu\": \"214\"", "\"cpu\": \"216\""), "memory of a CPU 216"},
      {changed("\"VB0\"", "\"VB4090\""), "not kept"},
      {changed("\"VB0\"", "\"QB0\""), "not kept"},
      {changed("\"VB0\"", "\"MB13\""), "not kept"},
      {changed("\"VB0\"", "\"VB9999\""), "does not exist on CPU 214"},
      {changed("\"VB0\": \"5a", "\"VB0\": \"5"), "whole bytes"},
      {changed("\"VB0\": \"5a", "\"VB0\": \"5g"), "hex"},
      {changed("\"month\": 11", "\"month\": 100"), "month"},
      {changed("\"month\": 11", "\"month\": \"May\""), "damaged"},
      {changed("\"eeprom\"", "\"eprom\""), "it is damaged: eeprom is missing"},
      {changed("\"month\": 11", "\"month\": 1e78"), "it is damaged: clock: month: 1e+78 is not a whole number from 0 to 99"},
      {changed("\"cpu\": \"214\"", "\"cpu\": 214"), "it is damaged: cpu: 214 is not a text"},
      {changed("\"VB0\": \"5a", "\"VB2\": 5, \"VB0\": \"5a"), "it is damaged: 5 is not a text"},
      {"{\"ram\": " + std::string(100'000, '[') + std::string(100'000, ']') + "}",
       "(no JSON object: it is JSON of more than 64 maps and lists inside each other)"},
      {with_forced("\"VB10\": 70000"), "'VB10' cannot be forced to 70000"},
      {with_forced("\"VB12\": 1.5"), "'VB12' cannot be forced to 1.5"},
      {with_forced("\"I0.0\": 2"), "'I0.0' cannot be forced to 2"},
      {with_forced("\"VB10\": \"5\""), "'VB10' cannot be forced to \"5\""},
      {with_forced("\"SMB0\": 1"), "'SMB0' cannot be forced"},
      {with_forced(too_many), "there is room for 16 values"},
  };
  for (const auto& [json, reason] : kCases) {
    std::string why = memory_from_json(json, cpu214()).why();
    EXPECT_NE(why.find(reason), std::string::npos) << why << " / " << reason;
  }
}

TEST(MemoryFile, HasWhatIsForced) {
  Plc plc(kIdle);
  plc.cpu.force(plc.place("I0.3"), 1);
  plc.cpu.force(plc.place("VW10"), 7);
  const auto memory = memory_from_json(memory_to_json(plc.cpu.retentive_memory(), cpu214()), cpu214());
  ASSERT_TRUE(memory) << memory.why();
  EXPECT_EQ(memory->forcing, plc.cpu.state().forcing);
}

TEST(MemoryFile, ANegativeForcedValueReadsBackAsItself) {
  Plc plc(kIdle);
  plc.cpu.force(plc.place("VB10"), static_cast<std::uint32_t>(-1));
  plc.cpu.force(plc.place("VW20"), static_cast<std::uint32_t>(-2));
  const std::string json = memory_to_json(plc.cpu.retentive_memory(), cpu214());
  EXPECT_NE(json.find("\"VB10\": 255"), std::string::npos) << json;
  EXPECT_NE(json.find("\"VW20\": 65534"), std::string::npos) << json;
  const auto memory = memory_from_json(json, cpu214());
  ASSERT_TRUE(memory) << memory.why();
  EXPECT_EQ(memory->forcing, plc.cpu.state().forcing);
}

// TODW takes any BCD.
TEST(MemoryFile, AClockThatAProgramHasSetToNoDateReadsBackAsItself) {
  Plc plc("LD SM0.1\nMOVD 16#02991012, VD0\nMOVD 16#30000002, VD4\nTODW VB0\nMEND\n");
  plc.run_scans(1);
  const auto memory = memory_from_json(memory_to_json(plc.cpu.retentive_memory(), cpu214()), cpu214());
  ASSERT_TRUE(memory) << memory.why();
  EXPECT_EQ(memory->clock.month, 99);
  EXPECT_EQ(memory->clock, plc.cpu.clock());
}

}  // namespace
}  // namespace s7200::test::memory_file_test

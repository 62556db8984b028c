// Pointers to special and analog memory, which only CPUs 22x of release 2 have (facts 1.5).
#include "interpreter/analysis/warnings/check.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::pointers_test {
namespace {

std::string pointed(std::string_view rest) { return fmt::format("LD SM0.0\n{}MEND\n", rest); }

/// The run-time errors of the first scan.
Ints errors_of(std::string_view rest) {
  Plc plc(pointed(rest), cpu224());
  plc.run_scans(1);
  return plc.records.errors();
}

TEST(Pointers, ReachSpecialAndAnalogMemoryOnLateCpus) {
  Plc plc(pointed("MOVD &AIW4, AC1\nMOVW *AC1, VW0\nMOVD &SMB28, AC2\nMOVB *AC2, VB2\nMOVD &AQW2, VD4\nMOVW 77, *VD4\n"
                  "MOVD &SMB34, AC3\nMOVB 9, *AC3\nMOVD AC1, VD8\nMOVD AC2, VD12\n"),
          cpu224());
  plc.set("AIW4", 1234);
  plc.set("SMB28", 200);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VW0"), 1234);
  EXPECT_EQ(plc.value("VB2"), 200);
  EXPECT_EQ(plc.value("AQW2"), 77);
  EXPECT_EQ(plc.value("SMB34"), 9);
  EXPECT_EQ(plc.value("VD8"), 0x0A000004);
  EXPECT_EQ(plc.value("VD12"), 0x0900001C);
  EXPECT_EQ(plc.records.errors(), Ints{});
  EXPECT_EQ(plc.records.of(TraceKind::AnalogChanged).size(), 1U) << "as MOVW 77, AQW2 does";
}

TEST(Pointers, ABlockOfAnalogInputsIsCopiedThroughThem) {
  Plc plc(pointed("MOVD &AIW0, AC1\nBMW *AC1, VW100, 3\n"), cpu226());
  for (const int word : {0, 2, 4}) plc.set(fmt::format("AIW{}", word), static_cast<std::uint32_t>(1000 + word));
  plc.run_scans(1);
  for (const int word : {0, 2, 4}) EXPECT_EQ(plc.value(fmt::format("VW{}", 100 + word)), 1000 + word);
}

TEST(Pointers, ThePortFollowsItsControlByteThroughThem) {
  Plc plc(pointed("MOVD &SMB30, AC1\nMOVB 16#09, *AC1\n"), cpu224());
  plc.run_scans(1);
  EXPECT_TRUE(plc.cpu.state().port[0].active);
  EXPECT_TRUE(plc.port.receiver);
}

TEST(Pointers, WhatIsReadOnlyIsNotWrittenThroughThem) {
  EXPECT_EQ(errors_of("MOVD &SMB29, AC1\nMOVB 1, *AC1\n"), Ints{6});
  EXPECT_EQ(errors_of("MOVD &AIW0, AC1\nMOVW 1, *AC1\n"), Ints{6});
  EXPECT_EQ(errors_of("MOVD &AQW0, AC1\nMOVW *AC1, VW0\n"), Ints{6}) << "AQ is not read";
  EXPECT_EQ(errors_of("MOVD &AQW0, AC1\nINCW *AC1\n"), Ints{6});
  EXPECT_EQ(errors_of("MOVD &AIW0, AC1\nINCD AC1\nMOVW *AC1, VW0\n"), Ints{6}) << "odd";
  EXPECT_EQ(errors_of("MOVD &AIW0, AC1\nMOVB *AC1, VB0\n"), Ints{6}) << "a word";
  EXPECT_EQ(errors_of("MOVD &SMB29, AC1\nMOVB *AC1, VB0\n"), Ints{});
}

TEST(Pointers, FirstEditionsAndCpus21xRefuseThem) {
  for (const CpuModel* model : {&cpu214(), &cpu216(), &cpu224r1(), &cpu226xm()})
    for (const char* target : {"&SMB30", "&AIW0", "&AQW0"}) {
      const auto result = check_text(pointed(fmt::format("MOVD {}, AC1\n", target)), "test", *model, default_times(*model));
      ASSERT_EQ(result.diagnostics.size(), 1U) << model->name << ' ' << target;
      EXPECT_EQ(result.diagnostics[0].message.substr(0, 28), "a pointer cannot point to " + std::string(target + 1, 2));
    }
  Plc plc(pointed("MOVD 16#0900001E, AC1\nMOVB *AC1, VB0\n"), cpu224r1());
  plc.run_scans(1);
  EXPECT_EQ(plc.records.errors(), Ints{6});
}

}  // namespace
}  // namespace s7200::test::pointers_test

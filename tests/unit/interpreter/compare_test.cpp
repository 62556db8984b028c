// Real compares with a value that is not a number (facts 5.1, 9.1). Times: plc.hpp.
#include "tests/support/plc.hpp"

namespace s7200::test::compare_test {
namespace {

constexpr std::uint32_t kQuietNan = 0x7FC00000, kSignallingNan = 0xFF800001, kInfinity = 0x7F800000;

TEST(Compare, AValueThatIsNotANumberStopsTheCpuAtItsInstruction) {
  for (const std::string join : {"LD", "A", "O"})
    for (const std::string relation : {"=", ">=", "<="})
      for (const char* operands : {"VD100, VD104", "VD104, VD100", "VD100, 1.5", "*VD108, VD104"}) {
        for (const std::uint32_t value : {kQuietNan, kSignallingNan}) {
          const std::string contact = fmt::format("{}R{} {}", join, relation, operands);
          Plc plc(fmt::format("LD SM0.0\n=I Q0.0\nLD SM0.0\n{}\n= M0.0\nMEND\n", contact));
          plc.set("VD100", value);
          plc.set("VD108", 0x0800'0000 + 100);
          plc.run_scans(2);
          EXPECT_TRUE(plc.stopped()) << contact;
          EXPECT_EQ(plc.records.errors(), Ints{0x0F}) << contact;
          ASSERT_EQ(plc.records.of(TraceKind::FatalError).size(), 1u) << contact;
          EXPECT_EQ(plc.cpu.state().fatal_code, 0x12) << contact;
          EXPECT_EQ(plc.cpu.state().fatal_op, 3u) << contact;
          EXPECT_EQ(plc.value("SM4.3"), 1) << contact;
          EXPECT_EQ(plc.value("M0.0"), 0) << contact;
          EXPECT_EQ(plc.cpu.state().image[image::kOutputs], 0) << contact << ": the outputs go off";
        }
      }
}

TEST(Compare, InfinitiesAreComparedAndTheSameBitsAsAnIntegerAreNotAnError) {
  Plc plc("LDR>= VD100, 3.4E+38\n= M0.0\nLDD<= VD104, 5\n= M0.1\nLDW= VW104, 5\n= M0.2\nMEND\n");
  plc.set("VD100", kInfinity);
  plc.set("VD104", kSignallingNan);
  plc.run_scans(1);
  EXPECT_FALSE(plc.stopped());
  EXPECT_EQ(plc.value("MB0"), 0b011);
}

TEST(Compare, AContactThatIsJumpedOverMeetsNothing) {
  Plc plc("LD SM0.0\nJMP 0\nLDR= VD100, VD100\n= M0.0\nLBL 0\nMEND\n");
  plc.set("VD100", kQuietNan);
  plc.run_scans(3);
  EXPECT_FALSE(plc.stopped());
}

}  // namespace
}  // namespace s7200::test::compare_test

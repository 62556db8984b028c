// Retentive ranges as the system block sets them (facts 1.6).
#include "interpreter/program/loading/system_block.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::retentive_test {
namespace {

std::string read_as(std::string_view text, const CpuModel& model = cpu224()) {
  const auto ranges = parse_retentive(text, model);
  return ranges ? to_text(*ranges) : ranges.why();
}

TEST(RetentiveRanges, AreUpToSixOfVMTAndC) {
  EXPECT_EQ(read_as("VB0:100,MB0:14,T0:32,C5"), "VB0:100,MB0:14,T0:32,C5:1");
  EXPECT_EQ(read_as("vw10:4, VD20"), "VB10:8,VB20:4") << "in bytes";
  EXPECT_EQ(read_as("none"), "none");
  EXPECT_EQ(read_as("VB0,VB2,VB4,VB6,VB8,VB10,VB12"), "7 ranges; a system block has 6 at most");
  const std::string can = " cannot be retentive; bytes of V and M, timers of TONR (T0 to T31, T64 to T95) and counters can";
  for (const char* wrong : {"QB0", "T32", "T0:40", "M0.0", "SMB30", "AC0"})
    EXPECT_EQ(read_as(wrong), fmt::format("'{}'{}", wrong, can));
  EXPECT_EQ(read_as("VB8190:4"), "'VB8190:4' does not exist on CPU 224: V memory has 8192 bytes");
  EXPECT_NE(read_as("C200", cpu214()), "C200:1") << "it has 128";
  EXPECT_NE(read_as(""), "none");
  EXPECT_EQ(read_as("foo"), "'foo' is no range of memory; write for example VB0:100, MB0:14, T0:32, C0:5, or none");
}

/// A CPU after a power cycle, of which some memory was set before.
struct Cycled {
  explicit Cycled(std::string_view retain, bool ram_lost = false) {
    const auto program =
        with_system_block(*program_of("LD SM0.0\nMEND\n", cpu224()), {.retentive = *parse_retentive(retain, cpu224())});
    Plc before(program);
    for (const char* address : {"VB0", "VB100", "MB0", "MB13", "MB14", "T0", "C5"}) before.set(address, 0x5A);
    before.cpu.set_clock({26, 11, 21, 10, 0, 0, 7});
    RetentiveMemory memory = before.cpu.retentive_memory();
    memory.ram_lost = ram_lost;
    after = std::make_unique<Plc>(program, &memory);
  }

  /// Those that have kept their values.
  std::string kept() const {
    std::string all;
    for (const char* address : {"VB0", "VB100", "MB0", "MB13", "MB14", "T0", "C5"})
      if (after->value(address) == 0x5A) all += fmt::format("{} ", address);
    return all;
  }
  std::unique_ptr<Plc> after;
};

TEST(RetentiveRanges, KeepTheirValuesAndAllElseIsZero) {
  EXPECT_EQ(Cycled("VB0:100,MB0:14").kept(), "VB0 MB0 MB13 ");
  EXPECT_EQ(Cycled("T0,C0:256").kept(), "T0 C5 ");
  EXPECT_EQ(Cycled("none").kept(), "");
}

// If they are retentive, MB0 to MB13 are in the EEPROM, too.
TEST(RetentiveRanges, Mb0ToMb13SurviveEvenTheLossOfTheRam) {
  EXPECT_EQ(Cycled("VB0:100,MB0:32", true).kept(), "MB0 MB13 ");
  EXPECT_EQ(Cycled("MB13:2", true).kept(), "MB13 ");
  const Cycled lost("MB0:14", true);
  EXPECT_EQ(lost.after->value("SM0.2"), 1);
}

TEST(RetentiveRanges, AreThoseOfTheCpuIfTheSystemBlockSaysNothing) {
  const auto program = program_of("LD SM0.0\nMEND\n", cpu224());
  EXPECT_EQ(to_text(program->retentive()), "VB0:8192,MB14:18,T0:32,T64:32,C0:256");
  EXPECT_EQ(to_text(program_of("LD SM0.0\nMEND\n", cpu212())->retentive()), "VB0:1024,MB14:2,T0:32,C0:64");
}

}  // namespace
}  // namespace s7200::test::retentive_test

// What +I, -I, +D, -D, DIV, INC and DEC leave when their result does not fit: a field of the CPU model. Times: plc.hpp.
#include "tests/support/plc.hpp"

namespace s7200::test::integer_overflow_test {
namespace {

constexpr int kZero = 1, kOverflow = 2, kNegative = 4, kDivisionByZero = 8;

/// A CPU 215 that keeps its operands, as a CPU 22x does.
const CpuModel& keeping_cpu() {
  static const CpuModel kModel = [] {
    CpuModel model = cpu215();
    model.integer_overflow = IntegerOverflow::Keep;
    return model;
  }();
  return kModel;
}

struct Outcome {
  std::uint32_t out;
  int flags;
  bool operator==(const Outcome&) const = default;
};

void PrintTo(const Outcome& outcome, std::ostream* out) {
  *out << fmt::format("16#{:08X}, SMB1 = {}", outcome.out, outcome.flags);
}

/// `op` with OUT in VD100 and IN1 in VD104.
Outcome execute(const CpuModel& model, std::string_view op, std::uint32_t out, std::uint32_t in1, int flags_before) {
  Plc plc(fmt::format("LD SM0.0\n{}\nMEND\n", op), model);
  plc.set("VD100", out);
  plc.set("VD104", in1);
  plc.set("SMB1", static_cast<std::uint32_t>(flags_before));
  plc.run_scans(1);
  EXPECT_TRUE(plc.records.errors().empty()) << op;
  return {static_cast<std::uint32_t>(plc.value("VD100")), static_cast<int>(plc.cpu.state().image[sm::kFlags])};
}

struct Sum {
  std::string_view op;
  std::uint32_t out, in1, wrapped;
  int flags;  ///< of the wrapped result
};

constexpr Sum kSums[] = {
    {"+I VW106, VW102", 0x0000'7FFF, 1, 0x0000'8000, kOverflow | kNegative},
    {"+I VW106, VW102", 0x0000'8000, 0x8000, 0, kOverflow | kZero},
    {"-I VW106, VW102", 0x0000'8000, 1, 0x0000'7FFF, kOverflow},
    {"+D VD104, VD100", 0x7FFF'FFFF, 1, 0x8000'0000, kOverflow | kNegative},
    {"-D VD104, VD100", 0x8000'0000, 1, 0x7FFF'FFFF, kOverflow},
    {"DIV VW106, VD100", 0x1234'8000, 0xFFFF, 0x0000'8000, kOverflow | kNegative},
};

TEST(Overflow, ACpu21xStoresTheWrappedResult) {
  for (const CpuModel* model : {&cpu212(), &cpu214(), &cpu215(), &cpu216()}) {
    EXPECT_EQ(model->integer_overflow, IntegerOverflow::Wrap);
    for (const Sum& sum : kSums)
      EXPECT_EQ(execute(*model, sum.op, sum.out, sum.in1, 0), (Outcome{sum.wrapped, sum.flags})) << sum.op;
  }
}

TEST(Overflow, ACpuThatKeepsItsOperandsSetsSM11Only) {
  for (const Sum& sum : kSums)
    EXPECT_EQ(execute(keeping_cpu(), sum.op, sum.out, sum.in1, kZero | kNegative), (Outcome{sum.out, kOverflow})) << sum.op;
}

TEST(Overflow, WithoutOverflowBothKindsOfCpuStoreTheSame) {
  for (const CpuModel* model : {&cpu215(), &keeping_cpu()}) {
    EXPECT_EQ(execute(*model, "+I VW106, VW102", 0x7FFE, 1, kOverflow), (Outcome{0x7FFF, 0}));
    EXPECT_EQ(execute(*model, "-D VD104, VD100", 5, 6, kOverflow), (Outcome{0xFFFF'FFFF, kNegative}));
    EXPECT_EQ(execute(*model, "DIV VW106, VD100", 0x1234'8000, 2, kOverflow), (Outcome{0x0000'C000, kNegative}));
    EXPECT_EQ(execute(*model, "MUL VW106, VD100", 0x1234'8000, 0x8000, kOverflow | kDivisionByZero),
              (Outcome{0x4000'0000, 0}));
  }
}

TEST(Overflow, DivisionByZeroChangesNothingButSM13OnBoth) {
  for (const CpuModel* model : {&cpu215(), &keeping_cpu()})
    EXPECT_EQ(execute(*model, "DIV VW106, VD100", 0x1234'8000, 0, kZero | kOverflow),
              (Outcome{0x1234'8000, kZero | kOverflow | kDivisionByZero}));
}

TEST(Overflow, MultiplicationsAndDivisionsResetSM13AndSumsLeaveIt) {
  for (const char* op : {"*I VW106, VW102", "*D VD104, VD100", "/I VW106, VW102", "/D VD104, VD100"})
    EXPECT_EQ(execute(cpu224(), op, 6, 2, kDivisionByZero).flags, 0) << op;
  for (const char* op : {"+I VW106, VW102", "-I VW106, VW102", "+D VD104, VD100", "-D VD104, VD100"})
    EXPECT_EQ(execute(cpu224(), op, 6, 2, kDivisionByZero).flags, kDivisionByZero) << op;
}

TEST(Overflow, IncrementAndDecrementWrapOnEveryCpu) {
  for (const CpuModel* model : {&cpu215(), &keeping_cpu()}) {
    EXPECT_EQ(execute(*model, "INCB VB103", 0xFF, 0, 0), (Outcome{0, kZero | kOverflow}));
    EXPECT_EQ(execute(*model, "DECB VB103", 0, 0, 0), (Outcome{0xFF, kOverflow}));
    EXPECT_EQ(execute(*model, "INCW VW102", 0x7FFF, 0, 0), (Outcome{0x8000, kOverflow | kNegative}));
    EXPECT_EQ(execute(*model, "DECW VW102", 0x8000, 0, 0), (Outcome{0x7FFF, kOverflow}));
    EXPECT_EQ(execute(*model, "INCD VD100", 0x7FFF'FFFF, 0, 0), (Outcome{0x8000'0000, kOverflow | kNegative}));
    EXPECT_EQ(execute(*model, "DECD VD100", 0x8000'0000, 0, 0), (Outcome{0x7FFF'FFFF, kOverflow}));
  }
}

}  // namespace
}  // namespace s7200::test::integer_overflow_test

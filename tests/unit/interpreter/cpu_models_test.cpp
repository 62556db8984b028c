// How the CPUs differ: instructions, events, ranges (facts 1.1, 2.1, 3.1, 3.2, 6.13). Times: plc.hpp.
#include <set>

#include "tests/support/plc.hpp"

namespace s7200::test::cpu_models_test {
namespace {

using Texts = std::set<std::string, std::less<>>;

/// The first error that the checker finds; empty if there is none.
std::string refusal(std::string_view stl, const CpuModel& model) {
  const CheckResult result = check_text(stl, "test.stl", model, default_times(model));
  for (const auto& diagnostic : result.diagnostics)
    if (diagnostic.severity == stl::Severity::Error) return diagnostic.message;
  return {};
}

// --- instructions ---

Texts lacking(const CpuModel& model) {
  Texts mnemonics;
  for (const Instruction& instruction : all_instructions())
    if (!(instruction.cpus & model.self)) mnemonics.emplace(instruction.mnemonic);
  return mnemonics;
}

Texts together(Texts a, const Texts& b) {
  a.insert(b.begin(), b.end());
  return a;
}

const Texts kOf22xOnly{
    "TOF",  "CTD",  "*I",    "/I",    "*D",    "/D",    "BTI",  "ITB",  "ITD",   "DTI",   "ROUND", "ITA",  "DTA",
    "RTA",  "BIR",  "BIW",   "LDS",   "AENO",  "SIN",   "COS",  "TAN",  "LN",    "EXP",   "GPA",   "SPA",  "LDB<>",
    "AB<>", "OB<>", "LDW<>", "AW<>",  "OW<>",  "LDD<>", "AD<>", "OD<>", "LDR<>", "AR<>",  "OR<>",  "LDB>", "AB>",
    "OB>",  "LDW>", "AW>",   "OW>",   "LDD>",  "AD>",   "OD>",  "LDR>", "AR>",   "OR>",   "LDB<",  "AB<",  "OB<",
    "LDW<", "AW<",  "OW<",   "LDD<",  "AD<",   "OD<",   "LDR<", "AR<",  "OR<",   "CSCRE", "SLEN",  "SCPY", "SSCPY",
    "SCAT", "SFND", "CFND",  "ITS",   "DTS",   "RTS",   "STI",  "STD",  "STR",   "LDS=",  "AS=",   "OS=",  "LDS<>",
    "AS<>", "OS<>", "TODRX", "TODWX", "BITIM", "CITIM", "DLED"};
const Texts kFrom215On{"RCV", "BMD", "PID", "INCB", "DECB", "ANDB", "ORB", "XORB", "INVB", "SLB", "SRB", "RLB", "RRB"};
const Texts kFrom214On{"LDR=", "AR=",   "OR=",  "LDR>=", "AR>=", "OR>=",  "LDR<=", "AR<=", "OR<=", "MOVR", "+R",
                       "-R",   "*R",    "/R",   "SQRT",  "DTR",  "TRUNC", "FOR",   "NEXT", "ATT",  "FIFO", "LIFO",
                       "FND=", "FND<>", "FND<", "FND>",  "TODR", "TODW",  "PLS",   "NETR", "NETW"};

TEST(CpuModels, EachCpuLacksTheInstructionsOfTheLargerOnes) {
  EXPECT_EQ(lacking(cpu216()), kOf22xOnly);
  EXPECT_EQ(lacking(cpu215()), kOf22xOnly);
  EXPECT_EQ(lacking(cpu214()), together(kOf22xOnly, kFrom215On));
  EXPECT_EQ(lacking(cpu212()), together(together(kOf22xOnly, kFrom215On), kFrom214On));
}

// Facts 10.7.
TEST(CpuModels, InstructionsThatCameWithRelease2OfTheCpus22x) {
  const Texts new_ones{"TODRX", "TODWX", "BITIM", "CITIM", "DLED"};
  for (const CpuModel* model : all_cpus())
    if (model->self & kCpu22x) {
      EXPECT_EQ(lacking(*model), model->self & kCpu22xRelease1 ? new_ones : Texts{}) << model->name;
    }
}

TEST(CpuModels, AnInstructionOfALargerCpuIsRefusedByName) {
  EXPECT_EQ(refusal("LD SM0.0\nMOVR 1.0, VD0\nMEND\n", cpu212()), "CPU 212 has no MOVR");
  EXPECT_EQ(refusal("LD SM0.0\nFOR VW0, 1, 2\nNEXT\nMEND\n", cpu212()), "CPU 212 has no FOR");
  EXPECT_EQ(refusal("LD SM0.0\nINCB VB0\nMEND\n", cpu214()), "CPU 214 has no INCB");
  EXPECT_EQ(refusal("LD SM0.0\nRCV VB0, 0\nMEND\n", cpu214()), "CPU 214 has no RCV");
  EXPECT_EQ(refusal("LD SM0.0\nRCV VB0, 0\nMEND\n", cpu216()), "");
}

/// One instruction on a CPU 215 with VB0 and VB1 for its inputs and VB2 for its output.
struct ByteCase {
  std::string_view op;
  int in, count, before, after;
  int mask, flags;  ///< the bits of SM1 concerned, and those set
};

void PrintTo(const ByteCase& c, std::ostream* out) {
  *out << c.op << " of " << c.in << ", " << c.count << " on " << c.before;
}

constexpr int kZ = 1, kV = 2;

class ByteInstruction : public testing::TestWithParam<ByteCase> {
 protected:
  void run(std::string_view power, int flags_before) {
    const ByteCase& c = GetParam();
    Plc plc(fmt::format("{}\n{}\nMOVB SMB1, VB3\nMEND\n", power, c.op), cpu215());
    plc.set("VB0", static_cast<std::uint32_t>(c.in));
    plc.set("VB1", static_cast<std::uint32_t>(c.count));
    plc.set("VB2", static_cast<std::uint32_t>(c.before));
    plc.set("SMB1", static_cast<std::uint32_t>(flags_before));
    plc.run_until(230 * us);  // LD, the instruction, MOVB
    out = plc.value("VB2");
    flags = plc.cpu.state().image[sm::kFlags];
    EXPECT_EQ(plc.value("VB1"), c.count);
  }
  std::int64_t out = 0;
  int flags = 0;
};

TEST_P(ByteInstruction, GivesItsResultAndTouchesItsFlagsOnly) {
  const ByteCase& c = GetParam();
  for (const int before : {0x00, 0xFF}) {
    run("LD SM0.0", before);
    EXPECT_EQ(out, c.after);
    EXPECT_EQ(flags, (before & ~c.mask) | c.flags);
  }
  const Instruction& row = *find_instruction(c.op.substr(0, c.op.find(' ')));
  EXPECT_EQ(c.mask & ~row.flags, 0) << "flags that the table does not mention";
}

TEST_P(ByteInstruction, DoesNothingWithoutPowerFlow) {
  run("LDN SM0.0", 0x5A);
  EXPECT_EQ(out, GetParam().before);
  EXPECT_EQ(flags, 0x5A);
}

INSTANTIATE_TEST_SUITE_P(
    OnCpu215, ByteInstruction,
    testing::Values(
        ByteCase{"INCB VB2", 0, 0, 0x12, 0x13, kZ | kV, 0}, ByteCase{"INCB VB2", 0, 0, 0xFF, 0x00, kZ | kV, kZ | kV},
        ByteCase{"INCB VB2", 0, 0, 0x7F, 0x80, kZ | kV, 0}, ByteCase{"DECB VB2", 0, 0, 0x12, 0x11, kZ | kV, 0},
        ByteCase{"DECB VB2", 0, 0, 0x01, 0x00, kZ | kV, kZ}, ByteCase{"DECB VB2", 0, 0, 0x00, 0xFF, kZ | kV, kV},
        ByteCase{"DECB VB2", 0, 0, 0x80, 0x7F, kZ | kV, 0}, ByteCase{"ANDB VB0, VB2", 0xF0, 0, 0x3C, 0x30, kZ, 0},
        ByteCase{"ANDB VB0, VB2", 0xAA, 0, 0x55, 0x00, kZ, kZ}, ByteCase{"ORB VB0, VB2", 0xF0, 0, 0x3C, 0xFC, kZ, 0},
        ByteCase{"ORB VB0, VB2", 0, 0, 0, 0, kZ, kZ}, ByteCase{"XORB VB0, VB2", 0xF0, 0, 0x3C, 0xCC, kZ, 0},
        ByteCase{"XORB VB0, VB2", 0xFF, 0, 0xFF, 0x00, kZ, kZ}, ByteCase{"INVB VB2", 0, 0, 0x0F, 0xF0, kZ, 0},
        ByteCase{"INVB VB2", 0, 0, 0xFF, 0x00, kZ, kZ},
        // SM1.1 is the last bit shifted out; a count above 8 counts as 8, and a shift by 0 touches nothing. A rotate counts
        // modulo 8; if that is 0, it only touches SM1.0.
        ByteCase{"SLB VB2, VB1", 0, 1, 0x81, 0x02, kZ | kV, kV},
        ByteCase{"SLB VB2, VB1", 0, 2, 0x40, 0x00, kZ | kV, kZ | kV},
        ByteCase{"SLB VB2, VB1", 0, 3, 0x40, 0x00, kZ | kV, kZ},
        ByteCase{"SLB VB2, VB1", 0, 8, 0x01, 0x00, kZ | kV, kZ | kV},
        ByteCase{"SLB VB2, VB1", 0, 255, 0x01, 0x00, kZ | kV, kZ | kV}, ByteCase{"SLB VB2, VB1", 0, 0, 0x81, 0x81, kZ, 0},
        ByteCase{"SRB VB2, VB1", 0, 1, 0x81, 0x40, kZ | kV, kV},
        ByteCase{"SRB VB2, VB1", 0, 2, 0x02, 0x00, kZ | kV, kZ | kV},
        ByteCase{"SRB VB2, VB1", 0, 3, 0x02, 0x00, kZ | kV, kZ},
        ByteCase{"SRB VB2, VB1", 0, 8, 0x80, 0x00, kZ | kV, kZ | kV},
        ByteCase{"SRB VB2, VB1", 0, 255, 0x80, 0x00, kZ | kV, kZ | kV}, ByteCase{"SRB VB2, VB1", 0, 0, 0x81, 0x81, kZ, 0},
        ByteCase{"RLB VB2, VB1", 0, 1, 0x81, 0x03, kZ | kV, kV}, ByteCase{"RLB VB2, VB1", 0, 3, 0x12, 0x90, kZ | kV, 0},
        ByteCase{"RLB VB2, VB1", 0, 8, 0x81, 0x81, kZ, 0}, ByteCase{"RLB VB2, VB1", 0, 9, 0x40, 0x80, kZ | kV, 0},
        ByteCase{"RLB VB2, VB1", 0, 1, 0x00, 0x00, kZ | kV, kZ}, ByteCase{"RLB VB2, VB1", 0, 0, 0x81, 0x81, kZ, 0},
        ByteCase{"RLB VB2, VB1", 0, 16, 0x00, 0x00, kZ, kZ}, ByteCase{"RRB VB2, VB1", 0, 1, 0x81, 0xC0, kZ | kV, kV},
        ByteCase{"RRB VB2, VB1", 0, 3, 0x12, 0x42, kZ | kV, 0}, ByteCase{"RRB VB2, VB1", 0, 8, 0x80, 0x80, kZ, 0},
        ByteCase{"RRB VB2, VB1", 0, 9, 0x02, 0x01, kZ | kV, 0}, ByteCase{"RRB VB2, VB1", 0, 1, 0x00, 0x00, kZ | kV, kZ},
        ByteCase{"RRB VB2, VB1", 0, 0, 0x81, 0x81, kZ, 0}, ByteCase{"RRB VB2, VB1", 0, 16, 0x00, 0x00, kZ, kZ}));

TEST(CpuModels, ByteInstructionsTakePointersAccumulatorsAndConstants) {
  Plc plc(
      "LD SM0.0\nMOVD &VB2, AC1\nINCB *AC1\nXORB 16#0F, *AC1\nMOVD 16#A5A5A500, AC0\nORB VB0, AC0\nMOVD AC0, VD4\nMEND\n",
      cpu215());
  plc.set("VB0", 0x12);
  plc.set("VB2", 0x30);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB2"), 0x3E);
  EXPECT_EQ(static_cast<std::uint32_t>(plc.value("VD4")), 0xA5A5'A512u) << "the upper bytes of an accumulator stay";
}

TEST(CpuModels, ByteInstructionsTakeConstantsForWhatTheyReadAndNotForWhatTheyWrite) {
  const auto refused = [](std::string_view op) { return refusal(fmt::format("LD SM0.0\n{}\nMEND\n", op), cpu215()); };
  for (const std::string mnemonic : {"INCB", "DECB", "INVB"})
    EXPECT_EQ(refused(mnemonic + " 5"), "OUT of " + mnemonic + " cannot be the constant 5");
  for (const std::string mnemonic : {"ANDB", "ORB", "XORB"}) {
    EXPECT_EQ(refused(mnemonic + " 5, VB0"), "");
    EXPECT_EQ(refused(mnemonic + " VB0, 5"), "OUT of " + mnemonic + " cannot be the constant 5");
  }
  for (const std::string mnemonic : {"SLB", "SRB", "RLB", "RRB"}) {
    EXPECT_EQ(refused(mnemonic + " VB0, 5"), "");
    EXPECT_EQ(refused(mnemonic + " 5, 5"), "OUT of " + mnemonic + " cannot be the constant 5");
  }
}

TEST(CpuModels, EachBitShiftedAndEachDoubleWordMovedCostsItsTime) {
  // The scan with the instruction, minus the scan without power flow.
  const auto cost = [](std::string_view op) {
    const auto scan = [&](std::string_view power) {
      const CheckResult result =
          check_text(fmt::format("{}\n{}\nMEND\n", power, op), "test", cpu215(), default_times(cpu215()));
      EventQueue queue;
      Port port(queue);
      Cpu cpu(result.program, queue, kCpu, {&port, &port});
      cpu.power_up();
      cpu.pause_at_scan_end(true);
      cpu.run(kNever);
      return cpu.time();
    };
    return scan("LD SM0.0") - scan("LDN SM0.0");
  };
  EXPECT_EQ(cost("SLB VB2, 5") - cost("SLB VB2, 1"), 4 * 4 * us);
  EXPECT_EQ(cost("RRB VB2, 5") - cost("RRB VB2, 1"), 4 * 4 * us);
  EXPECT_EQ(cost("BMD VD0, VD100, 9") - cost("BMD VD0, VD100, 1"), 8 * 32 * us);
}

TEST(CpuModels, BmdMovesDoubleWordsAsIfTheyHadBeenCopiedFirst) {
  Plc plc("LD SM0.0\nBMD VD0, VD4, 3\nBMD VD0, VD100, VB50\nBMD VD0, VD5112, VB51\nBMD VD5112, VD0, VB51\nMEND\n", cpu215());
  plc.set("VD0", 0x1111'2222);
  plc.set("VD4", 0x3333'4444);
  plc.set("VD8", 0x5555'6666);
  plc.set("VD16", 0x7777'7777);
  plc.set("VB51", 3);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VD0"), 0x1111'2222);
  EXPECT_EQ(plc.value("VD4"), 0x1111'2222);
  EXPECT_EQ(plc.value("VD8"), 0x3333'4444);
  EXPECT_EQ(plc.value("VD12"), 0x5555'6666);
  EXPECT_EQ(plc.value("VD16"), 0x7777'7777);
  EXPECT_EQ(plc.records.errors(), (Ints{0x92, 0x91, 0x91})) << "no double word; beyond the end";
  EXPECT_EQ(plc.value("VD5112"), 0);
  EXPECT_EQ(refusal("LD SM0.0\nBMD VD5112, VD0, 3\nMEND\n", cpu215()),
            "3 double words from VD5112 run past the end of V memory (range error 0091)");
}

TEST(CpuModels, BmdDoesNothingWithoutPowerFlow) {
  Plc plc("LDN SM0.0\nBMD VD0, VD4, 1\nMEND\n", cpu215());
  plc.set("VD0", 0x1111'2222);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VD4"), 0);
}

// --- events ---

Ints events_of(const CpuModel& model) {
  Ints events;
  for (int event = 0; event < static_cast<int>(kEvents); ++event) {
    const std::string message = refusal(fmt::format("LD SM0.0\nATCH 0, {}\nMEND\nINT 0\nRETI\n", event), model);
    if (!message.starts_with(fmt::format("CPU {} has no event {} ", model.name, event))) events.push_back(event);
  }
  return events;
}

Ints up_to(int last) {
  Ints numbers;
  for (int i = 0; i <= last; ++i) numbers.push_back(i);
  return numbers;
}

TEST(CpuModels, EachCpuHasTheEventsOfItsList) {
  EXPECT_EQ(events_of(cpu212()), (Ints{0, 1, 8, 9, 10, 12}));
  EXPECT_EQ(events_of(cpu214()), up_to(20));
  EXPECT_EQ(events_of(cpu215()), up_to(23));
  EXPECT_EQ(events_of(cpu216()), up_to(26));
}

// ATCH ends at 220 us. TON T32 at 250 us: its ticks are those of 1, 2, 3 ms.
TEST(CpuModels, Event21ComesWithTheTickThatBringsT32ToItsPreset) {
  Plc plc("LD SM0.1\nATCH 0, 21\nENI\nLD SM0.0\nTON T32, 3\nMEND\nINT 0\nMOVW T32, VW0\nINCW VW2\nRETI\n", cpu215());
  plc.run_until(20 * ms);
  EXPECT_EQ(plc.records.times(TraceKind::EventOccurred), Times{3 * ms});
  EXPECT_EQ(plc.records.events(TraceKind::EventOccurred), Ints{21});
  EXPECT_EQ(plc.value("VW0"), 3);
  EXPECT_EQ(plc.value("VW2"), 1) << "once, though the timer counts on";
}

TEST(CpuModels, Event22BelongsToT96AndWaitsForEvent21) {
  Plc plc("LD SM0.1\nATCH 0, 21\nATCH 0, 22\nENI\nLD SM0.0\nTON T96, 3\nTON T32, 3\nMEND\nINT 0\nRETI\n", cpu216());
  plc.run_until(20 * ms);
  EXPECT_EQ(plc.records.events(TraceKind::ServiceBegin), (Ints{21, 22}));
  EXPECT_EQ(plc.records.times(TraceKind::EventOccurred), (Times{3 * ms, 3 * ms}));
}

TEST(CpuModels, NoOtherTimerAndNoTickBeforeThePresetGivesAnEvent) {
  Plc plc("LD SM0.1\nATCH 0, 21\nATCH 0, 22\nENI\nLD SM0.0\nTON T32, 100\nTONR T0, 3\nTONR T64, 3\nMEND\nINT 0\nRETI\n",
          cpu215());
  plc.run_until(50 * ms);
  EXPECT_TRUE(plc.records.events(TraceKind::EventOccurred).empty());
}

// The queue of timed events is 2 long on CPU 212: SQRT does not exist there, so DISI holds them.
TEST(CpuModels, QueuesAreAsLongAsTheCpusAre) {
  struct Depth {
    const CpuModel& model;
    int timed, io, communication;
  };
  for (const Depth& depth :
       {Depth{cpu212(), 2, 4, 4}, Depth{cpu214(), 4, 16, 4}, Depth{cpu215(), 8, 16, 4}, Depth{cpu216(), 8, 16, 8}}) {
    Plc plc("LD SM0.1\nMOVB 9, SMB30\nMOVB 5, SMB34\nATCH 0, 10\nATCH 0, 0\nATCH 0, 8\nMEND\nINT 0\nRETI\n", depth.model);
    plc.run_scans(1);
    for (int i = 0; i < 20; ++i) {
      plc.pulse("I0.0");
      plc.cpu.character_received({.byte = 1, .start = plc.cpu.time(), .end = plc.cpu.time()});
    }
    plc.run_until(100 * ms);
    const auto& queue = plc.cpu.state().queue;
    EXPECT_EQ(queue[0].count, depth.communication) << depth.model.name;
    EXPECT_EQ(queue[1].count, depth.io) << depth.model.name;
    EXPECT_EQ(queue[2].count, depth.timed) << depth.model.name;
    EXPECT_EQ(plc.cpu.state().image[sm::kInterruptStatus] & 7, 7) << depth.model.name;
  }
}

// --- ranges ---

/// The last operand of its kind on CPU 212, 214, 215 and 216, and a program with `{}` for it.
struct Range {
  std::string_view program, format;
  std::array<int, 4> last;
  int step = 1;
};

TEST(CpuModels, AddressesAndNumbersBeyondTheLastAreRefused) {
  const Range ranges[] = {
      {"LD SM0.0\nMOVB {}, VB0\nMEND\n", "VB{}", {1023, 4095, 5119, 5119}},
      {"LD SM0.0\nMOVW {}, VW0\nMEND\n", "VW{}", {1022, 4094, 5118, 5118}},
      {"LD SM0.0\nMOVD {}, VD0\nMEND\n", "VD{}", {1020, 4092, 5116, 5116}},
      {"LD SM0.0\nMOVB {}, VB0\nMEND\n", "IB{}", {7, 7, 7, 7}},
      {"LD SM0.0\nMOVB {}, VB0\nMEND\n", "QB{}", {7, 7, 7, 7}},
      {"LD SM0.0\nMOVB {}, VB0\nMEND\n", "MB{}", {15, 31, 31, 31}},
      {"LD SM0.0\nMOVB {}, VB0\nMEND\n", "SMB{}", {45, 85, 194, 194}},
      {"LD SM0.0\nMOVB {}, VB0\nMEND\n", "SB{}", {7, 15, 31, 31}},
      {"LD SM0.0\nMOVW {}, VW0\nMEND\n", "AIW{}", {30, 30, 30, 30}, 2},
      {"LD SM0.0\nMOVW VW0, {}\nMEND\n", "AQW{}", {30, 30, 30, 30}, 2},
      {"LD SM0.0\nMOVW {}, VW0\nMEND\n", "T{}", {63, 127, 255, 255}},
      {"LD SM0.0\nMOVW {}, VW0\nMEND\n", "C{}", {63, 127, 255, 255}},
      {"LD SM0.0\nMOVD {}, VD0\nMEND\n", "HC{}", {0, 2, 2, 2}},
      {"LD SM0.0\nMOVD {}, VD0\nMEND\n", "AC{}", {3, 3, 3, 3}},
      {"LD SM0.0\nHSC {}\nMEND\n", "{}", {0, 2, 2, 2}},
      {"LBL {}\nMEND\n", "{}", {63, 255, 255, 255}},
      {"MEND\nSBR {}\nRET\n", "{}", {15, 63, 63, 63}},
      {"MEND\nINT {}\nRETI\n", "{}", {31, 127, 127, 127}},
      {"LD SM0.0\nXMT VB0, {}\nMEND\n", "{}", {0, 0, 0, 1}},
  };
  for (const Range& range : ranges)
    for (std::size_t cpu = 0; cpu < 4; ++cpu) {
      const CpuModel& model = *all_cpus()[cpu];
      const auto with = [&](int number) {
        return fmt::format(fmt::runtime(range.program), fmt::format(fmt::runtime(range.format), number));
      };
      const std::string last = with(range.last[cpu]);
      EXPECT_EQ(refusal(last, model), "") << last;
      const std::string beyond = with(range.last[cpu] + range.step);
      EXPECT_NE(refusal(beyond, model).find(fmt::format("does not exist on CPU {}", model.name)), std::string::npos)
          << beyond;
    }
}

TEST(CpuModels, PointersReachTheEndOfTheCpusOwnMemory) {
  for (const auto& [model, end] : {std::pair{&cpu212(), 1024}, {&cpu214(), 4096}, {&cpu215(), 5120}}) {
    Plc plc("LD SM0.0\nMOVB 7, *VD0\nMEND\n", *model);
    plc.set("VD0", 0x0800'0000u + static_cast<std::uint32_t>(end) - 1);
    plc.run_scans(1);
    EXPECT_TRUE(plc.records.errors().empty()) << model->name;
    EXPECT_EQ(plc.value(fmt::format("VB{}", end - 1)), 7);
    plc.set("VD0", 0x0800'0000u + static_cast<std::uint32_t>(end));
    plc.run_scans(2);
    EXPECT_EQ(plc.records.errors(), Ints{0x06}) << model->name;
  }
}

TEST(CpuModels, AProgramMayHaveAsManyInstructionsAsThereAreWords) {
  for (const auto& [model, words] : {std::pair{&cpu212(), 512}, {&cpu214(), 2048}, {&cpu215(), 4096}, {&cpu216(), 4096}}) {
    std::string program;
    for (int i = 0; i + 1 < words; ++i) program += "NOP 0\n";
    EXPECT_EQ(refusal(program + "MEND\n", *model), "");
    EXPECT_EQ(
        refusal(program + "NOP 0\nMEND\n", *model),
        fmt::format(
            "the program is too large: at least {0} words for {0} instructions and their constants, CPU {1} has {2} words "
            "(compile rule 0080)",
            words + 1, model->name, words));
  }
}

TEST(CpuModels, TheyTellTheirNameInSMB6) {
  for (const auto& [model, code] : {std::pair{&cpu212(), 0x00}, {&cpu214(), 0x20}, {&cpu215(), 0x80}, {&cpu216(), 0x90}})
    EXPECT_EQ(Plc("MEND\n", *model).value("SMB6"), code) << model->name;
}

TEST(CpuModels, BaudCode0Is38400ButOnCpu212ItIs19200) {
  for (const CpuModel* model : all_cpus()) {
    Plc plc("LD SM0.1\nMOVB 1, SMB30\nMEND\n", *model);
    plc.run_scans(2);
    EXPECT_EQ(plc.port.format.baud, model == &cpu212() ? 19'200u : 38'400u) << model->name;
  }
}

// What the EEPROM can hold: 200 bytes on CPU 212, 1024 on CPU 214, 5120 on CPU 215.
TEST(CpuModels, OnlyTheFirstPartOfVCanBeSaved) {
  for (const auto& [model, bytes] : {std::pair{&cpu212(), 200}, {&cpu214(), 1024}, {&cpu215(), 5120}}) {
    const auto errors = [&, model = model](int offset) {
      Plc plc(fmt::format("LD SM0.1\nMOVW {}, SMW32\nMOVB 16#81, SMB31\nMEND\n", offset), *model);
      plc.run_scans(2);
      return plc.records.errors();
    };
    EXPECT_EQ(errors(bytes - 1), Ints{}) << model->name;
    EXPECT_EQ(errors(bytes), Ints{0x94}) << model->name;
  }
}

TEST(CpuModels, ConstantsThatAreNoPartOfTheirInstructionCountForTheSizeOfAProgram) {
  std::string text = "LD SM0.0\n";
  for (int i = 0; i < 700; ++i) text += "MOVD 16#12345678, VD0\n";  // three words each
  const CheckResult result = check_text(text + "MEND\n", "x", cpu214(), default_times(cpu214()));
  ASSERT_FALSE(result.program);
  EXPECT_EQ(result.diagnostics[0].position.line, 684U);
}

}  // namespace
}  // namespace s7200::test::cpu_models_test

// The CPUs 22x as models: ranges, queues, events, local memory, calls in interrupt routines, times.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "interpreter/analysis/warnings/check.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::cpu22x_models_test {
namespace {

const std::vector<const CpuModel*>& cpus22x() {
  static const std::vector<const CpuModel*> kModels{&cpu221r1(), &cpu222r1(), &cpu224r1(), &cpu226r1(), &cpu226xm(),
                                                    &cpu221(),   &cpu222(),   &cpu224(),   &cpu224xp(), &cpu226()};
  return kModels;
}

std::string refusal(const std::string& text, const CpuModel& model) {
  const CheckResult result = check_text(text, "test", model, default_times(model));
  for (const auto& diagnostic : result.diagnostics)
    if (diagnostic.severity == stl::Severity::Error) return diagnostic.message;
  return "";
}

bool takes(const std::string& statement, const CpuModel& model) {
  return refusal("LD SM0.0\n" + statement + "\nMEND\n", model).empty();
}

// Facts 1.2 and 10.1.
TEST(Cpu22x, MemoryEndsWhereTheModelSays) {
  const std::pair<const CpuModel*, int> v[] = {
      {&cpu221r1(), 2048}, {&cpu222r1(), 2048}, {&cpu224r1(), 5120}, {&cpu226r1(), 5120},  {&cpu226xm(), 10240},
      {&cpu221(), 2048},   {&cpu222(), 2048},   {&cpu224(), 8192},   {&cpu224xp(), 10240}, {&cpu226(), 10240}};
  for (const auto& [model, bytes] : v) {
    EXPECT_TRUE(takes(fmt::format("MOVB VB{}, VB0", bytes - 1), *model)) << model->name;
    EXPECT_FALSE(takes(fmt::format("MOVB VB{}, VB0", bytes), *model)) << model->name;
    EXPECT_TRUE(takes("MOVB LB63, VB0", *model)) << model->name;
    EXPECT_FALSE(takes("MOVB LB64, VB0", *model)) << model->name;
    EXPECT_TRUE(takes("MOVB IB15, QB15", *model)) << model->name;
  }
}

TEST(Cpu22x, LocalMemoryIsRefusedOnACpuThatHasNone) {
  for (const CpuModel* model : {&cpu212(), &cpu214(), &cpu215(), &cpu216()})
    EXPECT_EQ(refusal("LD SM0.0\nMOVB LB0, VB0\nMEND\n", *model), fmt::format("CPU {} has no L memory", model->name));
}

TEST(Cpu22x, SendingFromLocalMemoryIsRefused) { EXPECT_FALSE(takes("XMT LB0, 0", cpu224())); }

TEST(Cpu22x, TheyTellTheirNameInSMB6) {
  const std::pair<const CpuModel*, int> codes[] = {
      {&cpu221(), 0x60}, {&cpu222(), 0x00}, {&cpu224(), 0x20}, {&cpu224xp(), 0x20}, {&cpu226(), 0x90}};
  for (const auto& [model, code] : codes) EXPECT_EQ(Plc("MEND\n", *model).value("SMB6"), code) << model->name;
}

// Facts 2.1: the fast rates came with release 1.2 in the place of 600 and 300 baud.
TEST(Cpu22x, BaudCodes6And7AreFastOnRelease2) {
  for (const CpuModel* model : cpus22x()) {
    const bool fast = model->self & kCpu22xRelease2;
    for (const auto& [code, baud] : {std::pair{6, fast ? 115'200u : 600u}, {7, fast ? 57'600u : 300u}}) {
      Plc plc(fmt::format("LD SM0.1\nMOVB {}, SMB30\nMEND\n", code << 2 | 1), *model);
      plc.run_scans(2);
      EXPECT_EQ(plc.port.format.baud, baud) << model->name;
    }
  }
}

// Facts 3.1: 221 and 222 have no HSC1 and HSC2, only CPUs with two ports have events 24 to 26.
TEST(Cpu22x, EventsThatACpuLacksNameTheCpusThatHaveThem) {
  const auto attaching = [](int event, const CpuModel& model) {
    return refusal(fmt::format("LD SM0.0\nATCH 0, {}\nMEND\nINT 0\nRETI\n", event), model);
  };
  EXPECT_EQ(attaching(13, cpu221()), "CPU 221 has no event 13 (HSC1: current value = preset value)");
  EXPECT_EQ(attaching(13, cpu224()), "");
  EXPECT_EQ(attaching(25, cpu224()), "CPU 224 has no event 25 (port 1: character received)");
}

// Priorities inside the group of I/O events: pulse outputs first on 22x CPUs, last on 21x (facts 3.1).
TEST(Cpu22x, TheOrderOfIoEventsDiffersFromThatOf21x) {
  for (const auto& [event, on_21x, on_22x] : {std::array{19, 15, 0}, {20, 16, 1}, {0, 0, 2}, {12, 0, 10}, {33, 23, 23}}) {
    EXPECT_EQ(find_event(event)->order(kCpu214), on_21x) << event;
    EXPECT_EQ(find_event(event)->order(kCpu224), on_22x) << event;
  }
}

TEST(Cpu22x, SetsOfCpusAreNamedAsEngineersNameThem) {
  EXPECT_EQ(to_text(kCpu22x), "CPU 22x");
  EXPECT_EQ(to_text(kFrom214), "CPU 214, 215, 216 or 22x");
  EXPECT_EQ(to_text(kCpu22xRelease2), "CPU 22x of release 2");
  EXPECT_EQ(to_text(kTwoPorts), "CPU 216, 224XP, 226, 226r1 or 226XM");
}

TEST(Cpu22x, NamesAreFoundInAnyCase) {
  for (const CpuModel* model : cpus22x()) EXPECT_EQ(find_cpu(model->name), model);
  EXPECT_EQ(find_cpu("224xp"), &cpu224xp());
  EXPECT_EQ(find_cpu("226xm"), &cpu226xm());
  EXPECT_EQ(find_cpu("225"), nullptr);
}

TEST(Cpu22x, The221And222HaveNoHsc1AndHsc2) {
  for (const CpuModel* model : cpus22x()) {
    const bool small = std::string_view(model->name).substr(0, 3) < "224";
    for (int counter = 0; counter < 6; ++counter)
      EXPECT_EQ(takes(fmt::format("HSC {}", counter), *model), !small || (counter != 1 && counter != 2)) << model->name;
  }
}

TEST(Cpu22x, TheWatchdogIs500msOnRelease2And300msBefore) {
  for (const CpuModel* model : cpus22x()) {
    Plc plc("LBL 0\nLD SM0.0\nJMP 0\nMEND\n", *model);
    plc.run_until(kSecond);
    const auto stops = plc.records.times(TraceKind::FatalError);
    ASSERT_EQ(stops.size(), 1u) << model->name;
    const Time limit = model->self & kCpu22xRelease2 ? 500 * ms : 300 * ms;
    EXPECT_GE(stops[0], limit) << model->name;
    EXPECT_LE(stops[0], limit + ms) << model->name;
  }
}

TEST(Cpu22x, WhatIsRetentiveOnTheCpu214IsRetentive) {
  for (const CpuModel* model : cpus22x()) {
    Plc before("MEND\n", *model);
    before.run_scans(1);
    for (const char* address : {"VB2047", "MB13", "MB14", "MB31"}) before.set(address, 7);
    const RetentiveMemory memory = before.cpu.retentive_memory();
    Plc after("MEND\n", &memory, *model);
    after.run_scans(1);
    for (const auto& [address, value] : {std::pair{"VB2047", 7}, {"MB13", 0}, {"MB14", 7}, {"MB31", 7}})
      EXPECT_EQ(after.value(address), value) << model->name << ' ' << address;
  }
}

// --- local memory (facts 1.2) ---

TEST(LocalMemory, ASubroutineHasItsOwn) {
  Plc plc(
      "LD SM0.0\nMOVB 5, LB3\nCALL 0\nMOVB LB3, VB0\nMEND\n"
      "SBR 0\nLD SM0.0\nMOVB LB3, VB1\nMOVB 9, LB3\nMOVB LB3, VB2\nRET\n",
      cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB0"), 5);
  EXPECT_EQ(plc.value("VB1"), 0);
  EXPECT_EQ(plc.value("VB2"), 9);
}

TEST(LocalMemory, ARoutineFindsWhatTheLastOneOfItsLevelLeft) {
  Plc plc(
      "LD SM0.0\nCALL 0\nCALL 1\nMEND\n"
      "SBR 0\nLD SM0.0\nMOVB 9, LB3\nRET\nSBR 1\nLD SM0.0\nMOVB LB3, VB1\nRET\n",
      cpu224());
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB1"), 9);
}

TEST(LocalMemory, AnInterruptRoutineAndTheSubroutineItCallsHaveTheirOwn) {
  Plc plc(
      "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nLD SM0.0\nMOVB 1, LB0\nMOVB LB0, VB0\nMEND\n"
      "SBR 0\nLD SM0.0\nMOVB LB0, VB1\nMOVB 3, LB0\nRET\n"
      "INT 0\nLD SM0.0\nMOVB 2, LB0\nCALL 0\nMOVB LB0, VB2\nINCB VB3\nRETI\n",
      cpu224());
  plc.run_until(22 * ms);
  EXPECT_TRUE(plc.records.errors().empty());
  EXPECT_EQ(plc.value("VB0"), 1);
  EXPECT_EQ(plc.value("VB1"), 3) << "what the call of the last interrupt left";
  EXPECT_EQ(plc.value("VB2"), 2);
  EXPECT_EQ(plc.value("VB3"), 4);
}

TEST(Cpu22x, AnInterruptRoutineCallsOneLevelOfSubroutines) {
  const std::string program =
      "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nMEND\n"
      "SBR 0\nLD SM0.0\nMOVB 1, VB0\nCALL 1\nRET\nSBR 1\nLD SM0.0\nMOVB 1, VB1\nRET\n"
      "INT 0\nLD SM0.0\nCALL 0\nRETI\n";
  Plc plc(program, cpu224());
  plc.run_until(6 * ms);
  EXPECT_EQ(plc.value("VB0"), 1);
  EXPECT_EQ(plc.value("VB1"), 0);
  EXPECT_EQ(plc.records.errors(), Ints{0x08});
  EXPECT_EQ(refusal(program, cpu214()), "CALL is not allowed in an interrupt routine");
}

// --- times (cpu22x_times.csv: MOVB 15, an accumulator adds 2.8, local memory 2.8, a pointer 14; LD of L 6) ---

TEST(Cpu22x, OperandsInAccumulatorsAndLocalMemoryTakeTheirTime) {
  const auto cost = [](const std::string& statement) {
    const CheckResult result = check_text("LD SM0.0\n" + statement + "\nMEND\n", "test", cpu224(), default_times(cpu224()));
    return result.program ? result.program->ops[1].cost : 0;
  };
  EXPECT_EQ(cost("MOVB VB0, VB1"), 15'000);
  EXPECT_EQ(cost("MOVB AC0, VB1"), 17'800);
  EXPECT_EQ(cost("MOVB LB0, AC0"), 20'600);
  EXPECT_EQ(cost("MOVB *AC1, VB1"), 29'000);
  EXPECT_EQ(cost("LD L0.0\nALD"), 6'000) << "the line for L has it whole";
}

TEST(Cpu22x, EveryModelledInstructionHasATime) {
  for (const CpuModel* model : {&cpu224(), &cpu224r1()}) {
    const TimeTable times = default_times(*model);
    for (const Instruction& instruction : all_instructions()) {
      if (!instruction.modelled() || !(instruction.cpus & model->self)) continue;
      const auto rules = instruction.rules();
      const Areas areas = rules.empty() ? Areas{0} : rules[0].areas;
      if (areas == 0 || rules[0].constant || rules[0].pointer) {
        EXPECT_TRUE(times.cost(instruction.mnemonic, {})) << instruction.mnemonic;
      }
      for (const AreaInfo& area : all_areas()) {
        if (!contains(areas, area.area)) continue;
        EXPECT_TRUE(times.cost(instruction.mnemonic, area.area)) << instruction.mnemonic << ' ' << area.name;
      }
    }
  }
}

TEST(Cpu22x, The226XmHas128Subroutines) {
  const std::string last = "MEND\nSBR 127\nRET\n", call = "LD SM0.0\nCALL 127\n";
  EXPECT_TRUE(check_text(call + last, "x", *find_cpu("226XM"), default_times(*find_cpu("226XM"))).program);
  EXPECT_FALSE(check_text(call + last, "x", *find_cpu("226"), default_times(*find_cpu("226"))).program);
}

TEST(Cpu22x, TwoPidsOfOneLoopAreWarnedOf) {
  const CheckResult result =
      check_text("LD SM0.0\nPID VB100, 0\nPID VB200, 1\nPID VB300, 0\nMEND\n", "x", cpu224(), default_times(cpu224()));
  ASSERT_EQ(result.diagnostics.size(), 1U);
  EXPECT_EQ(result.diagnostics[0].name, "double-loop");
  EXPECT_EQ(result.diagnostics[0].position.line, 4U);
}

TEST(Cpu22x, EnteringAnInterruptTakes47usOnRelease1And24usOnRelease2) {
  EXPECT_EQ(default_times(*find_cpu("224r1"))[SystemTime::InterruptEntry], 47 * kMicrosecond);
  EXPECT_EQ(default_times(cpu224())[SystemTime::InterruptEntry], 24 * kMicrosecond);
}

}  // namespace
}  // namespace s7200::test::cpu22x_models_test

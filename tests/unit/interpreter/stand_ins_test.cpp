// Stand-ins for libraries of Micro/WIN: which programs get them, where, and what MBUS_INIT says. What they do on a line:
// tests/programs/libraries.
#include "interpreter/program/loading/stand_ins.hpp"

#include <algorithm>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"
#include "tests/support/plc.hpp"

namespace s7200::test::stand_ins_test {
namespace {

constexpr const char* kSlave =
    "NETWORK 1\nLD SM0.1\nCALL MBUS_INIT, 1, 1, 9600, 2, 0, 128, 32, 1000, &VB0, M0.1, MB1\n"
    "NETWORK 2\nLD SM0.0\nCALL MBUS_SLAVE, M0.2, MB2\n";

std::string listing(const std::string& text) { return text + "MEND\n"; }

std::string exported(const std::string& text, const std::string& blocks = {}) {
  return "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\n" + text + "END_ORGANIZATION_BLOCK\n" + blocks;
}

/// A program and its symbol table.
CheckResult check_with(const std::string& text, const std::string& table, const CpuModel& model = cpu224()) {
  std::vector<SourceText> files{*read_source(text, "main.awl")};
  if (!table.empty()) files.push_back(*read_source(table, "symbols.txt"));
  return check(join_files(std::move(files)).parsed, model, default_times(model));
}

std::vector<std::string> errors(const CheckResult& result) {
  std::vector<std::string> all;
  for (const stl::Diagnostic& d : result.diagnostics) all.push_back(d.message);
  return all;
}

using Lines = std::vector<std::string>;

/// The stand-ins of a program without errors and warnings.
std::vector<StandIn> stand_ins(const std::string& text, const std::string& table = {}, const CpuModel& model = cpu224()) {
  const CheckResult result = check_with(text, table, model);
  EXPECT_EQ(errors(result), Lines{});
  return result.program ? stand_ins_of(result.program->source) : std::vector<StandIn>{};
}

TEST(StandIns, AreInExportsAndInListingsAlike) {
  for (const std::string& text : {exported(kSlave), listing(kSlave)}) {
    const auto taken = stand_ins(text);
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_EQ(taken[0].file, "stand-in:modbus_slave.awl");
    EXPECT_EQ(taken[0].routines, (Lines{"MBUS_INIT", "MBUS_SLAVE"}));
  }
}

TEST(StandIns, AreNoSymbolTableThatTheUserHasGiven) {
  const CheckResult result = check_with(exported(std::string(kSlave) + "NETWORK 3\nLD Pump_Start\n= Pump_Motor\n"), {});
  ASSERT_EQ(errors(result).size(), 2U);
  for (const stl::Diagnostic& d : result.diagnostics)
    EXPECT_EQ(d.hint, "give its symbol table too, s7200 check PROGRAM SYMBOLS, or write the address itself");
  const CheckResult with_table =
      check_with(exported(std::string(kSlave) + "NETWORK 3\nLD Pump_Start\n= Q0.0\n"), "Pump_On\tI0.0\nValve\tI0.1\n");
  ASSERT_EQ(errors(with_table).size(), 1U);
  EXPECT_EQ(with_table.diagnostics.front().hint,
            "symbols.txt does not have it; the nearest is Pump_On; add it there, or write the address itself");
}

TEST(StandIns, ThatNothingSwitchesOnAreNamed) {
  const auto note = [](const std::string& calls) {
    return to_text(stand_ins(listing("NETWORK 1\nLD SM0.0\n" + calls)).front());
  };
  EXPECT_TRUE(note("CALL MBUS_SLAVE, M0.2, MB2\n").ends_with("; nothing calls its MBUS_INIT, which switches it on"));
  EXPECT_TRUE(note("CALL MBUS_MSG, SM0.5, 1, 0, 40001, 2, &VB100, M0.0, MB2\n")
                  .ends_with("; nothing calls its MBUS_CTRL, which switches it on"));
  EXPECT_EQ(note(kSlave).find("nothing calls"), std::string::npos);
}

TEST(StandIns, AreNotThereWithoutACall) { EXPECT_TRUE(stand_ins(exported("NETWORK 1\nLD SM0.0\n= M0.0\n")).empty()); }

TEST(StandIns, FollowTheNameInAnyCapitalsAndQuotes) {
  for (const char* name : {"mbus_slave", "\"MBUS_SLAVE\"", "MBUS_SLAVE:SBR4"})
    EXPECT_EQ(stand_ins(exported(std::string("NETWORK 1\nLD SM0.0\nCALL ") + name + ", M0.2, MB2\n")).size(), 1U) << name;
}

TEST(StandIns, GiveWayToABlockOfTheProgram) {
  const std::string own =
      "SUBROUTINE_BLOCK MBUS_SLAVE:SBR4\nVAR_OUTPUT\n Done : BOOL;\n Error : BYTE;\nEND_VAR\nBEGIN\nNETWORK 1\nLD SM0.0\n= "
      "#Done\nEND_SUBROUTINE_BLOCK\n";
  for (const char* name : {"MBUS_SLAVE", "MBUS_SLAVE:SBR4"})
    EXPECT_TRUE(stand_ins(exported(std::string("NETWORK 1\nLD SM0.0\nCALL ") + name + ", M0.2, MB2\n", own)).empty());
}

TEST(StandIns, TakeThePlaceOfANumberThatNoBlockHas) {
  EXPECT_EQ(
      stand_ins(exported("NETWORK 1\nLD SM0.0\nCALL MBUS_SLAVE, M0.2, MB2\n"), "MBUS_SLAVE\tSBR1\nMBUS_INIT\tSBR2\n").size(),
      1U);
}

TEST(StandIns, TakeTheHighestFreeBytesOfVMemory) {
  const auto at_the_end = stand_ins(exported(kSlave));
  EXPECT_EQ(at_the_end[0].memory + at_the_end[0].bytes, 8192U);
  const std::string used = "NETWORK 3\nLD SM0.0\nMOVW VW8190, AC0\nMOVB 1, VB8000\n";
  const auto below = stand_ins(exported(kSlave + used));
  EXPECT_EQ(below[0].memory + below[0].bytes, 8000U);
  const std::string pointed = "NETWORK 3\nLD SM0.0\nMOVD &VB7936, AC1\n";
  const auto before_the_target = stand_ins(exported(kSlave + pointed));
  EXPECT_EQ(before_the_target[0].memory + before_the_target[0].bytes, 7936U);
  const std::string block = "NETWORK 3\nLD SM0.0\nBMW VW7000, VW7400, 200\n";
  const auto over_the_block = stand_ins(exported(kSlave + block));
  EXPECT_EQ(over_the_block[0].memory + over_the_block[0].bytes, 8192U) << "VW7400 and 200 words end at VB7799";
}

TEST(StandIns, LeaveTheHoldingRegistersAlone) {
  const std::string text =
      "NETWORK 1\nLD SM0.1\nCALL MBUS_INIT, 1, 1, 9600, 2, 0, 128, 32, 500, &VB1048, M0.1, MB1\nNETWORK 2\nLD SM0.0\nCALL "
      "MBUS_SLAVE, M0.2, MB2\n";
  const auto taken = stand_ins(exported(text), {}, cpu222());
  EXPECT_EQ(taken[0].memory + taken[0].bytes, 1048U);
  const auto by_name =
      stand_ins(exported(std::string(text).replace(text.find("500, &VB1048"), 12, "Registers, &First_Register")),
                "First_Register\tVB1048\nRegisters\t500\n", cpu222());
  EXPECT_EQ(by_name[0].memory + by_name[0].bytes, 1048U);
}

TEST(StandIns, TakeTheMemoryThatTheProgramGivesThem) {
  EXPECT_EQ(stand_ins(exported(kSlave), "Modbus_Slave_Memory\tVB3000\n")[0].memory, 3000U);
  const CheckResult beyond = check_with(exported(kSlave), "Modbus_Slave_Memory\tVB8000\n");
  EXPECT_EQ(errors(beyond).front(), "Modbus_Slave_Memory is not a place for 370 bytes of V memory");
}

TEST(StandIns, SayWhereThereIsNoRoom) {
  std::string used = "NETWORK 3\nLD SM0.0\n";
  for (int i = 0; i < 8192; i += 256) used += "MOVB 1, VB" + std::to_string(i) + "\n";
  EXPECT_EQ(errors(check_with(exported(kSlave + used), {})).front(),
            "there are no 370 free bytes of V memory for modbus_slave.awl");
}

TEST(StandIns, ShareNoNumberAndNoNameWithTheProgram) {
  const std::string own =
      "NETWORK 3\nLD SM0.0\nCALL 63\nCALL mb_crc\nATCH 127, 8\nENI\nMOVB 1, mbBuffer\nMOVB mbBuffer, VB100\nJMP 255\nLBL "
      "255\n";
  const std::string blocks =
      "SUBROUTINE_BLOCK SBR_63:SBR63\nBEGIN\nNETWORK 1\nLD SM0.0\n= M5.0\nEND_SUBROUTINE_BLOCK\n"
      "SUBROUTINE_BLOCK mb_crc:SBR62\nBEGIN\nNETWORK 1\nLD SM0.0\n= M5.1\nEND_SUBROUTINE_BLOCK\n"
      "INTERRUPT_BLOCK INT_127:INT127\nBEGIN\nNETWORK 1\nLD SM0.0\n= M5.2\nEND_INTERRUPT_BLOCK\n";
  const std::string table = "mbBuffer\tVB10\nmbStation\tVB11\n";
  const CheckResult result = check_with(exported(kSlave + own, blocks), table);
  ASSERT_TRUE(result.program) << errors(result).front();
  Plc plc(result.program);
  plc.run_scans(2);
  EXPECT_EQ(plc.value("M0.1"), 1) << "MBUS_INIT is done";
  EXPECT_EQ(plc.value("MB1"), 0);
  EXPECT_EQ(plc.value("VB10"), 1);
  EXPECT_EQ(plc.value("M5.0"), 1);
  EXPECT_EQ(plc.value("M5.1"), 1);
}

TEST(StandIns, PassCheckAloneOnEachCpuThatCanHaveThem) {
  for (const CpuModel* model : all_cpus()) {
    const bool can = (model->self & kCpu22x) != 0;
    const CheckResult result = check_with(listing("NETWORK 1\nLD SM0.0\nCALL MBUS_SLAVE, M0.2, MB2\n"), {}, *model);
    EXPECT_EQ(result.program != nullptr, can) << model->name;
    const Lines expected{"MBUS_SLAVE is a routine of a library that CPU " + std::string(model->name) + " cannot have"};
    EXPECT_EQ(errors(result), can ? Lines{} : expected);
  }
}

TEST(StandIns, AtPort1NeedACpuThatHasIt) {
  const std::string text = listing("NETWORK 1\nLD SM0.0\nCALL MBUS_CTRL_P1, 1, 9600, 2, 1000, M0.1, MB1\n");
  EXPECT_EQ(errors(check_with(text, {}, cpu224())),
            Lines{"MBUS_CTRL_P1 is a routine of a library that CPU 224 cannot have"});
  EXPECT_EQ(stand_ins(text, {}, cpu226())[0].file, "stand-in:modbus_master_P1.awl");
}

TEST(StandIns, TheMasterNeedsRelease2) {
  const std::string text = listing("NETWORK 1\nLD SM0.0\nCALL MBUS_CTRL, 1, 9600, 2, 1000, M0.1, MB1\n");
  EXPECT_EQ(errors(check_with(text, {}, cpu224r1())),
            Lines{"MBUS_CTRL is a routine of a library that CPU 224r1 cannot have"});
}

TEST(StandIns, OfBothPortsAndBothRolesAreInOneProgram) {
  const std::string text =
      kSlave + std::string(
                   "NETWORK 3\nLD SM0.0\nCALL MBUS_CTRL_P1, 1, 9600, 2, 1000, M0.3, MB3\nNETWORK 4\nLD I0.0\n"
                   "CALL MBUS_MSG_P1, I0.1, 1, 0, 40001, 10, &VB3000, M0.4, MB4\n");
  const auto taken = stand_ins(exported(text), {}, cpu226());
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_EQ(taken[0].memory, taken[1].memory + taken[1].bytes) << "one below the other";
}

TEST(StandIns, OfTheMasterHaveTheSymbolsThatProgramsSet) {
  const std::string text =
      "NETWORK 1\nLD SM0.0\nCALL MBUS_CTRL, 1, 9600, 2, 1000, M0.1, MB1\nMOVB mModbusRetries, VB0\nMOVB 5, "
      "mModbusRetries\nMOVB mModbusRetries, VB1\n";
  const CheckResult result = check_with(exported(text), {});
  ASSERT_TRUE(result.program) << errors(result).front();
  Plc plc(result.program);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB0"), 2) << "what it is as the library comes";
  EXPECT_EQ(plc.value("VB1"), 5);
}

TEST(StandIns, UseTheSymbolsOfTheLibraryWhereTheProgramsTableHasThem) {
  const CheckResult result =
      check_with(exported("NETWORK 1\nLD SM0.0\nCALL MBUS_CTRL, 1, 9600, 2, 1000, M0.1, MB1\nMOVB mModbusRetries, VB0\n"),
                 "mModbusRetries\tVB4000\nmModbusForceMulti\tVB4001\n");
  ASSERT_TRUE(result.program) << errors(result).front();
  Plc plc(result.program);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("VB0"), 2);
  EXPECT_EQ(plc.value("VB4000"), 2);
}

TEST(StandIns, AreNoFilesOfTheSameName) {
  std::vector<SourceText> files{*read_source(exported("NETWORK 1\nLD SM0.0\n= M0.0\n"), "main.awl")};
  files.push_back(*read_source("Pump\tQ0.0\n", "stand-in:modbus_slave.awl"));
  const CheckResult result = check(join_files(std::move(files)).parsed, cpu224(), default_times(cpu224()));
  ASSERT_TRUE(result.program);
  EXPECT_TRUE(stand_ins_of(result.program->source).empty());
}

TEST(StandIns, LibrariesThatHaveNoneAreNamedOnce) {
  const std::string calls =
      "NETWORK 1\nLD SM0.1\nCALL USS_INIT, 1, 9600, 1, M0.0, VB1\nNETWORK 2\nLD SM0.0\nCALL "
      "USS_RPM_W, 1, 0, 5, 0, &VB100, M0.1, VB2, VW4\nCALL USS_RPM_W, 1, 0, 5, 0, &VB100, M0.1, VB2, VW4\n";
  for (const std::string& text : {exported(calls), listing(calls)}) {
    const CheckResult result = check_with(text, {});
    EXPECT_EQ(stl::count_causes(result.diagnostics), 1U);
    EXPECT_EQ(errors(result).front(),
              "USS_INIT is a routine of the USS protocol library, which is in no export and has no stand-in here");
  }
}

TEST(StandIns, RoutinesOfLibrariesAreCalled) {
  for (const std::string routine : {"MBUS_INIT", "MBUS_MSG_P1", "USS_INIT", "S_ITR"}) {
    const CheckResult result = check_with(listing("NETWORK 1\nLD SM0.1\n" + routine + " 1, 5\n"), {});
    EXPECT_EQ(errors(result), Lines{routine + " is a routine of a library, not an instruction"});
    EXPECT_EQ(result.diagnostics.front().hint, "write CALL " + routine + " and its parameters");
  }
}

TEST(StandIns, OtherRoutinesThatAreMissingAreNamedOnceEach) {
  const std::string calls = "NETWORK 1\nLD SM0.1\nCALL Blend, 1\nCALL Blend, 2\nCALL Mix, 2\n";
  for (const std::string& text : {exported(calls), listing(calls)}) {
    const CheckResult result = check_with(text, {});
    EXPECT_EQ(stl::count_causes(result.diagnostics), 2U);
    EXPECT_EQ(errors(result).front(), "there is no subroutine Blend");
  }
}

TEST(StandIns, FineForNamesTheCpusThatCanHaveThem) {
  const auto fine = cpus_without_errors(read_source(exported(kSlave), "main.awl")->parsed);
  EXPECT_EQ(fine.size(),
            static_cast<std::size_t>(std::ranges::count_if(
                all_cpus(), [](const CpuModel* m) { return (m->self & kCpu22x) && m->size_of(Area::V) > 2048; })))
      << "VB0 to VB1999 are registers, and 48 bytes of a CPU 222 are left";
}

// --- MBUS_INIT ---

struct InitCase {
  const char* parameters;
  int error;
};

TEST(StandIns, MbusInitTellsWhatIsWrong) {
  for (const auto& [parameters, error] : std::vector<InitCase>{
           {"1, 1, 9600, 2, 0, 128, 32, 1000, &VB0", 0},
           {"1, 247, 115200, 0, 32767, 0, 0, 0, &VB0", 0},
           {"0, 0, 0, 9, 0, 0, 0, 0, 0", 0},
           {"1, 1, 9600, 2, 0, 128, 32, 4097, &VB0", 1},
           {"1, 1, 9600, 2, 0, 128, 32, 10, &MB0", 1},
           {"1, 1, 9600, 2, 0, 128, 32, 10, 0", 1},
           {"1, 1, 9601, 2, 0, 128, 32, 10, &VB0", 2},
           {"1, 1, 9600, 3, 0, 128, 32, 10, &VB0", 2},
           {"1, 0, 9600, 2, 0, 128, 32, 10, &VB0", 3},
           {"1, 248, 9600, 2, 0, 128, 32, 10, &VB0", 3},
           {"2, 1, 9600, 2, 0, 128, 32, 10, &VB0", 4},
           {"1, 1, 9600, 2, 32768, 128, 32, 10, &VB0", 4},
           {"1, 1, 9600, 2, 0, 129, 32, 10, &VB0", 4},
           {"1, 1, 9600, 2, 0, 128, 33, 10, &VB0", 4},
           {"1, 1, 9600, 2, 0, 128, 32, 10, &VB3000", 5},
           {"1, 1, 9600, 2, 0, 128, 32, 10, &VB3369", 5},
           {"1, 1, 9600, 2, 0, 128, 32, 10, &VB3370", 0},
           {"1, 1, 9600, 2, 0, 128, 32, 10, &VB2980", 0},
       }) {
    const CheckResult result = check_with(exported(std::string("NETWORK 1\nLD SM0.1\nCALL MBUS_INIT, ") + parameters +
                                                   ", M0.1, MB1\nNETWORK 2\nLD SM0.0\nCALL MBUS_SLAVE, M0.2, MB2\n"),
                                          "Modbus_Slave_Memory\tVB3000\n");
    ASSERT_TRUE(result.program) << parameters << ": " << errors(result).front();
    Plc plc(result.program);
    plc.run_scans(1);
    EXPECT_EQ(plc.value("M0.1"), 1) << "it is done at once: " << parameters;
    EXPECT_EQ(plc.value("MB1"), error) << parameters;
    const bool enabled = error == 0 && parameters[0] == '1';
    EXPECT_EQ(plc.value("MB2"), enabled ? 0 : 10) << "MBUS_SLAVE after " << parameters;
    EXPECT_EQ(plc.value("M0.2"), enabled ? 0 : 1) << parameters;
  }
}

TEST(StandIns, RatesOfRelease1EndAt38400) {
  const std::string text = "NETWORK 1\nLD SM0.1\nCALL MBUS_INIT, 1, 1, 57600, 2, 0, 128, 32, 10, &VB0, M0.1, MB1\n";
  const CheckResult result =
      check_with(exported(text + "NETWORK 2\nLD SM0.0\nCALL MBUS_SLAVE, M0.2, MB2\n"), {}, cpu224r1());
  ASSERT_TRUE(result.program);
  Plc plc(result.program);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("MB1"), 2);
}

TEST(StandIns, TheAccumulatorsOfTheCallerKeepTheirValues) {
  const std::string text =
      "NETWORK 1\nLD SM0.0\nMOVD 11111111, AC0\nMOVD 22222222, AC1\nMOVD 33333333, AC2\nMOVD 44444444, AC3\n"
      "CALL MBUS_CTRL, 1, 9600, 2, 1000, M0.1, MB1\nCALL MBUS_MSG, 1, 1, 1, 40001, 10, &VB100, M0.2, MB2\n"
      "MOVD AC0, VD0\nMOVD AC1, VD4\nMOVD AC2, VD8\nMOVD AC3, VD12\n";
  const CheckResult result = check_with(exported(text), {});
  ASSERT_TRUE(result.program) << errors(result).front();
  Plc plc(result.program);
  plc.run_scans(3);
  EXPECT_EQ(plc.value("VD0"), 11111111U);
  EXPECT_EQ(plc.value("VD4"), 22222222U);
  EXPECT_EQ(plc.value("VD8"), 33333333U);
  EXPECT_EQ(plc.value("VD12"), 44444444U);
}

// --- MBUS_CTRL, MBUS_MSG: what needs no line ---

TEST(StandIns, MbusCtrlTellsWhatIsWrong) {
  for (const auto& [parameters, error] : std::vector<InitCase>{{"1, 9600, 2, 1000", 0},
                                                               {"0, 9600, 9, 0", 0},
                                                               {"1, 9600, 3, 1000", 1},
                                                               {"1, 300, 2, 1000", 2},
                                                               {"1, 9600, 2, 0", 3},
                                                               {"1, 9600, 2, -5", 3}}) {
    const CheckResult result = check_with(exported(std::string("NETWORK 1\nLD SM0.0\nCALL MBUS_CTRL, ") + parameters +
                                                   ", M0.1, MB1\nCALL MBUS_MSG, 1, 1, 0, 40001, 1, &VB0, M0.2, MB2\n"),
                                          {});
    ASSERT_TRUE(result.program) << parameters << ": " << errors(result).front();
    Plc plc(result.program);
    plc.run_scans(1);
    EXPECT_EQ(plc.value("M0.1"), 1) << parameters;
    EXPECT_EQ(plc.value("MB1"), error) << parameters;
    const bool enabled = error == 0 && parameters[0] == '1';
    EXPECT_EQ(plc.value("M0.2"), enabled ? 0 : 1) << parameters;
    EXPECT_EQ(plc.value("MB2"), enabled ? 0 : 5) << parameters;
  }
}

TEST(StandIns, MbusMsgRefusesARequestThatCannotBe) {
  for (const char* request :
       {"248, 0, 40001, 1, &VB0", "0, 0, 40001, 1, &VB0", "1, 2, 40001, 1, &VB0", "1, 0, 0, 1, &VB0", "1, 0, 10000, 1, &VB0",
        "1, 0, 20000, 1, &VB0", "1, 0, 50000, 1, &VB0", "1, 0, 400000, 1, &VB0", "1, 0, 465537, 1, &VB0",
        "1, 0, 40001, 0, &VB0", "1, 0, 40001, 121, &VB0", "1, 0, 1, 1921, &VB0", "1, 1, 10001, 1, &VB0",
        "1, 1, 30001, 1, &VB0", "1, 0, 49999, 2, &VB0", "1, 0, 9999, 2, &VB0", "1, 0, 40001, 1, &MB0",
        "1, 0, 40001, 2, &VB8190", "1, 0, 40001, -1, &VB0"}) {
    const CheckResult result = check_with(
        exported(std::string("NETWORK 1\nLD SM0.0\nCALL MBUS_CTRL, 1, 9600, 2, 1000, M0.1, MB1\nCALL MBUS_MSG, 1, ") +
                 request + ", M0.2, MB2\n"),
        {});
    ASSERT_TRUE(result.program) << request << ": " << errors(result).front();
    Plc plc(result.program);
    plc.run_scans(1);
    EXPECT_EQ(plc.value("M0.2"), 1) << request;
    EXPECT_EQ(plc.value("MB2"), 4) << request;
  }
}

TEST(StandIns, MbusMsgOneAtATime) {
  const CheckResult result = check_with(
      exported("NETWORK 1\nLD SM0.0\nCALL MBUS_CTRL, 1, 9600, 2, 1000, M0.1, MB1\n"
               "CALL MBUS_MSG, 1, 1, 0, 40001, 1, &VB0, M0.2, MB2\nCALL MBUS_MSG, 1, 2, 0, 40001, 1, &VB0, M0.3, MB3\n"),
      {});
  ASSERT_TRUE(result.program);
  Plc plc(result.program);
  plc.run_scans(1);
  EXPECT_EQ(plc.value("M0.2"), 0);
  EXPECT_EQ(plc.value("M0.3"), 1);
  EXPECT_EQ(plc.value("MB3"), 6);
}

}  // namespace
}  // namespace s7200::test::stand_ins_test

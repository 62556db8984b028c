// What must be true of every row of the instruction table.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/stl/parser.hpp"
#include "interpreter/stl/printer.hpp"
#include "tests/support/source_path.hpp"
#include "tests/vectors/vector_file.hpp"

namespace s7200::table_test {
namespace {

const TimeTable& times() {
  static const TimeTable kTimes = default_times(cpu214());
  return kTimes;
}

std::vector<const Instruction*> modelled_on(const CpuModel& model) {
  std::vector<const Instruction*> result;
  for (const Instruction& instruction : all_instructions())
    if (instruction.modelled() && (instruction.cpus & model.self)) result.push_back(&instruction);
  return result;
}

/// The CPUs that have vectors: the one that the vectors began with, and one with all instructions.
class InstructionsOf : public testing::TestWithParam<const CpuModel*> {
 protected:
  const CpuModel& model() const { return *GetParam(); }
};

INSTANTIATE_TEST_SUITE_P(InstructionTable, InstructionsOf, testing::Values(&cpu214(), &cpu224()),
                         [](const auto& cpu) { return std::string(cpu.param->name); });

TEST(InstructionTable, MnemonicsAreUnique) {
  std::set<std::string_view> seen;
  for (const Instruction& instruction : all_instructions())
    EXPECT_TRUE(seen.insert(instruction.mnemonic).second) << instruction.mnemonic;
}

TEST(InstructionTable, FileNamesOfVectorsAreUnique) {
  std::set<std::string> seen;
  for (const Instruction& instruction : all_instructions())
    EXPECT_TRUE(seen.insert(vectors::file_name(instruction.mnemonic)).second) << instruction.mnemonic;
}

TEST(InstructionTable, EveryModelledRowSaysWhatItDoes) {
  for (const Instruction& instruction : all_instructions()) {
    if (!instruction.modelled()) continue;
    EXPECT_FALSE(instruction.meaning.empty()) << instruction.mnemonic;
    EXPECT_FALSE(instruction.group.empty()) << instruction.mnemonic;
    for (const OperandRule& rule : instruction.rules()) EXPECT_FALSE(rule.name.empty()) << instruction.mnemonic;
  }
}

TEST(InstructionTable, EveryModelledRowHasATimeOnEachCpuForEachAreaOfItsFirstOperand) {
  for (const CpuModel* model : all_cpus()) {
    const TimeTable times = default_times(*model);
    for (const Instruction* instruction : modelled_on(*model)) {
      const auto has_time = [&](std::optional<Area> area) { return times.cost(instruction->mnemonic, area).has_value(); };
      const OperandRule& first = instruction->operand[0];
      for (const AreaInfo& area : all_areas())
        if (contains(first.areas, area.area) && model->size_of(area.area) != 0) {
          EXPECT_TRUE(has_time(area.area)) << model->name << " " << instruction->mnemonic << " " << area.name;
        }
      if (instruction->rules().empty() || first.constant || first.pointer || first.kind != OperandKind::Memory) {
        EXPECT_TRUE(has_time({})) << model->name << " " << instruction->mnemonic;
      }
    }
  }
}

TEST(InstructionTable, RowsWithoutABodyAreRefusedByName) {
  for (const Instruction& instruction : all_instructions()) {
    if (instruction.modelled()) continue;
    const std::string mnemonic(instruction.mnemonic);
    const CheckResult result = check_text("LD SM0.0\n" + mnemonic + "\nMEND\n", "test", cpu214(), times());
    ASSERT_FALSE(result.program) << mnemonic;
    const auto& message = result.diagnostics.at(0).message;
    EXPECT_NE(message.find(mnemonic), std::string::npos) << message;
    EXPECT_EQ(result.diagnostics[0].position.line, 2u) << mnemonic;
  }
}

TEST(InstructionTable, RowsThatCpu214LacksAreRefusedByName) {
  for (const Instruction& instruction : all_instructions()) {
    if (instruction.cpus & kCpu214) continue;
    const std::string mnemonic(instruction.mnemonic);
    const CheckResult result = check_text("LD SM0.0\n" + mnemonic + " VB0, VB1\nMEND\n", "test", cpu214(), times());
    ASSERT_FALSE(result.program) << mnemonic;
    EXPECT_EQ(result.diagnostics.at(0).message, "CPU 214 has no " + mnemonic);
  }
}

// --- what a row says about the logic stack ---

/// How many levels an instruction needs and how many more it leaves, if its kind does not decide that.
TEST(InstructionTable, WhatEachInstructionFindsOnTheLogicStackAndLeavesThere) {
  static const std::map<std::string_view, std::pair<int, int>> kOwn{
      {"ALD", {2, -1}}, {"OLD", {2, -1}},  {"LPP", {2, -1}}, {"LRD", {2, 0}},  {"LPS", {1, 1}},
      {"CTU", {2, -1}}, {"CTUD", {3, -2}}, {"LSCR", {0, 1}}, {"CTD", {2, -1}}, {"LDS", {1, 1}}};
  static const std::set<std::string_view> kAlone{"NOP", "LBL", "SBR", "INT", "NEXT", "MEND", "RET", "RETI", "SCRE"};
  for (const Instruction& instruction : all_instructions()) {
    if (!instruction.modelled()) continue;
    std::pair<int, int> expected{1, 0};
    if (instruction.mnemonic.starts_with("LD")) expected = {0, 1};
    if (kAlone.contains(instruction.mnemonic)) expected = {0, 0};
    if (const auto own = kOwn.find(instruction.mnemonic); own != kOwn.end()) expected = own->second;
    EXPECT_EQ((std::pair<int, int>{instruction.rung.stack.needs, instruction.rung.stack.change}), expected)
        << instruction.mnemonic;
  }
}

/// Facts 10.7: boxes have ENO, which power flow, run-time errors and failures decide; of shifts SM1.1 says nothing about
/// that.
TEST(InstructionTable, EveryBoxHasEnoButNoContactCoilOrJump) {
  static const std::set<std::string_view> kPoweredCoils{"S",   "R",    "SI",   "RI",    "JMP",   "CRET", "END",
                                                        "WDR", "SCRT", "STOP", "CSCRE", "CRETI", "ENI",  "DISI"};
  for (const Instruction& instruction : all_instructions()) {
    if (!instruction.modelled()) continue;
    const bool box = instruction.rung.needs_power_flow && !kPoweredCoils.contains(instruction.mnemonic);
    const Eno expected = instruction.mnemonic == "PID"             ? Eno::ErrorsAndFlags
                         : !box                                    ? Eno::None
                         : instruction.group == "Shift and rotate" ? Eno::Errors
                                                                   : Eno::ErrorsAndFlags;
    EXPECT_EQ(instruction.rung.eno, expected) << instruction.mnemonic;
  }
}

// --- where an instruction is allowed (facts 3.5) ---

TEST(InstructionTable, WhatIsAllowedInTheMainProgramInSubroutinesAndInInterruptRoutines) {
  static const std::map<std::string_view, int> kParts{{"END", kMain},
                                                      {"MEND", kMain},
                                                      {"RET", kSubroutine},
                                                      {"CRET", kSubroutine},
                                                      {"RETI", kInterrupt},
                                                      {"CRETI", kInterrupt},
                                                      {"CALL", kMain | kSubroutine},
                                                      {"FOR", kMain | kSubroutine},
                                                      {"NEXT", kMain | kSubroutine},
                                                      {"ENI", kMain | kSubroutine},
                                                      {"DISI", kMain | kSubroutine},
                                                      {"HDEF", kMain | kSubroutine},
                                                      {"LSCR", kMain | kSubroutine},
                                                      {"SCRT", kMain | kSubroutine},
                                                      {"SCRE", kMain | kSubroutine},
                                                      {"CSCRE", kMain | kSubroutine}};
  for (const Instruction& instruction : all_instructions()) {
    const auto part = kParts.find(instruction.mnemonic);
    EXPECT_EQ(instruction.allowed.on(kCpu214), part == kParts.end() ? kAnywhere : part->second) << instruction.mnemonic;
  }
}

TEST(InstructionTable, JumpsLoopsAndEndAreNotAllowedBetweenLscrAndScre) {
  static const std::set<std::string_view> kForbidden{"JMP", "FOR", "NEXT", "END"};
  for (const Instruction& instruction : all_instructions())
    EXPECT_EQ(instruction.outside_segments, kForbidden.contains(instruction.mnemonic)) << instruction.mnemonic;
}

TEST(InstructionTable, OnlyContactsHaveABodyForSegments) {
  static const std::set<std::string_view> kContacts{"LD", "LDN", "LDI", "LDNI", "A",  "AN",
                                                    "AI", "ANI", "O",   "ON",   "OI", "ONI"};
  for (const Instruction& instruction : all_instructions()) {
    const bool contact = kContacts.contains(instruction.mnemonic) || instruction.structure == Structure::Compare;
    EXPECT_EQ(instruction.body.in_segment != nullptr, contact) << instruction.mnemonic;
  }
}

// --- forms of operands in the vectors ---

/// `V`, `AC`, `constant`, `*VD`, `*LD`, `*AC`, `&`: how an operand is written.
std::string form_of(const stl::Operand& operand) {
  if (const auto* address = std::get_if<stl::Address>(&operand.value)) return address->area;
  if (const auto* indirect = std::get_if<stl::Indirect>(&operand.value))
    return indirect->pointer.area == "AC" ? "*AC" : indirect->pointer.area == "L" ? "*LD" : "*VD";
  return std::holds_alternative<stl::AddressOf>(operand.value) ? "&" : "constant";
}

std::set<std::string> forms_of(const OperandRule& rule, const CpuModel& model) {
  std::set<std::string> forms;
  if (rule.kind != OperandKind::Memory) return {"constant"};
  for (const AreaInfo& area : all_areas())
    if (contains(rule.areas, area.area) && model.size_of(area.area) != 0) forms.emplace(area.name);
  if (rule.constant) forms.insert("constant");
  if (rule.pointer) forms.insert({"*VD", "*AC"});
  if (rule.pointer && model.size_of(Area::L) != 0) forms.insert("*LD");
  if (rule.address_of) forms.insert("&");
  return forms;
}

/// All vectors in the files of a mnemonic: `ADD_I.txt`, `ADD_I.hand.txt`, and for a CPU 224 also `ADD_I.224.txt` ….
std::vector<vectors::Vector> vectors_of(const Instruction& instruction, const CpuModel& model) {
  std::vector<vectors::Vector> result;
  for (const std::string_view cpu : std::set<std::string_view>{"214", model.name})
    for (const char* extension : {".txt", ".hand.txt"}) {
      const std::string path =
          test::source_path("tests/vectors/" + vectors::file_name(instruction.mnemonic, cpu) + extension);
      std::ifstream in(path, std::ios::binary);
      const std::string text{std::istreambuf_iterator<char>(in), {}};
      std::ranges::move(vectors::parse(text, path).vectors, std::back_inserter(result));
    }
  return result;
}

std::vector<stl::Statement> statements_in_vectors(const Instruction& instruction, const CpuModel& model) {
  std::vector<stl::Statement> result;
  for (const vectors::Vector& vector : vectors_of(instruction, model))
    for (const std::string& op : vector.ops)
      for (const stl::Line& line : stl::parse(op, "vector").source.lines)
        if (const auto* statement = std::get_if<stl::Statement>(&line);
            statement && statement->mnemonic == instruction.mnemonic)
          result.push_back(*statement);
  return result;
}

TEST_P(InstructionsOf, EveryFormOfEveryOperandHasAVector) {
  for (const Instruction* instruction : modelled_on(model())) {
    const auto statements = statements_in_vectors(*instruction, model());
    EXPECT_FALSE(statements.empty()) << instruction->mnemonic << " has no vector";
    for (std::size_t i = 0; i < instruction->rules().size() && !statements.empty(); ++i) {
      std::set<std::string> missing = forms_of(instruction->operand[i], model());
      for (const stl::Statement& statement : statements) missing.erase(form_of(statement.operands.at(i)));
      EXPECT_TRUE(missing.empty()) << fmt::format("{}: no vector with {} as {}", instruction->mnemonic,
                                                  fmt::join(missing, ", "), instruction->operand[i].name);
    }
  }
}

/// The bits of SM1 that change in any vector that has only this instruction.
int flags_in_vectors(const Instruction& instruction, const CpuModel& model) {
  int flags = 0;
  for (const vectors::Vector& vector : vectors_of(instruction, model)) {
    if (vector.is_program()) continue;
    for (const vectors::Assignment& after : vector.after)
      if (after.area == "SM" && after.at == 1) flags |= after.width == 0 ? 1 << after.bit : 0xFF;
  }
  return flags;
}

TEST_P(InstructionsOf, FlagsAreThoseThatTheVectorsShowToChange) {
  for (const Instruction* instruction : modelled_on(model()))
    EXPECT_EQ(flags_in_vectors(*instruction, model()), instruction->flags) << instruction->mnemonic;
}

TEST_P(InstructionsOf, StatementsPrintAndReadBackToThemselves) {
  for (const Instruction* instruction : modelled_on(model()))
    for (const stl::Statement& statement : statements_in_vectors(*instruction, model())) {
      const stl::Source printed{{"test", {}}, {statement}};
      const stl::ParseResult read = stl::parse(stl::to_text(printed), "test");
      EXPECT_TRUE(read.diagnostics.empty() && stl::same_program(printed, read.source)) << stl::to_text(statement);
    }
}

}  // namespace
}  // namespace s7200::table_test

// Which values may be written as operands: each rule of the table by itself, and all of them against the running CPU.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "interpreter/program/checking/warnings.hpp"
#include "tests/support/plc.hpp"

namespace s7200::operand_rules_test {
namespace {

const TimeTable& times_of(const CpuModel& model) {
  static std::map<std::string_view, TimeTable> known;
  const auto found = known.find(model.name);
  return found != known.end() ? found->second : known.emplace(model.name, default_times(model)).first->second;
}

/// A program with the statement in line 4 and three values on the logic stack, as CTUD needs them.
std::string with_power_flow(const std::string& statement) {
  return "LD SM0.0\nLD SM0.0\nLD SM0.0\n" + statement + "\nMEND\n";
}

CheckResult check_statement(const std::string& statement, const CpuModel& model = cpu214()) {
  return check_text(with_power_flow(statement), "test", model, times_of(model));
}

/// The message about the statement, its hint after " | ", and a warning's name in brackets; "fine" if there is no message.
std::string verdict(const std::string& statement, const CpuModel& model = cpu214()) {
  for (const stl::Diagnostic& d : check_statement(statement, model).diagnostics)
    if (d.position.line == 4 && d.name != "logic-stack")
      return d.message + (d.hint.empty() ? "" : " | " + d.hint) + (d.name.empty() ? "" : " [" + d.name + "]");
  return "fine";
}

// --- presets ---

TEST(OperandRules, PresetsOfTimersAndUpCountersAre1To32767) {
  for (const std::string instruction : {"TON T37", "TONR T5", "CTU C1"}) {
    const std::string name =
        instruction.starts_with("CTU") ? "PV of CTU" : "PT of " + instruction.substr(0, instruction.find(' '));
    for (const char* wrong : {"32768", "40000", "65535"})
      EXPECT_EQ(verdict(instruction + ", " + wrong), fmt::format("{} must be 1 to 32767, not {}", name, wrong));
    for (const auto& [low, read] : {std::pair{"0", 0}, std::pair{"-1", -1}, std::pair{"16#8000", -32768}})
      EXPECT_EQ(verdict(instruction + ", " + low),
                fmt::format("{} is {}: there is nothing to count | a preset is 1 to 32767 [preset]", name, read));
    for (const char* right : {"1", "32767", "16#7FFF", "VW0", "*VD0", "C2"})
      EXPECT_EQ(verdict(instruction + ", " + right), "fine") << instruction << ", " << right;
  }
}

TEST(OperandRules, APresetOfCtudMayBeNegativeBecauseItsValueMay) {
  for (const char* right : {"-32768", "-1", "0", "32767", "16#8000"})
    EXPECT_EQ(verdict(fmt::format("CTUD C1, {}", right)), "fine");
  EXPECT_EQ(verdict("CTUD C1, 40000"),
            "PV of CTUD is a signed word: 40000 is taken as -25536 | "
            "write -25536 if that is what you mean; a signed word is -32768 to 32767 [other-sign]");
}

// --- how much of memory ---

TEST(OperandRules, TextsMayEndAtTheLastByteOfVMemory) {
  const std::pair<const char*, std::uint32_t> kLengths[] = {{"ITA VW0, {}, 0", 8},
                                                            {"DTA VD0, {}, 0", 12},
                                                            {"RTA VD0, {}, 16#30", 3},
                                                            {"ITS VW0, {}, 0", 9},
                                                            {"DTS VD0, {}, 0", 13}};
  for (const auto& [statement, length] : kLengths) {
    const auto at = [&, text = statement](std::uint32_t byte) {
      return verdict(fmt::format(fmt::runtime(text), fmt::format("VB{}", byte)), cpu224());
    };
    EXPECT_EQ(at(8192 - length), "fine") << statement;
    EXPECT_NE(at(8192 - length + 1), "fine") << statement;
  }
}

// --- signs ---

TEST(OperandRules, ADecimalConstantThatIsReadWithTheOtherSignGetsAWarning) {
  const std::pair<const char*, const char*> kRead[] = {
      {"LDW>= VW0, 40000", "IN2 of LDW>= is a signed word: 40000 is taken as -25536"},
      {"AW<= 65535, VW0", "IN1 of AW<= is a signed word: 65535 is taken as -1"},
      {"LDD>= VD0, 4294967295", "IN2 of LDD>= is a signed double word: 4294967295 is taken as -1"},
      {"OB<= VB0, -1", "IN2 of OB<= is an unsigned byte: -1 is taken as 255"},
      {"MUL 50000, VD0", "IN1 of MUL is a signed word: 50000 is taken as -15536"},
      {"DIV 32768, VD0", "IN1 of DIV is a signed word: 32768 is taken as -32768"},
      {"DTR 2147483648, VD0", "IN of DTR is a signed double word: 2147483648 is taken as -2147483648"},
      {"FND> VW0, 40000, VW2", "PATRN of FND> is a signed word: 40000 is taken as -25536"},
      {"FOR VW0, 1, 40000\nNEXT", "FINAL of FOR is a signed word: 40000 is taken as -25536"},
      {"FOR VW0, 40000, VW2\nNEXT", "INIT of FOR is a signed word: 40000 is taken as -25536"}};
  for (const auto& [statement, message] : kRead)
    EXPECT_EQ(verdict(statement).substr(0, std::string_view(message).size()), message) << statement;
}

TEST(OperandRules, ConstantsThatShowTheirBitsAreTakenAsTheyAre) {
  for (const char* statement : {"LDW>= VW0, 16#9C40", "LDW<= VW0, 2#1111111111111111", "LDB>= VB0, 16#FF",
                                "LDD<= VD0, 16#FFFFFFFF", "MUL 16#FFFF, VD0", "LDW>= VW0, 'zz'"})
    EXPECT_EQ(verdict(statement), "fine") << statement;
}

/// Equality, sums, moves and logic give the same bits for either sign.
TEST(OperandRules, IfTheSignMakesNoDifferenceBothRangesAreRight) {
  for (const char* statement : {"MOVB 255, VB0", "MOVB -128, VB0", "MOVW 65535, VW0", "MOVW -1, VW0", "LDW= VW0, 65535",
                                "OB= VB0, -1", "+I 65535, VW0", "-D 4294967295, VD0", "ANDW 65535, VW0",
                                "FILL 40000, VW0, 1", "FND= VW0, 40000, VW2", "MOVD 4294967295, VD0"})
    EXPECT_EQ(verdict(statement), "fine") << statement;
}

// --- counts ---

TEST(OperandRules, ACountIsAnUnsignedByte) {
  for (const char* statement :
       {"S M0.0, 0", "R V0.0, -1", "BMB VB0, VB300, 0", "FILL 0, VW0, -5", "SLW VW0, -1", "ATH VB0, VB300, -1"})
    EXPECT_NE(verdict(statement).find(" 255, not "), std::string::npos) << statement << ": " << verdict(statement);
  for (const char* statement :
       {"S V0.0, 255", "ATH VB0, VB300, 0", "HTA VB0, VB300, 255", "SLW VW0, 0", "RRD VD0, 255", "FILL 0, VW0, 16#FF"})
    EXPECT_EQ(verdict(statement), "fine") << statement;
}

TEST(OperandRules, TheCountOfAShiftRegisterHasADirectionAndIsNot0) {
  EXPECT_EQ(verdict("SHRB I0.0, V0.0, 0"), "N of SHRB cannot be 0 (count error 0092) | it must be -64 to -1 or 1 to 64");
  EXPECT_EQ(verdict("SHRB I0.0, V0.0, 65"), "N of SHRB must be -64 to 64, not 65");
  EXPECT_EQ(verdict("SHRB I0.0, V0.0, 16#80"), "N of SHRB must be -64 to 64, not 16#80");
  for (const char* n : {"-64", "-1", "1", "64", "16#C0"})
    EXPECT_EQ(verdict(fmt::format("SHRB I0.0, V0.0, {}", n)), "fine") << n;
}

/// `VB4090`: the last address from which `bytes` fit.
std::string address(const CpuModel& model, Width width, std::int64_t bytes) {
  static constexpr const char* kLetter[] = {"", "B", "W", "D"};
  return fmt::format("V{}{}{}", kLetter[static_cast<std::size_t>(width)], model.size_of(Area::V) - bytes,
                     width == Width::Bit ? ".0" : "");
}

/// Operands that fit the rules, in V memory or constants that do no harm.
std::vector<std::string> harmless_operands(const Instruction& instruction, const CpuModel& model, int count) {
  std::vector<std::string> operands;
  for (std::size_t i = 0; i < instruction.rules().size(); ++i) {
    const OperandRule& rule = instruction.operand[i];
    operands.push_back(rule.count ? std::to_string(count)
                       : rule.kind != OperandKind::Memory
                           ? "0"
                           : address(model, rule.width, 300 * (static_cast<std::int64_t>(i) + 1)));
  }
  return operands;
}

TEST(OperandRules, ABlockThatRunsPastTheEndOfItsAreaIsFoundInEveryInstructionThatCounts) {
  std::set<std::string_view> tried;
  for (const CpuModel* model : all_cpus())
    for (const Instruction& instruction : all_instructions()) {
      if (!instruction.modelled() || !(instruction.cpus & model->self)) continue;
      for (std::size_t i = 0; i < instruction.rules().size(); ++i) {
        const OperandRule& rule = instruction.operand[i];
        if (rule.kind != OperandKind::Memory || (rule.counted == 0 && rule.elements == 1) || !contains(rule.areas, Area::V))
          continue;
        constexpr int kCount = 40;
        const std::int64_t bytes = rule.width == Width::Bit ? kCount / 8 : rule.reach(kCount) * bytes_of(rule.width);
        auto operands = harmless_operands(instruction, *model, kCount);
        const auto statement = [&](std::int64_t room) {
          operands[i] = address(*model, rule.width, room);
          return fmt::format("{} {}", instruction.mnemonic, fmt::join(operands, ", "));
        };
        EXPECT_EQ(verdict(statement(bytes), *model), "fine") << statement(bytes);
        EXPECT_NE(verdict(statement(bytes - 1), *model).find("past the end of V memory (range error 0091)"),
                  std::string::npos)
            << statement(bytes - 1) << ": " << verdict(statement(bytes - 1), *model);
        tried.insert(instruction.mnemonic);
      }
    }
  EXPECT_EQ(tried, (std::set<std::string_view>{"S",   "R",   "BMB",  "BMW",  "BMD",  "FILL", "SHRB", "ATH",
                                               "HTA", "ATT", "FIFO", "LIFO", "TODR", "TODW", "PID",  "ITA",
                                               "DTA", "RTA", "ITS",  "DTS",  "NETR", "NETW"}));
}

TEST(OperandRules, EachInstructionWithCountedOperandsHasOneCount) {
  for (const Instruction& instruction : all_instructions()) {
    const auto rules = instruction.rules();
    const auto counts = std::ranges::count_if(rules, &OperandRule::count);
    const bool counted = std::ranges::any_of(rules, [](const OperandRule& rule) { return rule.counted != 0; });
    EXPECT_EQ(counts, counted ? 1 : 0) << instruction.mnemonic;
  }
}

TEST(OperandRules, ABlockMayNotReachSpecialMemoryThatIsNotModelled) {
  EXPECT_EQ(verdict("BMB SMB166, VB0, 4", cpu224()), "fine");
  EXPECT_EQ(
      verdict("BMB SMB166, VB0, 5", cpu224()),
      "5 bytes from SMB166 reach SMB170 to SMB175 (pulse output 0: linear profile), which are not modelled | a profile of "
      "several segments is: SM67.5, SM77.5");
}

// --- addresses ---

TEST(OperandRules, EveryWidthEndsWithTheLastByteOfItsArea) {
  for (const char* right : {"MOVB VB4095, VB0", "MOVW VW4094, VW0", "MOVD VD4092, VD0", "LD V4095.7", "MOVB SMB85, VB0"})
    EXPECT_EQ(verdict(right), "fine") << right;
  for (const char* wrong : {"MOVB VB4096, VB0", "MOVW VW4095, VW0", "MOVD VD4093, VD0", "MOVD &VB4096, VD0",
                            "MOVB *VD4093, VB0", "LD V4096.0", "MOVB SMB86, VB0", "LD SM86.0"})
    EXPECT_NE(verdict(wrong).find(" does not exist on CPU 214 | "), std::string::npos) << wrong << ": " << verdict(wrong);
}

// --- numbers ---

TEST(OperandRules, NumbersAreNotWrittenAsCharacters) {
  EXPECT_EQ(verdict("NOP 'A'"), "NOP takes a number here, not 'A' | numbers are numbered 0 to 255");
  EXPECT_EQ(verdict("JMP 'A'").substr(0, 33), "JMP takes a number here, not 'A' ");
}

TEST(OperandRules, NopTakes0To255PlsTakes0And1) {
  EXPECT_EQ(verdict("NOP 255"), "fine");
  EXPECT_EQ(verdict("NOP 256"), "n of NOP must be 0 to 255, not 256");
  EXPECT_EQ(verdict("PLS 2"), "X of PLS must be 0 to 1, not 2");
}

TEST(OperandRules, Port1IsRefusedOnACpuWithoutIt) {
  EXPECT_EQ(verdict("XMT VB0, 1"), "port 1 does not exist on CPU 214 | the only port is 0");
  EXPECT_EQ(verdict("MOVB 9, SMB130\nXMT VB0, 1", cpu216()), "fine");
  EXPECT_EQ(verdict("XMT VB0, 2", cpu216()), "port 2 does not exist on CPU 216 | ports are numbered 0 to 1");
}

TEST(OperandRules, HighSpeedCounter0HasOnlyMode0) {
  EXPECT_EQ(verdict("HDEF 0, 0"), "fine");
  EXPECT_EQ(verdict("HDEF 0, 1"), "HSC0 has no mode 1 | HSC0 has only mode 0");
  EXPECT_EQ(verdict("HDEF 2, 11"), "fine");
  EXPECT_EQ(verdict("HDEF 2, 12"), "HSC2 has no mode 12 | HSC2 has the modes 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11");
  EXPECT_EQ(verdict("HDEF 2, 13"), "MODE of HDEF must be 0 to 12, not 13");
}

// Facts 10.4.
TEST(OperandRules, Cpus22xHaveMoreCountersAndModes) {
  const std::string modes = "has the modes 0, 1, 3, 4, 6, 7, 9, 10";
  for (const int counter : {0, 4}) {
    EXPECT_EQ(verdict(fmt::format("HDEF {}, 10", counter), cpu224r1()), "fine");
    EXPECT_EQ(verdict(fmt::format("HDEF {}, 2", counter), cpu224r1()),
              fmt::format("HSC{0} has no mode 2 | HSC{0} {1}", counter, modes));
  }
  EXPECT_EQ(verdict("HDEF 0, 12", cpu224()), "fine");
  EXPECT_EQ(verdict("HDEF 3, 12", cpu224()), "fine");
  EXPECT_EQ(verdict("HDEF 4, 12", cpu224()), "HSC4 has no mode 12 | HSC4 " + modes);
  EXPECT_EQ(verdict("HDEF 0, 12", cpu224r1()), "HSC0 has no mode 12 | HSC0 " + modes);
  EXPECT_EQ(verdict("HDEF 1, 11", cpu224()), "fine");
  EXPECT_EQ(verdict("HDEF 5, 0", cpu221()), "fine");
  EXPECT_EQ(verdict("HDEF 3, 1", cpu224()), "HSC3 has no mode 1 | HSC3 has the modes 0, 12");
  EXPECT_EQ(verdict("HDEF 3, 1", cpu224r1()), "HSC3 has no mode 1 | HSC3 has only mode 0");
  EXPECT_EQ(verdict("HSC 6", cpu224()),
            "high-speed counter 6 does not exist on CPU 224 | high-speed counters are numbered 0 to 5");
  EXPECT_EQ(verdict("HSC 1", cpu222()), "CPU 222 has no high-speed counter 1 | it has HSC0, HSC3, HSC4 and HSC5");
  EXPECT_EQ(verdict("MOVD HC2, VD0", cpu222()), "CPU 222 has no high-speed counter 2 | it has HSC0, HSC3, HSC4 and HSC5");
  EXPECT_EQ(verdict("MOVD HC5, VD0", cpu222()), "fine");
  EXPECT_EQ(verdict("HSC 3"), "high-speed counter 3 does not exist on CPU 214 | high-speed counters are numbered 0 to 2");
}

TEST(OperandRules, SpecialMemoryOfLinearProfilesIsRefusedWhereItExists) {
  const std::string refused =
      "SMB170 to SMB175 (pulse output 0: linear profile) are not modelled | a profile of several segments is: SM67.5, "
      "SM77.5";
  EXPECT_EQ(verdict("MOVB SMB170, VB0", cpu224()), refused);
  EXPECT_EQ(verdict("MOVD 1, SMD172", cpu224()), refused);
}

// --- reals ---

TEST(OperandRules, RealsAreFiniteAndNotSubnormal) {
  const std::string range = " | a real is 0.0, or 1.175495E-38 to 3.402823E+38 or its negative";
  for (const char* wrong : {"1.0E39", "-1.0E39", "1.0E-39", "1.0E-44", "1.0E-60"})
    EXPECT_EQ(verdict(fmt::format("MOVR {}, VD0", wrong)), fmt::format("{} does not fit in a 32-bit real{}", wrong, range));
  for (const char* wrong : {"NaN", "INF", "Infinity"})
    EXPECT_EQ(verdict(fmt::format("MOVR {}, VD0", wrong)), fmt::format("IN of MOVR cannot be {}{}", wrong, range));
  for (const char* right : {"0.0", "-0.0", "1.2E-38", "3.4E38", "-3.4E+38"})
    EXPECT_EQ(verdict(fmt::format("MOVR {}, VD0", right)), "fine") << right;
}

TEST(OperandRules, AnIntegerIsNotARealAndARealIsNotAnInteger) {
  EXPECT_EQ(verdict("MOVR 1, VD0"), "IN of MOVR is a real number, 1 is an integer | write 1.0");
  EXPECT_EQ(verdict("+R 16#3F800000, VD0"), "IN1 of +R is a real number, 16#3F800000 is an integer");
  EXPECT_EQ(
      verdict("MOVW 1.0, VW0"),
      "IN of MOVW is an integer word, 1.0 is a real number | write an integer without a decimal point: 5, -5 or 16#FF");
}

// --- all rules against the CPU ---

/// Values at the limits of what can be written, in every notation.
std::vector<std::string> border_constants(const OperandRule& rule) {
  if (rule.kind != OperandKind::Memory)
    return {"0", "1", "2", "3", "8", "11", "12", "33", "63", "64", "127", "128", "255", "256", "'A'", "-1"};
  if (!rule.constant) return {};
  if (rule.real) return {"0.0", "-0.0", "1.2E-38", "1.0E-44", "3.4E+38", "3.5E+38", "-3.4E+38"};
  return {"-2147483648", "-32769", "-32768", "-129",  "-128",  "-65",     "-64",        "-1",        "0",
          "1",           "2",      "40",     "64",    "65",    "127",     "128",        "255",       "256",
          "32767",       "32768",  "65535",  "65536", "16#80", "16#8000", "2147483647", "4294967295"};
}

/// The ends of the areas that an operand may name. None for a count, because its value would only be known at run time.
std::vector<std::string> border_addresses(const OperandRule& rule, const CpuModel& model) {
  static constexpr const char* kLetter[] = {"", "B", "W", "D"};
  std::vector<std::string> found;
  if (rule.count) return found;
  for (const AreaInfo& area : all_areas()) {
    if (rule.kind != OperandKind::Memory || !contains(rule.areas, area.area) || area.area == Area::SM) continue;
    const std::uint32_t size = model.size_of(area.area);
    for (std::uint32_t back = 0; back < 10 && back < size; ++back) {
      const std::uint32_t number = size - 1 - back;
      if (area.element != 0)
        found.push_back(fmt::format("{}{}", area.name, number));
      else if (rule.width == Width::Bit)
        found.push_back(fmt::format("{}{}.7", area.name, number));
      else
        found.push_back(fmt::format("{}{}{}", area.name, kLetter[static_cast<std::size_t>(rule.width)], number));
    }
  }
  return found;
}

/// V memory full of ones: at every address there is a table with room for one entry, which it has.
std::vector<std::uint8_t> tables_of_one_entry() {
  std::vector<std::uint8_t> bytes(4096);
  for (std::size_t i = 1; i < bytes.size(); i += 2) bytes[i] = 1;
  return bytes;
}

/// What is checked at load cannot go wrong at run time: an instruction with only constants and direct addresses that passes
/// the check never runs past the end of its area and never has a wrong count.
TEST(OperandRules, WhatPassesTheCheckCausesNoRangeOrCountErrorAtRunTime) {
  int executed = 0;
  for (const Instruction& instruction : all_instructions()) {
    if (!instruction.modelled() || !(instruction.cpus & kCpu214) || instruction.structure != Structure::None ||
        instruction.group == "Tables")
      continue;
    for (std::size_t i = 0; i < instruction.rules().size(); ++i)
      for (const auto& borders :
           {border_constants(instruction.operand[i]), border_addresses(instruction.operand[i], cpu214())})
        for (const std::string& border : borders) {
          auto operands = harmless_operands(instruction, cpu214(), 9);
          for (std::size_t k = 0; k < operands.size(); ++k) {
            const OperandRule& rule = instruction.operand[k];
            if (rule.kind != OperandKind::Memory)
              operands[k] = "0";
            else if (!contains(rule.areas, Area::V))
              operands[k] = border_addresses(rule, cpu214()).back();
          }
          operands[i] = border;
          const std::string statement = fmt::format("{} {}", instruction.mnemonic, fmt::join(operands, ", "));
          if (!check_statement(statement).program) continue;
          test::Plc plc(with_power_flow(statement));
          plc.cpu.poke(image::kV, tables_of_one_entry());
          plc.run_scans(2);
          ++executed;
          for (const int code : plc.records.errors()) {
            EXPECT_NE(code, 0x91) << statement;
            EXPECT_NE(code, 0x92) << statement;
          }
        }
  }
  EXPECT_GT(executed, 3000);
}

}  // namespace
}  // namespace s7200::operand_rules_test

// What `s7200 instructions` says of an instruction.
#include "tools/views/program/instruction_text.hpp"

#include <gtest/gtest.h>

#include "interpreter/analysis/warnings/check.hpp"

namespace s7200::tools::instruction_text_test {
namespace {

/// The example in a rung with as much on the logic stack as it needs.
std::string program_with(const Instruction& instruction) {
  std::string text;
  for (int i = 0; i < instruction.rung.stack.needs; ++i) text += "LD SM0.0\n";
  return text + example(instruction) + "\nMEND\n";
}

TEST(InstructionText, EveryExampleIsRightOnTheLargestCpu) {
  const CpuModel& model = *all_cpus().back();
  for (const Instruction& instruction : all_instructions()) {
    if (!instruction.modelled() || instruction.structure != Structure::None || !(instruction.allowed.parts & kMain))
      continue;
    const CheckResult result = check_text(program_with(instruction), "example", model, default_times(model));
    EXPECT_TRUE(result.program) << program_with(instruction)
                                << (result.diagnostics.empty() ? "" : result.diagnostics[0].message);
  }
}

TEST(InstructionText, ExplainsOperandsRangesFlagsAndTimes) {
  const TimeTable times = default_times(cpu214());
  const std::string text = explain(*find_instruction("+I"), times);
  for (const char* part : {"+I IN1, OUT", "CPU 212", "VW0 to VW1022", "VW0 to VW4094", "SM1.0 SM1.1 SM1.2", "73 us",
                           "estimate", "example     +I VW100, VW200"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
}

TEST(InstructionText, SaysTheResolutionAndRetentionOfTimersByNumber) {
  const TimeTable times = default_times(cpu214());
  const std::string on_delay = explain(*find_instruction("TON"), times);
  for (const char* part : {"1 ms       T32, T96\n", "10 ms      T33 to T36, T97 to T100\n",
                           "100 ms     T37 to T63, T101 to T255\n", "kept       none while the power is off"})
    EXPECT_NE(on_delay.find(part), std::string::npos) << part << " in\n" << on_delay;
  const std::string retentive = explain(*find_instruction("TONR"), times);
  for (const char* part : {"1 ms       T0, T64\n", "10 ms      T1 to T4, T65 to T68\n", "100 ms     T5 to T31, T69 to T95\n",
                           "kept       T0 to T31, T64 to T95 while the power is off"})
    EXPECT_NE(retentive.find(part), std::string::npos) << part << " in\n" << retentive;
}

TEST(InstructionText, SaysWhichCountersAreKept) {
  const std::string text = explain(*find_instruction("CTU"), default_times(cpu214()));
  EXPECT_NE(text.find("kept       C0 to C127 while the power is off, as CPU 214 is delivered\n"), std::string::npos) << text;
}

TEST(InstructionText, SaysWhatIsNotModelledAndWhichCpuHasIt) {
  const std::string text = explain(*find_instruction("TODRX"), default_times(cpu214()));
  EXPECT_NE(text.find("not modelled: the clock has no daylight saving"), std::string::npos) << text;
  EXPECT_NE(text.find("the real instruction needs CPU 22x of release 2"), std::string::npos) << text;
}

}  // namespace
}  // namespace s7200::tools::instruction_text_test

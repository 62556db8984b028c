// Interpreter against reference model over random programs. S7200_LOCKSTEP_INSTRUCTIONS sets how far each test goes.
#include "tests/reference_model/lockstep.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>
#include <string>

#include "interpreter/model/instruction.hpp"
#include "tests/reference_model/instructions.hpp"

namespace s7200::reference {
namespace {

std::uint64_t instructions_of_a_test() {
  const char* const wanted = std::getenv("S7200_LOCKSTEP_INSTRUCTIONS");
  return wanted ? std::stoull(wanted) : S7200_LOCKSTEP_INSTRUCTIONS;
}

class Lockstep : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Lockstep, InterpreterAgreesWithReferenceModel) {
  const LockstepResult result = run_lockstep(GetParam() * 1'000'000, instructions_of_a_test());
  EXPECT_FALSE(result.difference) << *result.difference;
}

TEST_P(Lockstep, InterpreterAgreesWithReferenceModelOnACpu224) {
  const LockstepResult result = run_lockstep(GetParam() * 1'000'000, instructions_of_a_test() / 4, "224");
  EXPECT_FALSE(result.difference) << *result.difference;
}

INSTANTIATE_TEST_SUITE_P(Seeds, Lockstep, testing::Range<std::uint64_t>(1, 5));

/// Interrupts, Freeport, ports, other stations, high-speed counters, pulse outputs, PID and the clock are left to other
/// tests.
TEST(ReferenceModel, KnowsEveryInstructionButThoseLeftToOtherTests) {
  static const std::set<std::string_view> kOthers{"XMT",  "RCV", "CRETI", "HDEF", "HSC",  "PLS",  "TODR",
                                                  "TODW", "PID", "GPA",   "SPA",  "DLED", "NETR", "NETW"};
  for (const auto& instruction : all_instructions()) {
    if (!instruction.modelled() || !(instruction.cpus & (kCpu214 | kCpu224))) continue;
    EXPECT_NE(instructions().contains(std::string(instruction.mnemonic)), kOthers.contains(instruction.mnemonic))
        << instruction.mnemonic;
  }
}

TEST(ReferenceModel, RandomProgramsExecuteEveryInstructionItKnows) {
  static const std::set<std::string> kNotExecuted{"INT", "RETI"};
  const LockstepResult result = run_lockstep(500'000, 1'000'000, "224");
  for (const auto& [mnemonic, instruction] : instructions()) {
    const auto found = result.executed.find(mnemonic);
    const std::uint64_t times = found == result.executed.end() ? 0 : found->second;
    EXPECT_TRUE(times >= 20 || kNotExecuted.contains(mnemonic))
        << mnemonic << " was executed with power flow " << times << " times";
  }
}

TEST(ReferenceModel, RandomProgramsMeetTheRareStatesAndValues) {
  const LockstepResult result = run_lockstep(1, 100'000);
  for (const char* what : {"compare with a value that is not a number", "overflow of a sum", "rotate by whole turns",
                           "R of a fast timer that counts", "R of a 100 ms timer that counts"}) {
    const auto found = result.met.find(what);
    EXPECT_GE(found == result.met.end() ? 0 : found->second, 20u) << what;
  }
}

}  // namespace
}  // namespace s7200::reference

// Which way the main program takes: networks with power flow, calls, jumps.
#include "interpreter/trace/program_path.hpp"

#include "tests/support/plc.hpp"

namespace s7200::test::program_path_test {
namespace {

/// The ways that a program is seen to take.
class Ways final : public TraceSink {
 public:
  explicit Ways(const Program& program) : path_(program) {}
  void record(const TraceRecord& record) override { keep(path_.of(record)); }
  void instruction(const InstructionRecord& record) override {
    if (const std::string* way = path_.of(record)) keep(*way);
  }
  bool wants_instructions() const override { return true; }

  std::vector<std::string> all;

 private:
  void keep(std::string way) {
    if (!way.empty()) all.push_back(std::move(way));
  }
  ProgramPath path_;
};

/// Of the first scans; I0.0 rises at 10 ms.
std::vector<std::string> ways_of(std::string_view stl, Time until = 30 * ms) {
  Plc plc(stl);
  Ways ways(plc.cpu.program());
  ways.record({.kind = TraceKind::ScanBegin, .count = 1});
  plc.cpu.set_sink(&ways);
  plc.input_at(10 * ms, "I0.0", true);
  plc.run_until(until);
  return ways.all;
}

using Texts = std::vector<std::string>;

TEST(ProgramPath, NetworksWithPowerFlowAndWhatIsCalledAreSaidOnceForEachChange) {
  EXPECT_EQ(ways_of("NETWORK 1\nLD SM0.1\nCALL 1\nNETWORK 2\nLD SM0.0\nINCW VW0\nNETWORK 3\nLD I0.0\n= Q0.0\nMEND\n"
                    "NETWORK 4\nSBR 1\nLD SM0.0\nMOVW 7, VW20\nRET\n"),
            (Texts{"main program: network 1, CALL 1 in line 3 (network 4), network 2", "main program: network 2",
                   "main program: networks 2-3"}));
}

TEST(ProgramPath, JumpsThatAreTakenAreNamedAndThoseOfALoopCounted) {
  EXPECT_EQ(ways_of("LD SM0.0\nMOVW 3, VW0\nLBL 1\nLD SM0.0\nDECW VW0\nLDW>= VW0, 1\nJMP 1\nLDW= VW0, 1\nJMP 2\n"
                    "LD SM0.0\nINCW VW2\nLBL 2\nMEND\n"),
            Texts{"main program: line 1, line 4, line 6, JMP 1 in line 7 2 times, line 10"});
}

TEST(ProgramPath, WhatAlternatesIsTheSameWay) {
  EXPECT_EQ(ways_of("NETWORK 1\nLDN M0.0\n= M0.0\nNETWORK 2\nLD SM0.0\nINCW VW0\nMEND\n").size(), 2U);
}

TEST(ProgramPath, AWayThatIsTakenAgainLaterIsToldAgain) {
  EXPECT_EQ(ways_of("NETWORK 1\nLD SM0.0\nINCW VW0\nNETWORK 2\nLDW= VW0, 4\nOW= VW0, 8\nOW= VW0, 16\nINCW VW2\n"
                    "NETWORK 3\nLDW= VW0, 12\nINCW VW4\nMEND\n"),
            (Texts{"main program: network 1", "main program: networks 1-2", "main program: networks 1-2",
                   "main program: networks 1, 3", "main program: networks 1-2"}));
}

TEST(ProgramPath, TwoScansThatDoOtherThingsInTheSameNetworksGoTheSameWay) {
  EXPECT_EQ(ways_of("NETWORK 1\nLDN I0.0\nINCW VW0\nLD I0.0\nDECW VW0\nMEND\n"), Texts{"main program: network 1"});
}

TEST(ProgramPath, OfAScanWithoutEndItKeepsTheBeginning) {
  EXPECT_EQ(ways_of("LD SM0.0\nMOVD 0, VD0\nLBL 1\nLD SM0.0\nWDR\nINCD VD0\nLDD<= VD0, 400000\nJMP 1\n"
                    "LD SM0.0\nINCW VW4\nMEND\n",
                    60 * kSecond),
            Texts{"main program: line 1, line 4, line 7, JMP 1 in line 8 249999 times, …"});
}

TEST(ProgramPath, AConditionalEndOfTheScanAndOfASubroutineAreNamed) {
  EXPECT_EQ(ways_of("NETWORK 1\nLD SM0.0\nCALL 1\nNETWORK 2\nLDN I0.0\nEND\nNETWORK 3\nLD SM0.0\nINCW VW0\nMEND\n"
                    "SBR 1\nLD SM0.0\nCRET\nINCW VW2\nRET\n"),
            (Texts{"main program: network 1, CALL 1 in line 3 (line 11, CRET in line 13), network 2, END in line 6",
                   "main program: network 1, CALL 1 in line 3 (line 11, CRET in line 13), network 3"}));
}

TEST(ProgramPath, InterruptsAreNotPartOfTheWay) {
  EXPECT_EQ(ways_of("NETWORK 1\nLD SM0.0\nATCH 0, 0\nENI\nMEND\nNETWORK 7\nINT 0\nLD SM0.0\nCRETI\nRETI\n"),
            Texts{"main program: network 1"});
}

TEST(ProgramPath, AChangeToStopSaysHowFarItCame) {
  const Texts ways = ways_of("NETWORK 1\nLD SM0.0\nINCW VW0\nNETWORK 2\nLD I0.0\nSTOP\nMEND\n");
  ASSERT_EQ(ways.size(), 2U);
  EXPECT_EQ(ways[1], "main program until then: network 1");
}

TEST(ProgramPath, ACallThatIsTooDeepIsNotOneThatReturns) {
  EXPECT_EQ(
      ways_of("LD SM0.0\nCALL 1\nINCW VW0\nMEND\nSBR 1\nLD SM0.0\nINCW VW2\nLDW<= VW2, 100\nCALL 1\nRET\n", 3 * ms).size(),
      ways_of("LD SM0.0\nCALL 1\nINCW VW0\nMEND\nSBR 1\nLD SM0.0\nINCW VW2\nRET\n", 3 * ms).size());
}

}  // namespace
}  // namespace s7200::test::program_path_test

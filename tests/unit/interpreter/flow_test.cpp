// The control flow of programs, as plain data.
#include "interpreter/analysis/flow/flow.hpp"

#include "tests/support/plc.hpp"

namespace s7200::test::flow_test {
namespace {

ControlFlow flow(std::string_view text, const CpuModel& model = *find_cpu("224")) {
  return control_flow(*program_of(text, model));
}

/// `1,3` or `end`, or both: what may follow an op.
std::string next(const ControlFlow& flow, std::uint32_t op) {
  std::vector<std::string> all;
  for (const std::uint32_t each : flow.nodes[op].next) all.push_back(std::to_string(each));
  if (flow.nodes[op].ends) all.emplace_back("end");
  return fmt::format("{}", fmt::join(all, ","));
}

TEST(Flow, AJumpGoesOnOrToItsLabel) {
  EXPECT_EQ(next(flow("LD I0.0\nJMP 1\nLD I0.1\nLBL 1\nMEND\n"), 1), "2,3");
  EXPECT_EQ(next(flow("LD SM0.0\nJMP 1\nLD I0.1\nLBL 1\nMEND\n"), 1), "3") << "it surely has power flow";
  EXPECT_EQ(next(flow("LBL 1\nLD I0.0\nJMP 1\nMEND\n"), 2), "3,0") << "back";
}

TEST(Flow, ALoopIsLeftBehindItsNext) {
  const ControlFlow loop = flow("LD I0.0\nFOR VW0, 1, 3\nLD I0.1\nNEXT\nMEND\n");
  EXPECT_EQ(next(loop, 1), "2,4");
  EXPECT_EQ(next(loop, 3), "4,2");
}

TEST(Flow, ARoutineMayEndWhereItReturnsWithPowerFlow) {
  const ControlFlow returns = flow("LD I0.0\nCALL 0\nEND\nMEND\nSBR 0\nCRET\nLD I0.0\nCRET\nRET\n");
  EXPECT_EQ(next(returns, 1), "2") << "a CALL comes back";
  EXPECT_EQ(next(returns, 2), "3,end");
  EXPECT_EQ(next(returns, 3), "end");
  EXPECT_EQ(next(returns, 5), "end") << "the stack of a subroutine begins with 1";
  EXPECT_EQ(next(returns, 7), "8,end");
}

TEST(Flow, ASegmentIsLeftAtItsEnd) {
  const ControlFlow segment = flow("LSCR S0.0\nLD SM0.0\nCSCRE\nLD I0.0\n= Q0.0\nSCRE\nMEND\n");
  EXPECT_EQ(next(segment, 2), "3,5") << "in a segment no power flow is certain";
  EXPECT_FALSE(segment.nodes[2].powered);
}

TEST(Flow, RoutinesAreKnownFromTheirFirstOpsToTheirEnds) {
  const ControlFlow found = flow("LD SM0.0\nCALL 3\nATCH 7, 10\nMEND\nSBR 3\nRET\nINT 7\nRETI\n");
  ASSERT_EQ(found.routines.size(), 3u);
  EXPECT_EQ(found.routines[1].kind, Routine::Kind::Subroutine);
  EXPECT_EQ(found.routines[1].number, 3);
  EXPECT_EQ(found.routines[1].first, 4u);
  EXPECT_EQ(found.routines[1].end, 6u);
  EXPECT_EQ(found.routine_of(7).kind, Routine::Kind::Interrupt);
  ASSERT_EQ(found.calls.size(), 1u);
  EXPECT_EQ(found.calls[0].op, 1u);
  EXPECT_EQ(found.calls[0].routine, 1u);
}

TEST(Flow, AnAttachmentNamesItsEventAndItsRoutine) {
  const ControlFlow found = flow("LD SM0.0\nATCH 7, 10\nENI\nMEND\nINT 0\nRETI\nINT 7\nRETI\n");
  ASSERT_EQ(found.attachments.size(), 1u);
  EXPECT_EQ(found.attachments[0].event, 10);
  EXPECT_EQ(found.attachments[0].routine, 2u);
}

TEST(Flow, AnOpBelongsToTheNetworkOfItsFirst) {
  const ControlFlow found = flow("NETWORK 1\nLD I0.0\n= Q0.0\nNETWORK 2\nLD I0.1\n= Q0.1\nMEND\n");
  EXPECT_EQ(found.nodes[1].network, 0u);
  EXPECT_EQ(found.nodes[3].network, 2u);
}

}  // namespace
}  // namespace s7200::test::flow_test

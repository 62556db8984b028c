#include <fmt/format.h>

#include "tests/unit/debugger/session.hpp"

namespace s7200::tools::forcing_test {
namespace {

constexpr std::string_view kCopy =
    "LD      I0.0\n"     // 1
    "=       Q0.0\n"     // 2
    "LD      SM0.0\n"    // 3
    "MOVW    1, VW10\n"  // 4
    "INCW    VW20\n"     // 5
    "MEND\n";            // 6

TEST(ForceCommand, HoldsAcrossScansUntilItIsTakenBack) {
  AtPrompt session(kCopy);
  session("scan; force I0.0=1 VW10 = 7; scan 5");
  EXPECT_EQ(session.vw(10), 7U);
  EXPECT_EQ(session.state().image[image::kQ], 1);
  session("unforce all; scan 2");
  EXPECT_EQ(session.vw(10), 1U);
  EXPECT_EQ(session.state().image[image::kQ], 0);
}

TEST(ForceCommand, AloneListsWhatIsForced) {
  AtPrompt session(kCopy);
  EXPECT_TRUE(has(session("force"), "nothing is forced"));
  session("force VW10=7 I0.0=1");
  EXPECT_EQ(session("force"), "I0.0     1\nVW10     16#0007 (7)\n");
}

TEST(ForceCommand, GoingBackUndoesItAndGoingForwardDoesItAgain) {
  AtPrompt session(kCopy);
  session("scan 3; force VW10=7; scan 3");
  session("at start; expect VW10 = 0");
  EXPECT_TRUE(has(session("force"), "nothing is forced"));
  session("at end; expect VW10 = 7");
  EXPECT_TRUE(has(session("force"), "VW10"));
}

TEST(ForceCommand, InThePastBeginsANewBranch) {
  AtPrompt session(kCopy);
  EXPECT_TRUE(has(session("scan 3; rscan; force I0.0=1"), "a new branch begins here"));
}

TEST(ForceCommand, PrintStatusAndWhoShowWhatIsForced) {
  AtPrompt session(kCopy);
  session("force VW10=7 Q0.0=0; scan 3");
  EXPECT_TRUE(has(session("print VB10:4"), "forced: VW10=16#0007 (7)"));
  EXPECT_TRUE(has(session("status"), "Q0.0=0  forced: Q0.0=0"));
  EXPECT_TRUE(has(session("who VW10"), "by the system, between two instructions  forced: VW10=16#0007 (7)"));
  EXPECT_TRUE(has(session("set VW10=3"), "VW10 keeps what is forced until 'unforce VW10'"));
}

TEST(ForceCommand, ChecksSeeWhatIsForcedAtEachMomentOfAScan) {
  AtPrompt session(kCopy);
  session("force Q0.0=1 VW10=7; scan 2; until 5");
  ASSERT_EQ(session.state().image[image::kQ], 0) << "the program has written it in this scan";
  ASSERT_EQ(session.vw(10), 1U);
  session("expect Q0.0 = 1 and QB0 = 1 and VW10 = 7 and V11.0");
  EXPECT_TRUE(has(session.error_of("expect Q0.0 = 0"), "does not hold here: Q0.0 is 1"));
  EXPECT_EQ(session("print Q0.0"), "Q0.0     1\n         forced: Q0.0=1; in this scan the program has 0\n");
  EXPECT_TRUE(has(session("print VB10:2"), " 00 07 "));
  EXPECT_TRUE(has(session("print /d VW10"), "VW10     7\n"));
  EXPECT_TRUE(has(session("print VW10 + 1"), "= 8"));
  EXPECT_TRUE(has(session("values VW10"), "VW10     7\n"));
  EXPECT_TRUE(has(session("display Q0.0"), "Q0.0     1\n"));
  EXPECT_FALSE(has(session("print VW20"), "forced"));
}

TEST(ForceCommand, UntilIsAboutTheForcedOutputAndWhyNotSaysThatItIsForced) {
  AtPrompt session(kCopy);
  EXPECT_TRUE(has(session("force Q0.0=0; input I0.0=1; scan 3; until Q0.0 within 50ms"),
                  "it is forced; 'unforce Q0.0' releases it"));
  EXPECT_TRUE(has(session("until not Q0.0"), "holds now"));
  EXPECT_TRUE(has(session("until QB0 = 1 within 50ms"), "QB0 = 1 does not hold: QB0 is 0"));
  session("force Q0.0=1");
  EXPECT_TRUE(has(session("until Q0.0"), "holds now"));
}

TEST(ForceCommand, ConditionsOfBreakpointsAreAboutWhatTheProgramFinds) {
  AtPrompt session(kCopy);
  session("force Q0.0=1; scan 2; break 3 if Q0.0 = 0; continue 100ms");
  EXPECT_EQ(session.line(), 3U);
}

TEST(ForceCommand, WhySaysWhatOfItAndOfItsContactsIsForced) {
  AtPrompt session(kCopy);
  EXPECT_TRUE(has(session("force I0.0=0; input I0.0=1; scan 3; why Q0.0"), "I0.0 was forced"));
  EXPECT_TRUE(has(session("force Q0.0=1; scan 2; why Q0.0"), "Q0.0 is forced to 1"));
}

TEST(ForceCommand, RefusesWhatACpuCannotForceAndSaysWhatItCan) {
  AtPrompt session(kCopy);
  EXPECT_TRUE(has(session.error_of("force M0.3=1"), "'M0.3=1' cannot be forced: the CPU forces points of I and Q"));
  EXPECT_TRUE(has(session.error_of("force I0.3"), "write one address, =, and a value"));
  EXPECT_TRUE(has(session.error_of("unforce VW10"), "VW10 is not forced"));
  std::string seventeen = "force I0.0=1";
  for (int i = 0; i < 17; ++i) seventeen += fmt::format(" VB{}=1", i);
  EXPECT_TRUE(has(session.error_of(seventeen), "no room: 17 values of memory given, 16 is the limit"));
  session("force VB300=1");
  EXPECT_TRUE(has(session.error_of(seventeen), "17 values of memory given, 1 forced already, 16 is the limit"));
  session("unforce all");
  for (int i = 0; i < 16; ++i) session(fmt::format("force VB{}=1", 100 + i));
  EXPECT_TRUE(has(session.error_of("force VB200=1"), "16 values of memory are forced already"));
}

TEST(ForceCommand, IsRedOnATerminalOnly) {
  serial::Simulation simulation(program_of(kCopy));
  simulation.power_up();
  std::ostringstream out;
  Prompt debugger(std::vector{&simulation}, out, PromptSettings{.colour = true});
  debugger.execute("force Q0.0=1; print Q0.0");
  EXPECT_TRUE(has(out.str(), "\x1b[31m  forced: Q0.0=1\x1b[0m"));
}

}  // namespace
}  // namespace s7200::tools::forcing_test

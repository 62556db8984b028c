// "The slave does not answer this frame": from the symptom backwards to the instruction that dropped it, as in the README.
#include <fmt/format.h>

#include <tuple>

#include "tests/support/tip41.hpp"
#include "tests/unit/debugger/session.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools::worked_example_test {
namespace {

struct Drop {
  const char* frame;
  const char* place;        ///< of the ATCH that left the frame
  const char* instruction;  ///< that dropped it
  const char* reason;       ///< seen in what ran before
};

void five_commands_lead_to(AtPrompt& session, const Drop& drop) {
  SCOPED_TRACE(drop.frame);
  session(std::string("continue 2s; break unanswered; send ") + drop.frame);
  EXPECT_TRUE(has(session("continue"), "breakpoint 1, unanswered"));
  EXPECT_TRUE(has(session("rwho event 8"), "ATCH: INT 122 to event 8"));
  const std::string left = session("rwho event 8");
  EXPECT_TRUE(has(left, "ATCH: INT 121 to event 8"));
  EXPECT_TRUE(has(left, drop.place));
  EXPECT_TRUE(has(session("rwhy"), drop.instruction));
  EXPECT_TRUE(has(session("history 9"), drop.reason));
}

TEST(WorkedExample, FiveCommandsFindWhatDroppedAFrameInOurSlave) {
  const auto program = test::compile(test::slave_text());
  for (const Drop& drop :
       {Drop{"01 03 00 0a 00 01 00 00", "by SBR 51 line", "JMP     255                  // a disturbed",
             "LDW=    AC0, 0               S0=0"},
        Drop{"02 03 00 0a 00 01 crc", "by INT 122 line", "CRETI",
             "LDB=    SMB2, VB4095         S0=0 SMB2=16#02 VB4095=16#01"},
        Drop{"01 03p 00 0a 00 01 crc", "by INT 123 line", "CRETI", "LDN     SM3.0                S0=0 SM3.0=1"},
        Drop{"01 03 00", "by SBR 51 line", "JMP     255                  // fewer are not",
             "LDW<=   VW3300, 3            S0=1 VW3300=16#0003"}}) {
    AtPrompt session(program);
    five_commands_lead_to(session, drop);
  }
}

TEST(WorkedExample, FiveCommandsFindWhatDroppedAFrameInTheTip) {
  if (!test::tip41::available()) GTEST_SKIP() << "the tip document is not here";
  const auto program = test::compile(test::tip41::text());
  for (const Drop& drop :
       {Drop{"01 03 00 00 00 01 00 00", "by SBR 51", "JMP     255", "LDW=    0, AC2               S0=0"},
        Drop{"02 03 00 00 00 01 crc", "by INT 122", "CRETI", "LDB=    SMB2, VB4095         S0=0 SMB2=16#02 VB4095=16#01"},
        Drop{"01 03p 00 00 00 01 crc", "by INT 123", "ATCH    120, 10", "LD      SM3.0                S0=1 SM3.0=1"},
        Drop{"01 03 00", "by SBR 51", "JMP     255", "LDW=    0, AC2               S0=0"}}) {
    AtPrompt session(program);
    five_commands_lead_to(session, drop);
  }
}

TEST(WorkedExample, WhyNamesWhatDecidedWithoutGoingThereAndGoesOnFromThere) {
  AtPrompt session("LD SM0.0\nAN I0.0\nJMP 1\nLD SM0.0\nINCW VW0\nLBL 1\nLD SM0.0\nINCW VW2\nMEND\n");
  EXPECT_TRUE(has(session("why"), "nothing has decided that it comes here"));
  const std::string there = session("until 8; why");
  EXPECT_TRUE(has(there, "JMP 1 in line 3 (LD SM0.0: SM0.0=1; AN I0.0: I0.0=0)"));
  EXPECT_EQ(session.line(), 8u);
  session("rwhy");
  EXPECT_EQ(session.line(), 3u) << "in front of the jump";
  EXPECT_TRUE(has(session("rwhy"), "the contacts from line 1 to line 2 (LD SM0.0: SM0.0=1; AN I0.0: I0.0=0)")) << "which has contacts of its own";
  EXPECT_EQ(session.line(), 1u);
  EXPECT_TRUE(has(session("rwhy"), "nothing has decided"));
  EXPECT_EQ(session.line(), 1u);
  session("input I0.0=1; scan 2; until 5");
  EXPECT_TRUE(has(session("why"), "JMP 1 in line 3, not taken (LD SM0.0: SM0.0=1; AN I0.0: I0.0=1)"));
  EXPECT_TRUE(has(session.error_of("why 5"), "'5' is not an address"));
}

struct Reason {
  const char* frame;
  const char* said;
};

void a_trace_names(const std::shared_ptr<const Program>& program, const Reason& reason) {
  SCOPED_TRACE(reason.frame);
  AtPrompt session(program);
  session("continue 2s; trace on");
  const std::string trace = session(std::string("send ") + reason.frame + "; continue");
  EXPECT_TRUE(has(trace, reason.said));
}

TEST(WorkedExample, ATraceNamesWhatDroppedAFrameInOurSlave) {
  const auto program = test::compile(test::slave_text());
  for (const Reason& reason :
       {Reason{"01 03 00 0a 00 01 00 00", "no answer to 8 characters since 2000."},
        Reason{"01 03 00 0a 00 01 00 00", "JMP 255 in line 141 (LDW= AC0, 0: AC0=16#7B06; NOT)  // a disturbed frame"},
        Reason{"02 03 00 0a 00 01 crc", ": CRETI in line 662, not taken (LDB= SMB2, VB4095: SMB2=16#02 VB4095=16#01; OB= "},
        Reason{"01 03p 00 0a 00 01 crc", ": CRETI in line 680, not taken (LDN SM3.0: SM3.0=1; AN V3304.1: V3304.1=0)"},
        Reason{"01 03 00", "JMP 255 in line 134 (LDW<= VW3300, 3: VW3300=16#0003)  // fewer are not"}})
    a_trace_names(program, reason);
  AtPrompt session(program);
  EXPECT_FALSE(has(session("continue 2s; trace on; send 01 03 00 0a 00 01 crc; continue; continue 50ms"), "no answer"));
}

TEST(WorkedExample, ATraceNamesWhatDroppedAFrameInTheTip) {
  if (!test::tip41::available()) GTEST_SKIP() << "the tip document is not here";
  const auto program = test::compile(test::tip41::text());
  for (const Reason& reason : {Reason{"01 03 00 00 00 01 00 00", "no answer to 8 characters since 2000."},
                               Reason{"01 03 00 00 00 01 00 00", ": JMP 255 in line "},
                               Reason{"02 03 00 00 00 01 crc", "(LDB= SMB2, VB4095: SMB2=16#02 VB4095=16#01"}})
    a_trace_names(program, reason);
}

constexpr std::string_view kWaiting =
    ": INT 121 (attached in line 120) took them without reading SMB2, and executed ATCH 120, 10 in line 650  // start the "
    "quiet time afresh";

TEST(WorkedExample, AFrameThatComesWhileTheSlaveStillWaitsForSilenceIsNamedByTheTraceAndByWhy) {
  const auto program = test::compile(test::slave_text());
  AtPrompt traced(program);
  const std::string trace = traced("trace on; continue 53ms; send 01 03 00 0a 00 01 crc; continue");
  EXPECT_TRUE(has(trace, "no answer to 8 characters since 53."));
  EXPECT_TRUE(has(trace, kWaiting));
  AtPrompt session(program);
  session("continue 53ms; break unanswered; send 01 03 00 0a 00 01 crc; continue");
  EXPECT_TRUE(has(session("why"), "no answer to 8 characters since 53."));
  EXPECT_TRUE(has(session("rwho event 8"), "ATCH: INT 122 to event 8"));
  EXPECT_TRUE(has(session("why"), kWaiting)) << "in front of the ATCH that leaves it";
  EXPECT_TRUE(has(session("rwho event 8"), "ATCH: INT 121 to event 8"));
  EXPECT_TRUE(has(session("why"), "CALL 50 in line 77 (LD SM0.1: SM0.1=1)")) << "not the loop of a subroutine that is over";
}

TEST(WorkedExample, FromAnUnansweredRequestItGoesStraightBackToWhatDroppedTheFrame) {
  const auto program = test::compile(test::slave_text());
  for (const auto& [frame, line] : {std::pair{"01 03 00 0a 00 01 00 00", 141u}, std::pair{"01 03 00", 134u}}) {
    SCOPED_TRACE(frame);
    AtPrompt session(program);
    session(std::string("continue 2s; break unanswered; send ") + frame + "; continue");
    const std::string text = session("rwhy");
    EXPECT_TRUE(has(text, fmt::format("JMP 255 in line {}", line)));
    EXPECT_FALSE(has(text, "nothing has decided"));
    EXPECT_EQ(session.line(), line);
    EXPECT_TRUE(has(text, fmt::format("{}  no answer to ", moment_text(session.simulation.time())))) << "its time";
  }
}

TEST(WorkedExample, BothPartsOfAFrameWithAPauseInItAreNamed) {
  const auto program = test::compile(test::slave_text());
  for (const auto& [fault, first, rest] :
       {std::tuple{"gap:character=4,length=10ms", "no answer to 3 characters since 2000.",
                   "no answer to 5 characters since "},
        std::tuple{"gap:length=10ms", "no answer to a character since 2000.", "no answer to 7 characters since "}}) {
    SCOPED_TRACE(fault);
    AtPrompt session(program);
    const std::string trace =
        session(fmt::format("continue 2s; trace on; fault {}; send 01 03 00 0a 00 01 crc; continue", fault));
    EXPECT_TRUE(has(trace, first));
    EXPECT_TRUE(has(trace, "JMP 255 in line 134 (LDW<= VW3300, 3"));
    EXPECT_TRUE(has(trace, rest));
    EXPECT_TRUE(has(trace, "took them without reading SMB2"));
    EXPECT_TRUE(has(session("why"), "JMP 255 in line 134"));
  }
}

TEST(WorkedExample, WhyKnowsAllOfALongScanAndEveryContactOfALongRung) {
  AtPrompt session(
      "LD SM0.0\nAN I0.0\nJMP 1\nLBL 1\nLD SM0.0\nFOR VW0, 1, 4000\nLD SM0.0\nWDR\nSQRT VD8, VD12\nNEXT\nLD SM0.0\nINCW "
      "VW2\nMEND\n");
  session("scan");
  const Time begun = session.simulation.time();
  const std::string text = session("until 12; why");
  EXPECT_GT(session.simulation.time() - begun, 3 * kSecond);
  EXPECT_TRUE(has(text, "JMP 1 in line 3 (LD SM0.0: SM0.0=1; AN I0.0: I0.0=0)"));

  std::string rung = "LDN M0.0\n";
  for (int bit = 1; bit < 20; ++bit) rung += fmt::format("AN M{}.{}\n", bit / 8, bit % 8);
  AtPrompt wide(rung + "INCW VW0\nMEND\n");
  const std::string why = wide("until 21; why");
  EXPECT_TRUE(has(why, "LDN M0.0: M0.0=0; AN M0.1: M0.1=0"));
  EXPECT_TRUE(has(why, "AN M2.3: M2.3=0)"));
  wide("rwhy; rwhy");
  EXPECT_EQ(wide.line(), 1u);
}

}  // namespace
}  // namespace s7200::tools::worked_example_test

// A CPU in STOP: time passes, requests come to their end, and the past is the past.
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.hpp"
#include "tests/unit/debugger/session.hpp"

namespace s7200::tools::standstill_test {
namespace {

/// An endless loop from I0.0 on, which the watchdog ends.
constexpr std::string_view kLoop =
    "LD      SM0.1\n"   // 1
    "MOVW    0, VW0\n"  // 2
    "LBL     1\n"       // 3
    "LD      SM0.0\n"   // 4
    "INCW    VW2\n"     // 5
    "LD      I0.0\n"    // 6
    "JMP     1\n"       // 7
    "MEND\n";           // 8

TEST(Standstill, WhyNamesTheJumpThatLedToTheWatchdog) {
  AtPrompt session(kLoop);
  EXPECT_TRUE(has(session("continue 20ms; input I0.0=1; continue"), "fatal error 0003"));
  EXPECT_TRUE(has(session("why"), "main: JMP 1 in line 7 (LD I0.0: I0.0=1)"));
  EXPECT_TRUE(has(session("continue 500ms; why"), "JMP 1 in line 7")) << "while STOP lasts";
}

TEST(Standstill, ARequestInStopIsGivenUpAtItsTimeOut) {
  AtPrompt session("LD SM0.0\nSTOP\nMEND\n");
  session("continue; send 01 03 00 00 00 02 crc");
  const Time asked = session.simulation.time();
  const std::string text = session("continue");
  EXPECT_TRUE(has(text, "answer   none within 1 s\n         the CPU is in STOP, where no program answers\n"));
  EXPECT_GE(session.simulation.time(), asked + kSecond);
  EXPECT_LT(session.simulation.time(), asked + 2 * kSecond);
  EXPECT_FALSE(session.simulation.master().busy());
  EXPECT_TRUE(has(session("break unanswered; send 01; continue"), "breakpoint 1, unanswered"));
}

TEST(Standstill, ContinueLetsAsMuchTimePassAsItSaysAndStepsExecuteNothing) {
  AtPrompt session("LD SM0.0\nSTOP\nMEND\n");
  session("continue");
  const Time stopped = session.simulation.time();
  EXPECT_TRUE(has(session("continue 250ms"), "250 ms of simulated time passed"));
  EXPECT_EQ(session.simulation.time(), stopped + 250 * kMillisecond);
  EXPECT_TRUE(has(session("step"), "executes nothing; 'continue' lets time pass, 'mode run' starts it"));
  EXPECT_EQ(session.simulation.time(), stopped + 250 * kMillisecond);
}

TEST(Standstill, TheTimeInStopCanBeGoneBackToAndPlayedAgain) {
  AtPrompt session("LD SM0.0\nSTOP\nMEND\n");
  session("continue");
  const Time stopped = session.simulation.time();
  session("send 01 03 00 00 00 02 crc; continue");
  const auto there = session.simulation.snapshot();
  session("at 500ms");
  EXPECT_EQ(session.simulation.time(), 500 * kMillisecond);
  EXPECT_TRUE(session.simulation.master().busy());
  session("continue 100ms");
  EXPECT_EQ(session.simulation.time(), 600 * kMillisecond) << "not to the end of what has run";
  session("continue");
  EXPECT_EQ(session.simulation.snapshot(), there);
  session("at start; continue");
  EXPECT_EQ(session.simulation.time(), stopped) << "where it went to STOP it stops again";
  EXPECT_EQ(session.state().mode, Mode::Stop);
}

TEST(Standstill, TheWatchdogStopsItAgainAtTheSameInstant) {
  AtPrompt session(kLoop);
  session("continue 20ms; input I0.0=1; continue");
  const auto stopped = session.simulation.snapshot();
  session("continue 1s; at 100ms; continue");
  EXPECT_EQ(session.simulation.snapshot(), stopped);
}

TEST(Standstill, ModeStopsAndStartsTheProgramAsAProgrammingDeviceDoes) {
  AtPrompt session(kNested);
  session("continue 20ms");
  const std::uint16_t scans = session.vw(10);
  EXPECT_TRUE(has(session("mode stop"), "STOP"));
  session("continue 100ms");
  EXPECT_EQ(session.vw(10), scans);
  EXPECT_EQ(session.error_of("mode stop"), "mode: the CPU is in STOP already");
  session("mode run; continue 20ms");
  EXPECT_EQ(session.state().mode, Mode::Run);
  EXPECT_GT(session.vw(10), scans);
  EXPECT_EQ(session.error_of("mode"), "mode expects run or stop");
  EXPECT_EQ(session.error_of("mode frob"), "mode expects run or stop");
}

TEST(Standstill, ModeIsPlayedAgainAndSaved) {
  const std::string path = test::scratch_folder() + "mode_session.json";
  AtPrompt session(kNested);
  session("continue 20ms; mode stop; continue 100ms; mode run; continue 20ms");
  const auto there = session.simulation.snapshot();
  session("save " + path + "; at start; continue");
  EXPECT_EQ(session.state().mode, Mode::Stop) << "where it was stopped";
  session("at end");
  EXPECT_EQ(session.simulation.snapshot(), there);
  AtPrompt other(kNested);
  other("load " + path);
  EXPECT_EQ(other.simulation.snapshot(), there);
}

TEST(Standstill, AfterAFatalErrorOnlyPowerBringsTheProgramBack) {
  AtPrompt session(kLoop);
  session("input I0.0=1; continue");
  EXPECT_TRUE(has(session.error_of("mode run"), "after fatal error 0003 the CPU stays in STOP"));
  EXPECT_TRUE(has(session("step"), "'restart' powers it up again"));
}

TEST(Standstill, TheOnlyPlcLosesPowerWhileTimeGoesOnAndThePastIsLeftAsItWas) {
  AtPrompt session(kEcho);
  session("continue 100ms; set VW200=7; send 41; continue");
  EXPECT_TRUE(has(session("power off"), "the PLC has no power from now on; 'power on' brings it back\n"));
  const Time off = session.simulation.time();
  EXPECT_TRUE(has(session("step"), "the PLC is without power; 'power on' brings it back; 'continue' lets time pass"));
  EXPECT_EQ(session.simulation.time(), off) << "there is nothing to step through";
  EXPECT_TRUE(has(session.error_of("set VW200=1"), "the PLC is without power"));
  EXPECT_TRUE(has(session.error_of("power off"), "the PLC is without power already"));
  EXPECT_TRUE(has(session("send 41; continue"), "answer   none within 1 s"));
  EXPECT_TRUE(has(session("continue 2s"), "without power\n"));
  EXPECT_GE(session.simulation.time(), off + 3 * kSecond);
  session("power on; continue 100ms");
  EXPECT_TRUE(has(session("send 42; continue"), "answer   42"));
  const serial::Simulation::Snapshot there = session.simulation.system().snapshot();
  const std::string file = test::scratch_folder() + "power_of_one.json";
  session("save " + file + " !");
  session("at 1s");
  EXPECT_FALSE(session.simulation.plc().powered());
  session("rcontinue");
  EXPECT_TRUE(session.simulation.plc().powered()) << "back to the first answer";
  session("at end");
  EXPECT_TRUE(session.simulation.system().snapshot() == there);
  AtPrompt other(kEcho);
  other("load " + file);
  EXPECT_TRUE(other.simulation.system().snapshot() == there);
}

TEST(Standstill, AProgrammingDeviceOnTheLineIsAnsweredInStop) {
  AtPrompt session("LD SM0.0\nSTOP\nMEND\n");
  session("continue");
  // SD1: station 2 is asked by station 0 for its state
  EXPECT_TRUE(has(session("send 10 02 00 49 4b 16; continue"), "answer   10 00 02 00 02 16"));
}

TEST(Standstill, EveryRequestThatWasUnansweredInStopIsGoneBackToByItself) {
  AtPrompt session("LD SM0.0\nSTOP\nMEND\n");
  session("continue; break unanswered; send 01; continue");
  const Time first = session.simulation.time();
  session("continue 100ms; send 02; continue");
  EXPECT_TRUE(has(session("send 03; continue"), "hit 3 times"));
  EXPECT_TRUE(has(session("rcontinue"), "unanswered, hit 2 times\nrequest  02"));
  EXPECT_TRUE(has(session("rcontinue"), "unanswered, hit for the first time\nrequest  01"));
  EXPECT_EQ(session.simulation.time(), first);
  EXPECT_TRUE(has(session("rcontinue"), "oldest moment"));
}

}  // namespace
}  // namespace s7200::tools::standstill_test

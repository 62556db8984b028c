// Answers that whoever has asked cannot take, and answers that come when somebody else is asking already.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "serial_sim/modbus/crc.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/debugger/system_session.hpp"
#include "tools/session/stops/stop_words.hpp"

namespace s7200::tools::wrong_answers_test {
namespace {

/// A slave that is polled twice a second; exchanges of its line have a fault.
std::string polled(std::string_view fault, std::string_view read = "40001, count: 2") {
  return fmt::format(
      "plcs: {{slave: {{program: ../modbus_slave.stl, station: 1}}}}\n"
      "peers: {{scada: {{polls: [{{station: 1, read: {}}}], every: 500ms, timeout: 200ms}}}}\n"
      "lines: {{bus: {{stations: [scada, slave], faults: ['{}']}}}}\n",
      read, fault);
}

TEST(WrongAnswers, AMasterThatPollsCannotTakeADamagedOne) {
  struct Case {
    std::string_view fault, wrong;
  };
  constexpr Case kCases[]{{"parity:of=answer,character=3,exchange=2", "characters with wrong parity"},
                          {"missing:of=answer,character=4,exchange=2", "wrong CRC"},
                          {"framing:of=answer,character=2,exchange=2", "characters with framing errors"}};
  for (const auto& [fault, wrong] : kCases) {
    SystemSession session(polled(fault), 0);
    session("break unanswered");
    const std::string stopped = session("break wrong; continue 4s");
    EXPECT_TRUE(has(stopped,
                    "slave: breakpoint 2, wrong, hit for the first time\n  01 03 00 00 00 02 c4 0b  asked by scada\n"
                    "  answered 01 "))
        << fault;
    EXPECT_TRUE(has(stopped, fmt::format(": {}\n", wrong))) << fault;
    const Time at = session.system().time(), end = session.rig->poller(0)->requester().exchange().response_end;
    EXPECT_GE(at, end);
    EXPECT_LT(at, end + 5 * kMillisecond);
    EXPECT_TRUE(has(session("continue 2s"), "nothing to stop for")) << "only once";
    EXPECT_TRUE(has(session("rcontinue"), "breakpoint 2, wrong"));
    EXPECT_EQ(session.system().time(), at) << "the same from either side";
    EXPECT_TRUE(has(session("rcontinue"), "oldest moment"));
  }
}

TEST(WrongAnswers, AnExceptionIsAnAnswer) {
  SystemSession session(polled("parity:exchange=90", "49999"), 0);
  EXPECT_TRUE(has(session("break wrong; break sent; continue 4s; delete 2"), "  01 83 02 c0 f1\n"));
  EXPECT_TRUE(has(session("continue 2s"), "nothing to stop for"));
}

TEST(WrongAnswers, TheMasterOfSendCannotTakeADamagedOne) {
  SystemSession session("plcs: {slave: {program: ../modbus_slave.stl, station: 1}}\nlines: {bus: {stations: [slave]}}\n", 0);
  session("continue 1s; break wrong");
  EXPECT_FALSE(has(session("send 01 03 00 0a 00 01 crc; continue"), "wrong, hit"));
  const std::string stopped = session("fault flip:of=answer,character=3,bit=1; send 01 03 00 0a 00 01 crc; continue");
  EXPECT_TRUE(has(stopped, "breakpoint 1, wrong, hit for the first time\n  answered 01 03 00 00 00 b8 44: "));
  EXPECT_TRUE(has(session("continue 1s; rcontinue"), "breakpoint 1, wrong"));
}

/// Asks station 1 at power-up + 0.3 s for 20 registers, and again as soon as RCV ends, `early` or not.
std::string asks_again(std::string_view then) {
  const std::string path = test::scratch_folder() + "asks_again.stl";
  std::ofstream(path) << "LD SM0.1\nMOVB 16#49, SMB30\nMOVB 8, VB100\nMOVD 16#01030000, VD101\nMOVD 16#001445C5, VD105\n"
                         "MOVB 8, VB120\nMOVD 16#02030000, VD121\nMOVD 16#001445F6, VD125\n"
                         "MOVB 16#94, SMB87\nMOVW 4, SMW90\nMOVW 10, SMW92\nMOVB 90, SMB94\nATCH 0, 9\nATCH 1, 23\nENI\n"
                         "LD SM0.0\nTON T37, 10\nLD T37\nEU\nXMT VB100, 0\nMEND\n"
                         "INT 0\nLD SM0.0\nRCV VB200, 0\nRETI\n"
                         "INT 1\nLD M0.0\nCRETI\nLD SM0.0\nS M0.0, 1\nXMT "
                      << then << ", 0\nRETI\n";
  return path;
}

std::string asking_plc(std::string_view then) {
  return "plcs:\n  master: {program: " + asks_again(then) +
         ", cpu: 224}\n"
         "  slave: {program: ../modbus_slave.stl, copies: 2, station: 1}\n"
         "lines: {bus: {stations: [master, slave], contention: 1}}\n";
}

TEST(WrongAnswers, AProgramThatAsksAgainWhileItsAnswerIsOnTheLineHasHeardAWrongOne) {
  SystemSession session(asking_plc("VB100"), 0);
  session("continue 900ms; fault parity:character=3 station=slave1; break unanswered; break wrong");
  const std::string stopped = session("continue 500ms");
  EXPECT_TRUE(has(stopped,
                  "breakpoint 2, wrong, hit for the first time\n  01 03 00 00 00 14 45 c5  asked by master\n"
                  "  answered 01 03 28: characters with wrong parity\n"));
  EXPECT_FALSE(has(stopped, "unanswered"));
  const Time at = session.system().time();
  session("continue 10ms; rcontinue");
  EXPECT_EQ(session.system().time(), at);
}

TEST(WrongAnswers, AnAnswerThatEndsWhileItsMasterAsksTheNextStationIsNoRequest) {
  for (const std::string_view then : {"VB100", "VB120"}) {
    SystemSession session(asking_plc(then), 0);
    session("continue 900ms; fault parity:character=3 station=slave1; break unanswered");
    const std::string text = session("continue 3s") + session("continue 3s") + session("continue 3s");
    EXPECT_FALSE(has(text, "asked by slave1")) << then;
    EXPECT_EQ(then == "VB120", text.find("  02 03 00 00 00 14 45 f6  asked by master\n") != std::string::npos)
        << "slave2 has not heard it, and that slave1 has answered is of no use";
  }
}

TEST(WrongAnswers, AnAnswerThatComesAfterItsTimeOutIsNoRequest) {
  SystemSession session(
      "plcs: {slave: {program: ../modbus_slave.stl, copies: 2, station: 1}}\n"
      "peers: {scada: {polls: [{station: 1..2, read: 40001, count: 30}], timeout: 6ms}}\n"
      "lines: {bus: {stations: [scada, slave]}}\n",
      0);
  std::string text = session("continue 1500ms; break unanswered");
  for (int stop = 0; stop < 8; ++stop) text += session("continue 300ms");
  EXPECT_TRUE(has(text, "asked by scada"));
  EXPECT_FALSE(has(text, "asked by slave")) << text;
}

TEST(WrongAnswers, AProgramCannotTakeAnAnswerWithAWrongCrc) {
  SystemSession session;  // the master program asks two slaves
  session("continue 1s; fault missing:character=4 station=slave1; break wrong");
  const std::string stopped = session("continue 4s; fault none");
  EXPECT_TRUE(
      has(stopped, "master: breakpoint 1, wrong, hit for the first time\n  01 03 00 00 00 02 c4 0b  asked by master\n"));
  EXPECT_TRUE(has(stopped, ": wrong CRC\n"));
  const Time at = session.system().time();
  EXPECT_TRUE(has(session("continue 2s"), "nothing to stop for"));
  session("rcontinue");
  EXPECT_EQ(session.system().time(), at);
}

// --- words ---

TEST(WrongAnswers, TheHelpOfBreakHasEveryWordOfAHappening) {
  AtPrompt session(kNested);
  const std::string help = session("help break");
  for (const std::string_view word : happening_words()) EXPECT_TRUE(has(help, word));
}

TEST(WrongAnswers, ABreakpointAtThemIsSavedAndLoaded) {
  const std::string file = test::scratch_folder() + "wrong.json";
  AtPrompt session(kNested);
  session("break wrong hits 2; continue 10ms; save " + file + " !");
  AtPrompt other(kNested);
  other("load " + file);
  EXPECT_TRUE(has(other("break"), "wrong, from hit 2"));
}

// --- two masters, and whose a fault is ---

TEST(WrongAnswers, SendSaysThatAnotherMasterIsOnTheLineAndWhoSentWhatItTookForAnAnswer) {
  SystemSession session(polled("parity:exchange=90"), 0);
  session("continue 1470ms");
  EXPECT_TRUE(has(session("send 09 03 00 00 00 01 crc"), "two masters are on this line: scada asks there too;"));
  const std::string answered = session("continue");
  EXPECT_TRUE(has(answered, "answer   01 03 00 00 00 02 c4 0b"));
  EXPECT_TRUE(has(answered, "sent by scada: a request of its own, not an answer; two masters are on this line\n"));
  AtPrompt alone(kEcho);
  EXPECT_FALSE(has(alone("continue 100ms; send 41; continue"), "two masters"));
}

TEST(WrongAnswers, ARequestThatWasTakenForTheAnswerLeavesTheOwnOneUnansweredAndTheLineHasLostNothing) {
  SystemSession session(polled("parity:exchange=90"), 0);
  session("continue 1470ms; break unanswered; send 09 03 00 00 00 01 crc");
  EXPECT_TRUE(has(session("continue"), "unanswered, hit"));
  EXPECT_TRUE(has(session("why"), "what the master took for its answer was sent by scada: a request of its own"));
  EXPECT_FALSE(has(session.out.str(), "which no S7-200 has sent"));
  EXPECT_FALSE(has(session("rwhy"), "lost on the line"));
}

TEST(WrongAnswers, SendNamesAllOthersThatAskOnTheLine) {
  SystemSession session(
      "plcs: {slave: {program: ../modbus_slave.stl, station: 1}}\n"
      "peers:\n"
      "  panel: {polls: [{station: 1, read: 40001}], every: 500ms}\n"
      "  recorder: {polls: [{station: 1, read: 40001}], every: 700ms}\n"
      "lines: {bus: {stations: [panel, recorder, slave]}}\n",
      0);
  session("continue 1470ms");
  EXPECT_TRUE(has(session("send 09 03 00 00 00 01 crc"), "3 masters are on this line: panel and recorder ask there too;"));
}

/// The recorder's write begins while the slave sends.
std::string two_masters() {
  return "plcs: {pump: {program: ../modbus_slave.stl, station: 7}}\n"
         "peers:\n"
         "  panel: {polls: [{station: 7, read: 40001, count: 2}], every: 150ms, timeout: 120ms}\n"
         "  recorder: {polls: [{station: 7, read: 40001, count: 10}, {station: 7, write: 40011, value: 99}], every: 710ms,\n"
         "             timeout: 300ms}\n"
         "lines: {field: {stations: [panel, pump, recorder], turn_round: 20ms}}\n";
}

TEST(WrongAnswers, AnAnswerIntoWhichAnotherMasterHasSentStaysTheAnswerOfItsSlave) {
  constexpr std::string_view kInto = "an answer of pump, into which recorder sent a request of its own from 11";
  SystemSession session(two_masters(), 0);
  const std::string sent = session("continue 1080ms; send 07 03 00 00 00 02 crc; continue");
  EXPECT_TRUE(has(sent, "answer   07 03 04 12 34") || has(sent, "answer   07 03 04 00 00")) << sent;
  EXPECT_TRUE(has(sent, kInto)) << sent;
  EXPECT_FALSE(has(sent, "not an answer")) << sent;
  SystemSession polls(two_masters(), 0);
  const std::string stopped = polls("break wrong; continue 5s; continue");
  EXPECT_TRUE(has(stopped, "asked by panel\n  answered 07 03 04 ")) << stopped;
  EXPECT_TRUE(has(stopped, kInto)) << stopped;
}

TEST(WrongAnswers, AFaultOfOneStationStrikesOnlyWhatThatSends) {
  SystemSession session;
  session("continue 1s");
  EXPECT_TRUE(has(session("fault parity:character=2 station=slave2"),
                  "from now on, of what slave2 sends: parity:character=2\n  the parity bit inverted\n"));
  EXPECT_TRUE(has(session("break wrong; continue 4s"), "  02 03 "));
  EXPECT_TRUE(has(session("fault"), "slave2"));
  EXPECT_TRUE(has(session.error_of("fault parity:of=answer station=slave2"), "leave 'of=' out"));
  EXPECT_TRUE(has(session.error_of("fault noise:ber=0.1 station=slave2"), "are of the line and not of a station"));
  EXPECT_TRUE(has(session.error_of("fault parity station=slave9"), "'slave9' is not on this line; known: master, slave1"));
  EXPECT_TRUE(has(session.error_of("fault none station=slave2"), "leave station= out"));
  AtPrompt one(kNested);
  EXPECT_TRUE(has(one.error_of("fault parity station=slave"), "station= is for a system"));
}

TEST(WrongAnswers, CompletionOffersThemAndTheStationsOfAFault) {
  SystemSession session(polled("parity:exchange=90"), 0);
  EXPECT_EQ(session.debugger->completions("break wro").candidates, std::vector<std::string>{"wrong"});
  EXPECT_EQ(session.debugger->completions("fault fl").candidates, std::vector<std::string>{"flip:"});
  EXPECT_EQ(session.debugger->completions("fault parity s").candidates,
            (std::vector<std::string>{"station=scada", "station=slave"}));
  EXPECT_TRUE(session.debugger->completions("fault none s").candidates.empty());
}

TEST(WrongAnswers, AFaultOfOneStationIsInASavedSession) {
  const std::string file = test::scratch_folder() + "fault.json";
  SystemSession session;
  session("continue 1s; fault parity:character=2 station=slave2; continue 3s; save " + file + " !");
  SystemSession other;
  other("load " + file);
  EXPECT_TRUE(other.system().snapshot() == session.system().snapshot());
}

TEST(WrongAnswers, StationListsPeersToo) {
  SystemSession session(polled("parity:exchange=90"), 0);
  EXPECT_TRUE(has(session("station"), "\n  scada  a master that polls on line bus\n"));
  EXPECT_TRUE(has(session.error_of("station scada"), "scada is a master that polls; it has no program to step through"));
}

}  // namespace
}  // namespace s7200::tools::wrong_answers_test

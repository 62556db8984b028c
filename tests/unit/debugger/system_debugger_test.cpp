// A session with the stations of a system, at the prompt.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "serial_sim/modbus/crc.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/debugger/system_session.hpp"
#include "tools/session/past/seen_rig.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools::system_debugger_test {
namespace {

/// Two PLCs; `first` counts its scans, `second` goes to STOP when M0.0 is set.
std::string two_programs() {
  const std::string folder = test::scratch_folder();
  std::ofstream(folder + "counts.stl") << "LD SM0.0\nINCW VW0\nMEND\n";
  std::ofstream(folder + "stops.stl") << "LD M0.0\nSTOP\nLD SM0.0\nINCW VW2\nMEND\n";
  return "plcs:\n  first: {program: " + folder + "counts.stl}\n  second: {program: " + folder +
         "stops.stl}\nlines:\n  bus: {stations: [first, second]}\n";
}

TEST(SystemDebugger, StationShowsWhereEachStandsAndGoesOverToAnother) {
  SystemSession session;
  session("continue 100ms");
  const std::string all = session("station");
  EXPECT_TRUE(has(all, "> master  100."));
  EXPECT_TRUE(has(all, "\n  slave1  100."));
  EXPECT_TRUE(has(all, "\n  slave2  100."));
  EXPECT_TRUE(session("station slave2").starts_with("slave2  100.")) << session("");
  EXPECT_TRUE(has(session("station"), "> slave2"));
  EXPECT_TRUE(has(session.error_of("station slave9"), "there is no station 'slave9'"));
}

TEST(SystemDebugger, AStationWithoutPowerIsShownSoAndComesBack) {
  SystemSession session;
  session("station slave2; continue 300ms");
  EXPECT_TRUE(has(session("station"), "> slave2  300."));
  EXPECT_TRUE(has(session("station"), "without power"));
  EXPECT_TRUE(has(session("step"), "slave2 is without power and executes nothing"));
  EXPECT_TRUE(has(session("continue 100ms; station"), "slave2  400."));
  EXPECT_FALSE(has(session("station"), "without power"));
  EXPECT_TRUE(has(session("at 290ms; station"), "without power"));
}

TEST(SystemDebugger, AStopAtAnotherStationGoesOverToItAndAStepBackIsOfTheStationLookedAt) {
  SystemSession session;
  session("station slave1; break event 8 served; station master");
  const std::string stopped = session("continue 1s");
  EXPECT_TRUE(has(stopped, "now at slave1\nslave1: breakpoint 1, event 8 served, hit for the first time\n"));
  EXPECT_TRUE(has(stopped, "slave1  "));
  const Time at_slave = session.system().time();
  const std::uint64_t of_master = session.stations[kMaster]->plc().executed();
  const std::string back = session("station master; rstep");
  EXPECT_TRUE(has(back, "master  "));
  EXPECT_TRUE(has(back, "in the past"));
  EXPECT_EQ(session.stations[kMaster]->plc().executed() + 1, of_master);
  EXPECT_LT(session.system().time(), at_slave);
  EXPECT_TRUE(has(session("continue"), "now at slave1\nslave1: breakpoint 1")) << "it is played, and the same";
  EXPECT_EQ(session.system().time(), at_slave);
}

constexpr std::string_view kTwoLines =
    "plcs:\n"
    "  gateway: {program: ../modbus_slave.stl, cpu: 226, station: 7}\n"
    "  pump: {program: ../modbus_slave.stl, station: 5}\n"
    "lines:\n"
    "  office: {stations: [gateway]}\n"
    "  field: {stations: [gateway.1, pump]}\n";

TEST(SystemDebugger, BackToAnAnswerShowsTheExchangeOfTheStationThatWasAsked) {
  SystemSession session(kTwoLines, 0);
  const std::string answered = session("continue 500ms; station pump; send 05 03 00 00 00 01 crc; continue");
  ASSERT_TRUE(has(answered, "request  05 03 00 00 00 01 85 8e"));
  const std::string back = session("continue 5ms; station gateway; rcontinue");
  EXPECT_TRUE(has(back, "request  05 03 00 00 00 01 85 8e")) << answered;
  EXPECT_FALSE(has(back, "after 1 s"));
}

TEST(SystemDebugger, OfAnUnansweredRequestItSaysWhetherThePlcThatWasAskedIsInStop) {
  constexpr std::string_view kInStop = "the CPU is in STOP, where no program answers";
  SystemSession session(kTwoLines, 0);
  session("continue 500ms; mode stop; station pump; send 09 03 00 00 00 01 crc; station gateway");
  EXPECT_FALSE(has(session("continue 3s"), kInStop)) << "only the gateway is";
  EXPECT_TRUE(has(session("station pump; mode stop; send 05 03 00 00 00 01 crc; continue 3s"), kInStop));
}

TEST(SystemDebugger, AStopAtAnotherStationGoesOverToItThoughTheRequestOfSendIsOverToo) {
  SystemSession session(
      "plcs: {slave: {program: ../modbus_slave.stl, copies: 2, station: 1}}\nlines: {bus: {stations: [slave]}}\n", 0);
  session("break unanswered; continue 100ms; station slave2; send 09 03 00 00 00 01 crc");
  const std::string stopped = session("continue");
  EXPECT_TRUE(
      has(stopped, "answer   none within 1 s\nnow at slave1\nslave1: breakpoint 1, unanswered, hit for the first time\n"));
  EXPECT_TRUE(has(session("station"), "> slave1"));
  const Time at = session.system().time();
  const std::string back = session("continue 100ms; station slave2; rcontinue");
  EXPECT_TRUE(has(back, "now at slave1\nslave1: breakpoint 1, unanswered"));
  EXPECT_EQ(session.system().time(), at) << "the same from either side";
  session("break unanswered; station slave2; send 09 03 00 00 00 01 crc; break unanswered");
  EXPECT_FALSE(has(session("continue"), "now at")) << "its own stop keeps it there";
}

TEST(SystemDebugger, StopsStayWithTheStationThatTheyWereSetAt) {
  SystemSession session(kPolled, kSlave1);
  session("continue 100ms; watch VW20; station slave2; break 76 always; station master");
  const std::string listed = session("break");
  EXPECT_TRUE(has(listed, "slave1: VW20 is 16#0000"));
  EXPECT_TRUE(has(listed, "slave2: main line 76"));
  session("delete 2; station slave2; set VW20=7; continue 20ms");
  EXPECT_TRUE(has(session("station slave1; set VW20=5; continue 20ms"), "nothing to stop for"))
      << "what is done from outside is no change while it runs";
  EXPECT_TRUE(has(session("who VW20"), "by 'set VW20', from outside"));
}

TEST(SystemDebugger, AFrameThatComesToAPlcInStopStopsThoughAnotherExecutes) {
  std::string text = two_programs();
  text.replace(text.find("lines:\n"), std::string::npos, "lines: {one: {stations: [first]}, two: {stations: [second]}}\n");
  SystemSession session(text, 1);
  EXPECT_TRUE(has(session("continue 100ms; mode stop; break received; send 41 42 43; continue"),
                  "second: breakpoint 1, received, hit for the first time\n  41 42 43\n"));
  EXPECT_LT(session.system().time(), 120 * kMillisecond);
}

/// Two slaves, 1 and 2, and a master on a bridge, which asks stations at their times, or sends something else instead.
struct BridgedSystem {
  struct Ask {
    Time at;
    std::uint8_t station;
    Bytes instead{};
  };

  explicit BridgedSystem(std::vector<Ask> all, std::string_view text = kBridged, bool named = false)
      : bench(text), asks(std::move(all)) {
    PromptSettings options{};
    for (const PlcPlan& plc : bench.rig->plan().plcs) options.history.plcs.push_back({plc.name, plc.address});
    if (named) options.history.line_stations = line_stations(*bench.rig);
    for (const PlcPlan& plc : bench.rig->plan().plcs) options.session.stations.push_back({.name = plc.name});
    options.history.hosts = {&bench.rig->host_port(0)};
    options.history.drive = [this](Time end, const auto&) { return drive(end); };
    debugger = std::make_unique<Prompt>(bench.stations, out, options);
  }

  serial::Halt drive(Time end) {
    serial::HostPort& port = bench.rig->host_port(0);
    if (!port.state().attached) port.attach(format, bench.system().time());
    for (;;) {
      const Time next = asked < asks.size() ? asks[asked].at : kNever;
      const serial::Halt halt = bench.system().run_until(std::min(end, next));
      if (halt != serial::Halt::Time || next > end) return halt;
      const Ask& ask = asks[asked++];
      Bytes request{ask.station, 0x03, 0x00, 0x00, 0x00, 0x01};
      modbus::add_crc(request);
      std::vector<serial::HostCharacter> frame;
      for (const std::uint8_t byte : ask.instead.empty() ? request : ask.instead)
        frame.push_back({.byte = byte, .format = format});
      port.send(frame, bench.system().time());
    }
  }

  std::string operator()(std::string_view commands) {
    out.str("");
    const auto error = debugger->execute(commands);
    EXPECT_FALSE(error.has_value()) << commands << ": " << *error;
    return out.str();
  }

  static constexpr std::string_view kBridged =
      "plcs: {slave: {program: ../modbus_slave.stl, copies: 2, station: 1}}\n"
      "bridges: {host: {tcp: 0}}\n"
      "lines: {bus: {stations: [slave, host]}}\n";
  SystemBench bench;
  std::vector<Ask> asks;
  SerialFormat format{};
  std::size_t asked = 0;
  std::ostringstream out;
  std::unique_ptr<Prompt> debugger;
};

TEST(SystemDebugger, ARequestOfAMasterOnABridgeThatNoStationAnswersIsUnanswered) {
  BridgedSystem session({{kSecond, 1}, {1'500 * kMillisecond, 2}, {2 * kSecond, 9}});
  EXPECT_TRUE(has(session("break unanswered; continue"),
                  "slave1: breakpoint 1, unanswered, hit for the first time\n  09 03 00 00 00 01 85 42\n"))
      << session.out.str();
  const Time end_of_frame = 2 * kSecond + 8 * SerialFormat{}.character_time(), stopped = session.bench.system().time();
  EXPECT_GE(stopped, end_of_frame + kSecond);
  EXPECT_LT(stopped, end_of_frame + kSecond + 10 * kMillisecond);
  EXPECT_FALSE(has(session("continue"), "breakpoint")) << "once, however many stations have heard it";
  EXPECT_TRUE(has(session("rcontinue"), "breakpoint 1, unanswered"));
  EXPECT_EQ(session.bench.system().time(), stopped);
}

TEST(SystemDebugger, ARequestOfAMasterOnABridgeIsHeardOnTheLinesOfAllPorts) {
  BridgedSystem session({{kSecond, 9}},
                        "plcs: {gateway: {program: ../modbus_slave.stl, cpu: 226}}\n"
                        "bridges: {host: {tcp: 0}}\n"
                        "lines: {office: {stations: [gateway]}, field: {stations: [gateway.1, host]}}\n");
  EXPECT_TRUE(has(session("break received; continue"), "breakpoint 1, received, hit for the first time\n  09 03 "));
  EXPECT_TRUE(has(session("break unanswered; continue"), "breakpoint 2, unanswered, hit for the first time\n  09 03 "));
  EXPECT_GT(session.bench.system().time(), 2 * kSecond);
  EXPECT_LT(session.bench.system().time(), 2'020 * kMillisecond);
}

TEST(SystemDebugger, ARequestOfAMasterOnABridgeIsUnansweredWhenItSendsAgain) {
  BridgedSystem session({{2 * kSecond, 9}, {2'200 * kMillisecond, 1}});
  session("station slave2; break unanswered; station slave1; continue");
  EXPECT_GT(session.bench.system().time(), 2'200 * kMillisecond);
  EXPECT_LT(session.bench.system().time(), 2'210 * kMillisecond);
}

TEST(SystemDebugger, ABroadcastOfAMasterOnABridgeIsNeverUnanswered) {
  BridgedSystem session({{2 * kSecond, 0}, {2'200 * kMillisecond, 1}});
  EXPECT_FALSE(has(session("break unanswered; continue 5s"), "breakpoint 1, unanswered, hit"));
}

constexpr std::string_view kPollers =
    "plcs: {slave: {program: ../modbus_slave.stl, copies: 2, station: 1}}\n"
    "peers:\n"
    "  scada: {polls: [{station: 1, read: 40001}, {station: 9, read: 40001}, {station: 2, read: 40001}], every: 1s, "
    "timeout: 300ms}\n"
    "lines: {bus: {stations: [scada, slave]}}\n";

TEST(SystemDebugger, AMasterThatPollsIsUnansweredWhenItsOwnTimeOutIsOver) {
  SystemSession session(kPollers, 0);
  EXPECT_TRUE(has(session("break unanswered; continue"),
                  "slave1: breakpoint 1, unanswered, hit for the first time\n  09 03 00 00 00 01 85 42  asked by scada\n"));
  const Time stopped = session.system().time(), end = session.rig->poller(0)->requester().exchange().request_end;
  EXPECT_GE(stopped, end + 300 * kMillisecond);
  EXPECT_LT(stopped, end + 301 * kMillisecond);
  session("continue; rcontinue");
  EXPECT_EQ(session.system().time(), stopped) << "the same from either side";
  EXPECT_TRUE(has(session.out.str(), "breakpoint 1, unanswered"));
  EXPECT_TRUE(has(session("continue; station slave2; power off; continue"), "  02 03 00 00 00 01 84 39  asked by scada\n"));
}

TEST(SystemDebugger, AMasterThatPollsIsUnansweredThoughNoPlcExecutesAProgram) {
  SystemSession session(kPollers, 0);
  session("continue 2.5s; mode stop; station slave2; mode stop; station slave1; break unanswered");
  EXPECT_TRUE(has(session("continue"), "  01 03 00 00 00 01 84 0a  asked by scada\n"));
  const Time end = session.rig->poller(0)->requester().exchange().request_end;
  EXPECT_LE(session.system().time(), end + 301 * kMillisecond);
}

TEST(SystemDebugger, RequestsUnansweredWithoutPowerAreGoneBackToOneByOne) {
  SystemSession session(
      "plcs: {slave: {program: ../modbus_slave.stl, station: 1}}\n"
      "peers: {scada: {polls: [{station: 1, read: 40001}], every: 1s, timeout: 300ms}}\n"
      "lines: {bus: {stations: [scada, slave]}}\n",
      0);
  session("continue 2.5s; break unanswered; power off; continue");
  const Time first = session.system().time();
  session("continue");
  const Time second = session.system().time();
  const std::string logged = session("break unanswered log 'none at {time}'; continue; delete 2");
  EXPECT_TRUE(has(logged, fmt::format("none at {}", moment_text(session.system().time())))) << "though its clock stands";
  session("rcontinue");
  EXPECT_EQ(session.system().time(), second);
  EXPECT_TRUE(has(session("power on; continue 500ms; rcontinue"), "hit 2 times"));
  EXPECT_EQ(session.system().time(), second);
  EXPECT_FALSE(session.stations[0]->plc().powered()) << "before power came back";
  EXPECT_TRUE(has(session("rcontinue"), "hit for the first time"));
  EXPECT_EQ(session.system().time(), first);
  EXPECT_TRUE(has(session("rcontinue"), "oldest moment"));
}

TEST(SystemDebugger, WhyKnowsWhatBecameOfARequestOfAMasterOnABridge) {
  BridgedSystem other({{kSecond, 9}});
  other("break unanswered; continue");
  EXPECT_TRUE(
      has(other("why"), "the request was for station 9; slave1 is station 1; no S7-200 on this line is station 9\n"));
  BridgedSystem dark({{kSecond, 2}});
  dark("break unanswered; station slave2; power off; station slave1; continue");
  EXPECT_TRUE(has(dark("why"), "; station 2 is slave2, which had no power from 0.000000 ms on\n"));
  BridgedSystem cut({{kSecond, 1}});
  EXPECT_TRUE(
      has(cut("fault cut:from=900ms; continue 1500ms; why"), "the bridge sent 8 characters from 1000.000000 ms to "));
  EXPECT_TRUE(has(cut.out.str(), ", and the PLC heard nothing: fault cut:from=900ms: 1×, since 900.000000 ms\n"));
  BridgedSystem damaged({{kSecond, 1}});
  damaged("break sent; fault flip:of=answer,character=2; continue; continue 20ms");
  EXPECT_TRUE(has(damaged("why"), ", and the bridge heard 01 02p 02 "));
  EXPECT_TRUE(has(damaged.out.str(), ": fault flip:character=2,of=answer: 1×, in character 2\n"));
  BridgedSystem answered({{kSecond, 1}});
  EXPECT_FALSE(has(answered("continue 1030ms; why"), "the bridge"));
}

TEST(SystemDebugger, WhyAndSendNameAMasterOnABridge) {
  BridgedSystem session({{kSecond, 9}, {2'504 * kMillisecond, 1}}, BridgedSystem::kBridged, true);
  EXPECT_TRUE(has(session("break unanswered; continue"), "  09 03 00 00 00 01 85 42  asked by host\n"));
  session("continue 490ms");
  EXPECT_TRUE(has(session("send 01 03 00 00 00 01 crc; continue"), "two masters are on this line: host asks there too;"));
  EXPECT_TRUE(has(session("why"), ": host sent 8 characters from 2504.000000 ms to 2513.166664 ms\n"));
}

TEST(SystemDebugger, WhyTellsFramesApartThatFollowEachOtherWithoutAPause) {
  // the slave answers from 2024.4 ms to 2032.5 ms
  BridgedSystem session({{2'034 * kMillisecond, 9}}, BridgedSystem::kBridged, true);
  session("continue 2s; break wrong; send 01 03 00 0a 00 01 crc; continue");
  const std::string why = session("why");
  EXPECT_TRUE(has(why, ", and the master heard 2 frames without a pause between them: slave1 sent 7 characters from 20"))
      << why;
  EXPECT_TRUE(has(why, "; host sent 8 characters from 2034.000000 ms to 2043.166664 ms\n")) << why;
  EXPECT_FALSE(has(why, "instead of")) << why;
}

TEST(SystemDebugger, ARequestOfAPlcIsUnansweredWhenNobodyAnswersOrItAsksAgain) {
  SystemSession session;  // the master asks first at 19 ms, the slaves hear from 52 ms on, it asks again at 823 ms
  const std::string stopped = session("station slave1; break unanswered; continue");
  EXPECT_TRUE(has(stopped,
                  "slave1: breakpoint 1, unanswered, hit for the first time\n  01 03 00 00 00 02 c4 0b  asked by "
                  "master\n"));
  const Time first = session.system().time();
  EXPECT_GT(first, 823 * kMillisecond);
  EXPECT_LT(first, 825 * kMillisecond);
  session("continue 3s; station slave2; power off; station slave1");
  EXPECT_TRUE(has(session("continue 3s"), "  02 03 ")) << "a request for another station";
  const Time second = session.system().time();
  session("continue; rcontinue");
  EXPECT_EQ(session.system().time(), second);
  EXPECT_TRUE(has(session("rcontinue"), "breakpoint 1, unanswered, hit for the first time\n  01 03 "));
  EXPECT_EQ(session.system().time(), first) << "found in parts of the past that begin while it waits";
  EXPECT_TRUE(has(session("rcontinue"), "this is the oldest moment"));
}

/// Asks once, station 5 or 6 (with its CRC), `tenths` of a second after power-up.
std::string asks_once(const std::string& name, std::string_view station, std::string_view crc, int tenths) {
  const std::string path = test::scratch_folder() + name + ".stl";
  std::ofstream(path) << "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 8, VB100\nMOVD 16#" << station << "03000a, VD101\nMOVD 16#0001"
                      << crc << ", VD105\nLD SM0.0\nTON T37, " << tenths << "\nLD T37\nEU\nXMT VB100, 0\nMEND\n";
  return name + ": {program: " + path + ", cpu: 224}";
}

TEST(SystemDebugger, ARequestOfAPlcIsUnansweredWhenAnotherPlcAsksBeforeAnAnswer) {
  SystemSession session("plcs:\n  " + asks_once("a", "05", "a58c", 1) + "\n  " + asks_once("b", "06", "a5bf", 3) +
                            "\nlines: {bus: {stations: [a, b]}}\n",
                        0);
  EXPECT_TRUE(has(session("break unanswered; continue"), "  05 03 00 0a 00 01 a5 8c  asked by a\n"));
  const Time first = session.system().time();
  EXPECT_GT(first, 300 * kMillisecond);
  EXPECT_LT(first, 320 * kMillisecond);
  EXPECT_TRUE(has(session("continue"), "  06 03 00 0a 00 01 a5 bf  asked by b\n"));
  EXPECT_FALSE(has(session("continue 3s"), "unanswered, hit"));
  session("rcontinue; rcontinue");
  EXPECT_EQ(session.system().time(), first);
}

TEST(SystemDebugger, ABroadcastOfAPlcIsNoAnswerAndLeavesTheRequestBeforeItUnanswered) {
  SystemSession session("plcs:\n  " + asks_once("a", "05", "a58c", 1) + "\n  " + asks_once("b", "00", "a5d9", 3) +
                            "\nlines: {bus: {stations: [a, b]}}\n",
                        0);
  EXPECT_TRUE(has(session("break unanswered; continue"), "  05 03 00 0a 00 01 a5 8c  asked by a\n"));
  EXPECT_GT(session.system().time(), 300 * kMillisecond);
  EXPECT_LT(session.system().time(), 320 * kMillisecond) << "when somebody else asks all";
  EXPECT_FALSE(has(session("continue 3s"), "unanswered, hit"));
}

TEST(SystemDebugger, PiecesOfAnAnswerOverABridgeAreNoRequestForThePlcsThatHearThem) {
  Bytes answer{0x05, 0x03, 0x02, 0x00, 0x05};
  modbus::add_crc(answer);
  const auto half = answer.begin() + 3;
  BridgedSystem session({{400 * kMillisecond, 5, {answer.begin(), half}}, {430 * kMillisecond, 5, {half, answer.end()}}},
                        "plcs:\n  " + asks_once("a", "05", "a58c", 3) + "\n  " + asks_once("b", "06", "a5bf", 300) +
                            "\nbridges: {host: {tcp: 0}}\nlines: {bus: {stations: [a, b, host]}}\n");
  session.format = {9600, 8, Parity::None, 1};
  EXPECT_FALSE(has(session("break unanswered; continue 3s"), "unanswered, hit")) << session.out.str();
}

TEST(SystemDebugger, WhoAndWatchNameWhatTheSystemFileHasPlanned) {
  SystemSession session(
      "plcs: {slave: {program: ../modbus_slave.stl, copies: 2, station: 1}}\n"
      "lines: {bus: {stations: [slave]}}\n"
      "events:\n"
      "  - {at: 100ms, plc: slave1, set: {VW20: 5}}\n"
      "  - {at: 200ms, power_off: slave2}\n"
      "  - {at: 300ms, power_on: slave2}\n"
      "  - {at: 400ms, plc: slave1, set: {VW22: 6}}\n",
      0);
  const std::string watched = session("watch VW20; continue 500ms; delete all");
  constexpr std::string_view kBySet = "'slave1: a programming device sets VW20 to 16#0005', in the system file\n";
  EXPECT_TRUE(has(watched, "VW20 was 16#0000 (0), is 16#0005 (5)\n  by " + std::string(kBySet)));
  session("continue 500ms");
  EXPECT_TRUE(has(session("who VW20"), "became 16#0005 (5), at 100.000000 ms\n  by " + std::string(kBySet)));
  session("rwho VW20");
  EXPECT_EQ(session.stations[0]->cpu().state().image[image::kV + 21], 0) << "before it";
  EXPECT_GT(session.system().time(), 99 * kMillisecond);
  EXPECT_TRUE(has(session("rwho VW20"), "nothing has written VW20"));
  EXPECT_TRUE(has(session("at end; who VW22; station slave2; who VW20"), "nothing has written VW20"));
  EXPECT_TRUE(has(session("who SMB30"), "  by SBR ")) << "after power came back";
}

TEST(SystemDebugger, ARequestOfAPlcIsOneThoughAMasterThatPollsWaitsForAnotherStation) {
  SystemSession session("plcs:\n  " + asks_once("a", "05", "a58c", 15) +
                            "\npeers: {scada: {polls: [{station: 9, read: 40001}], every: 4s, timeout: 3s}}\n"
                            "lines: {bus: {stations: [scada, a]}}\n",
                        0);
  EXPECT_TRUE(has(session("break unanswered; continue"), "  05 03 00 0a 00 01 a5 8c  asked by a\n"));
  EXPECT_LT(session.system().time(), 2'600 * kMillisecond);
  EXPECT_TRUE(has(session("continue"), "  09 03 00 00 00 01 85 42  asked by scada\n"));
}

TEST(SystemDebugger, AnAnswerIsNoRequestOfItsPlcThoughTheMasterHasTakenNoiseForIt) {
  SystemSession session(
      "plcs: {slave: {program: ../modbus_slave.stl, copies: 2, station: 1}}\n"
      "peers: {scada: {polls: [{station: 1..2, read: 40001, count: 3}], every: 500ms}}\n"
      "lines: {bus: {stations: [scada, slave]}}\n",
      0);
  session("continue 1400ms; fault noise:ber=0.01,seed=2; break unanswered");
  EXPECT_FALSE(has(session("continue 3s"), "asked by slave")) << session.out.str();
}

TEST(SystemDebugger, AnswersOfPlcsAndWhatTheyPassOnAreNoRequests) {
  SystemSession session(
      "plcs:\n  gateway: {program: ../systems/line_gateway.stl, cpu: 226}\n"
      "  pump: {program: ../modbus_slave.stl, station: 5}\n"
      "peers: {master: {polls: [{station: 5, read: 40001, count: 2}], every: 100ms}}\n"
      "lines:\n  office: {stations: [master, gateway]}\n  field: {stations: [gateway.1, pump]}\n",
      0);
  EXPECT_FALSE(has(session("break unanswered; station pump; break unanswered; continue 4s"), "unanswered, hit"));
  EXPECT_TRUE(has(session("power off; station gateway; continue 3s"), "unanswered")) << "of both lines, the gateway's too";
  EXPECT_TRUE(has(session.out.str() + session("continue 3s"), "  asked by gateway\n"));
}

TEST(SystemDebugger, PowerOffAndOnAreOfThePlcLookedAtAndInThePast) {
  SystemSession session(kPollers, 0);
  EXPECT_TRUE(has(session.error_of("power"), "power of which PLCs?"));
  EXPECT_TRUE(has(session.error_of("power on"), "slave1 is with power already"));
  EXPECT_TRUE(has(session("continue 2s; station slave2; set VW20=7; power off"), "slave2 has no power from now on"));
  EXPECT_TRUE(has(session("station"), "> slave2  2000."));
  EXPECT_TRUE(has(session.out.str(), "without power"));
  EXPECT_TRUE(session.stations[0]->plc().powered());
  EXPECT_TRUE(has(session.error_of("power off"), "slave2 is without power already"));
  for (const std::string_view command : {"set VW20=1", "input I0.0=1", "force VW20=1", "unforce all", "mode run"})
    EXPECT_TRUE(has(session.error_of(command), "slave2 is without power; 'power on' brings it back")) << command;
  EXPECT_TRUE(has(session("port"), "slave2 is without power; it was:\nSMB30 "));
  EXPECT_TRUE(has(session("regs"), "slave2 is without power; it was:\n"));
  EXPECT_FALSE(has(session("trace on; break lost; continue 1500ms"), "ignored")) << "as in --trace";
  EXPECT_FALSE(has(session.out.str(), "lost, hit")) << "nothing that a PLC without power could have got";
  session("trace off; delete all; power on; continue 100ms; rscan");
  EXPECT_TRUE(session.stations[1]->plc().powered());
  const serial::System::Snapshot there = session.system().snapshot();
  const std::string file = test::scratch_folder() + "power_session.json";
  session("save " + file + " !");
  session("at 3s");
  EXPECT_FALSE(session.stations[1]->plc().powered());
  session("at 1900ms");
  EXPECT_TRUE(session.stations[1]->plc().powered());
  SystemSession other(kPollers, 0);
  other("load " + file);
  EXPECT_TRUE(other.system().snapshot() == there);
}

/// A slave that is polled twice a second with a fault of its line.
SystemSession polled_with(const std::string& fault) {
  return SystemSession(
      "plcs: {slave: {program: ../modbus_slave.stl, station: 1}}\n"
      "peers: {scada: {polls: [{station: 1, read: 40001, count: 2}], every: 500ms, timeout: 200ms}}\n"
      "lines: {bus: {stations: [scada, slave], faults: ['" +
          fault + "']}}\n",
      0);
}

TEST(SystemDebugger, WhyKnowsWhatBecameOfARequestOfAMasterThatPolls) {
  struct Case {
    std::string_view fault, why;
  };
  constexpr Case kCases[]{
      {"parity:character=2,exchange=1",
       "no answer to 8 characters since 1000.000000 ms: CRETI in line 680, not taken (LDN SM3.0"},
      {"missing:character=3,exchange=1", "no answer to 7 characters since 1000.000000 ms: JMP 255 in line 141 (LDW= AC0, 0"},
      {"break:character=1,length=40bit,exchange=1", "no answer to 5 characters since 1000.000000 ms: JMP 255 in line 141"},
      {"missing:character=each,exchange=1",
       "scada sent 8 characters from 1000.000000 ms to 1009.166664 ms, and the PLC heard nothing: fault "
       "missing:character=each,exchange=1: 8×\n"},
      {"cut:from=900ms",
       "scada sent 8 characters from 1000.000000 ms to 1009.166664 ms, and the PLC heard nothing: fault cut"},
      {"missing:of=answer,character=each,exchange=1",
       " ms, and scada heard none of them: fault missing:character=each,of=answer,exchange=1: 9×\n"},
      {"answer:silent,exchange=1", ": fault answer:silent,exchange=1: 1×\n"}};
  for (const auto& [fault, why] : kCases) {
    SystemSession session = polled_with(std::string(fault));
    EXPECT_TRUE(has(session("continue 700ms; break unanswered; continue"), "  asked by scada\n")) << fault;
    const std::string text = session("why");
    EXPECT_TRUE(has(text, why)) << fault;
    EXPECT_FALSE(has(session("continue 50ms; continue 60ms; why"), "scada")) << "long ago";
  }
  SystemSession session = polled_with("parity:character=2,exchange=1");
  EXPECT_TRUE(has(session("continue 700ms; break unanswered; continue; rwhy"), "slave  1002."));
}

TEST(SystemDebugger, WhyNamesAMasterThatIsSetToAnotherFormat) {
  SystemSession session(kPollers, 1);  // the master is set as the first slave
  session("continue 1500ms; set SMB30=16#45; break unanswered if SMB30 = 16#45; continue");
  EXPECT_TRUE(has(session.out.str(), "  09 03 "));
  session("continue");
  EXPECT_TRUE(has(session.out.str(), "  02 03 00 00 00 01 84 39  asked by scada\n"));
  EXPECT_TRUE(has(session("why"), "no answer to "));
  EXPECT_TRUE(has(session.out.str(), "  scada has 9600 baud, 8 data bits, even parity, 1 stop bit, the port 19200 baud, "))
      << session.out.str();
}

TEST(SystemDebugger, WhyCountsTheCharactersThatPassAPlcWithoutPower) {
  SystemSession session = polled_with("gap:length=1ms,exchange=99");
  session("continue 2300ms; break unanswered; power off");
  EXPECT_TRUE(has(session("continue; why"),
                  "2500.000000 ms  no answer to 8 characters since 2500.000000 ms: the PLC has no power\n"));
  EXPECT_TRUE(has(session("continue; why"),
                  "3000.000000 ms  no answer to 8 characters since 3000.000000 ms: the PLC has no power\n"));
  EXPECT_EQ(session.out.str().find("2500."), std::string::npos) << "of the last request alone";
}

/// Three slaves; the second one is polled.
std::string polled_second(const std::string& events) {
  return "plcs: {slave: {program: ../modbus_slave.stl, copies: 3, station: 1}}\n"
         "peers: {scada: {polls: [{station: 2, read: 40001}], every: 500ms, timeout: 200ms}}\n"
         "lines: {bus: {stations: [scada, slave]}}\n" +
         events;
}

TEST(SystemDebugger, WhySaysSinceWhenAndBetweenWhomTheCableIsCut) {
  const std::string cut = "events: [{at: 700ms, cut: bus, after: slave1}, {at: ";
  SystemSession session(polled_second(cut + "3400ms, mend: bus}]\n"), 1);
  session("continue 2800ms; break unanswered; continue");
  EXPECT_TRUE(has(session("why"),
                  "scada sent 8 characters from 3000.000000 ms to 3009.166664 ms, and the PLC heard nothing: "
                  "the cable between scada and slave2 has been cut since 700.000000 ms\n"));
  EXPECT_TRUE(has(session("station slave1; why"),
                  "the request was for station 2; slave1 is station 1; station 2 is slave2; "
                  "the cable between scada and slave2 has been cut since 700.000000 ms\n"));
  SystemSession mended(polled_second(cut + "3100ms, mend: bus}, {at: 3150ms, cut: bus, after: slave2}]\n"), 1);
  mended("continue 2800ms; break unanswered; continue");
  EXPECT_TRUE(has(mended("why"), "the cable between scada and slave2 was cut from 700.000000 ms to 3100.000000 ms\n"));
}

TEST(SystemDebugger, WhySaysWhoIsAskedAndThatItHasNoPowerOrIsInStop) {
  const auto why_of_first = [](const std::string& events, const std::string& commands) {
    SystemSession session(polled_second(events), 0);
    session(commands + "break unanswered; continue");
    return session("station slave1; why");
  };
  EXPECT_TRUE(has(why_of_first("events: [{at: 700ms, power_off: slave2}]\n", ""),
                  "the request was for station 2; slave1 is station 1; station 2 is slave2, which had no power from "
                  "700.000000 ms on\n"));
  EXPECT_TRUE(has(why_of_first("", "station slave2; continue 700ms; mode stop; "),
                  "station 2 is slave2, which was in STOP from 700."));
  EXPECT_TRUE(has(why_of_first("", "fault missing:character=each; "),
                  "station 2 is slave2: 'station slave2', then 'why' tells what became of it there\n"));
  SystemSession nobody(
      "plcs: {slave: {program: ../modbus_slave.stl, station: 1}}\n"
      "peers: {scada: {polls: [{station: 2, read: 40001}], every: 500ms, timeout: 200ms}}\n"
      "lines: {bus: {stations: [scada, slave]}}\n",
      0);
  EXPECT_TRUE(has(nobody("break unanswered; continue; why"),
                  "the request was for station 2; slave is station 1; no S7-200 on this line is station 2\n"));
}

TEST(SystemDebugger, WhySaysWhoGaveAWrongAnswer) {
  SystemSession session(polled_second("events: [{at: 700ms, line: bus, fault: 'missing:character=2', station: slave2}]\n"),
                        0);
  EXPECT_TRUE(has(session("break wrong; continue"), "wrong CRC"));
  EXPECT_TRUE(has(session("why"),
                  "the request was for station 2; slave1 is station 1; station 2 is slave2: 'station slave2', then 'why' "
                  "tells what became of it there\n"));
  SystemSession right(polled_second(""), 0);
  EXPECT_FALSE(has(right("continue 1050ms; why"), "the request was for"));
  SystemSession program(kPolled, kSlave1);
  program("continue 3s; station slave2; fault flip:of=answer,character=3,bit=7; station slave1; break wrong; continue");
  EXPECT_TRUE(has(program("why"), "the request was for station 2; slave1 is station 1; station 2 is slave2: "));
}

TEST(SystemDebugger, PowerOfOnePlcCutsNothingOffThePast) {
  SystemSession session(kPolled, kSlave1);
  const auto is_powered = [&] { return session.stations[kSlave1]->plc().powered(); };
  session("continue 100ms; set VW20=7; power off; continue 20ms");
  const auto dark = session.system().snapshot();
  const std::string then = fmt::format("at {}ns", session.system().time());
  session("continue 20ms; power on; continue 50ms");
  const auto last = session.system().snapshot();
  EXPECT_TRUE(has(session("past"), ", where this session powered the CPU up, to ")) << "not where power came back";
  session(then);
  EXPECT_FALSE(is_powered());
  EXPECT_TRUE(session.system().snapshot() == dark);
  session("at 50ms");
  EXPECT_TRUE(is_powered());
  EXPECT_TRUE(has(session("at end; who VW20"), "by 'set VW20', from outside"));
  EXPECT_TRUE(session.system().snapshot() == last);
}

TEST(SystemDebugger, NoInstructionIsBlamedForAnAnswerThatTheLineLost) {
  SystemSession session(polled_second("events: [{at: 700ms, line: bus, fault: 'missing:of=answer,character=each'}]\n"), 1);
  session("break unanswered; continue 5s");
  const Time here = session.stations[1]->time();
  const std::string said = session("rwhy");
  EXPECT_TRUE(has(said, ", and scada heard none of them: fault missing:character=each,of=answer: 7×\n")) << said;
  EXPECT_TRUE(has(said, "rwhy goes nowhere: it was lost on the line, which no instruction has decided; 'at ")) << said;
  EXPECT_EQ(session.stations[1]->time(), here);
}

TEST(SystemDebugger, WhyOfAPlcWithoutPowerSaysSinceWhenAndByWhat) {
  SystemSession session(polled_second("events: [{at: 700ms, power_off: slave2}]\n"), 1);
  EXPECT_TRUE(has(session("continue 5s; why"),
                  "slave2 has been without power since 700.000000 ms: 'slave2: power off', in the system file\n"));
  EXPECT_FALSE(has(session.out.str(), "LD ")) << "what its program did before";
  SystemSession by_hand(polled_second(""), 1);
  by_hand("continue 800ms; power off; continue 2s; why");
  EXPECT_TRUE(has(by_hand.out.str(), "slave2 has been without power since 800."));
  EXPECT_TRUE(has(by_hand.out.str(), ": 'power off', from outside\n"));
}

TEST(SystemDebugger, WhyNamesAnotherMasterThatAskedAtTheSameTime) {
  const std::string system =
      "plcs: {pump: {program: ../modbus_slave.stl, station: 7}}\n"
      "peers:\n"
      "  panel: {polls: [{station: 7, read: 40001, count: 2}], every: 150ms, timeout: 120ms}\n"
      "  recorder: {polls: [{station: 7, read: 40001, count: 10}], every: 710ms, timeout: 300ms}\n"
      "lines: {field: {stations: [panel, pump, recorder], contention: space}}\n";
  constexpr std::string_view kSpan = " sent 8 characters from 1000.000000 ms to 1009.166664 ms";
  SystemSession session(system, 0);
  EXPECT_TRUE(has(session("break unanswered; continue 5s"), "asked by panel\n"));
  EXPECT_TRUE(has(session("why"), ": recorder" + std::string(kSpan) + "\n"));
  EXPECT_TRUE(has(session("break wrong; continue 5s"), "asked by recorder\n"));
  EXPECT_TRUE(has(session("why"),
                  "recorder heard 07 03 00 00 00 02 c4 6d from 1150.000000 ms to 1159.114581 ms, which no S7-200 has sent: "
                  "panel sent 8 characters from 1150.000000 ms to 1159.166664 ms\n"));
  EXPECT_TRUE(has(session("continue 5s"), "asked by recorder\n"));
  EXPECT_TRUE(has(session("why"), ", and recorder heard 07 03 14 00"));
  EXPECT_TRUE(has(session.out.str(), ": panel has been sending since 1750.000000 ms\n"));
  EXPECT_TRUE(has(session("delete 2; continue 5s"), "asked by panel\n"));
  EXPECT_TRUE(has(session("why"), "and the PLC heard no pause between that and others: recorder sent 8 characters from "));
}

TEST(SystemDebugger, WhyOfAnAskingProgramKnowsTheDamageOfItsAnswerAndWhoItAsked) {
  SystemSession session(kPolled, kMaster);
  session("continue 3s; fault flip:of=answer,character=3,bit=7; break wrong; continue");
  EXPECT_TRUE(has(session("why"), " instead of 0"));
  EXPECT_TRUE(has(session.out.str(), ": fault flip:character=3,bit=7,of=answer: 1×, in character 3\n"));
  SystemSession dark(kPolled, kMaster);
  dark("continue 3s; station slave2; power off; station master; break unanswered; continue");
  EXPECT_TRUE(has(dark("why"), "the request was for station 2; station 2 is slave2, which had no power from 300"));
}

TEST(SystemDebugger, WhyKnowsWhatBecameOfARequestOfAProgram) {
  SystemSession session(kPolled, kSlave1);
  session("continue 3s; fault missing:of=both,character=each; break unanswered; continue");
  EXPECT_TRUE(has(session.out.str(), "  asked by master\n"));
  EXPECT_TRUE(has(session("why"), "master sent 8 characters from 3"));
  EXPECT_TRUE(has(session.out.str(), ", and the PLC heard nothing: fault missing:character=each,of=both: 8×\n"))
      << "though the next one is under way";
  EXPECT_TRUE(has(session("station master; why"), "the program sent 8 characters from 3"));
  EXPECT_TRUE(has(session.out.str(), ", and has heard nothing since: fault missing:"));
}

/// Two programs that ask the same slave, which answers both; the second one asks when the answer to the first is over.
std::string two_programs_ask(const std::string& second) {
  const std::string folder = test::scratch_folder();
  const auto program = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder + name + ".stl") << text;
    return name + ": {program: " + folder + name + ".stl, cpu: 224";
  };
  const std::string port = "LD SM0.1\nMOVB 16#0D, SMB30\n";
  const std::string frame = "MOVB 8, VB100\nMOVD 16#01060001, VD101\nMOVD 16#00";
  // each hears a frame up to 3 ms without a character, less than a pause at 4800 baud, and sends when it has heard so many
  const auto after = [&](const std::string& value_and_crc, int frames) {
    return port + frame + value_and_crc + ", VD105\nMOVB 16#94, SMB87\nMOVW 0, SMW90\nMOVW 3, SMW92\nMOVB 50, SMB94\n" +
           "ATCH 1, 23\nENI\nRCV VB200, 0\nMEND\nINT 1\nLD SM0.0\nINCW VW300\nLDW= VW300, " + std::to_string(frames) +
           "\nXMT VB100, 0\nCRETI\nLD SM0.0\nRCV VB200, 0\nRETI\n";
  };
  const std::string ma = port + frame + "0a580d, VD105\nLD SM0.0\nTON T37, 3\nLD T37\nEU\nXMT VB100, 0\nMEND\n";
  const std::string slave = after("0a580d", 1);
  return "plcs:\n  " + program("ma", ma) + "}\n  " + program("mb", after(second, 2)) + "}\n  " + program("slave", slave) +
         "}\nlines: {bus: {stations: [ma, mb, slave]}}\n";
}

TEST(SystemDebugger, WhyOfAProgramTellsFramesApartThatFollowEachOtherWithoutAPause) {
  SystemSession session(two_programs_ask("0b99cd"), 0);
  session("break wrong; continue 2s");
  const std::string why = session("why");
  EXPECT_TRUE(has(why, "slave sent 8 characters from 3")) << session("history 3") << why;
  EXPECT_TRUE(has(why, ", and the program heard 2 frames without a pause between them: slave sent 8 characters from "))
      << why;
  EXPECT_TRUE(has(why, "; mb sent 8 characters from ")) << why;
}

TEST(SystemDebugger, WhyKnowsARequestOfAProgramAsLongAsTheTimeOutSaysThatItWaits) {
  const std::string system = "plcs:\n  " + asks_once("a", "05", "a58c", 1) + "\nlines: {bus: {stations: [a]}}\n";
  constexpr std::string_view kWhy = "the program sent 8 characters";
  SystemSession soon(system, 0), patient(system, 0, 4 * kSecond);
  EXPECT_TRUE(has(soon("continue 800ms; why"), kWhy));
  EXPECT_FALSE(has(soon("continue 2200ms; why"), kWhy));
  EXPECT_TRUE(has(patient("continue 3s; why"), kWhy));
  EXPECT_FALSE(has(patient("continue 3s; why"), kWhy));
}

TEST(SystemDebugger, AMasterThatPollsIsNoStationAndNotTheOneOfSend) {
  SystemSession session(kPollers, 0);
  EXPECT_EQ(session.error_of("station scada"), "scada is a master that polls; it has no program to step through");
  EXPECT_TRUE(
      has(session("port"), "master     has sent nothing\n           (the master of 'send'; scada asks by itself)\n"));
}

TEST(SystemDebugger, FaultAloneNamesTheStationOfAFault) {
  SystemSession session(
      "plcs: {slave: {program: ../modbus_slave.stl, copies: 2, station: 1}}\n"
      "lines: {bus: {stations: [slave], faults: [{fault: 'parity:character=3', station: slave2}]}}\n",
      0);
  EXPECT_TRUE(has(session("fault"), " of slave2: 0×\n"));
}

TEST(SystemDebugger, TheOnlyPlcOfASystemLosesPowerToo) {
  SystemSession session("plcs: {slave: {program: ../modbus_slave.stl, station: 1}}\nlines: {bus: {stations: [slave]}}\n", 0);
  session("continue 100ms; set VW20=7; break unanswered; power off; send 01 03 00 0a 00 01 crc; continue");
  EXPECT_TRUE(has(session.out.str(), "answer   none within 1 s")) << session.out.str();
  EXPECT_TRUE(has(session.out.str(), "slave is without power; 'power on' brings it back\n"));
  EXPECT_FALSE(has(session.out.str(), "Freeport mode")) << "which is not why it does not hear it";
  EXPECT_TRUE(has(session("continue 2s; power on; continue 100ms"), "scan "));
  const Time there = session.system().time();
  const serial::System::Snapshot snapshot = session.system().snapshot();
  EXPECT_GT(there, 3'200 * kMillisecond);
  session("at 1s");
  EXPECT_FALSE(session.stations[0]->plc().powered());
  session("at 50ms");
  EXPECT_TRUE(session.stations[0]->plc().powered());
  session("at end");
  EXPECT_TRUE(session.system().snapshot() == snapshot);
  EXPECT_TRUE(has(session("send 01 03 00 0a 00 01 crc; continue"), "answer   01 03 02"));
}

TEST(SystemDebugger, TheTraceNamesTheStationInTheOrderOfTime) {
  SystemSession session;
  session("continue 60ms; trace on");
  std::istringstream trace(session("continue 20ms"));
  std::set<std::string> stations;
  double before = 0;
  for (std::string line; std::getline(trace, line);) {
    std::istringstream words(line);
    double time = 0;
    std::string station;
    if (!line.starts_with("  ") || !(words >> time >> station)) continue;
    EXPECT_GE(time, before) << line;
    before = time;
    stations.insert(station);
  }
  EXPECT_TRUE(stations.contains("master"));
  EXPECT_TRUE(stations.contains("slave1"));
}

TEST(SystemDebugger, ACpuThatGoesToStopEndsTheRunAndTheOthersGoOn) {
  SystemSession session(two_programs());
  session("continue 20ms; station second; set M0.0=1; station first");
  const std::string stopped = session("continue 1s");
  EXPECT_TRUE(has(stopped, "now at second\nsecond: the CPU went to STOP; the last instruction was in main line 2: STOP"));
  EXPECT_TRUE(has(session("step"), "second is in STOP and executes nothing; 'continue' runs the others"));
  const std::uint64_t of_first = session.stations[0]->plc().executed();
  EXPECT_TRUE(has(session("continue 10ms"), "10 ms of simulated time passed"));
  EXPECT_GT(session.stations[0]->plc().executed(), of_first);
  session("rscan");
  EXPECT_EQ(session.stations[1]->cpu().state().mode, Mode::Run) << "the start of its last scan";
}

TEST(SystemDebugger, DisplayedMemoryIsShownWithItsStation) {
  SystemSession session(two_programs());
  session("continue 20ms; display VW0; station second; display VW2");
  const std::string shown = session("scan");
  EXPECT_TRUE(has(shown, "first: VW0"));
  EXPECT_TRUE(has(shown, "second: VW2"));
}

TEST(SystemDebugger, RestartAndPowerAreOfAllStations) {
  SystemSession session(two_programs());
  session("continue 20ms; restart");
  for (const serial::Simulation* station : session.stations) EXPECT_EQ(station->plc().executed(), 0U);
  session("back");
  EXPECT_GE(session.system().time(), 20 * kMillisecond);
  session("power all 8h");
  for (const serial::Simulation* station : session.stations) EXPECT_EQ(station->cpu().time(), 0);
}

TEST(SystemDebugger, ASavedSessionOfASystemIsLoadedInAnother) {
  const std::string file = test::scratch_folder() + "system_session.json";
  serial::System::Snapshot saved;
  {
    SystemSession session;
    session("continue 100ms; station slave2; set VW20=16#1234; station slave1; set VW20=1; continue 200ms; rscan 3; save " +
            file + " !");
    saved = session.system().snapshot();
  }
  SystemSession session;
  session("load " + file);
  EXPECT_TRUE(session.system().snapshot() == saved);
  EXPECT_TRUE(has(session("who VW20"), "nothing has written VW20")) << "of the master";
  EXPECT_TRUE(has(session("station slave2; who VW20"), "by 'set VW20', from outside"));
  SystemSession other(two_programs());
  EXPECT_TRUE(has(other.error_of("load " + file), "it is of a system of 3 PLCs, not of 2"));
  AtPrompt one(kNested);
  EXPECT_TRUE(has(one.error_of("load " + file), "it is of a system, not of one program"));
}

TEST(SystemDebugger, OneProgramHasNoStations) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session.error_of("station"), "there is one PLC only"));
}

TEST(SystemDebugger, PowerNamesTheRequestsOfAllMastersThatWereUnderWay) {
  const std::string slave = "{program: ../modbus_slave.stl, station: 1}";
  SystemSession session("plcs:\n  near: " + slave + "\n  far: " + slave + "\n  idle: " + slave +
                            "\nlines:\n  a: {stations: [near]}\n  b: {stations: [far]}\n  c: {stations: [idle]}\n",
                        0);
  session("continue 2s; send 01 03; station far; send 02 04; station idle");
  EXPECT_TRUE(has(session("power all"),
                  "under way when power went off, and nobody waits for an answer any more: near: 01 03, far: 02 04\n"));
}

TEST(SystemDebugger, TheFieldOfAPlcHasItsLevelsWhenItsPowerComesBack) {
  SystemSession session;
  session("station slave1; input I0.3=1; continue 50ms; power off; continue 50ms; power on; continue 50ms");
  EXPECT_TRUE(has(session("print I0.3"), "I0.3     1\n"));
}

}  // namespace
}  // namespace s7200::tools::system_debugger_test

// A session with the stations of a system, at the prompt.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "serial_sim/modbus/crc.hpp"
#include "tests/unit/debugger/session.hpp"
#include "tests/unit/debugger/system_bench.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

struct SystemSession : Prompt<SystemBench> {
  explicit SystemSession(std::string_view text = kPolled, std::size_t first = kMaster) : Prompt(text) {
    DebuggerOptions options{};
    for (const PlcPlan& plc : rig->plan().plcs) options.stations.push_back({.name = plc.name});
    options.station = first;
    for (std::size_t peer = 0; peer < rig->plan().peers.size(); ++peer)
      if (const serial::Poller* const poller = rig->poller(peer))
        options.history.pollers.push_back({rig->plan().peers[peer].name, poller});
    debugger = std::make_unique<Debugger>(stations, out, options);
  }
};

/// Two PLCs; `first` counts its scans, `second` goes to STOP when M0.0 is set.
std::string two_programs() {
  const std::string folder = testing::TempDir();
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

/// Two slaves, 1 and 2, and a master on a bridge, which asks stations at their times.
struct BridgedSystem {
  struct Ask {
    Time at;
    std::uint8_t station;
  };

  explicit BridgedSystem(std::vector<Ask> all) : asks(std::move(all)) {
    DebuggerOptions options{};
    for (const PlcPlan& plc : bench.rig->plan().plcs) options.stations.push_back({.name = plc.name});
    options.history.hosts = {&bench.rig->host_port(0)};
    options.history.drive = [this](Time end) { return drive(end); };
    debugger = std::make_unique<Debugger>(bench.stations, out, options);
  }

  serial::Halt drive(Time end) {
    serial::HostPort& port = bench.rig->host_port(0);
    if (!port.state().attached) port.attach(SerialFormat{}, bench.system().time());
    for (;;) {
      const Time next = asked < asks.size() ? asks[asked].at : kNever;
      const serial::Halt halt = bench.system().run_until(std::min(end, next));
      if (halt != serial::Halt::Time || next > end) return halt;
      Bytes request{asks[asked++].station, 0x03, 0x00, 0x00, 0x00, 0x01};
      modbus::add_crc(request);
      std::vector<serial::HostCharacter> frame;
      for (const std::uint8_t byte : request) frame.push_back({.byte = byte, .format = SerialFormat{}});
      port.send(frame, bench.system().time());
    }
  }

  std::string operator()(std::string_view commands) {
    out.str("");
    const auto error = debugger->execute(commands);
    EXPECT_FALSE(error.has_value()) << commands << ": " << *error;
    return out.str();
  }

  SystemBench bench{
      "plcs: {slave: {program: ../modbus_slave.stl, copies: 2, station: 1}}\n"
      "bridges: {host: {tcp: 0}}\n"
      "lines: {bus: {stations: [slave, host]}}\n"};
  std::vector<Ask> asks;
  std::size_t asked = 0;
  std::ostringstream out;
  std::unique_ptr<Debugger> debugger;
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
  const std::string path = testing::TempDir() + name + ".stl";
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

TEST(SystemDebugger, ARequestOfAPlcIsOneThoughAMasterThatPollsWaitsForAnotherStation) {
  SystemSession session("plcs:\n  " + asks_once("a", "05", "a58c", 15) +
                            "\npeers: {scada: {polls: [{station: 9, read: 40001}], every: 4s, timeout: 3s}}\n"
                            "lines: {bus: {stations: [scada, a]}}\n",
                        0);
  EXPECT_TRUE(has(session("break unanswered; continue"), "  05 03 00 0a 00 01 a5 8c  asked by a\n"));
  EXPECT_LT(session.system().time(), 2'600 * kMillisecond);
  EXPECT_TRUE(has(session("continue"), "  09 03 00 00 00 01 85 42  asked by scada\n"));
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
  EXPECT_TRUE(has(session("trace on; continue 1500ms"), "slave2  ignored  01: the PLC has no power\n"));
  session("trace off; power on; continue 100ms; rscan");
  EXPECT_TRUE(session.stations[1]->plc().powered());
  const serial::System::Snapshot there = session.system().snapshot();
  const std::string file = testing::TempDir() + "power_session.json";
  session("save " + file + " !");
  session("at 3s");
  EXPECT_FALSE(session.stations[1]->plc().powered());
  session("at 1900ms");
  EXPECT_TRUE(session.stations[1]->plc().powered());
  SystemSession other(kPollers, 0);
  other("load " + file);
  EXPECT_TRUE(other.system().snapshot() == there);
  Session one(kNested);
  EXPECT_TRUE(has(one.error_of("power off"), "power off is for a PLC of a system"));
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
  const std::string file = testing::TempDir() + "system_session.json";
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
  Session one(kNested);
  EXPECT_TRUE(has(one.error_of("load " + file), "it is of a system, not of one program"));
}

TEST(SystemDebugger, OneProgramHasNoStations) {
  Session session(kNested);
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

}  // namespace
}  // namespace s7200::tools

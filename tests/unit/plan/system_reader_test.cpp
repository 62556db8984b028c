// System files: what is read, and what is complained about, at which place.
#include "tools/plan/reading/system_reader.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/source_path.hpp"
#include "tools/host/files/files.hpp"
#include "tools/plan/reading/event_reader.hpp"
#include "tools/plan/system_keys.hpp"

namespace s7200::tools::system_reader_test {
namespace {

SystemFile read(const std::string& text) {
  return read_system(text, test::source_path("stl_programs/systems/test.yaml"), host_files());
}

TEST(SystemFile, NamesPlcsPeersAndLinesAndWhoIsOnThem) {
  const SystemFile file = read(
      "plcs:\n"
      "  gateway: {program: ../modbus_slave.stl, cpu: 226, ppi_baud: \"9600,187500\", ppi_station: \"7,8\", ppi_second: "
      "refused, station: 9, "
      "set: {VW0: 5}, dump: "
      "[VW0]}\n"
      "  slave: {program: ../modbus_slave.stl, copies: 2, station: 3, ppi_station: 20}\n"
      "peers:\n"
      "  master: {polls: [{station: 3..4, read: 40001, count: 2}, {station: 9, write: 00005, value: 1}], every: 1s}\n"
      "  old: {westinghouse: pc1000-lan, model: pc1250, settings: [unit=07], sync: gateway.Q1.2}\n"
      "lines:\n"
      "  field: {stations: [master, slave, gateway], turn_round: 7ms, faults: [\"noise:ber=0.001\"]}\n"
      "  office: {stations: [gateway.1, old], baud: 19200, parity: none}\n");
  ASSERT_TRUE(file.ok()) << file.file.diagnostics.front().message;
  const SystemPlan& plan = file.plan;
  ASSERT_EQ(plan.plcs.size(), 3U);
  EXPECT_EQ(plan.plcs[0].program->model->name, "226");
  EXPECT_EQ(plan.plcs[2].name, "slave2");
  ASSERT_EQ(plan.peers.size(), 2U);
  EXPECT_EQ(plan.peers[0].polls.requests.size(), 3U);
  EXPECT_EQ(plan.peers[0].polls.pause, 7 * kMillisecond);
  EXPECT_EQ(plan.peers[0].polls.every, kSecond);
  EXPECT_TRUE(plan.peers[1].automaton);
  ASSERT_TRUE(plan.peers[1].sync);
  EXPECT_EQ(plan.peers[1].sync->plc, 0U);
  EXPECT_EQ(plan.peers[1].sync->point, (serial::OutputPoint{1, 2}));
  EXPECT_FALSE(read("plcs: {a: {program: ../modbus_slave.stl}}\npeers: {m: {westinghouse: pc1000-lan, sync: master}}\n"
                    "lines: {l: {stations: [a, m]}}\n")
                   .plan.peers[0]
                   .sync)
      << "the master that joins the line drives it";
  EXPECT_EQ(plan.plcs[0].program->system_block.ppi_rates, (PpiRates{9600, 187500}));
  EXPECT_EQ(plan.plcs[0].program->system_block.ppi_stations, (PpiStations{7, 8}));
  EXPECT_EQ(plan.plcs[0].program->system_block.second_request, SecondRequest::Refused);
  EXPECT_EQ(plan.plcs[1].program->system_block, (SystemBlock{.ppi_rates = {9600, 9600}, .ppi_stations = {20, 20}}));
  EXPECT_EQ(plan.plcs[2].program->system_block.ppi_stations, (PpiStations{21, 21})) << "the next copy";
  ASSERT_EQ(plan.lines.size(), 2U);
  EXPECT_EQ(plan.lines[0].stations.size(), 4U);
  EXPECT_EQ(plan.lines[1].stations[0].port, 1);
  EXPECT_EQ(plan.lines[1].settings.baud, 19200U);
}

TEST(SystemFile, EveryMistakeIsToldAtItsPlace) {
  const std::string slave = "plcs: {a: {program: ../modbus_slave.stl}}\n";
  struct Case {
    std::string text;
    std::uint32_t line, column;
    std::string_view message;
  };
  const std::string with_master =
      slave + "peers: {m: {polls: [{station: 1, read: 40001}]}}\nlines: {l: {stations: [m, a]}}\n";
  const Case cases[] = {
      {"- a\n", 1, 1, "a system file is a map, not a list"},
      {"", 0, 0, "nothing in it"},
      {"a: *x\n", 1, 4, "anchors and aliases (& and *) have no place in a system file"},
      {"plc: {}\n", 1, 1, "'plc' has no place here"},
      {"system: plant.yaml\nsteps: []\n", 2, 8, "'steps' is of a scenario"},
      {slave, 1, 1, "the system has no line"},
      {"plcs: [a]\n", 1, 7, "'plcs' is a map of names, not a list"},
      {"plcs: {a: {}}\n", 1, 8, "PLC 'a' has no program"},
      {"plcs: {a.b: {program: x.stl}}\n", 1, 8, "'a.b' is not a name"},
      {"plcs: {a: {program: nowhere.stl}}\n", 1, 21, "cannot read "},
      {"plcs: {a: {program: ../modbus_slave.stl, cpu: 999}}\n", 1, 47, "there is no model of CPU '999'"},
      {"plcs: {a: {program: ../modbus_slave.stl, station: 248}}\n", 1, 51, "'248' is not a number from 1 to 247"},
      {"plcs: {a: {program: ../modbus_slave.stl, copies: 3, station: 246}}\n", 1, 62, "'246' is not a number from 1 to 245"},
      {"plcs: {a: {program: ../character_echo.stl, station: 2}}\n", 1, 53, "the program moves no constant into VB4095"},
      {"plcs: {a: {program: ../modbus_slave.stl, station: 1, constants: {VB4095: 7}}}\n", 1, 66,
       "'station' and this both set VB4095"},
      {"plcs: {a: {program: ../modbus_slave.stl, constants: {VB7: 1}}}\n", 1, 54, "the program moves no constant to VB7"},
      {"plcs: {a: {program: ../modbus_slave.stl, set: {VX: 1}}}\n", 1, 48, "'VX'"},
      {"plcs: {a: {program: ../modbus_slave.stl, copies: 2, trace: t}}\n", 1, 60, "several copies cannot write one file"},
      {"plcs: {a: {program: ../modbus_slave.stl, trace: t, output: t}}\n", 1, 60, "is written twice, first in line 1"},
      {"plcs: {a: {program: ../modbus_slave.stl, times: none.csv}}\n", 1, 49, "cannot read "},
      {"plcs: {a: {program: ../modbus_slave.stl, clock: noon}}\n", 1, 49,
       "'noon' is not a date and time between 1990 and 2089"},
      {"plcs: {a: {program: ../modbus_slave.stl, clock_error: 50}}\n", 1, 55, "'50' is not from -1000ppm to 1000ppm"},
      {"plcs: {a: {program: ../modbus_slave.stl, trace_instructions: true}}\n", 1, 62, "there is no 'trace'"},
      {slave + "peers: {a: {polls: [{read: 40001}]}}\n", 2, 9, "two stations are called 'a', the first in line 1"},
      {"peers: {m: {}}\n", 1, 9, "'m' is neither a master nor another PLC"},
      {"peers: {m: {polls: []}}\n", 1, 20, "nothing to ask"},
      {"peers: {m: {polls: [{station: 0, read: 40001}]}}\n", 1, 31, "'0' is not a station from 1 to 247"},
      {"peers: {m: {polls: [{station: 1}]}}\n", 1, 21, "what is polled has one of 'read' and 'write'"},
      {"peers: {m: {polls: [{write: 10001, value: 1}]}}\n", 1, 29, "inputs cannot be written"},
      {"peers: {m: {polls: [{read: 40001}]}}\nlines: {}\n", 1, 1, "no line"},
      {"peers: {m: {westinghouse: telex}}\n", 1, 27, "there is no protocol 'telex'"},
      {"peers: {m: {westinghouse: pc1000-lan, settings: [colour=red]}}\n", 1, 50, "'colour=red' is not a setting"},
      {"peers: {m: {westinghouse: modbus, settings: [HR20=1, holding_registers=10]}}\n", 1, 46,
       "HR20 is not there: holding_registers=10"},
      {"peers: {m: {westinghouse: pc1000-lan}}\n", 1, 27, "nothing drives the sync signal"},
      {slave + "peers: {m: {westinghouse: pc1000-lan, sync: a.I0.0}}\n", 2, 45, "'I0.0' is not an output point"},
      {slave + "peers: {m: {westinghouse: pc1000-lan, sync: a.QB0}}\n", 2, 45, "'QB0' is not an output point"},
      {slave + "peers: {m: {westinghouse: pc1000-lan, sync: a.Q9.0}}\n", 2, 45, "Q9.0"},
      {slave + "peers: {m: {westinghouse: pc1000-lan, sync: b.Q0.0}}\n", 2, 45, "'b.Q0.0' is not an output of a PLC"},
      {slave + "peers: {m: {westinghouse: pc1000-lan, sync: Q0}}\n", 2, 45, "'Q0' is not an output of a PLC"},
      {slave + "peers: {m: {westinghouse: hppc, sync: a.Q0.0}}\n", 2, 39, "this PLC has no sync signal, or ignores it"},
      {"plcs: {a: {program: ../character_echo.stl, cpu: 212, clock: 2026-11-21 10:00:00}}\n", 1, 61,
       "CPU 212 has no time-of-day clock"},
      {"plcs: {a: {program: ../modbus_slave.stl, ppi_baud: 38400}}\n", 1, 52, "'38400' is not a rate of PPI"},
      {"plcs: {a: {program: ../modbus_slave.stl, ppi_baud: 187500}}\n", 1, 52, "PPI at 187500 baud needs CPU 22x"},
      {"plcs: {a: {program: ../modbus_slave.stl, ppi_second: later}}\n", 1, 54,
       "'later' is not what a port does with a second request"},
      {"plcs: {a: {program: ../modbus_slave.stl, ppi_station: 127}}\n", 1, 55, "'127' is not a PPI station from 1 to 126"},
      {"plcs: {a: {program: ../modbus_slave.stl, ppi_station: \"3,4\"}}\n", 1, 55,
       "CPU 214 has no port 1 for the second station"},
      {"plcs: {a: {program: ../modbus_slave.stl, copies: 3, ppi_station: 125}}\n", 1, 66,
       "the last copy would be PPI station 127"},
      {"peers: {m: {polls: [{read: 40001}]}}\nlines: {l: {stations: [m], capture: [x.pcap]}}\n", 2, 37,
       "no PLC is on line 'l'"},
      {"peers: {m: {polls: [{read: 40001}]}}\n" + slave + "lines: {l: {stations: [a]}}\n", 1, 9, "'m' is on no line"},
      {"plcs: {a: {program: ../modbus_slave.stl}, b: {program: ../modbus_slave.stl}}\nlines: {l: {stations: [a]}}\n", 1, 43,
       "'b' is on no line"},
      {"plcs: {a: {program: ../modbus_slave.stl, copies: 2}}\nlines: {l: {stations: [a1]}}\n", 1, 8, "'a2' is on no line"},
      {slave + "lines: {l: {stations: [a, b]}}\n", 2, 27, "there is no station 'b'"},
      {slave + "lines: {l: {stations: [a]}, k: {stations: [a]}}\n", 2, 44, "port 0 of 'a' is on a line already"},
      {slave + "lines: {l: {stations: [a.1]}}\n", 2, 24, "CPU 214 has no port 1"},
      {slave + "lines: {l: {stations: [a.x]}}\n", 2, 24, "'a.x' has no port"},
      {slave + "lines: {l: {}}\n", 2, 9, "no one is on line 'l'"},
      {slave + "lines: {l: {stations: [a], baud: 20}}\n", 2, 34, "'20' is not a number from 50 to 1000000"},
      {slave + "lines: {l: {stations: [a], faults: [rain]}}\n", 2, 37, "there is no fault 'rain'"},
      {slave + "lines: {l: {stations: [a], capture: [x.pcap, x.pcap]}}\n", 2, 46, "is written twice"},
      {slave + "lines: {l: {stations: [a]}}\nevents: [{at: 1s}]\n", 3, 10, "nothing is done in this event"},
      {slave + "lines: {l: {stations: [a]}}\nevents: [{power_off: a}]\n", 3, 10, "an event without 'at'"},
      {slave + "lines: {l: {stations: [a]}}\nevents: [{at: 1s, power_off: b}]\n", 3, 30, "there is no PLC 'b'"},
      {slave + "lines: {l: {stations: [a]}}\nevents: [{at: 1s, mend: k}]\n", 3, 25, "there is no line 'k'"},
      {slave + "lines: {l: {stations: [a]}}\nevents: [{at: 1s, cut: l, after: a}]\n", 3, 34,
       "'a' is the last station of line 'l'"},
      {slave + "lines: {l: {stations: [a]}}\nevents: [{at: 1s, cut: l, after: b}]\n", 3, 34, "'b' is not on line 'l'"},
      {with_master + "events: [{at: 1s, power_off: x}]\n", 4, 30, "there is no PLC or peer 'x'"},
      {"peers: {o: {westinghouse: modbus}}\nlines: {l: {stations: [o]}}\nevents: [{at: 1s, power_off: x}]\n", 3, 30,
       "there is no peer 'x'"},
      {slave + "lines: {l: {stations: [a]}}\nevents: [{at: 1s, set: {VW0: 1}}]\n", 3, 10, "'set' without the 'plc'"},
      {slave + "lines: {l: {stations: [a]}}\nevents: [{at: 1s, mend: l, cut: l}]\n", 3, 10, "both 'cut' and 'mend'"},
      {slave + "lines: {l: {stations: [a]}}\nevents: [{at: 1s, power_off: a, after: a}]\n", 3, 33,
       "'after' has no place beside 'power_off'"},
      {slave + "lines: {l: {stations: [a]}}\nevents: [{at: 1s, line: l, mend: l}]\n", 3, 19,
       "'line' has no place beside 'mend'"},
      {"peers: {m: {polls: [{read: 40001, value: 7}]}}\n", 1, 42, "'value' has no place beside 'read'"},
      {"peers: {m: {polls: [{write: 40001, value: 7, count: 300}]}}\n", 1, 53, "'count' has no place beside 'write'"},
      {"peers: {m: {polls: [{write: 40001}]}}\n", 1, 21, "'write' without the 'value' to write"},
      {"peers: {m: {polls: [{read: 40001, count: 126}]}}\n", 1, 42, "126 registers in one request: function 3"},
      {"peers: {m: {polls: [{read: 10001, count: 2001}]}}\n", 1, 42, "2001 inputs in one request: function 2"},
      {"peers: {m: {polls: [{read: 465536, count: 2}]}}\n", 1, 43, "the last is 65535"},
      {"peers: {m: {polls: [{read: 40001}], westinghouse: modbus}}\n", 1, 9, "'m' is both a master and another PLC"},
      {slave + "lines: {l: {stations: [a], turn_round: 5ms}}\n", 2, 40, "no peer on line 'l' is a master"},
      {slave + "lines: {a: {stations: [a]}}\n", 2, 9, "a PLC is called 'a' too"},
      {"bridges: {b: {tcp: 15020}, c: {modbus-tcp: \"127.0.0.1:15020\"}}\n", 1, 44,
       "two bridges at 127.0.0.1:15020, the first in line 1"},
      {"bridges: {b: {tcp: here}}\n", 1, 20, "'here' is not a port from 0 to 65535"},
      {slave + "lines: {l: {stations: [a], faults: [{fault: flip, station: b}]}}\n", 2, 60, "'b' is not on line 'l'"},
      {slave + "lines: {l: {stations: [a], faults: [{station: a}]}}\n", 2, 37, "without the 'fault' itself"},
      {slave + "lines: {l: {stations: [a], faults: [{fault: flip, when: now}]}}\n", 2, 51, "'when' has no place here"},
      {slave + "lines: {l: {stations: [a], faults: [{fault: echo, station: a}]}}\n", 2, 60,
       "the port of an S7-200 does not hear what it sends"},
      {slave + "lines: {l: {stations: [a], faults: [{fault: cut, station: a}]}}\n", 2, 59, "are of the line"},
      {slave + "lines: {l: {stations: [a], faults: [{fault: \"flip:of=answer\", station: a}]}}\n", 2, 51,
       "'of=' says whose it is"},
      {slave + "lines: {l: {stations: [a], faults: [{fault: \"missing:character=2,of=request\", station: a}]}}\n", 2, 66,
       "'of=' says whose it is"},
      {slave + "lines: {l: {stations: [a], faults: [{fault: 'baud:station=master,error=3%', station: a}]}}\n", 2, 51,
       "'station=' says whose it is"},
      {slave + "lines: {l: {stations: [a], faults: [\"flip:character=2,bit=9\"]}}\n", 2, 59, "bit: '9' is not a bit"},
      {slave + "lines: {l: {stations: [a]}}\nevents: [{at: 1s, line: l, fault: flip, station: b}]\n", 3, 50,
       "'b' is not on line 'l'"},
      {"bridges: {b: {}}\n", 1, 11, "'b' is not one kind of bridge"},
      {"bridges: {b: {smoke: x}}\n", 1, 15, "'smoke' has no place here"},
      {"bridges: {b: {tcp: 5020}, c: {tcp: 5020}}\n", 1, 36, "two bridges at 5020, the first in line 1"},
      {slave + "bridges: {b: {tcp: 5020}}\nlines: {l: {stations: [a]}}\n", 2, 11, "'b' is on no line"},
      {slave + "bridges: {b: {tcp: 5020}}\nlines: {l: {stations: [a, b]}}\nevents: [{at: 1s, power_off: b}]\n", 4, 30,
       "'b' is a bridge, which has no power to switch"},
      {"plcs: {a: {program: ../modbus_slave.stl, copies: 32}, b: {program: ../modbus_slave.stl}}\n"
       "lines: {l: {stations: [a, b]}}\n",
       2, 23, "33 stations: a line takes 32"},
  };
  for (const Case& each : cases) {
    const SystemFile file = read(each.text);
    ASSERT_FALSE(file.ok()) << each.text;
    const stl::Diagnostic& first = file.file.diagnostics.front();
    EXPECT_NE(first.message.find(each.message), std::string::npos) << each.text << first.message;
    EXPECT_EQ(first.position.line, each.line) << each.text << first.message;
    EXPECT_EQ(first.position.column, each.column) << each.text << first.message;
  }
}

std::vector<std::string> warnings_of(const std::string& text) {
  const SystemFile file = read(text);
  EXPECT_TRUE(file.ok()) << text;
  std::vector<std::string> warnings;
  for (const stl::Diagnostic& each : file.file.diagnostics) warnings.push_back(each.message);
  return warnings;
}

TEST(SystemFile, PlcsOfOneLineThatMayAnswerAtTheSamePpiStationAreNamed) {
  const auto line = [](std::string_view first, std::string_view second) {
    return fmt::format("plcs: {{a: {{program: {}}}, b: {{program: {}}}}}\nlines: {{bus: {{stations: [a, b]}}}}\n", first,
                       second);
  };
  const std::string_view freeport = "../modbus_slave.stl", other = "../modbus_slave.stl, station: 7",
                         ppi = "../edge_counter.stl";
  using Warnings = std::vector<std::string>;
  const auto both = [](int station) {
    return Warnings{
        fmt::format("PPI station {} on line 'bus' is a, b: they answer at the same time, and the answers collide", station)};
  };
  const auto at = [](std::string_view program, int station) { return fmt::format("{}, ppi_station: {}", program, station); };
  EXPECT_EQ(warnings_of(line(ppi, ppi)), both(2));
  EXPECT_EQ(warnings_of(line(ppi, at(ppi, 3))), Warnings{});
  EXPECT_EQ(warnings_of(line(at(ppi, 3), at(ppi, 3))), both(3));
  EXPECT_EQ(warnings_of(line(at(freeport, 3), at(other, 3))), both(3)) << "someone has set them so";
  EXPECT_EQ(warnings_of(line(freeport, other)), Warnings{}) << "in Freeport mode from the first scan on";
  EXPECT_EQ(
      warnings_of(fmt::format(
          "plcs: {{a: {{program: {0}, cpu: 226}}}}\nlines: {{one: {{stations: [a]}}, two: {{stations: [a.1]}}}}\n", ppi)),
      Warnings{})
      << "two lines";
  EXPECT_EQ(
      warnings_of(fmt::format("plcs: {{a: {{program: {}, cpu: 226}}}}\nlines: {{bus: {{stations: [a, a.1]}}}}\n", ppi)),
      Warnings{"PPI station 2 on line 'bus' is a, a.1: they answer at the same time, and the answers collide"});
}

TEST(SystemFile, PlcsOfOneLineThatAnswerAtTheSameModbusStationAreNamed) {
  const auto warnings = [](std::string_view first, std::string_view second, std::string_view lines) {
    return warnings_of(
        fmt::format("plcs:\n  a: {{program: ../modbus_slave.stl{}}}\n  b: {{program: ../modbus_slave.stl{}}}\n"
                    "lines: {{{}}}\n",
                    first, second, lines));
  };
  constexpr const char *kOneLine = "bus: {stations: [a, b]}", *kTwo = "one: {stations: [a]}, two: {stations: [b]}";
  const auto both = [](int station) {
    return std::vector{fmt::format(
        "Modbus station {} on line 'bus' is a, b: they answer at the same time, and the answers collide", station)};
  };
  EXPECT_EQ(warnings("", "", kOneLine), both(1)) << "as the program has it";
  EXPECT_EQ(warnings(", station: 5", ", station: 5", kOneLine), both(5));
  EXPECT_EQ(warnings(", station: 5", "", kOneLine), std::vector<std::string>{});
  EXPECT_EQ(warnings("", "", kTwo), std::vector<std::string>{});
  EXPECT_EQ(warnings(", cpu: 226", "", "bus: {stations: [a, a.1]}, other: {stations: [b]}"), std::vector<std::string>{})
      << "it answers at one of its ports";
}

TEST(SystemFile, PowerThatStaysAsItIsIsNamed) {
  const std::string system = "plcs: {a: {program: ../modbus_slave.stl}}\nlines: {l: {stations: [a]}}\nevents:\n";
  EXPECT_EQ(warnings_of(system + "  - {at: 2s, power_on: a}\n  - {at: 1s, power_off: a}\n"), std::vector<std::string>{});
  EXPECT_EQ(warnings_of(system + "  - {at: 1s, power_on: a}\n"),
            std::vector<std::string>{"'a' has power already: this does nothing"});
  EXPECT_EQ(warnings_of(system + "  - {at: 1s, power_off: a}\n  - {at: 2s, power_off: a}\n"),
            std::vector<std::string>{"'a' has no power already: this does nothing"});
}

TEST(SystemFile, ALineThatStaysAsItIsIsNamed) {
  const std::string system =
      "plcs: {a: {program: ../modbus_slave.stl, copies: 3, station: 1}}\nlines: {l: {stations: [a]}}\nevents:\n";
  using Warnings = std::vector<std::string>;
  const std::string cut = "  - {at: 1s, cut: l, after: a1}\n", mend = "  - {at: 3s, mend: l}\n";
  EXPECT_EQ(warnings_of(system + cut + "  - {at: 2s, cut: l, after: a2}\n" + mend), Warnings{});
  EXPECT_EQ(warnings_of(system + cut + "  - {at: 2s, cut: l, after: a1}\n" + mend),
            Warnings{"line 'l' is cut there already: this does nothing"});
  EXPECT_EQ(warnings_of(system + mend), Warnings{"line 'l' is not cut: this does nothing"});
  const std::string fault = "  - {at: 1s, fault: flip, line: l}\n", clear = "  - {at: 2s, clear_faults: l}\n";
  EXPECT_EQ(warnings_of(system + fault + clear), Warnings{});
  EXPECT_EQ(warnings_of(system + clear), Warnings{"line 'l' has no fault: this does nothing"});
}

TEST(SystemFile, OfALineWithoutAStationThatCouldBeReadNoneIsNamed) {
  const SystemFile wrong =
      read("plcs: {a: {program: ../modbus_slave.stl}}\nlines: {l: {stations: [b], faults: [{fault: flip, station: q}]}}\n");
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.file.diagnostics.back().message, "'q' is not on line 'l'");
  EXPECT_EQ(wrong.file.diagnostics.back().hint, "");
}

TEST(SystemFile, TheMasterOfALineIsOneOfItsStations) {
  const std::string system =
      "plcs: {a: {program: ../modbus_slave.stl}, b: {program: ../edge_counter.stl}}\nlines: {l: {stations: [a, b], master: ";
  EXPECT_EQ(read(system + "b}}\n").plan.lines.at(0).master, 1U);
  const SystemFile wrong = read(system + "c}}\n");
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.file.diagnostics.front().message, "'c' is not on line 'l'");
}

TEST(SystemFile, ASystemTakesAThousandStations) {
  std::string text = "plcs: {a: {program: ../modbus_slave.stl}}\npeers:\n";
  for (int i = 0; i < 500; ++i) text += fmt::format("  m{}: {{polls: [{{read: 40001}}]}}\n", i);
  text += "bridges:\n";
  for (int i = 0; i < 500; ++i) text += fmt::format("  b{}: {{tcp: 0}}\n", i);
  const SystemFile file = read(text);
  ASSERT_FALSE(file.ok());
  const auto& diagnostics = file.file.diagnostics;
  const auto too_many = std::ranges::find_if(
      diagnostics, [](const stl::Diagnostic& d) { return d.message.starts_with("more than 1000 stations"); });
  ASSERT_NE(too_many, diagnostics.end());
  EXPECT_EQ(too_many->position.line, 1003U) << "b499, the thousand and first";
}

TEST(SystemFile, ANameThatATerminalWouldObeyIsRefusedWhereverItStands) {
  for (const std::string name : {"p\\e[31mX\\e]0;owned\\a", "a\\0b", "\\x9b1m", "a\\u202eb", "a\\nb"})
    for (const std::string map : {"plcs", "peers", "bridges", "lines"}) {
      const std::string text = fmt::format("{}: {{\"{}\": {{}}}}\n", map, name);
      const SystemFile file = read(text);
      const auto is_said = [](const stl::Diagnostic& d) { return d.hint.starts_with("a name has no"); };
      EXPECT_TRUE(std::ranges::any_of(file.file.diagnostics, is_said)) << text;
    }
}

TEST(SystemFile, ANameOfAFileWithNulIsRefused) {
  const std::string plc = "plcs: {a: {program: ../modbus_slave.stl";
  for (const std::string& text :
       {std::string("plcs: {a: {program: \"../modbus_slave.stl\\0.x\"}}\nlines: {l: {stations: [a]}}\n"),
        plc + ", memory: \"m\\0x\"}}\nlines: {l: {stations: [a]}}\n",
        plc + ", with: [\"s\\0x\"]}}\nlines: {l: {stations: [a]}}\n",
        plc + "}}\nlines: {l: {stations: [a], capture: [\"c\\0.pcap\"]}}\n",
        plc + "}}\nbridges: {b: {pty: \"l\\0x\"}}\nlines: {l: {stations: [a, b]}}\n"}) {
    const SystemFile file = read(text);
    const auto is_said = [](const stl::Diagnostic& d) {
      return d.message.ends_with("has the character NUL in it, which no name can have");
    };
    EXPECT_TRUE(std::ranges::any_of(file.file.diagnostics, is_said)) << text;
  }
}

TEST(SystemFile, EachBridgeAtPort0GetsAPortOfItsOwn) {
  const SystemFile file = read(
      "plcs: {a: {program: ../modbus_slave.stl}}\n"
      "bridges: {x: {tcp: \"127.0.0.1:0\"}, y: {tcp: \"127.0.0.1:0\"}, z: {modbus-tcp: 0}}\n"
      "lines: {l: {stations: [a, x, y, z]}}\n");
  EXPECT_TRUE(file.ok()) << file.file.diagnostics.front().message;
}

TEST(SystemFile, ACableIsCutAfterAStationAsItIsWrittenOnItsLine) {
  const std::string plcs = "plcs: {a: {program: ../modbus_slave.stl, cpu: 226}, b: {program: ../modbus_slave.stl}}\n";
  for (const char* const after : {"a", "a.1"}) {
    const SystemFile file =
        read(fmt::format("{}lines: {{l: {{stations: [a.1, b]}}}}\nevents: [{{at: 1s, cut: l, after: {}}}]\n", plcs, after));
    ASSERT_TRUE(file.ok()) << after;
    EXPECT_EQ(file.plan.events.at(0).near, 1U) << after;
  }
}

TEST(SystemFile, WhereThereIsNoPlcTheAdviceSaysSo) {
  const SystemFile file = read(
      "peers: {o: {westinghouse: modbus}}\nlines: {l: {stations: [o]}}\n"
      "events: [{at: 1s, set: {VB0: 1}, plc: x}]\n");
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.file.diagnostics.front().hint, "there is no PLC in this system");
}

TEST(SystemFile, EveryEventHasItsWordAndTheTableOfKeysHasAllOfThem) {
  const auto is_key = [](std::string_view word) {
    return std::ranges::any_of(system_keys(),
                               [&](const SystemKey& k) { return k.where == SystemKey::Where::Event && k.key == word; });
  };
  for (const EventWord& each : event_words()) {
    EXPECT_EQ(&word_of(each.what), &each) << each.word;
    EXPECT_TRUE(is_key(each.word)) << each.word;
    for (const std::string_view beside : each.beside) EXPECT_TRUE(is_key(beside)) << beside;
  }
}

TEST(SystemFile, AProgramWithErrorsIsShownWithItsOwnLines) {
  const SystemFile file = read("plcs: {a: {program: ../modbus_master.stl, cpu: 214}}\n");
  ASSERT_EQ(file.programs.size(), 1U);
  EXPECT_FALSE(file.programs.front().diagnostics.empty());
}

TEST(SystemFile, EventsAreCheckedWhenAProgramHasErrors) {
  const std::string bad =
      "plcs: {a: {program: ../modbus_master.stl, cpu: 214, copies: 2}, b: {program: ../modbus_slave.stl}}\n"
      "lines: {l: {stations: [a, b]}}\nevents:\n";
  const auto messages = [&](const std::string& event) {
    std::vector<std::string> found;
    for (const stl::Diagnostic& each : read(bad + "  - {at: 1s, " + event + "}\n").file.diagnostics)
      found.push_back(each.message);
    return found;
  };
  const std::string error = test::source_path("stl_programs/modbus_master.stl") + " has errors";
  using Messages = std::vector<std::string>;
  EXPECT_EQ(messages("power_off: c"), (Messages{error, "there is no PLC 'c'"}));
  EXPECT_EQ(
      messages("set: {VX: 1}, plc: b"),
      (Messages{error, read("plcs: {b: {program: ../modbus_slave.stl, set: {VX: 1}}}\n").file.diagnostics.front().message}));
  for (const char* const right : {"power_off: a2", "set: {VW0: 1}, plc: a1", "cut: l, after: a2"})
    EXPECT_EQ(messages(right), Messages{error}) << right;
}

TEST(SystemFile, EveryKeyStandsInTheTableOnce) {
  for (const SystemKey& key : system_keys())
    EXPECT_EQ(
        std::ranges::count_if(system_keys(), [&](const SystemKey& k) { return k.where == key.where && k.key == key.key; }),
        1)
        << key.key;
}

/// A system with all kinds of entries, in which `key` has a value that no key takes, on a line of its own.
std::string with_nonsense_at(const SystemKey& key) {
  using Where = SystemKey::Where;
  using Entries = std::vector<std::pair<std::string_view, std::string>>;
  const auto map = [&key](Where where, const Entries& usual) {
    std::string text;
    for (const auto& [name, value] : usual)
      if (where != key.where || name != key.key) text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", name, value);
    if (where == key.where) text += fmt::format("{}\n{}: [[nonsense]]\n", text.empty() ? "" : ", ", key.key);
    return "{" + text + "}";
  };
  const auto in = [&key](Where where, std::initializer_list<std::string_view> keys) {
    return key.where == where && std::ranges::find(keys, key.key) != keys.end();
  };
  Entries poll{{"read", "40001"}}, event{{"at", "1s"}}, bridge;
  if (in(Where::Poll, {"write", "value"})) poll = {{"write", "40001"}};
  if (in(Where::Event, {"at"})) event.emplace_back("power_off", "a");
  if (in(Where::Event, {"after"})) event.emplace_back("cut", "bus");
  if (in(Where::Event, {"plc"})) event.emplace_back("set", "{VW0: 1}");
  if (in(Where::Event, {"line", "station"})) event.emplace_back("fault", "parity:character=each");
  if (in(Where::Event, {"fault", "station"})) event.emplace_back("line", "bus");
  if (in(Where::Event, {"set"})) event.emplace_back("plc", "a");
  if (key.where != Where::Event) event.emplace_back("power_off", "a");
  if (key.where != Where::Bridge) bridge.emplace_back("pty", "link");
  const std::string fault = map(Where::Fault, {{"fault", "parity:character=each"}, {"station", "a"}});
  const std::string peers =
      fmt::format("{{m: {}, o: {}}}", map(Where::Master, {{"polls", "[" + map(Where::Poll, poll) + "]"}}),
                  map(Where::OtherPlc, {{"westinghouse", "modbus"}}));
  return map(Where::File,
             {{"plcs", "{a: " + map(Where::Plc, {{"program", "../modbus_slave.stl"}}) + "}"},
              {"peers", peers},
              {"bridges", "{b: " + map(Where::Bridge, bridge) + "}"},
              {"lines", "{bus: " + map(Where::Line, {{"stations", "[a, m, o, b]"}, {"faults", "[" + fault + "]"}}) + "}"},
              {"events", "[" + map(Where::Event, event) + "]"}});
}

TEST(SystemKeys, EachRowHasAReader) {
  for (const SystemKey& key : system_keys()) {
    const std::string text = with_nonsense_at(key);
    const auto line = static_cast<std::uint32_t>(std::ranges::count(text.substr(0, text.find("[[nonsense]]")), '\n') + 1);
    const SystemFile file = read_system(text, test::source_path("stl_programs/systems/test.yaml"), host_files());
    EXPECT_TRUE(std::ranges::any_of(file.file.diagnostics,
                                    [&](const stl::Diagnostic& d) {
                                      return d.severity == stl::Severity::Error && d.position.line == line &&
                                             d.message.find("has no place") == std::string::npos;
                                    }))
        << text << (file.file.diagnostics.empty() ? "accepted" : file.file.diagnostics.front().message);
  }
}

}  // namespace
}  // namespace s7200::tools::system_reader_test

#include "tools/plan/plc_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "interpreter/base/ppi_frame.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "serial_sim/line/line.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "tools/plan/clock_text.hpp"

namespace s7200::tools {
namespace {

using Shape = PlcKey::Shape;
using Stage = PlcKey::Stage;
using Group = PlcKey::Group;

constexpr std::string_view kClock = "\"2026-11-21 10:00:00\"";
constexpr Time kLatestStart = 24 * 3600 * kSecond;

/// For a value that is to be `what`.
WrongValueOfKey not_such(std::string_view text, std::string_view what, std::string_view example) {
  return {fmt::format("'{}' is not {}", stl::shortened(std::string(text)), what),
          fmt::format("write for example {}", example)};
}

/// Reads a part of the system block, for a CPU that is known.
template <class Part, class Parse>
WrongValueOfKey take_part(Part& part, std::string_view text, const AddressSpace* space, Parse parse) {
  if (!space) return {};
  const auto read = parse(text, space->model);
  if (read) part = *read;
  return {read.why()};
}

WrongValueOfKey take_second(PlcSettings& settings, std::string_view text, const AddressSpace* space) {
  if (!space) return {};
  const auto read = parse_second_request(text);
  if (read) settings.system_block.second_request = *read;
  return {read.why()};
}

WrongValueOfKey take_assignment(PlcSettings& settings, std::string_view text, const AddressSpace* space) {
  const auto assignment = space ? parse_assignment(text, *space) : std::nullopt;
  if (assignment) settings.set.push_back(*assignment);
  return {assignment.why()};
}

WrongValueOfKey take_clock(PlcSettings& settings, std::string_view text, const AddressSpace* space) {
  settings.clock = parse_clock(text);
  if (!settings.clock) return not_such(text, "a date and time between 1990 and 2089", kClock);
  return {space ? why_no_clock(space->model) : ""};
}

WrongValueOfKey take_clock_error(PlcSettings& settings, std::string_view text, const AddressSpace* /*space*/) {
  const auto error = parse_clock_error(text);
  if (!error) return not_such(text, "from -1000ppm to 1000ppm", "50ppm");
  settings.clock_error = *error;
  return {};
}

WrongValueOfKey take_start(PlcSettings& settings, std::string_view text, const AddressSpace* /*space*/) {
  const auto starts = text == "0" ? Time{0} : parse_duration(text);
  if (!starts || *starts > kLatestStart) return not_such(text, "a duration with its unit, of a day at most", "250ms, 2s, 0");
  settings.starts = *starts;
  return {};
}

WrongValueOfKey take_power_off(PlcSettings& settings, std::string_view text, const AddressSpace* /*space*/) {
  const auto off = parse_duration_in(text, {0, kLongestDuration});
  if (off) settings.memory.power_off = *off;
  return {off.why()};
}

WrongValueOfKey take_signals(PlcSettings& settings, std::string_view text, const AddressSpace* space) {
  const auto signals = space ? parse_signals(text, *space) : std::nullopt;
  if (signals) settings.signals.insert(settings.signals.end(), signals->begin(), signals->end());
  return {signals.why()};
}

WrongValueOfKey take_dump(PlcSettings& settings, std::string_view text, const AddressSpace* space) {
  const auto range = space ? parse_range(text, *space) : std::nullopt;
  if (!range) return {range.why()};
  settings.dumps.push_back(*range);
  settings.dump_names.emplace_back(text);
  return {};
}

/// Fills in a text or a flag as it stands.
template <auto Member, auto Value>
WrongValueOfKey take_as(PlcSettings& settings, std::string_view /*text*/, const AddressSpace* /*space*/) {
  settings.*Member = Value;
  return {};
}

template <auto Member>
WrongValueOfKey take_path(PlcSettings& settings, std::string_view text, const AddressSpace* /*space*/) {
  settings.*Member = text;
  return {};
}

template <auto Member>
std::string path_text(const PlcSettings& settings) {
  return settings.*Member;
}

std::string clock_text(const PlcSettings& settings) {
  if (!settings.clock) return {};
  const ClockTime& c = *settings.clock;
  return fmt::format("20{:02}-{:02}-{:02} {:02}:{:02}:{:02}", c.year, c.month, c.day, c.hour, c.minute, c.second);
}

std::string clock_error_text(const PlcSettings& settings) {
  return settings.clock_error == 0 ? std::string() : fmt::format("{}ppm", settings.clock_error);
}

/// A part of the system block in quotes, if it is not as a CPU is delivered.
template <auto Part>
std::string part_text(const PlcSettings& settings) {
  const auto& part = settings.system_block.*Part;
  return part == SystemBlock{}.*Part ? std::string() : fmt::format("\"{}\"", s7200::to_text(part));
}

std::string second_text(const PlcSettings& settings) {
  const SecondRequest second = settings.system_block.second_request;
  return std::string(second == SystemBlock{}.second_request ? "" : s7200::to_text(second));
}

std::string retain_text(const PlcSettings& settings) {
  const auto& retentive = settings.system_block.retentive;
  return retentive ? fmt::format("\"{}\"", s7200::to_text(*retentive)) : std::string();
}

// clang-format off
std::vector<PlcKey> rows() {
  const std::string delivered_rates = s7200::to_text(SystemBlock{}.ppi_rates), delivered_stations = s7200::to_text(SystemBlock{}.ppi_stations);
  const std::string_view delivered_second = s7200::to_text(SystemBlock{}.second_request);
  return {
    {.name = "program", .of_system = true, .form = "PATH", .meaning = "STL file or published document, from the folder of this file"},
    {.name = "with", .shape = Shape::List, .of_system = true, .of_scenario = true, .form = "LIST", .meaning = "paths of the other files of the program's project: symbol tables, data blocks, blocks"},
    {.name = "repair", .of_system = true, .form = "TEXT", .meaning = "slips of a published listing to repair, as `s7200 check` names them: `R1,R2` or `all`"},
    {.name = "cpu", .of_system = true, .of_scenario = true, .form = "TYPE", .meaning = "that of the program's head or of `s7200.yaml` if left out, else the first of 214, 224, 226, 224XP that can run it"},
    {.name = "times", .of_system = true, .of_scenario = true, .form = "TABLE", .meaning = "execution times: the name of a table, or the path of a CSV file as `s7200 times --csv` writes it"},

    {.name = "ppi_baud", .stage = Stage::Cpu, .of_system = true, .of_scenario = true, .form = "NUMBER",
     .meaning = fmt::format("rate of ports in PPI mode, as the system block sets it: {}; `\"9600,187500\"` is port 0 and port 1; {} if left out", ppi_rates_text(), delivered_rates),
     .option = {"BAUD[,BAUD]", fmt::format("rate of PPI: {}; 9600,187500: port 0 and port 1 [{}]", ppi_rates_text(), delivered_rates)},
     .take = [](PlcSettings& to, std::string_view text, const AddressSpace* space) { return take_part(to.system_block.ppi_rates, text, space, parse_ppi_rates); },
     .text = part_text<&SystemBlock::ppi_rates>},
    {.name = "ppi_station", .stage = Stage::Cpu, .of_system = true, .of_scenario = true, .form = "NUMBER",
     .meaning = fmt::format("PPI station of ports until the program's SPA sets another, as the system block sets it, 1 to {}; `\"3,4\"` is port 0 and port 1; {} if left out", ppi::kLastStation, delivered_stations),
     .option = {"NUMBER[,NUMBER]", fmt::format("PPI station until SPA sets another, 1 to {}; 3,4: port 0 and port 1 [{}]", ppi::kLastStation, delivered_stations)},
     .take = [](PlcSettings& to, std::string_view text, const AddressSpace* space) { return take_part(to.system_block.ppi_stations, text, space, parse_ppi_stations); },
     .text = part_text<&SystemBlock::ppi_stations>},
    {.name = "ppi_second", .stage = Stage::Cpu, .of_system = true, .of_scenario = true, .form = "WORD",
     .meaning = fmt::format("what becomes of a PPI master's request before it has fetched the answer to the last one: `{}`, it takes its place, or `{}`, there is no resource; `{}` if left out", kSecondRequestWords[0], kSecondRequestWords[1], delivered_second),
     .option = {"WORD", fmt::format("what becomes of a PPI master's request before it has fetched the answer to the last one: it {} that one, or is {} [{}]", kSecondRequestWords[0], kSecondRequestWords[1], delivered_second)},
     .take = take_second, .text = second_text},
    {.name = "retain", .stage = Stage::Cpu, .of_system = true, .of_scenario = true, .form = "RANGES",
     .meaning = "memory that survives power off, as the system block sets it: up to six ranges of V, M, T0–T31, T64–T95 and C, as `VB0:100,MB0:14,T0:32,C0:5`, or `none`; if left out those that the CPU is delivered with",
     .option = {"RANGES", "memory that survives power off: VB0:100,MB0:14,T0:32,C0:5, or none [as the CPU is delivered]"},
     .take = [](PlcSettings& to, std::string_view text, const AddressSpace* space) { return take_part(to.system_block.retentive, text, space, parse_retentive); },
     .text = retain_text},

    {.name = "copies", .of_system = true, .form = "NUMBER", .meaning = fmt::format("how many PLCs like this one, 1 to {}; each has a number after the name: `slave1`, `slave2`, …; `station` and `ppi_station` go up by one with each", serial::Line::kDrivers)},
    {.name = "station", .of_system = true, .form = "NUMBER", .meaning = fmt::format("address on the line, 1 to {}: the constant that the program moves into VB4095, as our slaves and Application Tip 41 do", modbus::kLastStation)},
    {.name = "constants", .shape = Shape::Map, .of_system = true, .form = "MAP", .meaning = "constants that the program moves to an address with MOVB, MOVW or MOVD, instead of its own: `{SMB30: 16#45}`"},

    {.name = "set", .stage = Stage::Program, .shape = Shape::Map, .of_system = true, .form = "MAP", .meaning = "memory and inputs before the first scan: `{VW20: 16#1234, I0.3: 1}`",
     .example = "{VW20: 5, I0.3: 1}",
     .option = {"ADDRESS=VALUE", "memory or inputs before the first scan: VW100=5, I0.3=1; symbols too, Speed=7; SM0.7=0 (repeatable)", Group::Memory},
     .take = take_assignment},
    {.name = "input", .stage = Stage::Program, .shape = Shape::Read, .of_system = true, .of_scenario = true, .form = "PATH", .meaning = "inputs over time, I, AIW, the potentiometers SMB28 and SMB29 and the mode switch SM0.7: CSV in the format of `s7200 run --input`",
     .option = {"FILE", "inputs over time: CSV rows such as 10ms,I0.3,1 (s7200 help files)", Group::Memory},
     .take = take_path<&PlcSettings::input>, .text = path_text<&PlcSettings::input>},
    {.name = "clock", .stage = Stage::Program, .of_system = true, .of_scenario = true, .form = "TIME", .meaning = "time of day at the start: `2026-11-21 10:00:00`",
     .option = {"\"YYYY-MM-DD HH:MM:SS\"", "time of day at the start"},
     .take = take_clock, .text = clock_text},
    {.name = "clock_error", .stage = Stage::Program, .of_system = true, .of_scenario = true, .form = "NUMBERppm", .meaning = "how far its crystal is off, `50ppm` is too fast: all that it counts by its clock, and its scans as a whole, but not the bits of its ports, of which a fault `baud` is, and not PTO and PWM; `0ppm` if left out, from -1000ppm to 1000ppm",
     .option = {"NUMBERppm", "how far the crystal of the PLC is off, 50ppm: too fast; its ports are not concerned (-1000ppm to 1000ppm) [0ppm]"},
     .take = take_clock_error, .text = clock_error_text},
    {.name = "starts", .stage = Stage::Program, .of_system = true, .form = "TIME", .meaning = "when it is powered up, `0s` if left out; of `copies` each as much later than the one before, so that they are not in step",
     .take = take_start},
    {.name = "memory", .stage = Stage::Program, .shape = Shape::Written, .of_system = true, .form = "PATH", .meaning = "retentive memory, EEPROM and clock: read at the start if it exists, written at the end",
     .option = {"FILE", "keep retentive memory and EEPROM; with the clock, read at power-up if FILE exists, written at the end", Group::Memory},
     .take = [](PlcSettings& to, std::string_view text, const AddressSpace*) { to.memory.path = text; return WrongValueOfKey{}; },
     .text = [](const PlcSettings& of) { return of.memory.path; }},
    {.name = "ram_lost", .stage = Stage::Program, .shape = Shape::Flag,
     .option = {"", "power was off too long: only the EEPROM of --memory is left, SM0.2 is 1", Group::More, "memory"},
     .take = [](PlcSettings& to, std::string_view, const AddressSpace*) { to.memory.ram_lost = true; return WrongValueOfKey{}; }},
    {.name = "power_off", .stage = Stage::Program,
     .option = {"TIME", "how long power was off since --memory was written [0s]", Group::More, "memory", "ram_lost"},
     .take = take_power_off},
    {.name = "trace", .stage = Stage::Program, .shape = Shape::Written, .of_system = true, .form = "PATH", .meaning = "interrupts, characters, attachments and errors are written there",
     .option = {"FILE", "write what happens in the CPU, as text, .jsonl or .json; --signals as .vcd or .csv; - is standard output", Group::Results},
     .take = take_path<&PlcSettings::trace>, .text = path_text<&PlcSettings::trace>},
    {.name = "trace_instructions", .stage = Stage::Program, .shape = Shape::Flag, .of_system = true, .form = "true, false", .meaning = "every instruction is traced too; `false` if left out",
     .option = {"", "trace every instruction too, with its operand values: its line has the time of its begin, below what it did", Group::More, "trace"},
     .take = take_as<&PlcSettings::trace_detail, TraceDetail::Instructions>},
    {.name = "trace_events", .stage = Stage::Program, .shape = Shape::Flag,
     .option = {"", "leave out the way of the main program, why a frame got no answer and how long an instruction took: faster", Group::More, "trace", "trace_instructions"},
     .take = take_as<&PlcSettings::trace_detail, TraceDetail::Events>},
    {.name = "signals", .stage = Stage::Program, .shape = Shape::List, .of_system = true, .form = "LIST", .meaning = "what a trace as .vcd, .csv or .json shows over time: `[Q0.0, VW20, INT, PORT0.TXD]`",
     .example = "[Q0.0, VW20, INT, PORT0]",
     .option = {"SIGNAL,…", "what a trace as .vcd, .csv or .json shows over time: addresses, symbols, INT123, INT for every interrupt routine, PORT0.RXD, PORT0.TXD, PORT0.LINE, or PORT0 for all three (repeatable)", Group::More, "trace"},
     .take = take_signals},
    {.name = "output", .stage = Stage::Program, .shape = Shape::Written, .of_system = true, .form = "PATH", .meaning = "each change of an output is written there: CSV, or waves if it ends in .vcd",
     .option = {"FILE", "write each change of an output (Q, AQ): CSV, or waves in FILE.vcd; - is standard output", Group::Memory},
     .take = take_path<&PlcSettings::output>, .text = path_text<&PlcSettings::output>},
    {.name = "dump", .stage = Stage::Program, .shape = Shape::List, .of_system = true, .form = "LIST", .meaning = "memory to show at the end: `[VB0:16, VW100]`",
     .example = "[VB0:16, VW100]",
     .option = {"ADDRESS[:COUNT]", "memory to show at the end: VB0:16, VW100, AC0, VD20:real; symbols too, Speed (repeatable)", Group::Memory},
     .take = take_dump},
  };
}
// clang-format on

}  // namespace

std::span<const PlcKey> plc_keys() {
  static const std::vector<PlcKey> kRows = rows();
  return kRows;
}

std::string option_of(std::string_view key) {
  std::string option = "--" + std::string(key);
  std::ranges::replace(option, '_', '-');
  return option;
}

bool says_anything(const PlcSettings& settings, PlcKey::Stage stage) {
  return std::ranges::any_of(
      plc_keys(), [&](const PlcKey& key) { return key.stage == stage && key.text && !key.text(settings).empty(); });
}

}  // namespace s7200::tools

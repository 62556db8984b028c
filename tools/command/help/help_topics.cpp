#include "tools/command/help/help_topics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/cpu_model.hpp"
#include "interpreter/model/times/named_times.hpp"
#include "interpreter/program/checking/warnings.hpp"
#include "tools/host/serial_device.hpp"
#include "tools/master/protocol.hpp"
#include "tools/plan/bridge_kinds.hpp"
#include "tools/plan/system_keys.hpp"
#include "tools/recordings/recording.hpp"
#include "tools/scenario/reading/keys.hpp"
#include "tools/session/commands/rows/command_table.hpp"
#include "tools/slave/slave_target.hpp"
#include "tools/views/state/faults.hpp"

namespace s7200::tools {
namespace {

std::string bridges() {
  std::string text = "A bridge joins the simulated line to masters outside, in real time; one at a time:\n";
  for (const BridgeRow& row : kBridges)
    if (row.kind != BridgeKind::Pty || has_ptys())
      text += fmt::format("  {:<32}{}\n", fmt::format("{} {}", row.option, row.place), row.meaning);
  text += "Without ADDRESS a server is for this computer only. All clients of one bridge share the line, as on RS-485.\n";
  if (has_ptys())
    text +=
        "A pty shows the rate, stop bits and odd parity of its client, but none and even parity only if the client sets "
        "INPCK, and never 7 data bits: otherwise these are the program's, or what --parity and --data-bits say.\n";
  return text + fmt::format(
                    "'run' with a bridge serves until Ctrl-C or SIGTERM, unless --for or --scans ends it.\n"
                    "Example: s7200 run stl_programs/modbus_slave.stl {}\n",
                    has_ptys() ? "--pty plc" : "--device COM3");
}

std::string faults() {
  std::string text = "Faults of the line, for --fault of run, send, master and debug; KIND or KIND:PARAMETER=VALUE,…:\n";
  text += fault_kinds_text();
  text += "Their parameters, each where it makes sense; a wrong one is answered with those that a fault has:\n";
  for (const serial::FaultParameter& parameter : serial::fault_parameters())
    text += fmt::format("  {:<12} {:<24} {}\n", parameter.name, parameter.values, parameter.meaning);
  return text + "Example: s7200 send stl_programs/modbus_slave.stl --crc 0103000a0001 --fault flip:character=3,bit=5\n";
}

std::string files() {
  return "Files that options name, for run, send, master and debug:\n"
         "  --input FILE    inputs over time, a row of CSV for each change, in the order of time:\n"
         "                  10ms,I0.3,1               an input point, or a symbol of one\n"
         "                  1s,AIW0,6400              an analog input\n"
         "                  1s,I0.6,pulses,5kHz,200ms pulses, for 200 ms\n"
         "                  2s,SMB28,128              a potentiometer, SMB28 or SMB29\n"
         "                  4s,SM0.7,0                the mode switch: 1 RUN, 0 TERM\n"
         "                  Semicolons or tabs may separate instead, with decimal commas, as spreadsheets write them.\n"
         "  --output FILE   each change of an output (Q, AQ): CSV, or waves if the name ends in .vcd; - is standard output\n"
         "  --memory FILE   retentive memory, EEPROM and clock: read at power-up if the file exists, written at the end; "
         "--power-off says how long power was off, --ram-lost that it was too long\n"
         "  --trace FILE    what happens in the CPU, with its time: interrupts, characters, attachments, errors, the way "
         "of the main program; with --trace-instructions each instruction. FILE.jsonl gets JSON lines for other "
         "programs, FILE.json events for the viewers of Perfetto and Chrome; FILE.vcd and FILE.csv get the values of "
         "--signals over time: memory, interrupt routines, the levels at a port (PORT0)\n"
         "  --capture FILE  the line: levels in FILE.vcd, for sigrok and waveform viewers; frames in FILE.pcap, for "
         "Wireshark and 's7200 decode'\n"
         "An existing file is replaced only if the same option wrote it; links are not followed. You can read a record "
         "while it grows; it ends at 1 GB, or where --record-limit says.\n";
}

/// Tables of Markdown, as columns: `  key: FORM  meaning`.
std::string as_columns(const std::string& markdown) {
  std::string text;
  for (const std::string& line : stl::split_lines(markdown)) {
    if (!line.starts_with('|') || line.starts_with("|---")) continue;
    std::vector<std::string> cells;
    for (std::string_view rest = std::string_view(line).substr(1); rest.find('|') != std::string_view::npos;) {
      std::string cell(stl::trim(rest.substr(0, rest.find('|'))));
      std::erase(cell, '`');
      cells.push_back(std::move(cell));
      rest.remove_prefix(rest.find('|') + 1);
    }
    const bool is_heading = cells.size() < 2 || cells.back().empty();
    if (is_heading)
      text += fmt::format("{}:\n", cells.front());
    else if (cells.size() == 2)
      text += fmt::format("  {:<26}  {}\n", cells[0], cells[1]);
    else
      text += fmt::format("  {:<26}  {} (beside: {})\n", cells[0], cells[2], cells[1]);
  }
  return text;
}

std::string keys() {
  return "What a system file may contain; stl_programs/systems/README.md has examples.\n" +
         as_columns(system_keys_markdown()) +
         "\nWhat a scenario for 's7200 test' may contain; tests/programs/README.md has examples.\n" +
         as_columns(scenario_keys_markdown());
}

std::string models() {
  std::string text = "CPUs that are modelled, for --cpu:\n";
  for (const CpuModel* cpu : all_cpus())
    text += fmt::format("  {:<8}{:>6} bytes of V memory, {} port{}, {} timers, {} counters, EEPROM for V0 to V{}{}\n",
                        cpu->name, cpu->size_of(Area::V), cpu->ports, cpu->ports == 1 ? "" : "s", cpu->size_of(Area::T),
                        cpu->size_of(Area::C), cpu->eeprom_bytes - 1,
                        cpu->sold_as.empty() ? "" : fmt::format("; sold as CPU {}", cpu->sold_as));
  return text +
         "Without --cpu a program runs on the CPU that its head or the s7200.yaml in its folder names, otherwise on a "
         "CPU 214, or the first of 224, 226, 224XP and the others that can run it, which is said.\n"
         "Models of the Westinghouse family: s7200 help westinghouse.\n";
}

std::string programs() {
  return "A PROGRAM is one of these; - is standard input:\n"
         "  an STL listing     .stl, .awl or .txt, in the notation of Micro/WIN, of Micro/DOS (K4) or in German letters\n"
         "  an export          the blocks that Micro/WIN writes with File, Export\n"
         "  a document         a published one with a listing in it, such as Application Tip 41\n"
         "The symbol table and the data block of a project are more files of the same program: 'run', 'debug', 'check' and "
         "'convert' take them one after the other, 'send' and 'master' with --with FILE, a scenario with 'with:'. A .mwp "
         "project cannot be read.\n"
         "Text may be UTF-8, UTF-16, Windows-1250 to -1254, CP437, GBK or Shift-JIS. Blanks, quotes, HTML, Markdown and "
         "line numbers "
         "from web pages and books are read as what they stand for; a note says so.\n"
         "Routines of Micro/WIN's Modbus library are in no export: stand-ins of ours take their place, unless "
         "--no-stand-ins refuses that.\n"
         "--repair R1,R2 or all repairs the slips of a published listing that 's7200 check' names.\n"
         "run, send, master, test, debug, view and dap take a system file (.yaml) too: s7200 help systems.\n";
}

std::string recordings() {
  return fmt::format(
      "Recordings that 'decode' and 'import-capture' read:\n  {}\n"
      "Given a serial device or tcp://HOST:PORT instead, they listen until Ctrl-C or --for, and send nothing. Times are "
      "then "
      "those of arrival: a USB adapter delivers up to 16 ms late.\n"
      "Tables may be those of Markdown or of a web page, or drawn. Bytes may be hex, marked as a language does, decimal or "
      "binary; frames of Modbus ASCII are read as well. docs/recordings.md lists the notations.\n"
      "A pcap does not say which characters had parity errors. Behind a --pty of 's7200 run' only what the simulated line "
      "says is heard, not what others ask it. Messages of Modbus TCP are shown as on a serial line, with CRCs that are not "
      "in the recording.\n",
      stl::joined(recording_forms(), &RecordingForm::meaning, "\n  "));
}

std::string systems() {
  return "A system file (.yaml) instead of a PROGRAM has any number of PLCs, lines, masters, PLCs of another make and "
         "bridges, all in one simulated time. 's7200 help keys' lists what it may contain, stl_programs/systems has "
         "examples.\n"
         "  run     runs it; --trace has all PLCs, with the name of each beside its lines\n"
         "  send    puts frames on one of its lines, beside everybody who is there; --at says which\n"
         "  master  joins a line as one more master, at --at\n"
         "  test    has it as --target, and 'system:' names it in a scenario; it is new for each scenario, and scenarios "
         "that set memory are skipped\n"
         "  debug   steps all PLCs in one time; 'station NAME' goes over from one to another\n"
         "Example: s7200 run stl_programs/systems/two_masters.yaml --for 2s\n"
         "Example: s7200 send stl_programs/systems/faults.yaml --crc 0103000a0001\n";
}

std::string targets() { return slave_targets_help(); }

std::string times() {
  std::string text = "Tables of execution times, for --times; each is what its CPUs run with, or can run with:\n";
  for (const NamedTimes& table : named_times()) text += fmt::format("  {:<20}{}\n", table.name, table.about);
  return text +
         "--times takes such a name or a CSV file as 's7200 times --csv' prints it; what a file leaves out is as usual.\n"
         "'within 25%' in a table: the true time lies between figure / 1.25 and figure × 1.25. 'within ± 0.5, 0.02': it is "
         "no farther from the base than 0.5 us, and from the figure per unit than 0.02 us.\n"
         "--times-band N of send, master and test says how far a result depends on times that are estimates: everything is "
         "repeated with each named table and with N random tables around them. 's7200 times --band-table 12' shows such a "
         "table, 's7200 times --check' compares a table with what is known of real CPUs.\n"
         "'s7200 calibrate' measures a real CPU and writes its table.\n";
}

std::string warnings() {
  std::string text = "Warnings of 'check', by the names that --no-warn NAME switches off:\n";
  for (const WarningInfo& warning : all_warnings()) text += fmt::format("  {:<18}{}\n", warning.name, warning.meaning);
  return text;
}

std::string westinghouse() {
  return "westinghouse:MODEL instead of a PROGRAM is a simulated PLC of that family, alone on its line: a target of "
         "'master' and 'test', and of 'run' behind a bridge. --plc NAME=VALUE sets it, --protocol says what it speaks. "
         "[M1] and the like mark what the documents leave open.\n"
         "Example: s7200 master westinghouse:pc1200 --plc HR1=1234,5678 read 40001:2\n" +
         simulated_plcs_help();
}

constexpr std::array kTopics{
    HelpTopic{"bridges", "what joins the line to masters outside", bridges},
    HelpTopic{"debugger", "the commands of 's7200 debug'", commands_help},
    HelpTopic{"faults", "faults of the line and their parameters", faults},
    HelpTopic{"files", "inputs, outputs, memory, traces and captures", files},
    HelpTopic{"keys", "what a system file and a scenario may contain", keys},
    HelpTopic{"models", "the CPUs that are modelled", models},
    HelpTopic{"programs", "what a PROGRAM may be, and the other files of its project", programs},
    HelpTopic{"protocols", "what 's7200 master' speaks, with all actions", protocols_help},
    HelpTopic{"recordings", "what 's7200 decode' and 's7200 import-capture' read", recordings},
    HelpTopic{"systems", "several PLCs, lines and masters in one simulated time", systems},
    HelpTopic{"targets", "what 's7200 master', 's7200 test' and 's7200 calibrate' ask", targets},
    HelpTopic{"times", "tables of execution times, and how sure they are", times},
    HelpTopic{"warnings", "what 's7200 check' warns of", warnings},
    HelpTopic{"westinghouse", "simulated PLCs of the Westinghouse family and their settings", westinghouse},
};

}  // namespace

std::span<const HelpTopic> help_topics() { return kTopics; }

const HelpTopic* find_help_topic(std::string_view name) {
  const auto found = std::ranges::find(kTopics, name, &HelpTopic::name);
  return found == kTopics.end() ? nullptr : &*found;
}

}  // namespace s7200::tools

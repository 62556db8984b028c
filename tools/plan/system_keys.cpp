#include "tools/plan/system_keys.hpp"

#include <fmt/format.h>

#include <deque>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/base/text/joined.hpp"
#include "serial_sim/line/line.hpp"
#include "serial_sim/modbus/functions.hpp"
#include "serial_sim/westinghouse/plcs.hpp"
#include "tools/plan/bridge_kinds.hpp"
#include "tools/plan/plc_keys.hpp"

namespace s7200::tools {
namespace {

using Where = SystemKey::Where;

/// A meaning with figures in it, for as long as the program runs.
std::string_view kept(std::string text) {
  static std::deque<std::string> texts;
  return texts.emplace_back(std::move(text));
}

/// The protocols for the help: `modbus, pc1000-lan … or hppc`
std::string meaning_of_other_plc() {
  const auto rows = westinghouse::plcs();
  return fmt::format("as `s7200 master --protocol` names it: {} or {}",
                     stl::joined(rows.first(rows.size() - 1), &westinghouse::PlcRow::name), rows.back().name);
}

SystemKey bridge_key(BridgeKind kind) {
  const BridgeRow& row = row_of(kind);
  return {Where::Bridge, row.word(), row.place, row.meaning};
}

// clang-format off
const SystemKey kOfFile[] = {
    {Where::File, "plcs", "MAP", kept(fmt::format("names of PLCs, and what each is; PLCs, peers and bridges are {} at most", kMostStations))},
    {Where::File, "peers", "MAP", "names of the other stations, and what each is: a master that polls, or a PLC of another make"},
    {Where::File, "bridges", "MAP", "names of bridges to this computer, and what each is; with one the system runs as fast as the clock"},
    {Where::File, "lines", "MAP", "names of lines, and who is on each"},

    {Where::File, "events", "LIST", "what is done to the system while it runs"},
};

const SystemKey kOfOthers[] = {
    {Where::Line, "stations", "LIST", kept(fmt::format("who is on it, in their order along the cable: names of PLCs (`gateway.1` is port 1; the name of several copies is all of them), of peers and of bridges; {} at most", serial::Line::kDrivers))},
    {Where::Line, "baud", "NUMBER", kept(fmt::format("of the masters and bridges on it and of who joins it, {} to {}; as its first PLC sets its port if left out (an S7-200, if there is one), like the next three", kLeastBaud, kMostBaud))},
    {Where::Line, "parity", "none, even, odd", "parity bit of a character"},
    {Where::Line, "data_bits", "7, 8", "data bits of a character"},
    {Where::Line, "stop_bits", "1, 2", "stop bits of a character"},
    {Where::Line, "turn_round", "TIME", "how long a master on it leaves it quiet between an answer and its next request; 7 characters and 10 ms if left out"},
    {Where::Line, "faults", "LIST", "from the start on, each in the form of `s7200 run --fault`, or a map if it is of one station; `master` says whose characters are requests"},
    {Where::Line, "master", "NAME", "which station asks the others, for `faults` of requests or answers, as in `of=answer`; if left out, the first PLC to send, where several are on the line and no one has asked them"},
    {Where::Line, "contention", "SEED, space", "two drivers that disagree give no defined level: mark or space by chance, the same with the same seed, 1 if left out; with `space` the level is always space, as if each driver only pulled the line down"},
    {Where::Line, "capture", "LIST", "files that it is written to: FILE.vcd (levels of rx, tx and line) or FILE.pcap (frames); rx and tx are those of its first PLC, an S7-200 if there is one"},

    {Where::Fault, "fault", "TEXT", "in the form of `s7200 run --fault`: `parity:character=each`"},
    {Where::Fault, "station", "NAME", "whose it is: what this station sends is disturbed, be it request or answer, or its clock is off, or it hears its echo; noise, and what happens at an instant, is of the line"},

    {Where::Master, "polls", "LIST", "what the master asks in Modbus RTU, in turn and without end"},
    {Where::Master, "starts", "TIME", "when it sends its first request after it has power; `1s` if left out"},
    {Where::Master, "every", "TIME", "the shortest time from the start of a round to the start of the next; without it rounds follow each other at once"},
    {Where::Master, "timeout", "TIME", "how long to wait for an answer to start; `1s` if left out"},

    {Where::Poll, "station", "NUMBER, FIRST..LAST", kept(fmt::format("who is asked, 1 to {}; several are asked one after the other; 1 if left out", modbus::kLastStation))},
    {Where::Poll, "read", "ADDRESS", "as manuals write it, with 5 or 6 digits: 00001 (coil), 10001 (input), 30001 (input register), 40001 (holding register)"},
    {Where::Poll, "write", "ADDRESS", "instead of `read`: a coil or a holding register"},
    {Where::Poll, "count", "NUMBER", "how many to read, up to 2000 coils or inputs or 125 registers; 1 if left out"},
    {Where::Poll, "value", "NUMBER", "the one to write"},

    {Where::OtherPlc, "westinghouse", "PROTOCOL", kept(meaning_of_other_plc())},
    {Where::OtherPlc, "model", "NAME", "pc1200, pc503, …; the first that speaks the protocol if left out"},
    {Where::OtherPlc, "settings", "LIST", "as `s7200 master --plc` takes them: `[slave=05, HR1=1234]` of modbus, `[unit=05, sync=ignored]` of pc1000-lan"},
    {Where::OtherPlc, "sync", "NAME.OUTPUT, master", "of the PC1000 LAN: the output of a PLC that drives its sync signal, `gateway.Q0.0`, or the master that joins its line, `s7200 master --protocol pc1000-lan` or that of a scenario; without it the PLC needs the setting `sync=ignored`"},

    bridge_key(BridgeKind::Pty),
    bridge_key(BridgeKind::Tcp),
    bridge_key(BridgeKind::Rfc2217),
    bridge_key(BridgeKind::RtuOverTcp),
    bridge_key(BridgeKind::ModbusTcp),
    bridge_key(BridgeKind::Device),

    {Where::Event, "at", "TIME", "since the start; beside one of the following"},
    {Where::Event, "power_off", "NAME", "a PLC or a peer loses power: it falls silent in the middle of a character and keeps what a real one keeps"},
    {Where::Event, "power_on", "NAME", "its power comes back; a PLC begins anew in RUN, or stays in STOP if its mode switch, SM0.7, is in TERM, a master at its first request"},
    {Where::Event, "cut", "LINE", "the cable is cut: both parts go on without each other"},
    {Where::Event, "after", "NAME", "beside `cut`: the last station on the first part, in the order of `stations`"},
    {Where::Event, "mend", "LINE", "the cable is whole again"},
    {Where::Event, "set", "MAP", "memory and inputs of `plc`, as a programming device sets them: no effect while it has no power; SMB30 and SMB130 set a port to another rate"},
    {Where::Event, "plc", "NAME", "beside `set`"},
    {Where::Event, "fault", "TEXT", "a fault of `line` from then on, in the form of `s7200 run --fault`"},
    {Where::Event, "line", "LINE", "beside `fault`"},
    {Where::Event, "station", "NAME", "beside `fault`, if it is of one station"},
    {Where::Event, "clear_faults", "LINE", "all faults of that line end"},
};
// clang-format on

std::vector<SystemKey> all_keys() {
  std::vector<SystemKey> keys(std::begin(kOfFile), std::end(kOfFile));
  for (const PlcKey& key : plc_keys())
    if (key.of_system) keys.push_back({Where::Plc, key.name, key.form, key.meaning});
  keys.insert(keys.end(), std::begin(kOfOthers), std::end(kOfOthers));
  return keys;
}

}  // namespace

std::span<const SystemKey> system_keys() {
  static const std::vector<SystemKey> kKeys = all_keys();
  return kKeys;
}

std::string system_keys_markdown() {
  static constexpr std::pair<Where, std::string_view> kTables[] = {
      {Where::File, "Of the file"},
      {Where::Plc, "Of a PLC"},
      {Where::Line, "Of a line"},
      {Where::Fault, "Of a fault of one station"},
      {Where::Master, "Of a peer that is a master"},
      {Where::Poll, "Of what it polls"},
      {Where::OtherPlc, "Of a peer that is a simulated PLC of another make"},
      {Where::Bridge, "Of a bridge, one of (LINK from the folder of this file)"},
      {Where::Event, "Of an event"}};
  std::string text;
  for (const auto& [where, heading] : kTables) {
    text += fmt::format("{}| {} | |\n|---|---|\n", text.empty() ? "" : "\n", heading);
    for (const SystemKey& key : system_keys())
      if (key.where == where) text += fmt::format("| `{}: {}` | {} |\n", key.key, key.form, key.meaning);
  }
  return text;
}

}  // namespace s7200::tools

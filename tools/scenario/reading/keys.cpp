#include "tools/scenario/reading/keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "serial_sim/peers/quiet_time.hpp"
#include "tools/plan/plc_keys.hpp"
#include "tools/scenario/reading/step_reader.hpp"
#include "tools/scenario/steps/steps.hpp"

namespace s7200::tools {
namespace {

using Where = ScenarioKey::Where;

constexpr std::string_view kExchanges = "send request read write";
constexpr std::string_view kOfOneProgram = ScenarioKey::kOfOneProgram;
constexpr std::string_view kReceptions = "send request read write receive";

const std::string kPause =
    fmt::format("between an exchange and the next one; `{}` if left out", serial::default_quiet_text());

// clang-format off
const ScenarioKey kBeforeActions[] = {
    {Where::File, "scenarios", "", "LIST", "several scenarios; what stands beside it holds for all of them"},
    {Where::File, "parameters", "", "MAP", "names for `${…}` and their values, unless others are given on the command line; an empty one has to be"},

    {Where::Scenario, "name", "", "TEXT", "one line, for reports; the name of the file if left out"},
    {Where::Scenario, "program", kOfOneProgram, "PATH", "STL file or published document, from the folder of this file, or `\"-\"` for standard input; `--target` comes before it"},
    {Where::Scenario, "system", "", "PATH", "instead of a program, a system file: PLCs and lines, and what happens to them when. What it says of records, `memory` among them, is left aside, and nobody is at its bridges"},
    {Where::Scenario, "on", "", "NAME", "of a system: the line or PLC that steps are about unless they say so themselves; the only line if left out"},
    {Where::Scenario, "repair", kOfOneProgram, "TEXT", "slips of a published listing to repair, as `s7200 check` names them: `R1,R2`, `all` or `none`"},
    {Where::Scenario, "skip_without", "", "PATH", "a file without which the scenario is skipped, such as a document that is not ours"},
    {Where::Scenario, "port", kOfOneProgram, "NUMBER", "of a CPU with two ports the one that the line is at, `0` or `1`; `0` if left out"},
    {Where::Scenario, "robust", kOfOneProgram, "SHARE", "`95%`: it must pass with so many of the tables of execution times that `--times-band 200` runs it with, and with the first of them, which is the one in use; not on a slave that is not a program"},
    {Where::Scenario, "line", "", "MAP", "how the master talks, if not as the program has set its port"},
    {Where::Scenario, "station", "", "NUMBER", "address of the slave, 0 to 247, or 255 for a Modbus TCP server itself; if left out that of the PLC that `on` names, in its system file, or 1"},
    {Where::Scenario, "set", kOfOneProgram, "MAP", "memory and inputs before the first scan: `{VW20: 16#1234, I0.3: 1}`"},
    {Where::Scenario, "after", "", "TIME", "when the first step begins; if left out, when the first scan has ended and the line is quiet"},
    {Where::Scenario, "pause", "", "SPAN", kPause},
    {Where::Scenario, "timeout", "", "TIME", "how long to wait for an answer or a transmission to begin, or for memory; `1s` if left out"},
    {Where::Scenario, "tolerance", "", "TIME", "by which a latency given as one figure may be missed, and for each exchange before it `at` and `wait: until`; `0` if left "
     "out"},
    {Where::Scenario, "needs", "", "LIST", "calculations as inside `${…}`: if one is 0, or has a parameter without a value, the scenario is not applicable"},
    {Where::Scenario, "expected_failure", "", "TEXT", "a known gap, and why: the scenario must fail, is counted apart, and turns red when it passes"},
    {Where::Scenario, "rule", "", "TEXT", "makes it a rule of a conformance suite, with this id"},
    {Where::Scenario, "source", "", "TEXT", "of a rule: the section it is from"},
    {Where::Scenario, "severity", "", "must, should", "of a rule; `must` if left out"},
    {Where::Scenario, "steps", "", "LIST", "what is done and expected, in this order"},

    {Where::Line, "baud", "", "NUMBER", "50 to 1000000"},
    {Where::Line, "parity", "", "none, even, odd", ""},
    {Where::Line, "data_bits", "", "7, 8", ""},
    {Where::Line, "stop_bits", "", "1, 2", ""},
};

const ScenarioKey kModifiers[] = {
    {Where::Modifier, "steps", "repeat for", "LIST", "what is repeated"},
    {Where::Modifier, "crc", "send receive", "true, false", "append the CRC to the frame, and look for it at the end of what comes; `false` if left out"},
    {Where::Modifier, "station", "request read write", "NUMBER", "instead of the scenario's, 0 to 255: those above 247 are reserved"},
    {Where::Modifier, "station", "fault", "NAME", "of a system: whose fault it is, as in a system file"},
    {Where::Modifier, "count", "read", "NUMBER", "how many; 1 if left out"},
    {Where::Modifier, "value", "write", "NUMBER", "the one to write"},
    {Where::Modifier, "values", "write", "LIST", "those to write"},
    {Where::Modifier, "expect", kExchanges, "ANSWER", "how it must end; if left out, in any way"},
    {Where::Modifier, "expect_one_of", kExchanges, "LIST", "several ANSWERs, one of which is right"},
    {Where::Modifier, "disturbed", kReceptions, "true, false", "whether what comes has parity or framing errors; `false` if left out"},
    {Where::Modifier, "latency", kReceptions, "WINDOW", "from the end of the request to the start of the answer; of `receive` from the start of the step, 0 if the transmission began earlier"},
    {Where::Modifier, "answer_gap", kReceptions, "WINDOW", "every pause between two characters of what comes"},
    {Where::Modifier, "at", kExchanges, "TIME", "when the request begins, since power-up"},
    {Where::Modifier, "at", "receive", "WINDOW", "when the transmission begins, since power-up"},
    {Where::Modifier, "pause", kExchanges, "SPAN", "between the exchange before and this one"},
    {Where::Modifier, "gap", kExchanges, "SPAN", "between the characters of the request; 0 if left out"},
    {Where::Modifier, "listen", kReceptions, "SPAN", "the silence that ends what comes; `3.5 characters` if left out"},
    {Where::Modifier, "timeout", "send request read write receive wait_until", "TIME", "instead of the scenario's"},
    {Where::Modifier, "power_off", "power_cycle", "TIME", "how long power was off; 0 if left out. The clock goes on, unless the memory is lost"},
    {Where::Modifier, "on", "send request read write receive wait wait_until set force unforce set_mode memory interrupts mode fatal errors fault", "NAME", "of a system: the PLC it is about (`gateway.1` is its port 1), or a line, there with its first PLC; the master sends on that line"},
    {Where::Modifier, "after", "cut", "NAME", "the last station on the first part, in the order of the file's `stations`; the master is on the part of the line's first PLC, or of the one that the scenario's `on` names"},
    {Where::Modifier, "needs", "", "LIST", "as of a scenario; if one does not hold, the step is left out"},
    {Where::Modifier, "note", "", "TEXT", "shown when the step fails"},
};
// clang-format on

bool has_word(std::string_view words, std::string_view word) {
  for (std::size_t at = 0; at <= words.size();) {
    const std::size_t end = std::min(words.find(' ', at), words.size());
    if (words.substr(at, end - at) == word) return true;
    at = end + 1;
  }
  return false;
}

std::vector<ScenarioKey> all_keys() {
  std::vector<ScenarioKey> keys(std::begin(kBeforeActions), std::end(kBeforeActions));
  for (const PlcKey& key : plc_keys())
    if (key.of_scenario) keys.push_back({Where::Scenario, key.name, kOfOneProgram, key.form, key.meaning});
  for (const StepKind& kind : step_kinds()) keys.push_back({Where::OfStep, kind.key, "", kind.form, kind.meaning});
  for (const LoopKind& kind : loop_kinds()) keys.push_back({Where::OfStep, kind.key, "", kind.form, kind.meaning});
  keys.insert(keys.end(), std::begin(kModifiers), std::end(kModifiers));
  return keys;
}

}  // namespace

bool ScenarioKey::belongs(std::initializer_list<Where> places, std::string_view action) const {
  if (std::find(places.begin(), places.end(), where) == places.end()) return false;
  return where != Where::Modifier || of.empty() || has_word(of, action);
}

const std::vector<ScenarioKey>& scenario_keys() {
  static const std::vector<ScenarioKey> kKeys = all_keys();
  return kKeys;
}

std::string scenario_keys_markdown() {
  static constexpr std::pair<Where, std::string_view> kTables[] = {
      {Where::File, "Of a file"},
      {Where::Scenario, "Of a scenario, or of a file for all its scenarios"},
      {Where::Line, "Inside `line:`"},
      {Where::OfStep, "A step has one of these"},
      {Where::Modifier, "and may have these beside it"}};
  std::string text;
  for (const auto& [where, heading] : kTables) {
    const bool modifiers = where == Where::Modifier;
    text += fmt::format("{}| {} |{} |\n|---|{}---|\n", text.empty() ? "" : "\n", heading, modifiers ? " beside |" : "",
                        modifiers ? "---|" : "");
    for (const ScenarioKey& key : scenario_keys()) {
      if (key.where != where) continue;
      std::string beside = modifiers ? fmt::format(" {} |", key.of.empty() ? "any" : key.of) : "";
      text += fmt::format("| `{}: {}` |{} {} |\n", key.key, key.form, beside, key.meaning);
    }
  }
  return text;
}

}  // namespace s7200::tools

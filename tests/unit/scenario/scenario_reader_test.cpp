#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "interpreter/base/diagnostic.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/source_path.hpp"
#include "tools/scenario/reading/memory_values.hpp"
#include "tools/scenario/reading/reader.hpp"
#include "tools/scenario/steps/exchange.hpp"
#include "tools/scenario/steps/expected/receive.hpp"
#include "tools/scenario/transcripts/transcript.hpp"
#include "tools/yaml/yaml.hpp"

namespace s7200::tools::scenario_reader_test {
namespace {

ScenarioFile read(const std::string& text, const GivenParameters* given = nullptr) {
  return read_scenarios(text, "folder/file.yaml", given);
}

/// The only scenario of a text without mistakes.
Scenario good(const std::string& text) {
  ScenarioFile file = read(text);
  for (const auto& d : file.diagnostics) ADD_FAILURE() << stl::render(d, *file.source, false);
  EXPECT_EQ(file.scenarios.size(), 1U);
  return file.scenarios.empty() ? Scenario{} : file.scenarios[0];
}

std::vector<Step> steps_of(const std::string& steps) { return good("steps:\n" + steps).steps; }

template <class Acting>
Acting action_of(const std::string& step) {
  const auto steps = steps_of("  - " + step + "\n");
  EXPECT_EQ(steps.size(), 1U);
  return steps.empty() ? Acting{} : dynamic_cast<const Acting&>(*steps[0].action);
}

/// As a transcript has it: what drives the plant is written back as it was read.
std::string written(const std::string& step) {
  const Scenario scenario = good("steps:\n  - " + step + "\n");
  const std::string text = transcript_text({{&scenario, {}}}, {"file.yaml", "a program", 0});
  return text.substr(text.find("      - ") + 8);
}

std::string request_of(const std::string& step) { return serial::to_hex(action_of<ExchangeStep>(step).request); }

TEST(ScenarioReader, ReadsTheHead) {
  const Scenario s = good(R"(
name: one
program: ../x.stl
cpu: 216
line: {baud: 19200, parity: odd, stop_bits: 2}
set: {VW20: 16#1234, I0.3: 1}
clock: 2026-11-21 10:00:00
after: 100ms
pause: 3.5 characters
timeout: 2s
tolerance: 5us
steps: [wait: 1ms]
)");
  EXPECT_EQ(s.name, "one");
  EXPECT_EQ(s.program, "x.stl");
  EXPECT_EQ(s.cpu, "216");
  EXPECT_EQ(s.line.baud, 19200U);
  EXPECT_EQ(s.line.parity, Parity::Odd);
  EXPECT_EQ(s.line.stop_bits, 2U);
  ASSERT_EQ(s.plc.set.size(), 2U);
  EXPECT_EQ(s.plc.set[0].value, 0x1234U);
  EXPECT_EQ(s.plc.clock->hour, 10);
  EXPECT_EQ(s.after, 100 * kMillisecond);
  EXPECT_EQ(s.pause, (Span{0, 3500}));
  EXPECT_EQ(s.line.timeout, 2 * kSecond);
  EXPECT_EQ(s.tolerance, 5 * kMicrosecond);
}

TEST(ScenarioReader, WhatStandsBesideTheListHoldsForAll) {
  const ScenarioFile file = read(R"(
cpu: 215
station: 9
scenarios:
  - {name: a, steps: [{read: holding 0}]}
  - {name: b, cpu: 216, station: 7, steps: [{read: holding 0}]}
  - {steps: [{read: holding 0}]}
)");
  ASSERT_TRUE(file.diagnostics.empty());
  ASSERT_EQ(file.scenarios.size(), 3U);
  EXPECT_EQ(file.scenarios[0].cpu, "215");
  EXPECT_EQ(file.scenarios[1].cpu, "216");
  EXPECT_EQ(file.scenarios[2].name, "file:7");
  const auto station = [&](std::size_t i) {
    return dynamic_cast<const ExchangeStep&>(*file.scenarios[i].steps[0].action).request[0].byte;
  };
  EXPECT_EQ(station(0), 9);
  EXPECT_EQ(station(1), 7);
  EXPECT_EQ(station(2), 9);
}

TEST(ScenarioReader, RequestsByNameByNumberAndInHex) {
  EXPECT_EQ(request_of("{read: holding 10}"), "01 03 00 0a 00 01 a4 08");
  EXPECT_EQ(request_of("{read: 40011}"), "01 03 00 0a 00 01 a4 08");
  EXPECT_EQ(request_of("{request: 03 00 0a 00 01}"), "01 03 00 0a 00 01 a4 08");
  EXPECT_EQ(request_of("{send: 01 03 00 0a 00 01, crc: true}"), "01 03 00 0a 00 01 a4 08");
  EXPECT_EQ(request_of("{send: 01 03p}"), "01 03p");
  EXPECT_EQ(request_of("{read: coils 5, count: 6, station: 2}"), "02 01 00 05 00 06 ac 3a");
  EXPECT_EQ(request_of("{read: 30002}").substr(0, 17), "01 04 00 01 00 01");
  EXPECT_EQ(request_of("{read: inputs 3}").substr(0, 17), "01 02 00 03 00 01");
  EXPECT_EQ(request_of("{write: coils 3, value: 1}").substr(0, 17), "01 05 00 03 ff 00");
  EXPECT_EQ(request_of("{write: holding 3, value: -1}").substr(0, 17), "01 06 00 03 ff ff");
  EXPECT_EQ(request_of("{write: coils 3, values: [1, 0, 1]}").substr(0, 23), "01 0f 00 03 00 03 01 05");
  EXPECT_EQ(request_of("{write: 40004, values: [16#1234]}").substr(0, 26), "01 10 00 03 00 01 02 12 34");
}

TEST(ScenarioReader, WhatIsExpectedOfAnAnswer) {
  using Kind = Expected::Kind;
  const auto expected = [](const std::string& text) {
    return action_of<ExchangeStep>("{read: holding 0, count: 3, expect: " + text + "}").expected[0];
  };
  EXPECT_EQ(expected("silence").kind, Kind::Silence);
  EXPECT_EQ(expected("echo").kind, Kind::Echo);
  EXPECT_EQ(expected("accepted").kind, Kind::Accepted);
  EXPECT_EQ(expected("refused").kind, Kind::Refused);
  EXPECT_EQ(expected("exception 2").exception, 2);
  EXPECT_EQ(expected("01 .. 0203").frame, (std::vector<BytePattern>{1, std::nullopt, 2, 3}));
  EXPECT_EQ(expected("[1, .., -1]").values, (std::vector<std::optional<std::uint16_t>>{1, std::nullopt, 0xFFFF}));
  EXPECT_EQ(action_of<ExchangeStep>("{read: holding 0, expect_one_of: [silence, exception 3]}").expected.size(), 2U);
}

TEST(ScenarioReader, Windows) {
  const auto latency = [](const std::string& text) {
    return *action_of<ExchangeStep>("{read: holding 0, latency: " + text + "}").latency;
  };
  EXPECT_EQ(latency("8ms..20ms"), (Window{{8 * kMillisecond, 0}, {20 * kMillisecond, 0}}));
  EXPECT_EQ(latency("..20ms").from, Span{});
  EXPECT_EQ(latency("3.5 characters..").from, (Span{0, 3500}));
  EXPECT_EQ(latency("3.5 characters..").to.fixed, kNever);
  EXPECT_EQ(latency("12.345678ms").from.fixed, 12'345'678);
  EXPECT_EQ(latency("7 characters + 10ms..").from, (Span{10 * kMillisecond, 7000}));
  const Scenario with_tolerance = good("tolerance: 1ms\nsteps: [{read: holding 0, latency: 5ms}]\n");
  const Window window = *dynamic_cast<const ExchangeStep&>(*with_tolerance.steps[0].action).latency;
  EXPECT_EQ(window.from.fixed, 4 * kMillisecond);
  EXPECT_EQ(window.to.fixed, 6 * kMillisecond);
}

TEST(ScenarioReader, SpansFollowTheFormatOfTheLine) {
  const SerialFormat format;  // 9600 8E1, 11 bits a character
  EXPECT_EQ((Span{0, 3500}).in(format), format.silence());
  EXPECT_EQ((Span{0, 1000}).in(format), format.character_time());
  EXPECT_EQ((Span{kMillisecond, 2000}).in(format), kMillisecond + format.bit_times(22));
  EXPECT_EQ(Span{kNever}.in(format), kNever);
}

TEST(ScenarioReader, StepsThatDriveThePlant) {
  EXPECT_EQ(written("wait: 3 scans"), "wait: 3 scans\n");
  EXPECT_EQ(written("wait: 20ms"), "wait: 20 ms\n");
  EXPECT_EQ(written("wait: until 1.5s"), "wait: until 1.5 s\n");
  EXPECT_EQ(written("set: {VD4: 1.5}"), "set: {VD4: 16#3FC00000}\n");
  EXPECT_EQ(written("power_cycle: memory lost"), "power_cycle: memory lost\n");
  EXPECT_EQ(written("{power_cycle: memory kept, power_off: 8h}"), "power_cycle: memory kept\n        power_off: 8 h\n");
  EXPECT_EQ(written("fault: flip:character=3,bit=5"), "fault: flip:character=3,bit=5\n");
  EXPECT_EQ(written("fault: none"), "fault: none\n");
  EXPECT_EQ(written("{wait_until: {VW20: 5}, timeout: 2s}"), "wait_until: {\"VW20\": \"5\"}\n        timeout: 2 s\n");
}

/// Of a map without mistakes.
std::vector<MemoryExpected> memory_expected(const std::string& map) {
  stl::Diagnostics diagnostics;
  const auto source = source_of(map, "file.yaml");
  ValueReader values(diagnostics);
  auto expected = read_memory_expected(values, *read_yaml(map, *source, diagnostics), cpu214());
  for (const auto& d : diagnostics) ADD_FAILURE() << stl::render(d, *source, false);
  return expected;
}

TEST(ScenarioReader, TextIsSentAndExpectedWithItsEscapes) {
  EXPECT_EQ(request_of(R"({send: {text: 'HI\r\n'}})"), "48 49 0d 0a");
  EXPECT_EQ(request_of(R"({send: {text: HI\r}})"), "48 49 0d");
  EXPECT_EQ(request_of(R"({send: {text: "HI\r"}})"), "48 49 0d") << "YAML's own escape";
  EXPECT_EQ(request_of(R"({send: {text: 'HI'}, crc: true})"), "48 49 f6 46");
  const auto expected = [](const std::string& text) {
    return action_of<ExchangeStep>("{send: 41, expect: " + text + "}").expected[0];
  };
  EXPECT_EQ(expected(R"({text: 'A\?\r'})").frame, (std::vector<BytePattern>{0x41, std::nullopt, 0x0D}));
  EXPECT_EQ(expected("any").kind, Expected::Kind::Any);
  const Scenario s = good("parameters: {x: 7}\nsteps:\n  - send: {text: 'SET ${x + 1}\\r'}\n");
  EXPECT_EQ(serial::to_hex(dynamic_cast<const ExchangeStep&>(*s.steps[0].action).request), "53 45 54 20 38 0d");
}

TEST(ScenarioReader, WhatNoOneAskedForIsReceived) {
  using Kind = Expected::Kind;
  const auto receive = [](const std::string& text) { return action_of<ReceiveStep>(text); };
  EXPECT_EQ(receive("receive: any").expected[0].kind, Kind::Any);
  EXPECT_EQ(receive("receive: silence").expected[0].kind, Kind::Silence);
  EXPECT_EQ(receive("receive: 41 ..").expected[0].frame, (std::vector<BytePattern>{0x41, std::nullopt}));
  EXPECT_EQ(receive("receive: {text: A}").expected[0].frame, (std::vector<BytePattern>{0x41}));
  const ReceiveStep step = receive(
      "{receive: 01 03, crc: true, timeout: 5s, listen: 20ms, latency: ..1s, at: 1s..2s, answer_gap: ..1ms, disturbed: "
      "true}");
  EXPECT_TRUE(step.has_crc && step.disturbed && step.answer_gap);
  EXPECT_EQ(step.timeout, 5 * kSecond);
  EXPECT_EQ(step.listen->fixed, 20 * kMillisecond);
  EXPECT_EQ(step.latency->to.fixed, kSecond);
  EXPECT_EQ(step.at->from.fixed, kSecond);
}

TEST(ScenarioReader, MemoryIsExpectedByteByByte) {
  const auto memory = memory_expected("{VW20: -2, Q0.0: 1, 'VB0:3': 01 .. 03}");
  EXPECT_EQ(memory[0].bytes, (std::vector<BytePattern>{0xFF, 0xFE}));
  EXPECT_EQ(memory[1].bytes, (std::vector<BytePattern>{1}));
  EXPECT_EQ(memory[2].bytes, (std::vector<BytePattern>{1, std::nullopt, 3}));
}

TEST(ScenarioReader, MemoryIsComparedAsTheValueIsWritten) {
  const auto fits = [](const std::string& what, const std::vector<std::uint8_t>& found) {
    return memory_expected("{" + what + "}").at(0).fits(found);
  };
  EXPECT_TRUE(fits("VD0: 1.5", {0x3F, 0xC0, 0, 0}));
  EXPECT_FALSE(fits("VD0: 1.5", {0x3F, 0xC0, 0, 1}));
  EXPECT_TRUE(fits("VD0: 0.0", {0x80, 0, 0, 0})) << "minus zero is zero";
  EXPECT_FALSE(fits("VD0: 0.0..", {0x7F, 0xC0, 0, 0})) << "what is not a number is never inside";
  EXPECT_TRUE(fits("VD0: 1.4..1.6", {0x3F, 0xC0, 0, 0}));
  EXPECT_FALSE(fits("VD0: ..1.4", {0x3F, 0xC0, 0, 0}));
  EXPECT_FALSE(fits("VD0: 1", {0x3F, 0x80, 0, 0})) << "a whole number is not a real";
  EXPECT_TRUE(fits("VW0: 5..10", {0, 10}));
  EXPECT_FALSE(fits("VW0: 5..10", {0, 11}));
  EXPECT_TRUE(fits("VW0: -5..5", {0xFF, 0xFB}));
  EXPECT_FALSE(fits("VW0: 5..", {0xFF, 0xFB})) << "words have a sign";
  EXPECT_TRUE(fits("VW0: 5..40000", {0x9C, 0x40})) << "unless a limit is larger than that";
  EXPECT_TRUE(fits("VB0: 199..16#C9", {200})) << "bytes have none";
  EXPECT_TRUE(fits("VD0: 3000000000..", {0xFF, 0xFF, 0xFF, 0xFF}));
}

TEST(ScenarioReader, AScenarioWhoseStepsAllLackWhatTheyNeedIsNotApplicable) {
  const Scenario s = good("parameters: {a: }\nsteps:\n  - {wait: 1ms, needs: [a]}\n");
  EXPECT_EQ(s.skipped, "not applicable: none of its steps has what it needs");
}

TEST(ScenarioReader, EveryActionOfTheTableIsRead) {
  const std::map<std::string_view, std::string> examples{{"send", "01"},
                                                         {"request", "03"},
                                                         {"read", "holding 0"},
                                                         {"write", "holding 0\n    value: 1"},
                                                         {"receive", "any"},
                                                         {"wait", "1ms"},
                                                         {"wait_until", "{VB0: 1}"},
                                                         {"set", "{VB0: 1}"},
                                                         {"force", "{VB0: 1}"},
                                                         {"unforce", "[VB0, I0.3]"},
                                                         {"set_mode", "stop"},
                                                         {"memory", "{VB0: 1}"},
                                                         {"interrupts", "{lost: 0}"},
                                                         {"mode", "run"},
                                                         {"fatal", "none"},
                                                         {"errors", "none"},
                                                         {"fault", "none"},
                                                         {"power_cycle", "memory kept"},
                                                         {"power_off", "pump"},
                                                         {"power_on", "pump"},
                                                         {"cut", "field\n    after: panel"},
                                                         {"mend", "field"},
                                                         {"repeat", "2\n    steps: [{wait: 1ms}]"},
                                                         {"for", "{x: [1]}\n    steps: [{wait: 1ms}]"}};
  for (const ScenarioKey& key : scenario_keys()) {
    if (key.where != ScenarioKey::Where::OfStep) continue;
    ASSERT_TRUE(examples.contains(key.key)) << key.key;
    const std::string steps = fmt::format("steps:\n  - {}: {}\n", key.key, examples.at(key.key));
    const bool of_a_system = key.key == "power_off" || key.key == "power_on" || key.key == "cut" || key.key == "mend";
    const std::string system = "system: " + test::source_path("stl_programs/systems/two_masters.yaml") + "\n";
    EXPECT_FALSE(good((of_a_system ? system : "") + steps).steps.empty()) << key.key;
  }
}

TEST(ScenarioReader, LoopsRunThroughTheirValuesInOrder) {
  const auto steps = steps_of("  - for: {a: [1, 2], b: 7..8}\n    steps: [{read: 'holding ${a * 10 + b}'}]\n");
  ASSERT_EQ(steps.size(), 4U);
  EXPECT_EQ(steps[0].loop, "a = 1, b = 7");
  EXPECT_EQ(steps[3].loop, "a = 2, b = 8");
  EXPECT_EQ(dynamic_cast<const ExchangeStep&>(*steps[3].action).request[3].byte, 28);
  EXPECT_EQ(steps_of("  - repeat: 3\n    steps:\n      - repeat: 2\n        steps: [{wait: 1ms}]\n").size(), 6U);
}

TEST(ScenarioReader, ParametersAreGivenOrHaveAValue) {
  const std::string text =
      "parameters: {a: 5, list: [1, 3], deep: {b: }}\nneeds: [a]\n"
      "steps:\n  - {read: 'holding ${a}', needs: [list.3]}\n  - {wait: 1ms, needs: [deep.b]}\n"
      "  - for: {x: list}\n    steps: [{wait: '${x}ms'}]\n";
  EXPECT_EQ(good(text).steps.size(), 3U);
  stl::Diagnostics diagnostics;
  const auto given = read_parameters("a: 0\n", "g.yaml", diagnostics);
  ASSERT_TRUE(given);
  EXPECT_EQ(read(text, &*given).scenarios[0].skipped, "not applicable: a");
  const auto unknown = read_parameters("b: 1\ndeep: {b: 2, c: 3}\n", "g.yaml", diagnostics);
  const ScenarioFile file = read(text, &*unknown);
  ASSERT_EQ(file.given_diagnostics.size(), 2U);
  EXPECT_EQ(file.given_diagnostics[0].message, "folder/file.yaml has no parameter 'b'");
  EXPECT_EQ(file.given_diagnostics[1].position.line, 2U);
  EXPECT_EQ(file.given_diagnostics[1].position.column, 14U);
}

TEST(ScenarioReader, ADescriptionNamesTheRulesThatAreExpectedToFail) {
  const std::string text = "scenarios:\n  - {rule: A-1, steps: [wait: 1ms]}\n  - {rule: B-2, steps: [wait: 1ms]}\n";
  stl::Diagnostics diagnostics;
  const auto given = read_parameters("expected_failures: {B-2: no clock}\n", "g.yaml", diagnostics);
  ASSERT_TRUE(given);
  const ScenarioFile file = read(text, &*given);
  EXPECT_TRUE(file.given_diagnostics.empty());
  EXPECT_EQ(file.scenarios[0].expected_failure, "");
  EXPECT_EQ(file.scenarios[1].expected_failure, "no clock");
  const auto unknown = read_parameters("expected_failures: {C-3: no clock}\n", "g.yaml", diagnostics);
  EXPECT_EQ(read(text, &*unknown).given_diagnostics.at(0).message, "folder/file.yaml has no rule 'C-3'");
  EXPECT_EQ(read(text, &*unknown).given_diagnostics.at(0).hint, "known: A-1, B-2");
  EXPECT_EQ(diagnostics.size(), 0U);
  EXPECT_FALSE(read_parameters("expected_failures: {B-2: }\n", "g.yaml", diagnostics));
  EXPECT_EQ(diagnostics.at(0).message, "an expected failure without a reason");
  diagnostics.clear();
  EXPECT_FALSE(read_parameters("expected_failures: B-2\n", "g.yaml", diagnostics));
  EXPECT_EQ(diagnostics.at(0).message, "'expected_failures' is a map, not 'B-2'");
}

TEST(ScenarioReader, PathsGivenFromOutsideAreFromTheFolderOfTheirFile) {
  stl::Diagnostics diagnostics;
  const auto given = read_parameters("program: ../p.stl\n", "other/place/g.yaml", diagnostics);
  EXPECT_EQ(read("parameters: {program: }\nprogram: ${program}\nsteps: [wait: 1ms]\n", &*given).scenarios[0].program,
            "other/p.stl");
  EXPECT_EQ(good("parameters: {program: }\nprogram: ${program}\nsteps: [wait: 1ms]\n").program, "");
  EXPECT_EQ(good("parameters: {program: p.stl}\nprogram: ${program}\nsteps: [wait: 1ms]\n").program, "folder/p.stl");
}

TEST(ScenarioReader, CalculatesInsideBraces) {
  Parameters parameters;
  parameters.values = {{"a", "5"}, {"deep.b", "16#10"}, {"t", "text"}};
  const auto result = [&](const std::string& text) {
    const auto made = substitute(text, parameters);
    return made.value_or("! " + made.why());
  };
  EXPECT_EQ(result("no braces"), "no braces");
  EXPECT_EQ(result("<${t}> ${a}"), "<text> 5");
  EXPECT_EQ(result("${a + deep.b * 2}"), "37");
  EXPECT_EQ(result("${(a + 1) % 4 - -2}"), "4");
  EXPECT_EQ(result("${a < 6} ${a >= 6} ${a = 5} ${a != 5}"), "1 0 1 0");
  EXPECT_EQ(result("${byte(a)} ${word(deep.b * 256)}"), "05 10 00");
  EXPECT_EQ(result("${bytes(3, 255)}"), "ff ff ff ");
  EXPECT_EQ(result("${has(a)} ${has(b)}"), "1 0");
  for (const char* wrong :
       {"${", "${}", "${b}", "${a +}", "${a b}", "${1/0}", "${byte(256)}", "${nothing(1)}", "${t + 1}", "${bytes(1025, 0)}",
        "${999999999999999999999}", "${((((((((((((((((((((((1))))))))))))))))))))))}", "${4000000000 * 4000000000}"})
    EXPECT_EQ(result(wrong)[0], '!') << wrong;
}

// --- mistakes: place, message ---

struct Mistake {
  const char* text;
  std::uint32_t line, column;
  const char* message;
};

TEST(ScenarioReader, StepsOfOtherToolsHaveTheirHints) {
  const auto hint_of = [](const char* text) { return read(text).diagnostics.at(0).hint; };
  EXPECT_TRUE(hint_of("steps:\n  - input: {I0.0: 1}\n").starts_with("'set' switches inputs"));
  EXPECT_TRUE(hint_of("steps:\n  - sleep: 1s\n").starts_with("'wait' lets time pass"));
  EXPECT_TRUE(hint_of("steps:\n  - expect: {Q0.0: 1}\n").starts_with("of memory it is"));
  EXPECT_EQ(hint_of("steps:\n  - {send: 01 03 crc}\n"), "crc: true beside it appends the CRC");
  EXPECT_EQ(hint_of("steps:\n  - {send: 01 03, expect: none}\n"), "write silence");
}

TEST(ScenarioReader, EveryMistakeIsToldAtItsPlace) {
  const Mistake mistakes[] = {
      {"", 0, 0, "nothing in it"},
      {"- a\n", 1, 1, "a file of scenarios is a map, not a list"},
      {"name: x\n", 1, 1, "neither 'steps' nor 'scenarios'"},
      {"steps: []\nscenarios: []\n", 1, 8, "both 'steps' and 'scenarios'"},
      {"steps: 5\n", 1, 8, "'steps' is a list, not '5'"},
      {"frob: 1\nsteps: []\n", 1, 1, "'frob' has no place here"},
      {"steps:\n  - {wait: 1ms, frob: 1}\n", 2, 17, "'frob' has no place beside 'wait'"},
      {"steps:\n  - {wait: 1ms, count: 1}\n", 2, 17, "'count' has no place beside 'wait'"},
      {"steps:\n  - {expect: silence}\n", 2, 6, "a step that does nothing"},
      {"steps:\n  - input: {I0.0: 1}\n", 2, 5, "there is no step 'input'"},
      {"steps:\n  - {wait: 1ms, mode: run}\n", 2, 17, "'wait' and 'mode' in one step"},
      {"steps:\n  - wait\n", 2, 5, "a step is a map, not 'wait'"},
      {"steps:\n  - wait: 5\n", 2, 11, "'5' is not a duration"},
      {"steps:\n  - wait: [1ms]\n", 2, 11, "one value is needed here, not a list"},
      {"steps:\n  - mode: fast\n", 2, 11, "'fast' is not a choice here"},
      {"steps:\n  - memory: {VB9999: 1}\n", 2, 14, "'VB9999' does not exist on CPU 214: V memory has 4096 bytes"},
      {"steps:\n  - memory: {VB0: 256}\n", 2, 19, "'256' does not fit VB0"},
      {"steps:\n  - memory: {X5: 1}\n", 2, 14, "'X5' is not an address; write for example VB100, VW100:4, M31.7, AC0"},
      {"steps:\n  - memory: {'VB0:4': 01 02}\n", 2, 23, "2 bytes for VB0:4, which has 4"},
      {"steps:\n  - set: {Q8.0: 1}\n", 2, 11, "'Q8.0' does not exist on CPU 214: Q memory has 8 bytes"},
      {"cpu: 213\nsteps: []\n", 1, 6, "there is no model of CPU '213'"},
      {"steps:\n  - send: 0g\n", 2, 11, "'g' is not a hex digit"},
      {"steps:\n  - {read: holding}\n", 2, 12, "'holding' is not an address of 5 or 6 digits"},
      {"steps:\n  - {read: frob 1}\n", 2, 12, "'frob 1' is not a place"},
      {"steps:\n  - {write: inputs 1, value: 1}\n", 2, 13, "inputs cannot be written"},
      {"steps:\n  - {write: coils 1, value: 2}\n", 2, 29, "'2' is not a number from 0 to 1"},
      {"steps:\n  - {write: coils 1}\n", 2, 13, "neither 'value' nor 'values'"},
      {"steps:\n  - {read: holding 0, expect: maybe}\n", 2, 31, "'maybe' is not an answer"},
      {"steps:\n  - {read: holding 0, expect: exception 0}\n", 2, 31, "'exception 0' is not an exception"},
      {"steps:\n  - {read: holding 0, latency: fast}\n", 2, 32, "'fast' is not a window of time"},
      {"steps:\n  - {read: holding 0, at: 1s, pause: 1ms}\n", 2, 27, "both 'at' and 'pause'"},
      {"steps:\n  - interrupts: {INT 128: 1}\n", 2, 18, "'INT 128' cannot be counted"},
      {"steps:\n  - interrupts: {INT 1: many}\n", 2, 25, "'many' is not a count"},
      {"steps:\n  - fatal: 99999\n", 2, 12, "'99999' is not an error code"},
      {"steps:\n  - errors: some\n", 2, 13, "run-time errors are a map or 'none', not 'some'"},
      {"steps:\n  - fault: flip:charakter=3\n", 2, 17, "charakter"},
      {"station: 248\nsteps:\n  - wait: 1ms\n", 1, 10, "'248' is not a station from 0 to 247, nor 255"},
      {"steps:\n  - fault: \"parity:of=me\"\n", 2, 23, "'me' is none of request, answer, both"},
      {"steps:\n  - repeat: 3\n", 2, 5, "a loop without 'steps'"},
      {"steps:\n  - repeat: 0\n    steps: []\n", 2, 13, "'0' is not a number from 1 to 4096"},
      {"steps:\n  - for: {x: 1..9999}\n    steps: []\n", 2, 14, "'1..9999' are not values for a loop"},
      {"steps:\n  - read: holding ${x}\n", 2, 11, "there is no parameter 'x'"},
      {"line: {baud: 1}\nsteps: []\n", 1, 14, "'1' is not a number from 50 to 1000000"},
      {"line: {bauds: 1}\nsteps: []\n", 1, 8, "'bauds' has no place here"},
      {"clock: today\nsteps: []\n", 1, 8, "'today' is not a date and time between 1990 and 2089"},
      {"severity: may\nsteps: []\n", 1, 11, "'may' is not a choice here"},
      {"needs: x\nsteps: []\n", 1, 8, "'needs' is a list, not 'x'"},
      {"input: no.csv\nsteps: []\n", 1, 8, "cannot read folder/no.csv"},
      {"parameters: {'a b': 1}\nsteps: []\n", 1, 14, "'a b' is not the name of a parameter"},
      {"name: a\nname: b\nsteps: []\n", 2, 1, "'name' stands here a second time, first in line 1"},
      {"steps:\n  - {read: holding 0, expect: [1, 2]}\n", 2, 31, "1 read, 2 expected"},
      {"steps:\n  - {read: coils 0, expect: [2]}\n", 2, 29, "coils and inputs are 0 or 1"},
      {"steps:\n  - {read: coils 0, latency: 20ms..10ms}\n", 2, 30, "'20ms..10ms' is not a window of time"},
      {"steps:\n  - {read: coils 0, latency: 9 characters..8 characters}\n", 2, 30, "is not a window of time"},
      {"steps:\n  - wait: 25h\n", 2, 11, "'25h' is not a duration with its unit, of a day at most"},
      {"a: &x 1\nb: *x\n", 1, 4, "anchors and aliases"},
      {"a: !!int 1\n", 1, 4, "tags (!)"},
      {"steps: []\n---\nsteps: []\n", 3, 1, "a second document"},
      {"a: [1\n", 1, 4, "a [ that is never closed"},
      {"a: {b: 1\n", 1, 4, "a { that is never closed"},
      {"steps: ]\n", 1, 8, "this closes nothing that is open here"},
      {"steps:\n\t- wait: 1ms\n", 2, 1, "a tab in the indentation: YAML takes blanks only"},
      {"steps:\n  - wait: 1ms\n  \tnote: x\n", 3, 3, "a tab in the indentation: YAML takes blanks only"},
      {"steps:\n  -\twait: 1ms\n", 2, 4, "a tab in the indentation: YAML takes blanks only"},
      {"set:\n\tVB0: 1\nsteps: []\n", 2, 1, "a tab in the indentation: YAML takes blanks only"},
      {"steps:\n  - note: a: b\n", 2, 12, "no key can stand here; ': ' makes one of what is before it"},
      {"steps:\n  - wait: 1ms\n   - wait: 1ms\n", 3, 4, "this does not belong to the map or list before it"},
      {"steps:\n  - wait: 1ms\n note: 1\n", 3, 2, "this does not belong to the map or list before it"},
      {"name: - a\n", 1, 7, "no list can begin here"},
      {"name: @x\n", 1, 7, "no text begins with this sign"},
      {"name: 'it's'\n", 1, 11, "this does not belong to the map or list before it"},
      {"name: \"a\nsteps: [wait: 1ms]\n", 1, 7, "a quotation that is never closed"},
      {"name: 'a\nsteps: [wait: 1ms]\n", 1, 7, "a quotation that is never closed"},
      {"name: \"a\\qb\"\n", 1, 11, "not an escape of YAML"},
      {"name: \"a\\xGG\"\n", 1, 13, "two hex digits belong after \\x"},
      {"name: |0\n  x\n", 1, 9, "the indentation of a block is 1 to 9"},
      {"name: |x\n  x\n", 1, 8, "nothing but 1 to 9, + and - follows | or >"},
      {"%YAML 9.1\n---\nname: x\n", 1, 1, "directives (%) have no place in a scenario"},
      {"name: &\n", 1, 8, "anchors and aliases"},
      {"name: *x\n", 1, 7, "anchors and aliases"},
      {"name: !<x\n", 1, 10, "tags (!)"},
      {"# nothing\n", 0, 0, "nothing in it"},
      {"~\n", 1, 1, "a file of scenarios is a map, not nothing"},
      {"steps: []\n", 1, 8, "no steps: nothing would be tested"},
      {"steps: [{repeat: 3, steps: []}]\n", 1, 8, "no steps: nothing would be tested"},
      {"steps: [{for: {x: []}, steps: [wait: 1ms]}]\n", 1, 8, "no steps: nothing would be tested"},
      {"scenarios: []\n", 1, 12, "no scenarios: nothing would be tested"},
      {"scenarios: [{name: a, steps: []}]\n", 1, 30, "no steps: nothing would be tested"},
      {"steps:\n  - set: {}\n", 2, 10, "nothing to set"},
      {"steps:\n  - {read: holding 0, expect_one_of: []}\n", 2, 38, "'expect_one_of' expects nothing"},
      {"steps:\n  - send: {txt: A}\n", 2, 11, "a map here is {text: ...} and nothing else"},
      {"steps:\n  - send: {text: 'A\\q'}\n", 2, 18, "\\ is followed by r, n, t, xHH, \\, ' or \""},
      {"steps:\n  - send: {text: 'A\\?'}\n", 2, 18, "\\ is followed by r, n, t, xHH, \\, ' or \""},
      {"steps:\n  - send: {text: Fünf}\n", 2, 18, "'ü' is not an ASCII character"},
      {"steps:\n  - send: {text: ''}\n", 2, 18, "a frame has one byte at least"},
      {"steps:\n  - {send: {text: A}, expect: refused}\n", 2, 31, "a text is not a Modbus request"},
      {"steps:\n  - {send: {text: A}, expect_one_of: [silence, [1]]}\n", 2, 38, "a text is not a Modbus request"},
      {"steps:\n  - {send: 41, expect: {text: 'A\\x4'}}\n", 2, 31, "\\x is followed by two hex digits"},
      {"steps:\n  - receive: accepted\n", 2, 14, "'receive' waits for what no one asked for"},
      {"steps:\n  - {receive: any, gap: 1ms}\n", 2, 20, "'gap' has no place beside 'receive'"},
      {"steps:\n  - wait_until: {}\n", 2, 17, "addresses and values are a map, not an empty one"},
      {"steps:\n  - wait_until: 5\n", 2, 17, "addresses and values are a map, not '5'"},
      {"steps:\n  - {wait_until: {VW0: 5}, listen: 1ms}\n", 2, 28, "'listen' has no place beside 'wait_until'"},
      {"steps:\n  - memory: {VW0: 1.5}\n", 2, 19, "'1.5' does not fit VW0"},
      {"steps:\n  - memory: {VW0: 10..5}\n", 2, 19, "'10..5': no value is inside"},
      {"steps:\n  - memory: {VB0: 1..256}\n", 2, 19, "'1..256': '256' does not fit VB0"},
      {"steps:\n  - memory: {VD0: 1..2.5}\n", 2, 19, "'1..2.5': both limits of a real are reals"},
      {"steps:\n  - memory: {V0.0: 0..1}\n", 2, 20, "'0..1': a bit is 0 or 1"},
      {"steps:\n  - memory: {VW0: ..}\n", 2, 19, "'..': neither from nor to"},
      {"steps:\n  - memory: {VW0: -1..40000}\n", 2, 19, "a value with a sign is not that large"},
      {"steps:\n  - memory: {VB0: -1..5}\n", 2, 19, "one without is not below 0"},
      {"? [a]\n: 1\n", 1, 3, "a key is a word, not a list"},
      {"größe: 1\nsteps:\n  - note: ö\n    größe: 1\n    wait: 1ms\n", 1, 1, "'größe' has no place here"},
  };
  for (const Mistake& mistake : mistakes) {
    const ScenarioFile file = read(mistake.text);
    ASSERT_FALSE(file.diagnostics.empty()) << mistake.text;
    const stl::Diagnostic& first = file.diagnostics[0];
    EXPECT_EQ(std::pair(first.position.line, first.position.column), std::pair(mistake.line, mistake.column))
        << mistake.text << stl::render(first, *file.source, false);
    EXPECT_NE(first.message.find(mistake.message), std::string::npos) << mistake.text << first.message;
  }
}

TEST(ScenarioReader, EveryMistakeOfTheYamlItselfSaysWhatToDo) {
  for (const char* text : {"a: [1\n",        "a: {b\n",          "steps: ]\n", "\ta: 1\n",     "a: b: c\n",
                           "a: - b\n",       "a: 1\n b: 2\n",    "a: @\n",     "a: 'b\n",      "a: \"\\q\"\n",
                           "a: \"\\xZZ\"\n", "a: \"\\ud800\"\n", "a: &\n",     "a: *\n",       "a: &b &c d\n",
                           "a: !<b\n",       "a: |0\n",          "a: >x\n",    "%YAML\n---\n", "%YAML 1.2\n%YAML 1.2\n---\n",
                           "%TAG a\n---\n",  "a: 'b\n---\n"}) {
    const ScenarioFile file = read(text);
    ASSERT_FALSE(file.diagnostics.empty()) << text;
    EXPECT_FALSE(file.diagnostics[0].hint.empty()) << text << file.diagnostics[0].message;
    EXPECT_GT(file.diagnostics[0].position.line, 0U) << text << file.diagnostics[0].message;
  }
}

TEST(ScenarioReader, AKeyThatStandsTwiceIsOneMistake) {
  const ScenarioFile twice = read("steps:\n  - read: holding 0\n    read: holding 1\n    frob: 1\n    frob: 2\n");
  std::vector<std::string> messages;
  for (const stl::Diagnostic& diagnostic : twice.diagnostics) messages.push_back(diagnostic.message);
  EXPECT_EQ(messages, (std::vector<std::string>{"'read' stands here a second time, first in line 2",
                                                "'frob' has no place beside 'read'",
                                                "'frob' stands here a second time, first in line 4"}));
}

TEST(ScenarioReader, ALoopThatCannotBeCountedDoesNotMakeTheOthersDeeper) {
  std::string loops = "steps:\n";
  for (int i = 0; i < 6; ++i) loops += "  - repeat: 0\n    steps: [wait: 1ms]\n";
  for (const stl::Diagnostic& diagnostic : read(loops).diagnostics)
    EXPECT_EQ(diagnostic.message, "'0' is not a number from 1 to 4096");
}

TEST(ScenarioReader, SaysHowMemoryIsExpected) {
  const auto file = read("steps:\n  - expect: {Q0.0: 1}\n");
  ASSERT_EQ(file.diagnostics.size(), 1U);
  EXPECT_EQ(file.diagnostics[0].hint, "of memory it is - memory: {Q0.0: 1}; of an answer it stands beside the request");
}

TEST(ScenarioReader, TellsAllMistakesAtOnceAndThoseOfLoopsOnce) {
  const ScenarioFile file =
      read("frob: 1\nsteps:\n  - wait: 5\n  - repeat: 50\n    steps:\n      - memory: {VB9999: 1}\n  - mode: x\n");
  ASSERT_EQ(file.diagnostics.size(), 4U);
  EXPECT_EQ(stl::render(file.diagnostics[1], *file.source, false),
            "folder/file.yaml:3:11: error: '5' is not a duration with its unit, of a day at most\n  - wait: 5\n          "
            "^\nhint: write for "
            "example 20ms, 3.5 "
            "characters, 2 scans, until 1.5s\n");
}

TEST(ScenarioReader, NothingMakesItGrowWithoutBounds) {
  std::string deep = "steps:\n  - repeat: 4096\n    steps: ";
  for (int i = 0; i < 4; ++i) deep += "[{repeat: 4096, steps: ";
  deep += "[]";
  for (int i = 0; i < 4; ++i) deep += "}]";
  EXPECT_NE(read(deep + "\n").diagnostics[0].message.find("more than 20000 steps"), std::string::npos);
  EXPECT_FALSE(read(std::string(100'000, '[')).diagnostics.empty());
  EXPECT_FALSE(read(std::string(100'000, '{')).diagnostics.empty());
  EXPECT_FALSE(read(std::string(Limits{}.bytes + 1, ' ')).diagnostics.empty());
  EXPECT_FALSE(read("a: \xFF\n").diagnostics.empty());
  std::string keys;
  for (int i = 0; i < 1001; ++i) keys += fmt::format("k{}: 1\n", i);
  EXPECT_NE(read(keys).diagnostics[0].message.find("more than 1000 keys"), std::string::npos);
}

/// So many exchanges, as they are recorded.
std::string transcript(std::size_t exchanges) {
  std::string text =
      "# Recorded from a slave by s7200 test --record. Replayed by s7200 test.\nscenarios:\n  - name: \"long\"\n    "
      "steps:\n";
  for (std::size_t i = 0; i < exchanges; ++i)
    text += fmt::format(
        "      - send: 01 03 00 00 00 01 84 0a\n        at: {} ms\n        expect: 01 03 02 00 00 b8 44\n"
        "        latency: 11.7 ms\n",
        50 * i);
  return text;
}

TEST(ScenarioReader, ATranscriptMayBeAsLongAsWhatWasRecorded) {
  const std::string text = transcript(25'000);
  ASSERT_GT(text.size(), 2 * Limits{}.bytes);
  const ScenarioFile file = read(text);
  EXPECT_TRUE(file.diagnostics.empty()) << file.diagnostics[0].message;
  EXPECT_EQ(file.scenarios.at(0).steps.size(), 25'000U);
}

TEST(ScenarioReader, AnImportedRecordingMayBeAsLongAsWhatWasRecorded) {
  EXPECT_TRUE(read("# Imported from plant.log by s7200 import-capture." + transcript(25'000)).diagnostics.empty());
}

TEST(ScenarioReader, WhatIsNotATranscriptMayNotBeSoLong) {
  EXPECT_FALSE(read(transcript(25'000).substr(2)).diagnostics.empty());
}

TEST(ScenarioReader, ATranscriptHasNoMoreStepsThanItsTextSays) {
  const ScenarioFile file =
      read("# Recorded from a slave\nsteps:\n  - repeat: 4096\n    steps: [{repeat: 4096, steps: [wait: 1ms]}]\n");
  EXPECT_NE(file.diagnostics.at(0).message.find("more than 20000 steps"), std::string::npos);
}

TEST(Transcript, ThatIsTooLongToBeReplayedIsNotOne) {
  EXPECT_EQ(why_not_replayed(kLongestTranscript), "");
  EXPECT_NE(why_not_replayed(kLongestTranscript + 1), "");
}

// --- systems ---

const std::string kGateway = "system: " + test::source_path("stl_programs/systems/gateway.yaml") + "\n";

TEST(ScenarioReader, AStepOfASystemIsAboutAPortOfAPlcAndItsLine) {
  const Scenario s = good(kGateway +
                          "on: office\nsteps:\n  - {read: holding 0}\n  - {memory: {VW0: 1}, on: pump}\n"
                          "  - {read: holding 0, on: gateway.1}\n  - wait: 1ms\n  - power_off: pump\n");
  EXPECT_EQ(s.steps[0].spot, (Spot{0, 0, 0}));
  EXPECT_EQ(s.steps[1].spot, (Spot{1, 1, 0}));
  EXPECT_EQ(s.steps[2].spot, (Spot{1, 0, 1}));
  EXPECT_FALSE(s.steps[3].spot || s.steps[4].spot);
}

TEST(ScenarioReader, WhatMakesAStepMayStandBesideAnother) {
  for (const char* const step : {"{power_cycle: memory kept, power_off: 8h}", "{power_off: 8h, power_cycle: memory kept}"})
    EXPECT_EQ(written(step), "power_cycle: memory kept\n        power_off: 8 h\n");
}

TEST(ScenarioReader, AddressesOfAStepAreThoseOfItsPlc) {
  EXPECT_EQ(good(kGateway + "steps:\n  - {memory: {VB5119: 0}, on: gateway}\n").steps.size(), 1U) << "a CPU 226 has them";
  const ScenarioFile file = read(kGateway + "steps:\n  - {memory: {VB5119: 0}, on: pump}\n");
  ASSERT_EQ(file.diagnostics.size(), 1U) << "a CPU 214 does not";
}

std::string file_of(const std::string& name, const std::string& text) {
  const std::string path = test::scratch_folder() + name;
  std::ofstream(path) << text;
  return path;
}

TEST(ScenarioReader, AStepAboutAPlcOfASystemAsksTheStationThatItsFileGivesIt) {
  const std::string slave = "{program: " + test::source_path("stl_programs/modbus_slave.stl") + ", station: ";
  const std::string two = "system: " +
                          file_of("stations.yaml", "plcs:\n  near: " + slave + "5}\n  far: " + slave +
                                                       "20}\nlines: {bus: {stations: [near, far]}}\n") +
                          "\n";
  const auto asked = [&](const std::string& text) {
    const Scenario s = good(two + text);
    return dynamic_cast<const ExchangeStep&>(*s.steps[0].action).request[0].byte;
  };
  EXPECT_EQ(asked("steps:\n  - {read: holding 0, on: far}\n"), 20);
  EXPECT_EQ(asked("on: far\nsteps:\n  - {write: coils 0, value: 1}\n"), 20);
  EXPECT_EQ(asked("on: far\nsteps:\n  - {read: holding 0, station: 7}\n"), 7) << "the step says so itself";
  EXPECT_EQ(asked("station: 9\non: far\nsteps:\n  - {read: holding 0}\n"), 9) << "and so does the scenario";
  EXPECT_EQ(asked("on: bus\nsteps:\n  - {read: holding 0}\n"), 1) << "a line is no PLC";
}

const std::string kOthers =
    "peers:\n  usual: {westinghouse: modbus, model: pc1200, settings: [slave=05, \"HR1=1234\"]}\n"
    "  other: {westinghouse: modbus, model: pc1250, settings: [slave=06, baud=19200, \"HR1=5678\"]}\n"
    "  panel: {polls: [{station: 7, read: 40001}]}\n"
    "lines:\n  east: {stations: [usual]}\n  west: {stations: [other]}\n  empty: {stations: [panel]}\n";

TEST(ScenarioReader, AStepOfASystemWithoutAnS7200IsAboutALine) {
  const std::string path = file_of("others.yaml", kOthers);
  const Scenario s = good("system: " + path +
                          "\non: east\nsteps:\n  - {read: holding 0}\n  - {read: holding 0, on: west}\n"
                          "  - {fault: flip, on: west, station: other}\n  - power_off: usual\n");
  EXPECT_TRUE(s.is_of_peers());
  EXPECT_EQ(s.steps[0].line, 0U);
  EXPECT_EQ(s.steps[1].line, 1U);
  EXPECT_EQ(s.steps[2].line, 1U);
  EXPECT_FALSE(s.steps[0].spot || s.steps[3].line);
  const auto complaint = [&](const std::string& step) {
    const ScenarioFile file = read("system: " + path + "\nsteps:\n  - " + step + "\n");
    return file.diagnostics.empty() ? "" : file.diagnostics[0].message;
  };
  EXPECT_EQ(complaint("{read: holding 0}"), "there are several lines, east, west, empty: name one of them");
  EXPECT_EQ(complaint("{read: holding 0, on: north}"), "there is no line 'north': the lines are east, west, empty");
  EXPECT_EQ(complaint("{read: holding 0, on: empty}"), "no PLC is on line 'empty'");
  for (const char* const step : {"{set: {VW0: 1}, on: east}", "{memory: {VW0: 1}, on: east}", "{mode: run, on: east}"})
    EXPECT_NE(complaint(step).find("is about an S7-200, and there is none in "), std::string::npos) << step;
}

TEST(ScenarioReader, TheHeadSaysWhoseScansAreWaitedFor) {
  const Scenario s = good(kGateway + "on: pump\nsteps:\n  - wait: 2 scans\n  - {wait: 2 scans, on: gateway}\n");
  ASSERT_TRUE(s.plan && s.steps[0].spot && s.steps[1].spot);
  EXPECT_EQ(s.plan->plcs[s.steps[0].spot->plc].name, "pump");
  EXPECT_EQ(s.plan->plcs[s.steps[1].spot->plc].name, "gateway");
  const ScenarioFile nobody = read(kGateway + "steps:\n  - wait: 2 scans\n");
  ASSERT_EQ(nobody.diagnostics.size(), 1U);
  EXPECT_EQ(nobody.diagnostics[0].message, "scans of which PLC?");
  EXPECT_EQ(read(kGateway + "on: nobody\nsteps:\n  - wait: 5ms\n").diagnostics.size(), 1U) << "said once, of the head";
  EXPECT_EQ(read("program: x.stl\non: pump\nsteps:\n  - wait: 2 scans\n").diagnostics.size(), 1U) << "no system at all";
}

TEST(ScenarioReader, AFaultOfAStationNamesOneOnItsLine) {
  const auto complaint = [&](const std::string& text) {
    const ScenarioFile file = read(text);
    return file.diagnostics.empty() ? "" : file.diagnostics[0].message;
  };
  EXPECT_EQ(complaint(kGateway + "steps:\n  - {fault: flip, on: field, station: pump}\n"), "");
  EXPECT_EQ(complaint(kGateway + "steps:\n  - {fault: flip, on: office, station: pump}\n"),
            "'pump' is not on line 'office'");
  EXPECT_EQ(complaint(kGateway + "steps:\n  - {fault: none, on: field, station: pump}\n"),
            "'fault: none' ends all faults of the line, whosever they are");
  EXPECT_EQ(complaint(kGateway + "steps:\n  - {fault: \"missing:of=request\", on: field, station: pump}\n"),
            "'of=' says whose it is, and so does 'station' beside it");
  const ScenarioFile both = read(kGateway + "steps:\n  - {power_off: pump, on: field}\n");
  ASSERT_EQ(both.diagnostics.size(), 1U) << "it is about a system, and needs no advice to name one";
  EXPECT_EQ(both.diagnostics[0].message, "'on' has no place beside 'power_off'");
  EXPECT_EQ(complaint("program: x.stl\nsteps:\n  - {fault: flip, station: pump}\n"),
            "'station' says whose fault it is in a system");
}

TEST(ScenarioReader, ASystemWithoutAPlcIsRefused) {
  const std::string path = test::scratch_folder() + "no_plc.yaml";
  std::ofstream(path) << "peers:\n  panel:\n    polls:\n      - {station: 7, read: 40001, count: 2}\n    every: 150ms\n"
                         "lines:\n  field:\n    stations: [panel]\n";
  const ScenarioFile file = read("system: " + path + "\nsteps:\n  - wait: 1ms\n");
  ASSERT_EQ(file.diagnostics.size(), 1U);
  EXPECT_EQ(file.diagnostics[0].message, path + " has no line with a PLC and room for a master");
}

TEST(ScenarioReader, WhatASystemFileWouldRecordIsLeftAside) {
  const Scenario s = good(kGateway + "steps:\n  - wait: 1ms\n");
  ASSERT_TRUE(s.plan);
  for (const PlcPlan& plc : s.plan->plcs) EXPECT_TRUE(plc.settings.trace.empty() && plc.settings.memory.path.empty());
}

}  // namespace
}  // namespace s7200::tools::scenario_reader_test

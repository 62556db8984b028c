// The keys of a PLC: one row is an option, a key of files, and a line of transcripts.
#include "tools/plan/plc_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "interpreter/analysis/warnings/check.hpp"
#include "tools/plan/system_plan.hpp"

namespace s7200::tools::plc_keys_test {
namespace {

std::shared_ptr<const Program> program() {
  return check_text("LD SM0.0\nINCW VW0\nMEND\n", "counts.stl", *find_cpu("226"), default_times(*find_cpu("226"))).program;
}

/// A value that the key takes and that is not what holds without it.
const std::map<std::string_view, std::string> kValues{{"ppi_baud", "19200,187500"},
                                                      {"ppi_station", "3,4"},
                                                      {"ppi_second", "refused"},
                                                      {"retain", "VB0:100,T0:32"},
                                                      {"set", "VW20=5"},
                                                      {"input", "rows.csv"},
                                                      {"clock", "2026-11-21 10:00:00"},
                                                      {"clock_error", "-50ppm"},
                                                      {"starts", "250ms"},
                                                      {"memory", "plc.memory"},
                                                      {"ram_lost", "true"},
                                                      {"power_off", "1h"},
                                                      {"trace", "plc.trace"},
                                                      {"trace_instructions", "true"},
                                                      {"trace_events", "true"},
                                                      {"signals", "Q0.0,VW20"},
                                                      {"output", "outputs.csv"},
                                                      {"dump", "VB0:16"}};

std::string without_quotes(std::string text) {
  std::erase(text, '"');
  return text;
}

TEST(PlcKeys, EachIsSomewhereAndHasAReaderOrIsPartOfTheProgram) {
  for (const PlcKey& key : plc_keys()) {
    EXPECT_EQ(std::ranges::count(plc_keys(), key.name, &PlcKey::name), 1) << key.name;
    EXPECT_TRUE(key.of_system || key.of_scenario || key.is_option()) << key.name;
    EXPECT_EQ(key.take == nullptr, key.stage == PlcKey::Stage::Source) << key.name;
    EXPECT_TRUE(!(key.of_system || key.of_scenario) || !key.meaning.empty()) << key.name;
    EXPECT_TRUE(!key.of_scenario || !key.take || key.text) << key.name << ": a transcript would lose it";
  }
}

TEST(PlcKeys, WhatAKeyWritesItReadsAgain) {
  const auto of = program();
  const AddressSpace space = *of;
  for (const PlcKey& key : plc_keys()) {
    if (!key.take) continue;
    ASSERT_TRUE(kValues.contains(key.name)) << key.name << ": give the test a value";
    PlcSettings settings, again;
    EXPECT_EQ(key.take(settings, kValues.at(key.name), &space).message, "") << key.name;
    if (!key.text) continue;
    EXPECT_EQ(key.text(PlcSettings{}), "") << key.name;
    const std::string written = key.text(settings);
    EXPECT_NE(written, "") << key.name;
    EXPECT_EQ(key.take(again, without_quotes(written), &space).message, "") << key.name;
    EXPECT_EQ(key.text(again), written) << key.name;
  }
}

TEST(PlcKeys, AValueIsCheckedAsFarAsItCanBeBeforeTheProgramIsKnown) {
  for (const PlcKey& key : plc_keys()) {
    PlcSettings settings;
    if (key.take) {
      EXPECT_EQ(key.take(settings, kValues.at(key.name), nullptr).message, "") << key.name;
    }
  }
  const auto* const clock = &*std::ranges::find(plc_keys(), "clock", &PlcKey::name);
  PlcSettings settings;
  EXPECT_EQ(clock->take(settings, "noon", nullptr).message, "'noon' is not a date and time between 1990 and 2089");
}

TEST(PlcKeys, FilesThatAreWrittenAreForgottenByTheirRows) {
  ProgramSettings settings;
  settings.trace = "a.trace";
  settings.output = "a.csv";
  settings.memory.path = "a.memory";
  settings.captures = {"a.pcap"};
  SystemPlan plan = plan_of(program(), settings);
  forget_files(plan);
  for (const PlcKey& key : plc_keys())
    if (key.shape == PlcKey::Shape::Written) {
      EXPECT_EQ(key.text(plan.plcs.front().settings), "") << key.name;
    }
  EXPECT_TRUE(plan.lines.front().captures.empty());
}

TEST(PlanOfAProgram, IsOnePlcOnALineOfItsOwnWithoutNames) {
  ProgramSettings settings;
  settings.port = 1;
  const SystemPlan plan = plan_of(program(), settings);
  EXPECT_TRUE(is_of_one_program(plan));
  ASSERT_EQ(plan.plcs.size(), 1U);
  EXPECT_EQ(spots_of_plcs(plan), (std::vector<Spot>{{0, 0, 1}}));
  EXPECT_EQ(find_spot(plan, ""), (Spot{0, 0, 1}));
}

}  // namespace
}  // namespace s7200::tools::plc_keys_test

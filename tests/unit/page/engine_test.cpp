// The engine of a page that holds its session itself: programs with what surrounds them, and recordings.
#include "tools/faces/page/engine/engine.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/base/bytes.hpp"
#include "tests/support/slave_bench.hpp"
#include "tools/faces/page/engine/carried_system.hpp"
#include "tools/faces/page/engine/surroundings.hpp"
#include "tools/json/json_text.hpp"
#include "tools/rig/rig.hpp"
#include "tools/session/commands/answers/recording_json.hpp"
#include "tools/session/past/actions/journal.hpp"
#include "tools/session/past/seen_rig.hpp"
#include "tools/views/state/memory.hpp"

namespace s7200::tools::page::engine_test {
namespace {

/// An engine with a program, and what it said last.
struct Page {
  Json take(const Json& message) {
    said.clear();
    engine.take(message.dump());
    for (const Json& one : said)
      if (one.contains("id")) return one;
    return {};
  }
  Json open(const std::string& text, const Json& options, const Json& recording = nullptr) {
    return take(
        {{"id", 1},
         {"open", {{"sources", {{{"name", "p.stl"}, {"text", text}}}}, {"options", options}, {"recording", recording}}}});
  }
  Json operator()(const std::string& command) { return take({{"id", 2}, {"command", command}}); }

  std::vector<Json> said{};
  Engine engine{[this](const std::string& message) { said.push_back(parse_json(message).value_or(Json())); }};
};

const std::array<const CpuModel*, 1> kOne{&cpu214()};

constexpr const char* kCounts = "LD SM0.0\nINCW VW10\nLD I0.0\n= Q0.0\nMEND\n";

TEST(Engine, PowersUpWithWhatTheOptionsSay) {
  Page page;
  EXPECT_EQ(page.open(kCounts,
                      {{"cpu", "224"}, {"set", {"VW10=5", "I0.0=1"}}, {"clock", "2026-11-21 10:00:00"}})["json"]["opened"],
            true);
  EXPECT_EQ(page("values VW10")["json"]["values"][0]["number"], 5);
  page("scan 2");
  EXPECT_EQ(page("values Q0.0")["json"]["values"][0]["number"], 1) << "the input point is on";
}

TEST(Engine, RefusesAnOptionThatItDoesNotKnow) {
  Page page;
  const std::string error = page.open(kCounts, {{"memory", "x"}})["error"];
  EXPECT_TRUE(error.starts_with("memory: there is no option 'memory' here; there are cpu, times, repair, port, ")) << error;
}

TEST(Engine, FindsOutTheEncodingOfASourceInHex) {
  Page page;
  const auto open = [&page](const std::string& hex) {
    return page.take({{"id", 1}, {"open", {{"sources", {{{"name", "p.awl"}, {"hex", hex}}}}, {"options", Json::object()}}}});
  };
  const Json reply = open("4c44204930 2e30202f2f20cde0f1eef1 0a4d454e440a");
  EXPECT_EQ(reply["error"], "a source has a name, and text or hex") << "blanks are no hex";
  const Json json = open("4c442049302e30202f2f20cde0f1eef1202d20d1f2eeef0a4d454e440a")["json"];
  EXPECT_EQ(json["opened"], true);
  EXPECT_EQ(json["sources"],
            (Json::array({{{"name", "p.awl"}, {"text", "LD I0.0 // Насос - Стоп\nMEND\n"}, {"encoding", "Windows-1251"}}})));
  EXPECT_EQ(page("listing 1 1")["json"]["text"][0]["text"], "LD I0.0 // Насос - Стоп");
  const std::string error = open("d0cf11e0a1b11ae10000")["error"];
  EXPECT_TRUE(error.starts_with("cannot read p.awl: an OLE file")) << error;
}

TEST(Engine, RefusesARecordingThatIsDamaged) {
  Page page;
  const Json damaged{{"actions", Json::array()}, {"count", 1}, {"done", {{"action", {3}}}}};
  const std::string error = page.open(kCounts, {{"cpu", "214"}}, damaged)["error"];
  EXPECT_EQ(error, "recording: something unknown was done");
  EXPECT_TRUE(page("past").contains("error")) << "nothing is open";
}

/// The slave is asked twice, and something is set; as a verb runs it, with a journal.
struct Asked {
  Asked() : program(test::compile(test::slave_text())), simulation(program), journal((simulation.power_up(), simulation)) {
    simulation.run_until(100 * kMillisecond);
    for (int i = 0; i < 2; ++i) {
      const SendFrame send{simulation.port_format(),
                           {.frame = serial::parse_hex_frame("0103000a0002e409").frame, .silence = {}}};
      journal.note(send);
      perform(send, simulation);
      simulation.finish_exchange();
      simulation.run_until(simulation.time() + 50 * kMillisecond);
    }
    const SetMemory set{{{*parse_range("VW20", cpu214()), 7}}};
    journal.note(set);
    perform(set, simulation);
    simulation.run_until(simulation.time() + 50 * kMillisecond);
  }

  std::shared_ptr<const Program> program;
  serial::Simulation simulation;
  Journal journal;
};

TEST(Engine, ComesToTheSameStateAsTheRunThatWasRecorded) {
  Asked asked;
  const Json recording = json_of(asked.journal.recording(), kOne);
  EXPECT_EQ(recording["actions"].size(), 2U) << "the same request is there once";
  EXPECT_EQ(recording["count"], 3);
  Page page;
  ASSERT_EQ(page.open(test::slave_text(), {{"cpu", "214"}}, recording)["json"]["opened"], true);
  const Json past = page("past")["json"];
  EXPECT_EQ(past["now_ns"], 0);
  EXPECT_EQ(past["newest_ns"], asked.simulation.time());
  page("at end");
  std::string addresses;
  for (const char* const each : {"VW20", "VB4095", "MB31", "SMB0", "SMB2", "AC0", "T32"})
    addresses += fmt::format(" {}", each);
  const Json values = page("values" + addresses)["json"]["values"];
  for (const Json& value : values) {
    const auto range = parse_range(value["name"].get<std::string>(), cpu214());
    ASSERT_TRUE(range) << value;
    EXPECT_EQ(value["number"], number_at(asked.simulation.cpu().state(), *range, 0)) << value;
  }
  EXPECT_EQ(page("past")["json"]["scan"], asked.simulation.cpu().state().scans + 1);
}

TEST(Engine, RunsOnFromTheEndOfARecording) {
  Asked asked;
  Page page;
  page.open(test::slave_text(), {{"cpu", "214"}}, json_of(asked.journal.recording(), kOne));
  page("at end; continue 20ms");
  EXPECT_EQ(page("past")["json"]["in_the_past"], false);
}

TEST(RecordingJson, IsReadAsItWasWritten) {
  Asked asked;
  const Recording recording = asked.journal.recording();
  const auto read = recording_from(json_of(recording, kOne), kOne);
  ASSERT_TRUE(read) << read.why();
  EXPECT_EQ(read->moments, recording.moments);
  EXPECT_EQ(read->stations, recording.stations);
  EXPECT_EQ(read->end, recording.end);
  ASSERT_EQ(read->actions.size(), recording.actions.size());
  for (std::size_t i = 0; i < recording.actions.size(); ++i)
    EXPECT_EQ(describe(read->actions[i]), describe(recording.actions[i]));
}

TEST(Surroundings, AreReadAsTheyWereWritten) {
  const auto program = test::compile(kCounts);
  Surroundings around;
  around.plc.set.push_back(*parse_assignment("VW10=5", *program));
  around.plc.clock = ClockTime{.year = 26, .month = 11, .day = 21, .hour = 10, .minute = 0, .second = 0, .weekday = 7};
  around.plc.clock_error = 50;
  around.faults.push_back(serial::parse_fault("flip:exchange=2").fault);
  around.field.changes.push_back({.at = 5, .place = 3, .mask = 1, .value = 1});
  around.field.pulses.push_back({.at = 6, .place = 3, .mask = 2, .pulses = 10, .millihertz = 5000});
  around.kept.emplace();
  around.kept->image[program->model->retentive.front().at()] = 7;
  around.kept->ram_lost = true;
  around.kept->power_off = 3;
  const auto read = surroundings_of_options(options_of(*program, around), *program);
  ASSERT_TRUE(read) << read.why();
  EXPECT_EQ(read->plc.set.size(), 1U);
  EXPECT_EQ(read->plc.clock, around.plc.clock);
  EXPECT_EQ(read->plc.clock_error, 50);
  EXPECT_EQ(read->faults, around.faults);
  EXPECT_EQ(read->field, around.field);
  EXPECT_EQ(read->kept, around.kept);
}

TEST(Surroundings, HaveTheTimesOfTheProgramOnlyIfTheyAreNotTheOnesOfItsCpu) {
  const auto program = test::compile(kCounts);
  EXPECT_FALSE(options_of(*program, {}).contains("times"));
  TimeTable times = default_times(cpu214());
  ASSERT_TRUE(times.add("mnemonic,form,base_us,per_unit_us,unit,marker\nINCW,,99,,,manual\n", "t").empty());
  const auto slower = check_text(kCounts, "p.stl", cpu214(), times).program;
  const auto read = times_of_options(options_of(*slower, {}), cpu214());
  ASSERT_TRUE(read) << read.why();
  EXPECT_EQ(to_csv(*read), to_csv(slower->times));
}

constexpr const char* kTwoPlcs =
    "plcs:\n  first: {program: counts.stl, cpu: 224, set: {VW10: 100}}\n  second: {program: counts.stl, cpu: 214, starts: "
    "50ms}\n"
    "lines:\n  bus: {stations: [first, second]}\nevents:\n  - {at: 300ms, set: {VW10: 0}, plc: second}\n";

CarriedSystem two_plcs() {
  stl::Diagnostics diagnostics;
  CarriedSystem system{.path = "plant/two.yaml"};
  system.root = read_yaml(kTwoPlcs, *source_of(kTwoPlcs, system.path), diagnostics, {}).value();
  system.files["plant/counts.stl"] = kCounts;
  return system;
}

TEST(Engine, OpensASystemWithAllThatItsFileNames) {
  Page page;
  EXPECT_EQ(page.take({{"id", 1}, {"open", {{"system", system_json(two_plcs())}}}})["json"]["opened"], true);
  page("continue 400ms");
  const auto opened = system_from(system_json(two_plcs()));
  ASSERT_TRUE(opened) << opened.why();
  Rig rig(opened->plan, {});
  rig.power_up();
  rig.system().run_until(400 * kMillisecond);
  for (const std::size_t plc : {std::size_t{0}, std::size_t{1}}) {
    page(plc == 0 ? "station first" : "station second");
    const auto counted = static_cast<std::int16_t>(load16(&rig.plc(plc).cpu().state().image[image::kV + 10]));
    EXPECT_EQ(page("values VW10")["json"]["values"][0]["number"], counted);
  }
}

TEST(Engine, ASystemIsRunAgainFromItsRecording) {
  const auto opened = [] { return system_from(system_json(two_plcs())).value(); }();
  const std::vector models{opened.plan.plcs[0].program->model, opened.plan.plcs[1].program->model};
  Rig rig(opened.plan, {});
  rig.power_up();
  const SeenRig seen(rig, {});
  Journal journal(*seen.stations().front());
  rig.system().run_until(100 * kMillisecond);
  const SetMemory set{{{*parse_range("VW10", *models[1]), 7000}}};
  journal.note(set, 1);
  perform(set, *seen.stations()[1]);
  rig.system().run_until(200 * kMillisecond);
  Page page;
  page.take(
      {{"id", 1}, {"open", {{"system", system_json(two_plcs())}, {"recording", json_of(journal.recording(), models)}}}});
  page("station second");
  page("at 200ms");
  const auto counted = static_cast<std::int16_t>(load16(&rig.plc(1).cpu().state().image[image::kV + 10]));
  EXPECT_GT(counted, 7000);
  EXPECT_EQ(page("values VW10")["json"]["values"][0]["number"], counted);
}

TEST(Engine, RefusesASystemThatIsDamaged) {
  Page page;
  Json system = system_json(two_plcs());
  system["files"] = Json::array();
  EXPECT_EQ(page.take({{"id", 1}, {"open", {{"system", system}}}})["error"],
            "system: plant/two.yaml: cannot read plant/counts.stl: the report does not carry it");
  system = system_json(two_plcs());
  system["spots"] = {{0, 5, 0}};
  EXPECT_EQ(page.take({{"id", 1}, {"open", {{"system", system}}}})["error"], "system: a place that the system has not");
  Json deep = "x";
  for (int i = 0; i < 40; ++i) deep = Json::array({deep});
  system["tree"] = deep;
  EXPECT_EQ(page.take({{"id", 1}, {"open", {{"system", system}}}})["error"],
            "system: a system with too many maps in each other");
  EXPECT_TRUE(page("past").contains("error")) << "nothing is open";
}

}  // namespace
}  // namespace s7200::tools::page::engine_test

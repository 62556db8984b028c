// Saved sessions, and power that goes off and comes back.
#include "tools/session/commands/session_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

#include "tests/unit/debugger/session.hpp"
#include "tools/session/past/digest.hpp"

namespace s7200::tools::session_file_test {
namespace {

class SavedSession : public testing::Test {
 protected:
  SavedSession() { std::filesystem::create_directory(folder_); }
  ~SavedSession() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(file(name)) << text; }
  std::string read(const std::string& name) const {
    std::ifstream in(file(name));
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() / fmt::format("s7200_session_{}", getpid());
};

TEST_F(SavedSession, IsLoadedBitByBitIntoAnotherSession) {
  AtPrompt session(kEcho);
  session(
      "continue 50ms; set VW100=7; input I0.0=1; force VB200=3; fault flip:bit=0; send 41 42; continue; continue 1s; at "
      "60ms");
  const auto here = session.simulation.snapshot();
  session("save " + file("a.json"));
  AtPrompt other(kEcho);
  EXPECT_TRUE(has(other("scan 3; load " + file("a.json")), "in the past; going forward plays what has run, up to"));
  EXPECT_EQ(other.simulation.snapshot(), here);
  session("at end");
  other("at end");
  EXPECT_EQ(other.simulation.snapshot(), session.simulation.snapshot());
  EXPECT_TRUE(has(other("at start; back 3; back"), "back to before 'scan 3'"));
}

TEST_F(SavedSession, HasWhatOneCommandDidToAPlaceTwiceInItsOrder) {
  for (const std::string_view command : {"set VB20=5 VW20=1 VB20=7", "force VB20=5 VW20=1 VB20=7"}) {
    AtPrompt session(kEcho), other(kEcho);
    session(fmt::format("scan 3; {}; scan 3; expect VW20 = 16#0701; save {}", command, file("a.json")));
    other(fmt::format("load {}; expect VW20 = 16#0701", file("a.json")));
    EXPECT_EQ(other.simulation.snapshot(), session.simulation.snapshot()) << command;
  }
}

TEST_F(SavedSession, HasItsBreakpointsAndWatches) {
  AtPrompt session(kNested);
  session(
      "continue 12ms; break INT 0 if VW30 > 2 hits 2; break 4 always; watch VW30 write; watch VB20:2 VD100:real; "
      "break event 10 occurs; break error 0006 log \"it's {VW10}  at {time}\"; delete 2; save " +
      file("a.json"));
  EXPECT_TRUE(has(session.out.str(), "from outside; breakpoints and watches: 6\n"));
  const std::string there = session("break");
  AtPrompt other(kNested);
  EXPECT_TRUE(has(other("load " + file("a.json")), "breakpoints and watches of that session: 6; 'break' lists them\n"));
  EXPECT_EQ(other("break"), there);
  EXPECT_FALSE(has(other("load " + file("a.json")), "of that session")) << "they are there already";
  EXPECT_EQ(other("break"), there);
  EXPECT_EQ(session("delete 3 4 5 6; continue"), other("delete 3 4 5 6; continue")) << "they stop the same";
  EXPECT_TRUE(has(other.out.str(), "breakpoint 1, hit 2 times"));
  AtPrompt third(kNested);
  third("break 4; load " + file("a.json"));
  EXPECT_TRUE(has(third("break"), "1   break")) << "its own keeps its number";
  EXPECT_TRUE(has(third.out.str(), "2   break    0 hits  INT 0")) << "that of another one is not taken";
}

TEST_F(SavedSession, KeepsTheTypeOfAWatchOnAPartOfAnAccumulator) {
  AtPrompt session(kNested), other(kNested);
  session("set AC1=16#12345678; watch AC1:byte AC1:word AC0; save " + file("parts.json"));
  const std::string there = session("break");
  other("load " + file("parts.json"));
  EXPECT_EQ(other("break"), there);
  EXPECT_TRUE(has(there, "AC1:BYTE"));
}

TEST_F(SavedSession, KeepsAPowerCycleThatItBeganWith) {
  AtPrompt session(kNested);
  session("scan 5; set MB14=9; power 1s; scan 2; save " + file("a.json"));
  AtPrompt other(kNested);
  other("load " + file("a.json") + "; expect MB14 = 9");
  EXPECT_EQ(other.simulation.snapshot(), session.simulation.snapshot());
}

/// A bridge attaches its port before the session begins.
TEST_F(SavedSession, ThatHadAMasterOnABridgeIsLoadedWithoutTheBridge) {
  constexpr SerialFormat kFormat{9600, 8, Parity::None, 1};
  serial::Simulation simulation(program_of(kEcho));
  simulation.power_up();
  serial::HostPort& port = simulation.host_port();
  port.attach(kFormat, simulation.time());
  bool asked = false;
  PromptSettings options{.session = {.files = &files_of_commands()}};
  options.history.drive = [&](Time end, const auto&) {
    serial::Halt halt = simulation.run_until(std::min(end, simulation.time() + 300 * kMillisecond));
    if (halt != serial::Halt::Time) return halt;
    const serial::HostCharacter character{.byte = 0x41, .format = kFormat};
    if (!std::exchange(asked, true)) port.send({&character, 1}, simulation.time());
    return simulation.run_until(end);
  };
  std::ostringstream out;
  Prompt saving(std::vector{&simulation}, out, options);
  EXPECT_FALSE(saving.execute("continue 1s; expect VB1 = 16#41; save " + file("a.json")));
  AtPrompt session(kEcho);
  session("scan 2; load " + file("a.json") + "; expect VB1 = 16#41");
  EXPECT_EQ(session.state().instructions, simulation.cpu().state().instructions);
  session("at 1ms; expect VB1 = 0; at end; expect VB1 = 16#41; power; restart; scan 2");
}

TEST_F(SavedSession, OfAnotherProgramCpuVersionOrBeginningIsRefused) {
  AtPrompt session(kEcho);
  session("scan 2; save " + file("a.json"));
  AtPrompt another(kNested);
  EXPECT_TRUE(has(another.error_of("load " + file("a.json")), "it is of another program, or of other execution times"));
  AtPrompt cpu(check_text(kEcho, "test.stl", cpu215(), default_times(cpu215())).program);
  EXPECT_TRUE(has(cpu.error_of("load " + file("a.json")), "it is of a CPU 214, not of a CPU 215"));
  serial::Simulation simulation(program_of(kEcho));
  simulation.power_up();
  const std::uint8_t byte = 1;
  simulation.cpu().poke(image::kV, {&byte, 1});
  std::ostringstream out;
  Prompt otherwise(std::vector{&simulation}, out, {.session = {.files = &files_of_commands()}});
  EXPECT_TRUE(has(otherwise.execute("load " + file("a.json")).value_or(""), "it began with other memory or inputs"));
}

TEST_F(SavedSession, OfOtherOptionsIsRefusedWithTheirNamesAndBothValues) {
  const auto program = program_of(kEcho);
  serial::Simulation simulation(program);
  simulation.power_up();
  std::ostringstream out;
  serial::MasterSettings slow;
  slow.baud = 1200;
  slow.gap = 2 * kMillisecond;
  PromptSettings options{.session = {.master = slow, .files = &files_of_commands()}};
  options.session.options = {{"--fault", "flip:bit=0"}};
  Prompt saving(std::vector{&simulation}, out, options);
  EXPECT_FALSE(saving.execute("scan 2; save " + file("a.json")));
  AtPrompt session(program);
  EXPECT_TRUE(has(session.error_of("load " + file("a.json")),
                  "it was saved with other options: --baud 1200 (here as the port), --gap 2 ms (here none), "
                  "--fault flip:bit=0 (here none)"));
  EXPECT_FALSE(saving.execute("load " + file("a.json")));
}

TEST_F(SavedSession, OfAnotherTimeOfDayIsRefused) {
  const auto program = program_of(kEcho);
  AtPrompt session(program);
  session("scan 2; save " + file("a.json"));
  serial::Simulation later(program);
  later.power_up();
  later.cpu().set_clock({.year = 26, .month = 11, .day = 21});
  std::ostringstream out;
  Prompt debugger(std::vector{&later}, out, {.session = {.files = &files_of_commands()}});
  EXPECT_TRUE(
      has(debugger.execute("load " + file("a.json")).value_or(""), "--clock 90-01-01 00:00:00 (here 26-11-21 00:00:00)"));
}

TEST_F(SavedSession, DamagedIsRefusedWhereverTheDamageIs) {
  AtPrompt session(kEcho);
  session("scan 2; set VW100=7; save " + file("a.json"));
  const std::string whole = read("a.json");
  const auto here = session.simulation.snapshot();
  for (std::size_t i = 0; i + 2 < whole.size(); i += 7) {
    std::string damaged = whole;
    damaged[i] = damaged[i] == '3' ? '4' : '3';
    write("b.json", damaged);
    EXPECT_TRUE(has(session.error_of("load " + file("b.json")), "cannot load")) << i;
    write("b.json", whole.substr(0, i));
    EXPECT_TRUE(has(session.error_of("load " + file("b.json")), "cannot load")) << i;
  }
  EXPECT_EQ(session.simulation.snapshot(), here);
  EXPECT_TRUE(has(session.error_of("load " + file("none.json")), "cannot read"));
}

/// Someone has changed it, and its check sum with it.
TEST_F(SavedSession, ThatIsAsNoneIsWrittenIsRefusedThoughItsCheckSumIsRight) {
  using Json = nlohmann::ordered_json;
  const Json action{{"send", "01"},  {"format", {9600, 8, "even", 1}}, {"timeout", 5}, {"gap", 0},
                    {"sync", false}, {"at", {0, 0, false, false, 0}}};
  struct Case {
    std::string_view why;
    std::function<void(Json& json)> change;
  };
  const Case cases[] = {
      {"a breakpoint at nothing", [](Json& json) { json["stops"][0]["break"] = ""; }},
      {"a breakpoint at nothing", [](Json& json) { json["stops"][0]["break"] = "  "; }},
      {"a number that it cannot have", [](Json& json) { json["stops"][0]["number"] = 2147483647; }},
      {"more was done than it has", [](Json& json) { json["end"][1] = 5; }},
      {"more was done than it has", [](Json& json) { json["now"][1] = 5; }},
      {"it stands after its own end", [](Json& json) { json["now"][4] = 156'444'294'967'296'000; }},
      {"something was done after its end", [](Json& json) { json["actions"][0]["at"][4] = 156'440'004'294'967'296; }},
      {"an unknown action", [](Json& json) { json["actions"][0].erase("send"); }},
      {"a format of characters that there is not", [](Json& json) { json["actions"][0]["format"][0] = 0; }},
      {"a format of characters that there is not", [](Json& json) { json["actions"][0]["format"][1] = 77; }},
      {"a format of characters that there is not", [](Json& json) { json["actions"][0]["format"][3] = 0; }},
      {"1e+78 is not a whole number from 0 to 4294967295", [](Json& json) { json["actions"][0]["format"][0] = 1e78; }},
      {"timeout: -1 is not a whole number from 0 to", [](Json& json) { json["actions"][0]["timeout"] = -1; }},
      {"timeout: 1e+19 is not", [](Json& json) { json["actions"][0]["timeout"] = 1e19; }},
      {"number: 0.5 is not a whole number", [](Json& json) { json["stops"][0]["number"] = 0.5; }},
      {"sync: 1 is not true or false", [](Json& json) { json["actions"][0]["sync"] = 1; }},
      {"-1 is not a whole number", [](Json& json) { json["end"][0] = -1; }}};
  AtPrompt session(kEcho);
  session("break 9; save " + file("a.json"));
  for (const Case& one : cases) {
    Json json = Json::parse(read("a.json"));
    json.erase("sum");
    json["actions"].push_back(action);
    one.change(json);
    json["sum"] = digest_of(std::string_view(json.dump()));
    write("b.json", json.dump(2) + "\n");
    EXPECT_TRUE(has(session.error_of("load " + file("b.json")), one.why)) << json.dump();
  }
}

TEST_F(SavedSession, ThatIsNestedWithoutEndIsRefused) {
  AtPrompt session(kEcho);
  session("save " + file("a.json"));
  const std::string whole = read("a.json");
  for (const std::string open : {"[", "{\"a\":"}) {
    std::string nested;
    for (int i = 0; i < 100'000; ++i) nested += open;
    write("b.json", whole.substr(0, whole.rfind('}')) + ", \"more\": " + nested + '0' +
                        std::string(100'000, open == "[" ? ']' : '}') + "}\n");
    EXPECT_TRUE(has(session.error_of("load " + file("b.json")), "JSON of more than 64 maps and lists inside each other"));
  }
}

TEST_F(SavedSession, ThatTookMoreThanAWeekIsRunAgainOnlyIfThatIsAskedFor) {
  using Json = nlohmann::ordered_json;
  std::atomic<bool> stop = false;
  AtPrompt session(program_of(kEcho), StopToken(stop));
  session("scan 2; save " + file("a.json"));
  Json json = Json::parse(read("a.json"));
  json.erase("sum");
  json["end"].back() = 100'000'000 * kSecond;
  json["sum"] = digest_of(std::string_view(json.dump()));
  write("b.json", json.dump(2) + "\n");
  EXPECT_TRUE(
      has(session.error_of("load " + file("b.json")),
          "of simulated time are run again, which may take long; 'load " + file("b.json") + " !' does it all the same"));
  stop = true;
  EXPECT_TRUE(has(session.error_of("load " + file("b.json") + " !"), "nothing is loaded"));
}

TEST_F(SavedSession, ReplacesItsOwnKindOfFileAndOthersOnlyWhenToldTo) {
  AtPrompt session(kNested);
  session("save " + file("a.json") + "; scan; save " + file("a.json"));
  write("mine.txt", "mine");
  EXPECT_TRUE(has(session.error_of("save " + file("mine.txt")), "exists and is not a saved session; it is left alone"));
  EXPECT_EQ(read("mine.txt"), "mine");
  session("save " + file("mine.txt") + " !");
  EXPECT_TRUE(read("mine.txt").starts_with(session_beginning()));
}

TEST_F(SavedSession, IsToldToReplaceOnlyWhatIsThere) {
  AtPrompt session(kNested);
  write("mine.txt", "mine");
  EXPECT_TRUE(has(session.error_of("save " + file("mine.txt")), "mine.txt !' replaces it"));
  EXPECT_FALSE(has(session.error_of("save " + file("nowhere/a.json")), "!"));
}

TEST(PowerCommand, KeepsWhatTheCpuKeepsAndBackTakesItBack) {
  AtPrompt session(kNested);
  session("scan 5; set MB0=5 MB14=9");
  EXPECT_TRUE(has(session("power"), "retentive memory, EEPROM and clock are kept"));
  session("expect MB0 = 0 and MB14 = 9");
  EXPECT_EQ(session.state().time, 0);
  EXPECT_TRUE(has(session("power lost"), "the EEPROM is left, RAM and clock are lost"));
  session("expect MB14 = 0 and SM0.2; back 2; expect MB0 = 5");
}

TEST(PowerCommand, SaysThatARequestUnderWayWentDownToo) {
  AtPrompt session(kEcho);
  EXPECT_FALSE(has(session("continue 20ms; power"), "under way"));
  EXPECT_TRUE(has(session("continue 20ms; send 41 42; step; power"),
                  "under way when power went off, and nobody waits for an answer any more: 41 42\n"));
}

TEST(PowerCommand, WrongWordsTellWhatIsExpected) {
  AtPrompt session(kNested);
  EXPECT_TRUE(has(session.error_of("power soon"), "power expects off, on, or how long it was off"));
  EXPECT_TRUE(has(session.error_of("load"), "load expects a file"));
  EXPECT_TRUE(has(session.error_of("save"), "save expects a file"));
  EXPECT_TRUE(has(session.error_of("record a.yaml"), "scenarios cannot be written here"));
}

}  // namespace
}  // namespace s7200::tools::session_file_test

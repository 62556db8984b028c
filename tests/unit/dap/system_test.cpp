// A system in an editor: a thread for each PLC.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "tests/support/scratch_folder.hpp"
#include "tests/unit/debugger/system_bench.hpp"
#include "tools/faces/dap/session.hpp"

namespace s7200::tools::dap::system_test {
namespace {

class SystemDebuggee final : public Debuggee {
 public:
  explicit SystemDebuggee(std::string_view text) : bench(text), history_(bench.stations, {}) {}

  std::string source() const override { return "system.yaml"; }
  History& history() override { return history_; }
  SessionSetup setup() override {
    SessionSetup setup{.station = 1};
    for (const PlcPlan& plc : bench.rig->plan().plcs) setup.stations.push_back({.name = plc.name});
    return setup;
  }
  void when_saying(std::function<void(const std::string&)>) override {}
  std::vector<std::string> finish() override { return {}; }

  SystemBench bench;

 private:
  History history_;
};

struct SystemEditor {
  explicit SystemEditor(std::string_view text = kPolled)
      : debuggee(std::make_shared<SystemDebuggee>(text)),
        session({.launch = [this](const Json&) { return debuggee; }, .stop_request = StopToken(stop)},
                [this](const Json& message) { messages.push_back(message); }) {
    (*this)("initialize", {{"adapterID", "s7200"}});
    (*this)("launch", {{"stopOnEntry", true}});
    (*this)("configurationDone");
  }

  Json ask(const std::string& command, Json arguments = Json::object()) {
    const std::size_t first = messages.size();
    session.handle({{"seq", ++sent}, {"type", "request"}, {"command", command}, {"arguments", std::move(arguments)}});
    Json response;
    for (std::size_t i = first; i < messages.size(); ++i)
      if (messages[i]["type"] == "response") response = messages[i];
    if (session.runs()) session.run();
    return response;
  }
  Json operator()(const std::string& command, Json arguments = Json::object()) {
    const Json response = ask(command, std::move(arguments));
    EXPECT_TRUE(response["success"]) << response.dump(1);
    return response.value("body", Json::object());
  }
  Json stopped() const { return last("stopped"); }
  Json last(const std::string& event) const {
    for (auto i = messages.rbegin(); i != messages.rend(); ++i)
      if ((*i)["type"] == "event" && (*i)["event"] == event) return (*i)["body"];
    return {};
  }
  Json frame(int thread) { return (*this)("stackTrace", {{"threadId", thread}})["stackFrames"][0]; }
  std::string value(int thread, const std::string& expression) {
    return (*this)("evaluate", {{"expression", expression}, {"frameId", frame(thread)["id"]}})["result"];
  }
  std::uint64_t executed(std::size_t station) const { return debuggee->bench.stations[station]->plc().executed(); }

  std::atomic<bool> stop = false;
  std::vector<Json> messages;
  std::shared_ptr<SystemDebuggee> debuggee;
  Session session;
  int sent = 0;
};

constexpr int kMasterThread = 1, kSlave1Thread = 2, kSlave2Thread = 3;

TEST(DapSystem, EachPlcIsAThreadUnderItsName) {
  SystemEditor editor;
  const Json threads = editor("threads")["threads"];
  ASSERT_EQ(threads.size(), 3U);
  EXPECT_EQ(threads[0], (Json{{"id", kMasterThread}, {"name", "master"}}));
  EXPECT_EQ(threads[2], (Json{{"id", kSlave2Thread}, {"name", "slave2"}}));
  EXPECT_EQ(editor.stopped()["threadId"], kSlave1Thread) << "the one that is looked at first";
  EXPECT_EQ(editor.stopped()["allThreadsStopped"], true);
  EXPECT_EQ(editor("loadedSources")["sources"].size(), 2U) << "two slaves with one program";
}

TEST(DapSystem, TheProcessIsNamedByTheFileOfTheSystem) {
  SystemEditor editor;
  EXPECT_EQ(editor.last("process")["name"], "system.yaml");
}

TEST(DapSystem, ABreakpointHoldsAtEveryPlcThatHasTheLineAndTheStopSaysWhereItIs) {
  SystemEditor editor;
  const Json source = editor.frame(kSlave1Thread)["source"];
  const Json breakpoint =
      editor("setFunctionBreakpoints", {{"breakpoints", Json::array({{{"name", "received"}}})}})["breakpoints"][0];
  EXPECT_EQ(breakpoint["verified"], true) << breakpoint.dump();
  editor("continue", {{"threadId", kMasterThread}});
  std::set<int> threads;
  for (int i = 0; i < 8; ++i) {
    threads.insert(editor.stopped()["threadId"].get<int>());
    editor("continue", {{"threadId", editor.stopped()["threadId"]}});
  }
  EXPECT_EQ(threads, (std::set{kMasterThread, kSlave1Thread, kSlave2Thread}));
  editor("setFunctionBreakpoints", {{"breakpoints", Json::array()}});
  const int line = editor.frame(kSlave1Thread)["line"];
  editor("setBreakpoints", {{"source", source}, {"breakpoints", Json::array({{{"line", line}, {"condition", "always"}}})}});
  threads.clear();
  for (int i = 0; i < 6; ++i) {
    editor("continue", {{"threadId", kSlave1Thread}});
    threads.insert(editor.stopped()["threadId"].get<int>());
    EXPECT_EQ(editor.frame(editor.stopped()["threadId"])["line"], line);
  }
  EXPECT_EQ(threads, (std::set{kSlave1Thread, kSlave2Thread}));
}

TEST(DapSystem, AStepIsOfItsThreadAndAllOthersRunMeanwhileForwardsAndBackwards) {
  SystemEditor editor;
  editor("stepScan", {{"threadId", kMasterThread}, {"count", 3}});
  EXPECT_EQ(editor.stopped()["threadId"], kMasterThread);
  const serial::System::Snapshot before = editor.debuggee->bench.system().snapshot();
  const std::uint64_t master = editor.executed(kMaster), slave = editor.executed(kSlave1);
  for (int i = 0; i < 20; ++i) editor("stepIn", {{"threadId", kMasterThread}});
  EXPECT_EQ(editor.executed(kMaster), master + 20);
  EXPECT_GT(editor.executed(kSlave1), slave);
  for (int i = 0; i < 20; ++i) editor("stepBack", {{"threadId", kMasterThread}});
  EXPECT_TRUE(editor.debuggee->bench.system().snapshot() == before);
  editor("stepIn", {{"threadId", kSlave2Thread}});
  EXPECT_EQ(editor.stopped()["threadId"], kSlave2Thread);
  EXPECT_FALSE(editor.ask("next", {{"threadId", 4}})["success"]);
}

TEST(DapSystem, FramesVariablesAndMemoryAreThoseOfTheirThread) {
  SystemEditor editor;
  editor("stepScan", {{"threadId", kSlave1Thread}});
  const Json set = editor("setExpression",
                          {{"expression", "VW20"}, {"value", "16#1234"}, {"frameId", editor.frame(kSlave2Thread)["id"]}});
  EXPECT_EQ(editor.value(kSlave2Thread, "VW20"), "16#1234 (4660)");
  EXPECT_EQ(editor.value(kSlave1Thread, "VW20"), "16#0000 (0)");
  const std::string reference = set["memoryReference"];
  EXPECT_EQ(reference, "VW20@2");
  EXPECT_EQ(editor("readMemory", {{"memoryReference", reference}, {"count", 2}})["data"], "EjQ=");
  EXPECT_EQ(editor("readMemory", {{"memoryReference", "VW20@1"}, {"count", 2}})["data"], "AAA=");
  EXPECT_FALSE(editor.ask("readMemory", {{"memoryReference", "VW20@3"}, {"count", 2}})["success"]);
  const Json scopes = editor("scopes", {{"frameId", editor.frame(kSlave2Thread)["id"]}})["scopes"];
  for (const Json& scope : scopes) {
    if (scope["name"] != "V") continue;
    EXPECT_EQ(scope["memoryReference"], "V@2");
    const Json variables = editor("variables", {{"variablesReference", scope["variablesReference"]}})["variables"];
    EXPECT_GT(variables.size(), 10U);
  }
  const Json info = editor("dataBreakpointInfo", {{"name", "VW20"}, {"frameId", editor.frame(kSlave2Thread)["id"]}});
  EXPECT_EQ(info["dataId"], "VW20@2");
  const std::string instruction = editor.frame(kSlave2Thread)["instructionPointerReference"];
  const Json first = editor("disassemble", {{"memoryReference", instruction}, {"instructionCount", 1}})["instructions"][0];
  EXPECT_EQ(first["address"], instruction);
}

TEST(DapSystem, TheFilterOfUnansweredRequestsHearsPlcsThatAskOnceALine) {
  SystemEditor editor;  // the master asks before the slaves hear
  editor("setExceptionBreakpoints", {{"filters", {"unanswered"}}});
  editor("continue", {{"threadId", kSlave1Thread}});
  EXPECT_EQ(editor.stopped()["reason"], "exception");
  const std::string text = editor.stopped()["text"];
  EXPECT_NE(text.find("unanswered request, 01 03 00 00 00 02 c4 0b"), std::string::npos) << text;
  EXPECT_NE(text.find(", asked by master"), std::string::npos) << text;
  const auto said = std::ranges::count_if(editor.messages, [](const Json& message) {
    return message.value("event", "") == "output" &&
           message["body"]["output"].get<std::string>().find("asked by") != std::string::npos;
  });
  EXPECT_EQ(said, 1) << "not for each PLC on the line";
}

TEST(DapSystem, TheFilterOfWrongAnswersStopsAtOneThatAPlcCannotTake) {
  SystemEditor editor;
  editor("setExceptionBreakpoints", {{"filters", {"wrong"}}});
  editor("fault", {{"fault", "missing:of=answer,character=4"}});
  editor("continue", {{"threadId", kSlave1Thread}});
  EXPECT_EQ(editor.stopped()["reason"], "exception");
  const std::string text = editor.stopped()["text"];
  EXPECT_NE(text.find("wrong answer, 01 03 00 00 00 02 c4 0b, asked by master, answered 01 03 "), std::string::npos) << text;
  EXPECT_NE(text.find(": wrong CRC"), std::string::npos) << text;
}

TEST(DapSystem, AnExceptionIsThatOfItsThread) {
  SystemEditor editor;
  editor("setExceptionBreakpoints", {{"filters", {"unanswered"}}});
  editor("continue", {{"threadId", kSlave1Thread}});
  const int stopped = editor.stopped()["threadId"];
  EXPECT_EQ(editor("exceptionInfo", {{"threadId", stopped}})["exceptionId"], "unanswered request");
  for (int thread = kMasterThread; thread <= kSlave2Thread; ++thread) {
    if (thread == stopped) continue;
    const Json refused = editor.ask("exceptionInfo", {{"threadId", thread}});
    EXPECT_FALSE(refused["success"]);
    EXPECT_NE(refused["message"].get<std::string>().find(": it has not stopped for an exception"), std::string::npos);
  }
}

TEST(DapSystem, AnUnansweredRequestIsToldOnceThoughAnotherPlcHearsTwoLines) {
  const std::string folder = test::scratch_folder();
  std::ofstream(folder + "asks.stl")
      << "LD SM0.1\nMOVB 16#09, SMB30\nMOVB 8, VB100\nMOVD 16#0503000a, VD101\nMOVD 16#0001a58c, VD105\n"
         "LD SM0.0\nTON T37, 3\nLD T37\nEU\nXMT VB100, 0\nMEND\n";
  std::ofstream(folder + "idle.stl") << "LD SM0.0\n= Q0.0\nMEND\n";
  SystemEditor editor("plcs:\n  x: {program: " + folder + "asks.stl, cpu: 224}\n  gw: {program: " + folder +
                      "idle.stl, cpu: 226}\nlines:\n  office: {stations: [x, gw]}\n  field: {stations: [gw.1]}\n");
  editor("setExceptionBreakpoints", {{"filters", {"unanswered"}}});
  editor("continue", {{"threadId", 2}});
  EXPECT_EQ(editor.stopped()["threadId"], 1);
  const std::string text = editor.stopped()["text"];
  EXPECT_TRUE(text.starts_with("x: ")) << text;
  EXPECT_NE(text.find("05 03 00 0a 00 01 a5 8c, asked by x"), std::string::npos) << text;
  const auto said = std::ranges::count_if(editor.messages, [](const Json& message) {
    return message.value("event", "") == "output" &&
           message["body"]["output"].get<std::string>().find("asked by") != std::string::npos;
  });
  EXPECT_EQ(said, 1);
}

TEST(DapSystem, ALaunchThatSendsIsRefusedOnALineThatHasNoPlaceForAMaster) {
  const auto full = std::make_shared<SystemDebuggee>(
      "plcs: {master: {program: ../modbus_master.stl, cpu: 224}, slave: {program: ../modbus_slave.stl, copies: 31, station: "
      "1}}\nlines: {bus: {stations: [master, slave]}}\n");
  Json response;
  Session session({.launch = [&](const Json&) { return full; }}, [&](const Json& message) { response = message; });
  session.handle({{"seq", 1}, {"type", "request"}, {"command", "launch"}, {"arguments", {{"send", "01 03 crc"}}}});
  EXPECT_EQ(response["success"], false);
  EXPECT_EQ(response["message"],
            "send: this line has as many stations already as it takes: there is no place for one more master");
}

TEST(DapSystem, ARefusedStepLeavesThePlcThatIsLookedAt) {
  SystemEditor editor;
  editor("setExpression", {{"expression", "VW20"}, {"value", "7"}});
  EXPECT_FALSE(editor.ask("stepOut", {{"threadId", kSlave2Thread}})["success"]);
  EXPECT_EQ(editor("evaluate", {{"expression", "VW20"}})["result"], "16#0007 (7)");
}

TEST(DapSystem, MemoryOfAPlcWithoutPowerIsNotChanged) {
  SystemEditor editor;
  editor("goToMoment", {{"time", "end"}});
  editor.debuggee->history().act(SetPower{false}, kSlave2);
  const Json refused = editor.ask(
      "evaluate", {{"expression", "set VW20=1"}, {"context", "repl"}, {"frameId", editor.frame(kSlave2Thread)["id"]}});
  EXPECT_FALSE(refused["success"]);
  EXPECT_NE(refused["message"].get<std::string>().find("without power"), std::string::npos) << refused.dump();
}

}  // namespace
}  // namespace s7200::tools::dap::system_test

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "interpreter/program/load.hpp"
#include "tests/support/slave_bench.hpp"
#include "tests/unit/dap/editor.hpp"
#include "tools/json/base64.hpp"
#include "tools/session/commands/rows/command_table.hpp"

namespace s7200::tools::dap::session_test {
namespace {

testing::AssertionResult has(const std::string& text, std::string_view part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << part << "' is not in:\n" << text;
}

Json variable(Editor& editor, const std::string& scope, const std::string& name, int frame = 1) {
  const Json scopes = editor("scopes", {{"frameId", frame}});
  for (const Json& one : scopes["scopes"]) {
    if (one["name"] != scope) continue;
    const Json variables = editor("variables", {{"variablesReference", one["variablesReference"]}});
    for (const Json& found : variables["variables"])
      if (found["name"] == name) return found;
  }
  ADD_FAILURE() << scope << " has no " << name;
  return {{"value", ""}, {"variablesReference", 0}};
}

// --- messages ---

TEST(DapSession, EveryRequestHasOneResponseAndNumbersRise) {
  Editor editor(kNested);
  editor.begin();
  editor.lines({6});
  editor("continue", {{"threadId", 1}});
  std::int64_t last = 0;
  for (const Json& message : editor.messages) {
    EXPECT_EQ(message["seq"].get<std::int64_t>(), last + 1);
    last = message["seq"];
  }
}

TEST(DapSession, AnAttachThatIsRefusedLeavesTheLaunchThatFollowsALaunch) {
  Editor editor(kNested);
  editor("initialize", {{"adapterID", "s7200"}});
  EXPECT_EQ(editor.error_of("attach", {{"station", 999}}), "station: 999 is not from 0 to 255");
  editor("launch");
  editor.lines({6});
  editor("configurationDone");
  EXPECT_EQ(editor.stopped(), "breakpoint") << "not at the entry, as after an attach";
  editor("terminate");
  EXPECT_EQ(editor.last("exited")["exitCode"], 0);
  EXPECT_EQ(editor.debuggee->finished, 1);
}

TEST(DapSession, WhatIsNotOfferedIsRefusedByNameAndNotAnnounced) {
  Editor editor(kNested);
  EXPECT_TRUE(has(editor.error_of("frobnicate"), "'frobnicate' is not a request that is offered"));
  const Json capabilities = editor("initialize", {{"adapterID", "s7200"}});
  EXPECT_TRUE(capabilities["supportsStepBack"]);
  for (const char* other : {"supportsModulesRequest", "supportsTerminateThreadsRequest", "supportsStepInTargetsRequest",
                            "supportsExceptionOptions", "supportsSingleThreadExecutionRequests"})
    EXPECT_FALSE(capabilities.contains(other)) << other;
  EXPECT_TRUE(has(editor.error_of("stackTrace", {{"threadId", 1}}), "launch or attach comes first"));
}

TEST(DapSession, WrongArgumentsAreAnErrorAndTheSessionGoesOn) {
  Editor editor(kNested);
  editor.begin();
  EXPECT_EQ(editor.error_of("evaluate"), "expression is missing");
  EXPECT_EQ(editor.error_of("readMemory", {{"memoryReference", 5}, {"count", "x"}}), "memoryReference: 5 is not a text");
  EXPECT_EQ(editor.breakpoint({{"line", -3}})["message"], "there is no line -3: lines are counted from 1");
  EXPECT_TRUE(has(editor.error_of("lastWrite", {{"expression", "event 99"}}),
                  "there is no event 99; expected one address, or event and a number"));
  EXPECT_EQ(editor.error_of("evaluate", {{"expression", "1 / 0"}}), "'1 / 0', column 5: a division by 0");
  EXPECT_EQ(editor.error_of("evaluate", {{"expression", "1 / VW40"}}), "cannot be computed: a division by 0");
  EXPECT_FALSE(editor.breakpoint({{"line", 4}, {"condition", "1/0 = 1"}})["verified"]);
  EXPECT_TRUE(has(editor.breakpoint({{"line", 4}, {"logMessage", "a {VW2"}})["message"], "the closing } is missing"));
  EXPECT_EQ(editor.error_of("scopes", {{"frameId", 99999}}), "there is no frame 99999");
  EXPECT_EQ(editor.error_of("scopes", {{"frameId", 77}}), "there is no frame 77");
  EXPECT_EQ(editor.error_of("readMemory", {{"memoryReference", "VB0"}, {"count", -1}}), "count: -1 is less than 0");
  editor.session.handle(Json::array());
  editor.session.handle({{"type", "response"}});
  EXPECT_EQ(editor.value("1 + 1"), "2");
}

TEST(DapSession, ARefusalPopsUpUnlessTheEditorAsksInPassing) {
  Editor editor(kNested);
  editor.begin();
  const auto pops_up = [&](const char* request, const Json& arguments) {
    return editor.ask(request, arguments)["body"]["error"]["showUser"];
  };
  EXPECT_EQ(pops_up("evaluate", {{"expression", "no such"}, {"context", "watch"}}), false);
  EXPECT_EQ(pops_up("stlStatus", {{"source", {{"path", "another.stl"}}}, {"line", 0}}), false);
  EXPECT_EQ(pops_up("sendFrame", {{"frame", "zz"}}), true);
  editor.session.refuse({{"seq", 99}, {"type", "request"}, {"command", "stackTrace"}}, "cancelled");
  EXPECT_EQ(editor.messages.back()["body"]["error"]["showUser"], false) << "the editor has cancelled it";
}

TEST(DapSession, BackToAWriteFromOutsideStopsBeforeItAndFindsTheEarlierOneNext) {
  Editor editor(kNested);
  editor.begin();
  editor("setExpression", {{"expression", "VW40"}, {"value", "7"}});
  editor("stepIn", {{"threadId", 1}});
  editor("setExpression", {{"expression", "VW40"}, {"value", "8"}});
  EXPECT_TRUE(has(editor("reverseToLastWrite", {{"expression", "VW40"}})["text"].get<std::string>(),
                  "VW40 was 16#0007 (7), became 16#0008 (8)"));
  EXPECT_TRUE(has(editor("reverseToLastWrite", {{"expression", "VW40"}})["text"].get<std::string>(),
                  "VW40 was 16#0000 (0), became 16#0007 (7)"));
  EXPECT_TRUE(has(editor.error_of("reverseToLastWrite", {{"expression", "VW40"}}), "nothing has written VW40"));
}

TEST(DapSession, NothingInAMessageIsBelieved) {
  Editor editor(kNested);
  editor.begin();
  const Json values = Json::array({nullptr,
                                   true,
                                   -1,
                                   5,
                                   1e300,
                                   INT64_MAX,
                                   INT64_MIN,
                                   "",
                                   "V",
                                   "VB0",
                                   "(((",
                                   Json::array(),
                                   Json::object(),
                                   {{"path", "test.stl"}},
                                   std::string(100'000, '('),
                                   Json::array({{{"line", -1}}})});
  const char* const commands[] = {"setBreakpoints",
                                  "setFunctionBreakpoints",
                                  "setDataBreakpoints",
                                  "setInstructionBreakpoints",
                                  "setExceptionBreakpoints",
                                  "breakpointLocations",
                                  "dataBreakpointInfo",
                                  "gotoTargets",
                                  "stackTrace",
                                  "scopes",
                                  "variables",
                                  "evaluate",
                                  "completions",
                                  "disassemble",
                                  "readMemory",
                                  "writeMemory",
                                  "setVariable",
                                  "setExpression",
                                  "sendFrame",
                                  "timeline",
                                  "lastWrite",
                                  "lastInstructions",
                                  "stlStatus",
                                  "goToMoment",
                                  "stepBack",
                                  "cancel",
                                  "initialize",
                                  "launch"};
  const char* const keys[] = {"source",
                              "breakpoints",
                              "line",
                              "endLine",
                              "name",
                              "variablesReference",
                              "frameId",
                              "expression",
                              "text",
                              "column",
                              "memoryReference",
                              "offset",
                              "count",
                              "instructionCount",
                              "instructionOffset",
                              "data",
                              "value",
                              "frame",
                              "from",
                              "time",
                              "filters",
                              "start",
                              "startFrame",
                              "levels",
                              "send",
                              "step"};
  std::uint32_t random = 1;
  const auto next = [&random](std::size_t below) { return (random = random * 1'664'525 + 1'013'904'223) / 65'536 % below; };
  for (int i = 0; i < 20'000; ++i) {
    Json arguments = Json::object();
    for (int k = 0; k < 4; ++k) arguments[keys[next(std::size(keys))]] = values[next(values.size())];
    arguments["memoryReference"] = next(2) ? Json("VB0") : values[next(values.size())];
    editor.session.handle({{"seq", values[next(values.size())]},
                           {"type", next(50) ? Json("request") : values[next(values.size())]},
                           {"command", next(50) ? Json(commands[next(std::size(commands))]) : values[next(values.size())]},
                           {"arguments", next(20) ? arguments : values[next(values.size())]}});
    editor.messages.clear();
  }
  EXPECT_EQ(editor.value("1 + 1"), "2");
}

TEST(DapSession, ALaunchThatWasRefusedCanBeMended) {
  Editor editor(kNested);
  editor("initialize");
  EXPECT_TRUE(has(editor.error_of("launch", {{"stopOnEntry", "yes"}}), "stopOnEntry: \"yes\" is not true or false"));
  EXPECT_TRUE(has(editor.error_of("launch", {{"step", "mile"}}), "'mile' is not line or network"));
  EXPECT_TRUE(has(editor.error_of("launch", {{"send", "frob"}}), "frob"));
  EXPECT_TRUE(has(editor.error_of("launch", {{"sendAfter", "soon"}}), "'soon' is not a duration"));
  editor("launch", {{"stopOnEntry", true}});
  editor("configurationDone");
  EXPECT_EQ(editor.stopped(), "entry");
}

TEST(DapSession, AttributesOfOtherDebuggersAreTakenWithOneLine) {
  Editor editor(kNested);
  editor.begin({{"stopOnEntry", true},
                {"type", "s7200"},
                {"__restart", "x"},
                {"env", Json::object()},
                {"args", Json::array({"-x"})},
                {"console", "integratedTerminal"},
                {"host", "localhost"},
                {"restart", true},
                {"linux", {{"program", "x"}}}});
  EXPECT_EQ(editor.printed(), "without effect here (of other debuggers): env, args, console, host, restart, linux\n");
}

TEST(DapSession, AnAttachSaysWhichAttributesOfAProgramHaveNoEffect) {
  Editor editor(kNested);
  editor("initialize");
  editor("attach", {{"port", 4711}, {"trace", "a.trace"}, {"stopOnEntry", true}, {"name", "Attach"}});
  EXPECT_TRUE(has(editor.printed(), "the command line of s7200 dap says how this PLC runs): trace\n"));
}

TEST(DapSession, ASessionThatDisconnectsIsCompletedOnce) {
  Editor editor(kNested);
  editor.begin();
  editor("terminate");
  EXPECT_FALSE(editor.last("terminated").is_null());
  EXPECT_EQ(editor.debuggee->finished, 1);
  EXPECT_TRUE(has(editor.error_of("continue", {{"threadId", 1}}), "the session has ended"));
  editor("disconnect");
  EXPECT_TRUE(editor.session.is_over());
  EXPECT_EQ(editor.debuggee->finished, 1);
}

// --- stopping ---

TEST(DapSession, ItStopsAtTheEntryIfAsked) {
  Editor editor(kNested);
  editor.begin();
  EXPECT_EQ(editor.stopped(), "entry");
  EXPECT_EQ(editor.line(), 2);
  EXPECT_EQ(editor.frame()["name"], "main");
}

TEST(DapSession, ABreakpointSaysItsLineAndStopsThere) {
  Editor editor(kNested);
  editor.begin();
  const Json placed = editor.lines({4, 22, 99});
  EXPECT_TRUE(placed[0]["verified"]);
  EXPECT_EQ(placed[0]["line"], 5) << "NETWORK is not an instruction";
  EXPECT_TRUE(has(placed[0]["message"], "line 4 has no instruction"));
  EXPECT_FALSE(placed[2]["verified"]);
  EXPECT_TRUE(has(placed[2]["message"], "has no line 99"));
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.stopped(), "breakpoint");
  EXPECT_EQ(editor.last("stopped")["hitBreakpointIds"], Json::array({placed[0]["id"]}));
  EXPECT_EQ(editor.line(), 5);
}

TEST(DapSession, ConditionsHitsAndMessagesAreAsInTheEditor) {
  Editor editor(kNested);
  editor.begin();
  editor.breakpoint({{"line", 6}, {"condition", "VW10 = 4"}});
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.value("VW10"), "16#0004 (4)");
  editor.breakpoint({{"line", 6}, {"hitCondition", "> 2"}});
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.value("VW10"), "16#0007 (7)");
  const Json log = editor.breakpoint({{"line", 6}, {"logMessage", "scan {scan} has {VW10}"}});
  EXPECT_TRUE(log["verified"]);
  editor("stepScan", {{"threadId", 1}, {"count", 2}});
  EXPECT_TRUE(has(editor.printed(), "scan 9 has 8"));
  for (const Json& wrong : {Json{{"line", 6}, {"condition", "VW10 >"}}, Json{{"line", 6}, {"hitCondition", "often"}},
                            Json{{"line", 6}, {"logMessage", "{VW99999}"}}})
    EXPECT_FALSE(editor.breakpoint(wrong)["verified"]) << wrong;
}

TEST(DapSession, SpecialMemoryIsShownInWords) {
  Editor editor("LD SM0.1\nMOVB 16#09, SMB30\nMEND\n");
  editor.begin();
  editor("stepScan", {{"threadId", 1}});
  editor("stepScan", {{"threadId", 1}});
  EXPECT_TRUE(has(editor.value("SMB30"), "16#09 (9)  Freeport"));
  EXPECT_TRUE(has(editor.value("SM0.0"), "1  SM0.0 "));
  EXPECT_EQ(editor.value("VB0"), "16#00 (0)");
}

TEST(DapSession, BoxesWithoutPowerFlowAreSkippedUnlessAlways) {
  Editor editor("LDN SM0.0\nMOVB 1, VB0\nLD SM0.0\nINCW VW2\nMEND\n");
  editor.begin();
  editor.lines({2, 4});
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 4);
  EXPECT_TRUE(has(editor.printed(), "was passed once without power flow"));
  editor.breakpoint({{"line", 2}, {"condition", "always if VW2 = 1"}});
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 2);
  EXPECT_EQ(editor.value("VW2"), "16#0001 (1)");
}

TEST(DapSession, AlwaysIsRefusedForWhatHasNoPowerFlow) {
  constexpr std::string_view kWhy = "'always' is for places; what happens has no power flow";
  Editor editor(kNested);
  editor.begin();
  const Json data{{"dataId", "VW30"}, {"condition", "always"}},
      event{{"name", "event 10"}, {"condition", "always if VW30 = 1"}};
  EXPECT_EQ(editor("setDataBreakpoints", {{"breakpoints", Json::array({data})}})["breakpoints"][0]["message"], kWhy);
  EXPECT_EQ(editor("setFunctionBreakpoints", {{"breakpoints", Json::array({event})}})["breakpoints"][0]["message"], kWhy);
}

TEST(DapSession, ASymbolThatBeginsWithAlwaysIsOne) {
  Editor editor(kNested);
  editor.begin();
  const Json refused = editor.breakpoint({{"line", 6}, {"condition", "Always_Open = 1"}});
  EXPECT_FALSE(refused["verified"]);
  EXPECT_TRUE(has(refused["message"], "Always_Open")) << refused;
  EXPECT_TRUE(editor.breakpoint({{"line", 6}, {"condition", "Always_On = 1"}})["verified"]);  // SM0.0
}

TEST(DapSession, ABreakpointAfterTheEndOfItsFileSaysWhereThatIs) {
  Editor editor(kNested);
  editor.begin();
  const Json answer = editor("setBreakpoints", {{"source", {{"path", "test.stl"}}}, {"breakpoints", {{{"line", 99999}}}}});
  EXPECT_FALSE(answer["breakpoints"][0]["verified"]);
  EXPECT_EQ(answer["breakpoints"][0]["message"], "test.stl has no line 99999; its last one is 23");
}

TEST(DapSession, ABreakpointThatStaysKeepsItsHits) {
  Editor editor(kNested);
  editor.begin();
  const Json wanted{{"line", 6}, {"hitCondition", "3"}};
  const int id = editor.breakpoint(wanted)["id"];
  editor.breakpoint({{"line", 6}, {"hitCondition", "3"}});
  editor("stepScan", {{"threadId", 1}, {"count", 2}});
  const Json both = editor("setBreakpoints", {{"source", {{"path", "test.stl"}}},
                                              {"breakpoints", Json::array({wanted, {{"line", 22}}})}})["breakpoints"];
  EXPECT_EQ(both[0]["id"], id);
  EXPECT_NE(both[1]["id"], id);
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.value("VW10"), "16#0002 (2)");
}

TEST(DapSession, FunctionBreakpointsTakeRoutinesAndEvents) {
  Editor editor(kNested);
  editor.begin();
  const auto stop_at = [&](const std::string& name) {
    const Json placed =
        editor("setFunctionBreakpoints", {{"breakpoints", Json::array({{{"name", name}}})}})["breakpoints"][0];
    EXPECT_TRUE(placed["verified"]) << placed;
    editor("continue", {{"threadId", 1}});
    EXPECT_EQ(editor.stopped(), "function breakpoint") << name;
    return editor.frame()["name"].get<std::string>();
  };
  EXPECT_EQ(stop_at("SBR 2"), "SBR 2");
  EXPECT_TRUE(has(stop_at("INT 0"), "INT 0 for event 10"));
  EXPECT_TRUE(has(stop_at("event 10"), "INT 0"));
  EXPECT_FALSE(stop_at("event 10 occurs").empty());
  EXPECT_TRUE(has(stop_at("Timed interrupt 0, SMB34"), "INT 0"));
  EXPECT_EQ(stop_at("NETWORK 2"), "main");
  const Json wrong = editor("setFunctionBreakpoints", {{"breakpoints", Json::array({{{"name", "SBR 9"}}, {{"name", ""}}})}});
  EXPECT_EQ(wrong["breakpoints"][0]["message"], "the program has no SBR 9");
  EXPECT_FALSE(wrong["breakpoints"][1]["verified"]);
}

TEST(DapSession, DataBreakpointsStopAfterAChangeAReadOrAnyWrite) {
  Editor editor(kNested);
  editor.begin();
  const auto stop_at = [&](const Json& wanted) {
    const Json placed = editor("setDataBreakpoints", {{"breakpoints", Json::array({wanted})}})["breakpoints"][0];
    EXPECT_TRUE(placed["verified"]) << placed;
    editor("continue", {{"threadId", 1}});
    EXPECT_EQ(editor.stopped(), "data breakpoint") << wanted;
    return editor.last("stopped")["text"].get<std::string>();
  };
  const Json info = editor("dataBreakpointInfo", {{"name", "VW30"}});
  EXPECT_EQ(info["dataId"], "VW30");
  EXPECT_TRUE(
      has(stop_at({{"dataId", "VW30"}, {"accessType", "write"}}), "VW30 was 16#0000 (0), is 16#0001 (1), by INT 0 line 22"));
  EXPECT_TRUE(has(stop_at({{"dataId", "VW10"}, {"accessType", "read"}}), "VW10"));
  EXPECT_TRUE(has(stop_at({{"dataId", "VW10"}, {"accessType", "readWrite"}, {"condition", "VW10 > 5"}}), "VW10"));
  EXPECT_EQ(editor.last("stopped")["hitBreakpointIds"].size(), 1u) << "read and written by one instruction: one stop";
  EXPECT_EQ(editor("dataBreakpointInfo", {{"name", "VB20"}, {"bytes", 4}})["dataId"], "VB20:4");
  EXPECT_EQ(editor("dataBreakpointInfo", {{"name", "VW10 write"}})["dataId"], "VW10 write");
  EXPECT_EQ(editor("dataBreakpointInfo", {{"name", "*VD100"}})["dataId"], "VB20");
  EXPECT_TRUE(editor("dataBreakpointInfo", {{"name", "frob"}})["dataId"].is_null());
  const Json memory = editor("readMemory", {{"memoryReference", "VB20"}, {"count", 1}});
  EXPECT_EQ(editor("dataBreakpointInfo", {{"name", memory["address"]}, {"asAddress", true}, {"bytes", 2}})["dataId"],
            "VB20:2");
}

TEST(DapSession, InstructionBreakpointsStopAtInstructionsOfTheDisassembly) {
  Editor editor(kNested);
  editor.begin();
  const Json list = editor("disassemble", {{"memoryReference", editor.frame()["instructionPointerReference"]},
                                           {"instructionOffset", -1},
                                           {"instructionCount", 30}})["instructions"];
  ASSERT_EQ(list.size(), 30u);
  EXPECT_EQ(list[0]["presentationHint"], "invalid");
  EXPECT_TRUE(has(list[1]["instruction"], "LD      SM0.1"));
  EXPECT_EQ(list[1]["symbol"], "main");
  EXPECT_EQ(list[4]["line"], 6);
  const Json placed =
      editor("setInstructionBreakpoints",
             {{"breakpoints", Json::array({{{"instructionReference", list[4]["address"]}},
                                           {{"instructionReference", list[5]["address"]}}})}})["breakpoints"];
  EXPECT_EQ(placed[0]["message"], "stops without power flow, too") << "INCW is a box";
  EXPECT_FALSE(placed[1].contains("message")) << "MEND has nothing to do with power flow";
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.stopped(), "instruction breakpoint");
  EXPECT_EQ(editor.line(), 6);
  EXPECT_TRUE(has(editor("disassemble", {{"memoryReference", list[16]["address"]},
                                         {"instructionCount", 1}})["instructions"][0]["instruction"],
                  "*VD100 = VB20"));
}

TEST(DapSession, RunTimeErrorsStopByTheirCodes) {
  Editor editor("LD SM0.0\nMOVD 16#7F000000, VD0\nMOVB 1, *VD0\nMEND\n");
  editor.begin();
  const auto filter = [&](const Json& options) {
    return editor("setExceptionBreakpoints",
                  {{"filters", Json::array()}, {"filterOptions", Json::array({options})}})["breakpoints"][0];
  };
  EXPECT_TRUE(filter({{"filterId", "error"}, {"condition", "0091, 0006"}})["verified"]);
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.stopped(), "exception");
  EXPECT_EQ(editor("exceptionInfo", {{"threadId", 1}})["exceptionId"], "run-time error 0006");
  EXPECT_TRUE(has(editor.printed(), "0006"));
  EXPECT_FALSE(filter({{"filterId", "error"}, {"condition", "often"}})["verified"]);
  EXPECT_FALSE(filter({{"filterId", "frob"}})["verified"]);
  editor("next", {{"threadId", 1}});
  EXPECT_TRUE(has(editor.error_of("exceptionInfo", {{"threadId", 1}}), "has not stopped for an exception"));
}

TEST(DapSession, AnExceptionIsNamedByItsCodeAndByNoNumberThatTheClientDoesNotKnow) {
  Editor editor("LD SM0.0\nMOVD 16#7F000000, VD0\nMOVB 1, *VD0\nMEND\n");
  editor.begin();
  editor("setExceptionBreakpoints", {{"filters", Json::array({"error"})}});
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor("exceptionInfo", {{"threadId", 1}})["exceptionId"], "run-time error 0006");
  EXPECT_TRUE(editor.last("stopped")["text"].get<std::string>().starts_with("run-time error, "));
  EXPECT_FALSE(has(editor.printed(), "breakpoint "));
}

TEST(DapSession, ARunTimeErrorOfABadPointerTellsItsValueAndWhoWroteIt) {
  Editor editor("LD SM0.0\nMOVD 16#7F000000, VD10\nMOVB 1, *VD10\nMEND\n");
  editor.begin();
  editor("setExceptionBreakpoints", {{"filters", Json::array({"error"})}});
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.stopped(), "exception");
  EXPECT_TRUE(has(editor.printed(), "*VD10: VD10 is 16#7F000000, which points nowhere"));
  EXPECT_TRUE(has(editor.printed(), "by main line 2 "));
}

TEST(DapSession, TheWatchdogStopsInFrontOfTheInstructionAndTheSessionLives) {
  Editor editor("LD SM0.0\nLBL 1\nINCW VW0\nJMP 1\nMEND\n");
  editor("initialize");
  editor("launch");
  editor("setExceptionBreakpoints", {{"filters", Json::array({"watchdog"})}});
  editor("configurationDone");
  EXPECT_EQ(editor.stopped(), "exception");
  EXPECT_TRUE(has(editor.last("stopped")["text"], "fatal error 0003"));
  EXPECT_EQ(editor.state().mode, Mode::Run) << "in front of it";
  editor("setExceptionBreakpoints", {{"filters", Json::array()}});
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.state().mode, Mode::Stop);
  EXPECT_EQ(editor.frame()["name"], "STOP");
  editor("stepBack", {{"threadId", 1}});
  EXPECT_EQ(editor.state().mode, Mode::Run);
}

// --- stepping ---

TEST(DapSession, StepsGoOverIntoAndOut) {
  Editor editor(kNested);
  editor.begin();
  editor("next", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 3);
  editor("stepIn", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 8);
  EXPECT_EQ(editor.frame()["name"], "SBR 1");
  EXPECT_EQ(editor.frame(1)["line"], 3) << "the CALL";
  editor("stepOut", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 5);
  EXPECT_EQ(editor.stopped(), "step");
  EXPECT_TRUE(has(editor.error_of("stepOut", {{"threadId", 1}}), "main program"));
}

TEST(DapSession, AStatementIsANetwork) {
  Editor editor(kNested);
  editor.begin();
  editor("next", {{"threadId", 1}, {"granularity", "statement"}});
  EXPECT_EQ(editor.line(), 5);
  editor("stepBack", {{"threadId", 1}, {"granularity", "statement"}});
  EXPECT_EQ(editor.line(), 16) << "the last routine that began";
  editor("reverseStepOver", {{"threadId", 1}, {"granularity", "line"}});
  EXPECT_EQ(editor.frame()["name"], "SBR 1");
  Editor by_networks(kNested);
  by_networks.begin({{"stopOnEntry", true}, {"step", "network"}});
  by_networks("next", {{"threadId", 1}});
  EXPECT_EQ(by_networks.line(), 5);
  by_networks("next", {{"threadId", 1}, {"granularity", "instruction"}});
  EXPECT_EQ(by_networks.line(), 6);
}

TEST(DapSession, EveryStepGoesBackToo) {
  Editor editor(kNested);
  editor.begin();
  for (int i = 0; i < 4; ++i) editor("stepIn", {{"threadId", 1}});
  const State there = editor.state();
  EXPECT_EQ(editor.line(), 10);
  editor("reverseStepOut", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 3);
  EXPECT_TRUE(has(editor.printed(), "in the past"));
  editor("stepIn", {{"threadId", 1}});
  editor("stepIn", {{"threadId", 1}});
  editor("stepIn", {{"threadId", 1}});
  EXPECT_EQ(editor.state(), there);
  editor("stepBack", {{"threadId", 1}, {"count", 2}});
  EXPECT_EQ(editor.line(), 8);
  editor("reverseContinue", {{"threadId", 1}});
  EXPECT_TRUE(has(editor.last("stopped")["description"], "oldest moment"));
}

TEST(DapSession, StepsGoByInterruptsTooInBothDirections) {
  Editor editor(kNested);
  editor.begin();
  editor("stepInterrupt", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 20);
  editor("stepInterrupt", {{"threadId", 1}, {"end", true}});
  EXPECT_FALSE(editor.state().in_interrupt);
  editor("reverseStepInterrupt", {{"threadId", 1}, {"end", true}});
  EXPECT_EQ(editor.line(), 23);
  editor("reverseStepInterrupt", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 20);
}

TEST(DapSession, AFrameThatNobodyWantedLeadsToWhatDetachedItsEvent) {
  Editor editor(
      "LD SM0.1\nMOVB 16#09, SMB30\nATCH 1, 8\nENI\nLD I0.0\nEU\nDTCH 8\nMEND\n"
      "INT 1\nLD SM0.0\nMOVB SMB2, VB1\nMOVB 1, VB0\nXMT VB0, 0\nRETI\n");
  editor.begin();
  editor("evaluate", {{"expression", "set I0.0=1"}, {"context", "repl"}});
  for (int scan = 0; scan < 3; ++scan) editor("stepScan", {{"threadId", 1}});
  editor("setExceptionBreakpoints", {{"filters", {"unanswered"}}});
  editor("sendFrame", {{"frame", "41 42"}});
  editor("continue", {{"threadId", 1}});
  const Json decision = editor("lastDecision");
  EXPECT_TRUE(has(decision["text"], "no answer to 2 characters since "));
  EXPECT_TRUE(has(decision["text"], "event 8 is not attached; detached at "));
  EXPECT_EQ(decision["line"], 7);
  editor("reverseToLastDecision", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 7);
}

TEST(DapSession, AMessageThatHasNotEndedLeadsToItsRCV) {
  Editor editor(check_text("LD SM0.1\nMOVB 9, SMB30\nMOVB 16#B0, SMB87\nMOVB 16#0D, SMB89\nMOVW 5, SMW90\nMOVB 10, SMB94\n"
                           "RCV VB100, 0\nMEND\n",
                           "test.stl", cpu224(), default_times(cpu224()))
                    .program);
  editor.begin();
  editor("stepScan", {{"threadId", 1}, {"count", 100}});
  editor("setExceptionBreakpoints", {{"filters", {"unanswered"}}});
  editor("sendFrame", {{"frame", "41 42"}});
  editor("continue", {{"threadId", 1}});
  const Json decision = editor("lastDecision");
  EXPECT_TRUE(has(decision["text"], "RCV took them and waits for the end of its message: the character 16#0D or 10 "));
  EXPECT_EQ(decision["line"], 7);
  editor("reverseToLastDecision", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 7);
}

TEST(DapSession, ARequestUnderWayIsGivenUp) {
  Editor editor("LD SM0.1\nMOVB 16#09, SMB30\nATCH 1, 8\nENI\nMEND\nINT 1\nLD SM0.0\nMOVB SMB2, VB1\nRETI\n");
  editor.begin();
  EXPECT_TRUE(has(editor.error_of("sendFrame", {{"frame", "cancel"}}), "no request of the simulated master is under way"));
  for (int scan = 0; scan < 3; ++scan) editor("stepScan", {{"threadId", 1}});
  editor("sendFrame", {{"frame", "41 42"}});
  EXPECT_EQ(editor("sendFrame", {{"frame", "cancel"}})["frame"], "41 42");
  editor("evaluate", {{"expression", "send 43"}, {"context", "repl"}});
  EXPECT_TRUE(has(editor("evaluate", {{"expression", "send cancel"}, {"context", "repl"}})["result"],
                  "given up before its first character: 43"));
}

TEST(DapSession, WhatDecidedIsNamedAndReached) {
  Editor editor("LD SM0.0\nAN I0.0\nJMP 1\nLD SM0.0\nINCW VW0\nLBL 1\nLD SM0.0\nINCW VW2\nMEND\n");
  editor.begin();
  EXPECT_TRUE(has(editor("lastDecision")["text"], "nothing has decided"));
  EXPECT_TRUE(has(editor("evaluate", {{"expression", "why"}, {"context", "repl"}})["result"], "nothing has decided"));
  EXPECT_TRUE(has(editor("evaluate", {{"expression", "who VW40"}, {"context", "repl"}})["result"],
                  "nothing has written VW40 since power-up; it is "));
  EXPECT_TRUE(has(editor("lastWrite", {{"expression", "VW40"}})["text"], "nothing has written VW40"));
  EXPECT_TRUE(has(editor.error_of("reverseToLastDecision", {{"threadId", 1}}), "nothing has decided"));
  editor.lines({8});
  editor("continue", {{"threadId", 1}});
  EXPECT_TRUE(has(editor("evaluate", {{"expression", "why"}, {"context", "repl"}})["result"], "JMP 1 in line 3 (LD SM0.0"));
  EXPECT_EQ(editor("lastDecision")["line"], 3);
  EXPECT_EQ(editor.line(), 8);
  editor("reverseToLastDecision", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 3);
  EXPECT_EQ(editor.last("stopped")["description"], "in front of what decided");
}

TEST(DapSession, GoingBackToADecisionIsRefusedWhereNoInstructionIsNamed) {
  Editor editor(test::slave_text());
  editor.begin();
  editor("stepScan", {{"threadId", 1}, {"count", 20}});
  editor("fault", {{"fault", "missing:of=answer,character=each"}});
  editor("setExceptionBreakpoints", {{"filters", {"unanswered"}}});
  editor("sendFrame", {{"frame", "01 03 00 0a 00 01 crc"}});
  editor("continue", {{"threadId", 1}});
  EXPECT_TRUE(has(editor("lastDecision")["text"], "missing"));
  const std::size_t messages = editor.messages.size();
  const std::string refused = editor.error_of("reverseToLastDecision", {{"threadId", 1}});
  EXPECT_TRUE(has(refused, "missing")) << "why nothing came is said all the same";
  EXPECT_TRUE(has(refused, "\nit was lost on the line, which no instruction has decided; 'at "));
  EXPECT_EQ(editor.messages.size(), messages + 1) << "nothing but the response";
}

TEST(DapSession, AFaultOfTheLineBeginsNow) {
  Editor editor("LD SM0.1\nMOVB 16#09, SMB30\nATCH 1, 8\nENI\nMEND\nINT 1\nLD SM0.0\nMOVB SMB2, VB1\nRETI\n");
  editor.begin();
  editor("stepScan", {{"threadId", 1}, {"count", 3}});
  EXPECT_EQ(editor("fault", {{"fault", "flip:bit=0"}})["text"],
            "on the line from now on: flip\n  one bit inverted: character=1, bit=0, of=request\n");
  editor("sendFrame", {{"frame", "41"}});
  editor("setDataBreakpoints", {{"breakpoints", Json::array({{{"dataId", "VB1"}}})}});
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.value("VB1"), "16#40 (64)");
  EXPECT_TRUE(has(editor.error_of("fault", {{"fault", "frob"}}), "fault, column 1"));
  EXPECT_EQ(editor("evaluate", {{"expression", "fault none"}, {"context", "repl"}})["result"],
            "the line has no fault any more\n");
}

TEST(DapSession, ReverseContinueGoesToTheLastStop) {
  Editor editor(kNested);
  editor.begin();
  editor("stepScan", {{"threadId", 1}, {"count", 5}});
  editor.breakpoint({{"line", 6}, {"condition", "VW10 = 2"}});
  editor("reverseContinue", {{"threadId", 1}});
  EXPECT_EQ(editor.stopped(), "breakpoint");
  EXPECT_EQ(editor.value("VW10"), "16#0002 (2)");
  editor("reverseStepScan", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 2);
  editor("goToMoment", {{"time", "end"}});
  EXPECT_EQ(editor.value("VW10"), "16#0005 (5)");
  editor("goToMoment", {{"time", "-1us"}});
  EXPECT_TRUE(has(editor.error_of("goToMoment", {{"time", "10s"}}), "nothing has run after"));
  EXPECT_TRUE(has(editor.error_of("goToMoment", {{"time", "soon"}}), "'soon' is not a moment; write for example 15.193ms"));
}

TEST(DapSession, LongReversalsReportTheirProgress) {
  Editor editor(kNested);
  editor.begin();
  editor("stepScan", {{"threadId", 1}, {"count", 200}});
  editor("reverseContinue", {{"threadId", 1}});
  const Json start = editor.last("progressStart"), end = editor.last("progressEnd");
  ASSERT_FALSE(start.is_null());
  EXPECT_TRUE(start["cancellable"]);
  EXPECT_EQ(start["progressId"], end["progressId"]);
}

TEST(DapSession, ARequestToStopEndsAReversalWhereItBegan) {
  Editor editor(kNested);
  editor.begin();
  editor("stepScan", {{"threadId", 1}, {"count", 20}});
  const State there = editor.state();
  editor.stop = true;
  editor("reverseContinue", {{"threadId", 1}});
  EXPECT_EQ(editor.stopped(), "pause");
  EXPECT_EQ(editor.state(), there);
}

TEST(DapSession, AMessageInterruptsARunThatGoesOnAndAPauseEndsIt) {
  Editor editor(kNested);
  editor.stop = true;  // as the reader of messages does when one comes
  editor.begin(Json::object());
  EXPECT_TRUE(editor.session.runs());
  EXPECT_EQ(editor.stopped(), "not at all");
  EXPECT_EQ(editor.value("VW10").substr(0, 3), "16#");
  EXPECT_TRUE(has(editor.error_of("next", {{"threadId", 1}}), "the program runs: pause it first"));
  editor("pause", {{"threadId", 1}});
  EXPECT_EQ(editor.stopped(), "pause");
  EXPECT_FALSE(editor.session.runs());
}

TEST(DapSession, AFailureOfThePeerStopsTheProgramAndTheSessionLives) {
  Editor editor(kNested);
  editor.begin();
  editor.debuggee->failure_text = "the device has gone";
  editor.lines({6});
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.last("stopped")["description"], "the device has gone");
  EXPECT_EQ(editor.value("1"), "1");
  editor("stepBack", {{"threadId", 1}});
  EXPECT_EQ(editor.last("stopped")["description"], "step") << "said once";
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.stopped(), "breakpoint") << "and the program goes on without it";
}

TEST(DapSession, GotoLeadsToAnotherInstructionOfTheRoutine) {
  Editor editor(kNested);
  editor.begin();
  const auto targets = [&](int line) {
    return editor("gotoTargets", {{"source", {{"path", "test.stl"}}}, {"line", line}})["targets"];
  };
  EXPECT_TRUE(targets(22).empty()) << "another routine";
  const Json target = targets(6)[0];
  editor("goto", {{"threadId", 1}, {"targetId", target["id"]}});
  EXPECT_EQ(editor.stopped(), "goto");
  EXPECT_EQ(editor.line(), 6);
  editor("next", {{"threadId", 1}});
  EXPECT_EQ(editor.line(), 7);
  editor("stepBack", {{"threadId", 1}, {"count", 2}});
  EXPECT_EQ(editor.line(), 2);
  EXPECT_TRUE(has(editor.error_of("goto", {{"threadId", 1}, {"targetId", 77}}), "gotoTargets"));
}

TEST(DapSession, ARestartPowersUpAgain) {
  Editor editor(kNested);
  editor.begin();
  editor("stepScan", {{"threadId", 1}, {"count", 5}});
  editor("restart");
  EXPECT_EQ(editor.stopped(), "entry");
  EXPECT_EQ(editor.state().scans, 0u);
  EXPECT_EQ(editor.value("VW10"), "16#0000 (0)");
}

TEST(DapSession, ARestartWithOtherArgumentsTakesThoseOfTheSessionAndSaysWhichItCannotTake) {
  Editor editor(kNested);
  const Json before{{"stopOnEntry", true}, {"program", "a.stl"}, {"cpu", "214"}, {"__sessionId", "1"}};
  editor.begin(before);
  editor("restart", {{"arguments", before}});
  EXPECT_FALSE(has(editor.printed(), "restart:"));
  EXPECT_EQ(editor.stopped(), "entry");
  editor("restart",
         {{"arguments", {{"stopOnEntry", true}, {"step", "network"}, {"program", "b.stl"}, {"__sessionId", "2"}}}});
  EXPECT_TRUE(has(editor.printed(), "for another program, cpu end the session and begin a new one"));
}

TEST(DapSession, FramesOfTheLaunchAreSentAgainOnABranchThatBeginsBefore) {
  Editor editor(kNested);
  editor.begin({{"stopOnEntry", true}, {"send", "01 02"}, {"sendAfter", "50ms"}});
  const auto frames = [&] {
    return std::ranges::count_if(editor.debuggee->history().actions(),
                                 [](const Action& action) { return std::holds_alternative<SendFrame>(action); });
  };
  editor("setFunctionBreakpoints", {{"breakpoints", Json::array({{{"name", "sent"}}, {{"name", "unanswered"}}})}});
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(frames(), 1);
  editor("goToMoment", {{"threadId", 1}, {"time", "20ms"}});
  editor("setExpression", {{"expression", "VW100"}, {"value", "7"}});
  EXPECT_EQ(frames(), 0) << "a new branch";
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(frames(), 1);
}

TEST(DapSession, WhatIsNeitherRequestNorResponseIsComplainedOf) {
  Editor editor(kNested);
  editor.begin();
  editor.session.handle(Json::object());
  EXPECT_TRUE(has(editor.printed(), "skipped what is not a message: '{}' has no type 'request'"));
  editor.session.handle({{"type", "response"}, {"request_seq", 1}});
  EXPECT_FALSE(has(editor.printed(), "request_seq"));
}

TEST(DapSession, ADataBreakpointTakesASymbolWithABlank) {
  const auto read = [](std::string_view text, const char* name) { return *read_source(std::string(text), name); };
  Editor editor(check(join_files({read("LD SM0.0\nMOVW 5, \"Pump 1\"\nMEND\n", "p.awl"),
                                  read("Symbol\tAddress\nPump 1\tVW100\n", "t.txt")})
                          .parsed,
                      cpu214(), default_times(cpu214()))
                    .program);
  editor.begin();
  const Json info = editor("dataBreakpointInfo", {{"name", "\"Pump 1\" write"}});
  EXPECT_EQ(info["dataId"], "VW100 write");
  EXPECT_TRUE(editor("setDataBreakpoints",
                     {{"breakpoints", Json::array({{{"dataId", info["dataId"]}}})}})["breakpoints"][0]["verified"]);
}

// --- seeing ---

TEST(DapSession, FramesAreTheRoutinesThatAreOpen) {
  Editor editor(kNested);
  editor.begin();
  editor("setFunctionBreakpoints", {{"breakpoints", Json::array({{{"name", "SBR 2"}}})}});
  editor("continue", {{"threadId", 1}});
  const Json trace = editor("stackTrace", {{"threadId", 1}});
  ASSERT_EQ(trace["totalFrames"], 3);
  EXPECT_EQ(trace["stackFrames"][1]["name"], "SBR 1");
  EXPECT_EQ(trace["stackFrames"][1]["line"], 14);
  EXPECT_EQ(trace["stackFrames"][2]["name"], "main");
  EXPECT_EQ(editor("stackTrace", {{"threadId", 1}, {"startFrame", 1}, {"levels", 1}})["stackFrames"][0]["name"], "SBR 1");
}

TEST(DapSession, ScopesShowTheMachine) {
  Editor editor(kNested);
  editor.begin();
  editor("setDataBreakpoints", {{"breakpoints", Json::array({{{"dataId", "VW30"}}})}});
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(variable(editor, "Logic stack", "S0")["value"], "1");
  EXPECT_EQ(variable(editor, "V", "VW30")["value"], "16#0001 (1)");
  EXPECT_EQ(variable(editor, "SM", "SMB34 timed interrupts: interval in ms")["value"], "16#05 (5)");
  EXPECT_TRUE(has(variable(editor, "T", "T37")["value"], "counts 100 ms"));
  EXPECT_TRUE(has(variable(editor, "Runtime", "serving")["value"], "event 10"));
  EXPECT_TRUE(has(variable(editor, "Port", "SMB30")["value"], "PPI"));
  EXPECT_EQ(variable(editor, "AC", "AC0")["memoryReference"], "AC0");
  const Json byte = variable(editor, "Q", "QB0");
  EXPECT_EQ(editor("variables", {{"variablesReference", byte["variablesReference"]}})["variables"].size(), 8u);
  const Json block = variable(editor, "V", "VB0…VB255");
  EXPECT_EQ(editor("variables", {{"variablesReference", block["variablesReference"]},
                                 {"start", 20},
                                 {"count", 1},
                                 {"format", {{"hex", true}}}})["variables"][0]["value"],
            "16#07");
}

TEST(DapSession, ExpressionsAreInStlTerms) {
  Editor editor(kNested);
  editor.begin();
  editor("stepScan", {{"threadId", 1}, {"count", 3}});
  EXPECT_EQ(editor.value("VW10 * 2 + 1"), "7");
  EXPECT_EQ(editor.value("*VD100"), "16#07 (7)");
  EXPECT_EQ(editor.value("VB20:3"), "07 00 00");
  EXPECT_EQ(editor("evaluate", {{"expression", "VW10"}, {"format", {{"hex", true}}}})["result"], "16#0003");
  editor("setExpression", {{"expression", "VD200"}, {"value", "16#7F000000"}});
  const std::string bad = editor.error_of("evaluate", {{"expression", "*VD200"}});
  EXPECT_TRUE(has(bad, "*VD200: VD200 is 16#7F000000, which points nowhere"));
  EXPECT_TRUE(has(bad, "by 'set VD200', from outside"));
  EXPECT_TRUE(has(editor.error_of("evaluate", {{"expression", "frob"}}), "is not an address"));
  EXPECT_TRUE(has(editor.error_of("evaluate", {{"expression", "1 / 0"}}), "division by 0"));
  EXPECT_TRUE(has(editor.error_of("evaluate", {{"expression", std::string(5000, '(') + "1"}}), "nested too deeply"));
  std::string chain = "1";
  for (int i = 0; i < 200'000; ++i) chain += "+1";
  EXPECT_TRUE(has(editor.error_of("evaluate", {{"expression", chain}}), "more than 1000 operators"));
  EXPECT_EQ(editor.value(std::string(50, '(') + "1" + std::string(50, ')')), "1");
}

TEST(DapSession, CompletionsKnowTheAddressesOfTheProgram) {
  Editor editor(kNested);
  editor.begin();
  const Json targets = editor("completions", {{"text", "VW10 + vw3"}, {"column", 11}})["targets"];
  ASSERT_EQ(targets.size(), 1u);
  EXPECT_EQ(targets[0]["label"], "VW30");
  EXPECT_EQ(targets[0]["start"], 8) << "a column, which counts from 1 here as in the request";
  EXPECT_EQ(targets[0]["length"], 3);
}

TEST(DapSession, CompletionsKnowTheAreasOfTheCpu) {
  Editor editor("LD SM0.0\nINCW VW10\nMEND\n");
  editor.begin();
  const auto offered = [&](const std::string& text) {
    const Json targets = editor("completions", {{"text", text}, {"column", text.size() + 1}})["targets"];
    std::vector<std::string> labels;
    for (const Json& target : targets) labels.push_back(target["label"]);
    return labels;
  };
  using Words = std::vector<std::string>;
  EXPECT_EQ(offered("V"), (Words{"VB", "VD", "VW", "VW10", "values"}));
  EXPECT_EQ(offered("1 + A"), (Words{"AC", "AIW", "AQW"}));
  EXPECT_EQ(offered("1 + T"), Words{"T"});
}

// --- doing ---

TEST(DapSession, VariablesAndExpressionsAreSet) {
  Editor editor(kNested);
  editor.begin();
  const Json scopes = editor("scopes", {{"frameId", 1}})["scopes"];
  const auto v = std::ranges::find_if(scopes, [](const Json& scope) { return scope["name"] == "V"; });
  const Json set =
      editor("setVariable", {{"variablesReference", (*v)["variablesReference"]}, {"name", "VW10"}, {"value", "16#0102"}});
  EXPECT_EQ(set["value"], "16#0102 (258)");
  EXPECT_EQ(editor.value("VB11"), "16#02 (2)");
  editor("setExpression", {{"expression", "M0.3"}, {"value", "1"}});
  EXPECT_EQ(editor.value("MB0"), "16#08 (8)");
  const auto refused = [&](const char* expression, const char* value) {
    return editor.error_of("setExpression", {{"expression", expression}, {"value", value}});
  };
  EXPECT_EQ(refused("VB0", "256"), "'256' is not a value that fits VB0: a byte is -128 to 255");
  EXPECT_EQ(refused("M0.3", "2"), "'2' is not a value that fits M0.3: a bit is 0 to 1");
  EXPECT_EQ(refused("VW10", "x"), "'x' is not a value that fits VW10: a word is -32768 to 65535");
  EXPECT_EQ(refused("T37", "65536"),
            "'65536' is not a value that fits T37: a word is -32768 to 65535, and T37 counts 100 ms");
  EXPECT_EQ(refused("VD20:real", "x"), "'x' is not a value that fits VD20:real: a REAL is up to 3.4e38, of either sign");
  EXPECT_EQ(refused("VB0:4", "1"), "'VB0:4' is not one value but 4");
  EXPECT_TRUE(has(editor.error_of("setExpression", {{"expression", "SM0.0"}, {"value", "0"}}), "SM0.0 cannot be set"));
  editor("setExpression", {{"expression", "I0.0"}, {"value", "1"}});
  EXPECT_TRUE(has(editor.printed(), "when the next scan reads its inputs"));
}

TEST(DapSession, ARequestInStopIsGivenUpAndAModeRequestStartsTheProgram) {
  Editor editor(kNested);
  editor.begin();
  const auto console = [&](const char* line) { return editor("evaluate", {{"expression", line}, {"context", "repl"}}); };
  editor("stepScan", {{"threadId", 1}, {"count", 5}});
  console("mode stop");
  EXPECT_EQ(editor.frame()["name"], "STOP");
  console("send 01 03 00 00 00 02 crc");
  editor("continue", {{"threadId", 1}});
  EXPECT_TRUE(has(editor.printed(), "answer   none within 1 s"));
  EXPECT_EQ(editor.last("stopped")["description"], "the CPU is in STOP");
  console("mode run");
  editor("stepScan", {{"threadId", 1}});
  EXPECT_NE(editor.frame()["name"], "STOP");
  EXPECT_TRUE(has(editor.error_of("evaluate", {{"expression", "mode run"}, {"context", "repl"}}), "is in RUN already"));
}

TEST(DapSession, TheOnlyPlcLosesPowerWhileStepsLetTimePassAndTheWayBackStays) {
  Editor editor(kNested);
  editor.begin();
  const auto console = [&](const char* line) { return editor("evaluate", {{"expression", line}, {"context", "repl"}}); };
  const auto time = [&] { return editor.debuggee->simulation().time(); };
  editor("stepScan", {{"threadId", 1}, {"count", 5}});
  console("power off");
  EXPECT_EQ(editor.frame()["name"], "without power");
  EXPECT_TRUE(has(editor.error_of("evaluate", {{"expression", "power off"}, {"context", "repl"}}), "without power already"));
  EXPECT_TRUE(has(editor.error_of("setExpression", {{"expression", "VW10"}, {"value", "1"}}), "'power on' in the console"));
  const Time off = time();
  editor("next", {{"threadId", 1}});
  EXPECT_EQ(editor.stopped(), "step");
  EXPECT_EQ(time(), off + 100 * kMillisecond);
  editor("continue", {{"threadId", 1}});
  EXPECT_TRUE(has(editor.last("stopped")["description"].get<std::string>(), "the PLC is without power"));
  console("power on");
  editor("stepScan", {{"threadId", 1}});
  EXPECT_NE(editor.frame()["name"], "without power");
  EXPECT_GT(time(), off);
  editor("goToMoment", {{"time", "start"}});
  EXPECT_EQ(time(), 0);
  editor("goToMoment", {{"time", "end"}});
  EXPECT_GT(time(), off + 100 * kMillisecond);
}

TEST(DapSession, AStackTraceNamesLineAndFileIfItIsAskedTo) {
  Editor editor(kNested);
  editor.begin();
  const auto name = [&](const Json& format) {
    return editor("stackTrace", {{"threadId", 1}, {"format", format}})["stackFrames"][0]["name"].get<std::string>();
  };
  EXPECT_EQ(name({{"hex", true}}), "main");
  EXPECT_EQ(name({{"line", true}}), "main, line 2");
  EXPECT_EQ(name({{"module", true}, {"line", true}}), "test.stl!main, line 2");
}

TEST(DapSession, SettingInThePastBeginsABranch) {
  Editor editor(kNested);
  editor.begin();
  editor("stepScan", {{"threadId", 1}, {"count", 5}});
  editor("reverseStepScan", {{"threadId", 1}});
  editor("setExpression", {{"expression", "VW10"}, {"value", "100"}});
  EXPECT_TRUE(has(editor.printed(), "a new branch begins here"));
  editor("stepScan", {{"threadId", 1}});
  EXPECT_EQ(editor.value("VW10"), "16#0065 (101)");
}

TEST(DapSession, MemoryIsReadWrittenAndToldOf) {
  Editor editor(kNested);
  editor.begin();
  const Json end = editor("readMemory", {{"memoryReference", "VB4090"}, {"count", 16}});
  EXPECT_EQ(end["unreadableBytes"], 10);
  EXPECT_EQ(from_base64(end["data"].get<std::string>())->size(), 6u);
  editor("readMemory", {{"memoryReference", "V"}, {"offset", 20}, {"count", 2}});
  EXPECT_EQ(editor("writeMemory", {{"memoryReference", "VB20"}, {"data", "AQI="}})["bytesWritten"], 2);
  EXPECT_EQ(editor.value("VW20"), "16#0102 (258)");
  EXPECT_EQ(editor.last("memory")["memoryReference"], "VB4090");
  EXPECT_EQ(editor.last("memory")["offset"], 20 - 4090);
  EXPECT_EQ(editor.last("memory")["count"], 2);
  EXPECT_TRUE(has(editor.error_of("writeMemory", {{"memoryReference", "VB4095"}, {"data", "AQI="}}), "past the end"));
  EXPECT_EQ(editor("writeMemory", {{"memoryReference", "VB4095"}, {"data", "AQI="}, {"allowPartial", true}})["bytesWritten"],
            1);
  EXPECT_TRUE(has(editor.error_of("readMemory", {{"memoryReference", "frob"}, {"count", 1}}), "is not memory of this CPU"));
  EXPECT_FALSE(editor("readMemory", {{"memoryReference", "VB0"}, {"offset", -50}, {"count", 10}}).contains("data"));
  const std::size_t before = editor.messages.size();
  editor("stepScan", {{"threadId", 1}, {"count", 1}});
  bool told = false;
  for (std::size_t i = before; i < editor.messages.size(); ++i) told |= editor.messages[i].value("event", "") == "memory";
  EXPECT_TRUE(told) << "the program has written";
}

TEST(DapSession, EveryScopeHasMemoryThatIsReadAndToldOf) {
  Editor editor(kNested);
  editor.begin();
  const Json scopes = editor("scopes", {{"frameId", 1}})["scopes"];
  for (const Json& scope : scopes) {
    ASSERT_TRUE(scope.contains("memoryReference")) << scope;
    EXPECT_TRUE(editor("readMemory", {{"memoryReference", scope["memoryReference"]}, {"count", 1}}).contains("data"))
        << scope;
  }
  const auto told = [&](const char* command) {
    const std::size_t before = editor.messages.size();
    editor(command, {{"threadId", 1}});
    std::set<std::string> references;
    for (std::size_t i = before; i < editor.messages.size(); ++i)
      if (editor.messages[i].value("event", "") == "memory")
        references.insert(editor.messages[i]["body"]["memoryReference"].get<std::string>());
    return references;
  };
  EXPECT_TRUE(told("stepIn").contains("stack")) << "LD has pushed a level";
  EXPECT_TRUE(told("stepScan").contains("SMB0")) << "the first scan is over";
}

TEST(DapSession, TheLogicStackIsMemoryOfNineLevelsAndThatOfWhatRunsCanBeSet) {
  Editor editor(kNested);
  editor.begin();
  editor("setFunctionBreakpoints", {{"breakpoints", Json::array({{{"name", "SBR 1"}}})}});
  editor("continue", {{"threadId", 1}});
  editor("stepIn", {{"threadId", 1}});
  editor("stepIn", {{"threadId", 1}});
  ASSERT_EQ(editor.line(), 10);
  const auto levels = [&](const char* reference) {
    return *from_base64(editor("readMemory", {{"memoryReference", reference}, {"count", 9}})["data"].get<std::string>());
  };
  EXPECT_EQ(levels("stack"), (std::vector<std::uint8_t>{1, 1, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(levels("stack:1"), (std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 0, 0, 0})) << "of the caller";
  EXPECT_EQ(editor("writeMemory", {{"memoryReference", "stack"}, {"data", "AA=="}})["bytesWritten"], 1);
  EXPECT_EQ(editor.last("memory")["memoryReference"], "stack");
  EXPECT_EQ(variable(editor, "Logic stack", "S0")["value"], "0");
  editor("stepIn", {{"threadId", 1}});
  EXPECT_EQ(editor.value("SMB34"), "16#00 (0)") << "MOVB had no power flow";
  const Json scope = editor("scopes", {{"frameId", 1}})["scopes"][0];
  const Json set =
      editor("setVariable", {{"variablesReference", scope["variablesReference"]}, {"name", "S0"}, {"value", "1"}});
  EXPECT_EQ(set["value"], "1");
  EXPECT_TRUE(editor.state().stack.top());
  EXPECT_EQ(levels(set["memoryReference"].get<std::string>().c_str()).size(), 9u);
  EXPECT_TRUE(has(
      editor.error_of("setVariable", {{"variablesReference", scope["variablesReference"]}, {"name", "S0"}, {"value", "2"}}),
      "0 or 1"));
  EXPECT_TRUE(has(editor.error_of("writeMemory", {{"memoryReference", "stack"}, {"data", "Ag=="}}), "is 0 or 1, not 2"));
  EXPECT_TRUE(has(editor.error_of("writeMemory", {{"memoryReference", "stack:1"}, {"data", "AA=="}}), "the others wait"));
  EXPECT_TRUE(has(editor.error_of("readMemory", {{"memoryReference", "stack:99"}, {"count", 1}}), "is not memory"));
  EXPECT_EQ(editor("readMemory", {{"memoryReference", "stack:7"}, {"count", 9}})["unreadableBytes"], 9);
  editor("stepBack", {{"threadId", 1}});
  EXPECT_FALSE(editor.state().stack.top()) << "going back undoes it";
}

TEST(DapSession, TheAccumulatorsThatAnInterruptedRoutineWillFindAgainAreMemoryToo) {
  Editor editor(
      "LD SM0.1\nMOVB 5, SMB34\nATCH 0, 10\nENI\nLD SM0.0\nMOVD 16#0A0B0C0D, AC0\n"
      "FOR VW0, 1, 5000\nLD SM0.0\nINCW VW4\nNEXT\nMEND\nINT 0\nLD SM0.0\nMOVD 5, AC0\nRETI\n");
  editor.begin();
  editor.lines({15});
  editor("continue", {{"threadId", 1}});
  ASSERT_EQ(editor("stackTrace", {{"threadId", 1}})["stackFrames"].size(), 2u);
  const Json scope = editor("scopes", {{"frameId", 2}})["scopes"][1];
  EXPECT_EQ(scope["memoryReference"], "AC:1");
  EXPECT_EQ(editor("readMemory", {{"memoryReference", "AC:1"}, {"count", 4}})["data"], "CgsMDQ==");
  EXPECT_EQ(editor("readMemory", {{"memoryReference", "AC"}, {"count", 4}})["data"], "AAAABQ==");
  EXPECT_TRUE(has(editor.error_of("writeMemory", {{"memoryReference", "AC:1"}, {"data", "AA=="}}), "cannot be set"));
}

TEST(DapSession, TheConsoleHasWordsForWhatTheEditorHasNone) {
  Editor editor(kNested);
  editor.begin();
  editor("stepScan", {{"threadId", 1}, {"count", 3}});
  const auto console = [&](const std::string& line) {
    return editor("evaluate", {{"expression", line}, {"context", "repl"}})["result"].get<std::string>();
  };
  EXPECT_TRUE(has(console("who VB20"), "by SBR 2 line 18"));
  EXPECT_TRUE(has(console("who event 10"), "ATCH: INT 0 to event 10"));
  EXPECT_TRUE(has(console("history 3"), "line 6"));
  EXPECT_EQ(console("set VW40=5"), "16#0005 (5)");
  EXPECT_TRUE(has(console("help"), "who ADDRESS"));
  EXPECT_EQ(console("Help"), console("help"));
  EXPECT_TRUE(has(console("fault"), "the line has no fault now"));
  console("fault flip:character=3,bit=5");
  EXPECT_TRUE(has(console("fault"), "flip"));
  EXPECT_EQ(console("VW40 = 5"), "1");
  editor("reverseToLastWrite", {{"expression", "VB20"}});
  EXPECT_EQ(editor.line(), 18);
}

TEST(DapSession, TheConsoleHasEveryCommandOfTheTable) {
  Editor editor(kNested);
  editor.begin();
  const auto console = [&](const std::string& line) {
    return editor("evaluate", {{"expression", line}, {"context", "repl"}})["result"].get<std::string>();
  };
  const std::string help = console("help");
  for (const CommandRow& row : command_table()) {
    EXPECT_TRUE(has(help, row.name)) << row.name;
    EXPECT_TRUE(has(console(fmt::format("help {}", row.name)), row.syntax)) << row.name;
  }
  const auto offers = [&](const std::string& text) {
    return editor("completions", {{"text", text}, {"column", text.size() + 1}})["targets"].dump();
  };
  EXPECT_TRUE(has(offers("rwh"), "rwho"));
  EXPECT_TRUE(has(offers("break eve"), "event"));
  EXPECT_TRUE(has(offers("mode r"), "run"));
}

TEST(DapSession, ACommandThatMovesTheSessionStopsThere) {
  Editor editor(kNested);
  editor.begin();
  const auto console = [&](const std::string& line) {
    return editor("evaluate", {{"expression", line}, {"context", "repl"}})["result"].get<std::string>();
  };
  EXPECT_TRUE(has(console("step 2"), ">     8  SBR     1"));
  EXPECT_TRUE(has(editor.printed(), "CALL    1")) << "what it came by is told on the way";
  EXPECT_EQ(editor.last("stopped")["description"], "step 2");
  EXPECT_TRUE(has(console("break 22; continue"), "breakpoint 1"));
  EXPECT_EQ(editor.last("breakpoint")["reason"], "new");
  EXPECT_EQ(editor.line(), 22);
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.stopped(), "function breakpoint");
  EXPECT_EQ(editor.line(), 22);
  EXPECT_TRUE(has(console("back"), "back to before 'continue'")) << "that of the editor";
  EXPECT_EQ(editor.last("stopped")["description"], "back");
  console("delete all");
  EXPECT_EQ(editor.last("breakpoint")["reason"], "removed");
  EXPECT_TRUE(
      has(editor.error_of("evaluate", {{"expression", "step; over 3"}, {"context", "repl"}}), "over takes no argument"));
  EXPECT_EQ(editor.last("stopped")["description"], "over 3") << "the step before it is done";
  EXPECT_TRUE(
      has(editor.error_of("evaluate", {{"expression", "save a.json"}, {"context", "repl"}}), "neither read nor written"));
}

TEST(DapSession, WhatIsForcedHoldsAcrossScansUntilItIsReleased) {
  Editor editor(kNested);
  editor.begin();
  const Json forced = editor("force", {{"values", {"VW10=7", "I0.0=1"}}})["forced"];
  EXPECT_EQ(forced[0], (Json{{"name", "I0.0"}, {"value", "1"}})) << forced;
  editor("stepScan", {{"threadId", 1}, {"count", 3}});
  EXPECT_EQ(editor.value("VW10"), "16#0007 (7)");
  EXPECT_EQ(editor("force")["forced"].size(), 2U);
  EXPECT_TRUE(has(editor.error_of("force", {{"values", {"M0.3=1"}}}), "'M0.3=1' cannot be forced"));
  EXPECT_TRUE(has(editor.error_of("unforce", {{"places", {"VW12"}}}), "VW12 is not forced"));
  EXPECT_TRUE(editor("unforce", {{"places", {"all"}}})["forced"].empty());
  const auto console = [&](const std::string& line) {
    return editor("evaluate", {{"expression", line}, {"context", "repl"}})["result"].get<std::string>();
  };
  EXPECT_EQ(console("force VW10 = 5"), "VW10     16#0005 (5)\n");
  EXPECT_EQ(console("unforce all"), "nothing is forced");
  editor("stepScan", {{"threadId", 1}, {"count", 2}});
  EXPECT_EQ(editor.value("VW10"), "16#0007 (7)") << "5, and two scans more";
}

TEST(DapSession, RequestsByNameGoToTheStationOfTheLaunchUnlessTheyNameOne) {
  Editor editor("LD SM0.1\nMOVB 16#49, SMB30\nMEND\n");
  editor("initialize");
  EXPECT_TRUE(has(editor.error_of("launch", {{"station", 300}}), "300 is not from 0 to 255"));
  editor("launch", {{"stopOnEntry", true}, {"station", 7}});
  editor("configurationDone");
  editor("stepScan", {{"threadId", 1}, {"count", 3}});
  EXPECT_EQ(editor("sendFrame", {{"frame", "read 40011:2"}})["frame"], "07 03 00 0a 00 02 e4 6f");
  EXPECT_TRUE(has(editor.error_of("sendFrame", {{"frame", "read 11:2"}}), "'read 11:2': "));
}

/// The second of two characters comes before the routine of the first has begun, and the queue holds one.
TEST(DapSession, QueueOverflowAndLostCharactersStopByTheirFilters) {
  Editor overflow("LD SM0.1\nMOVB 16#09, SMB30\nATCH 0, 8\nLD SM0.0\nINCW VW0\nMEND\nINT 0\nRETI\n");
  overflow("initialize");
  overflow("launch", {{"send", "01 02 03 04 05 06"}, {"sendAfter", "100ms"}});
  overflow("setExceptionBreakpoints", {{"filters", Json::array({"overflow"})}});
  overflow("configurationDone");
  EXPECT_EQ(overflow.stopped(), "exception");
  EXPECT_TRUE(has(overflow("exceptionInfo", {{"threadId", 1}}).dump(), "event 8 (port 0: character received) LOST"));

  Editor lost("LD SM0.1\nMOVB 16#09, SMB30\nLD SM0.0\nINCW VW0\nMEND\n");
  lost("initialize");
  lost("launch", {{"send", "41"}, {"sendAfter", "100ms"}});
  lost("setExceptionBreakpoints", {{"filters", Json::array({"lost"})}});
  lost("configurationDone");
  EXPECT_EQ(lost.stopped(), "exception");
  EXPECT_TRUE(has(lost("exceptionInfo", {{"threadId", 1}}).dump(), "ignored  41: event 8 is not attached"));
}

TEST(DapSession, AnUnansweredRequestOfTheLaunchStopsThoughTheNextOneWaits) {
  Editor editor(
      "LD SM0.1\nMOVB 16#09, SMB30\nATCH 1, 8\nENI\nMEND\n"
      "INT 1\nLDB= SMB2, 16#42\nMOVB SMB2, VB1\nMOVB 1, VB0\nXMT VB0, 0\nRETI\n");
  editor("initialize");
  editor("launch", {{"send", Json::array({"41", "42"})}, {"sendAfter", "100ms"}});
  editor("setExceptionBreakpoints", {{"filters", Json::array({"unanswered"})}});
  editor("configurationDone");
  EXPECT_EQ(editor.stopped(), "exception");
  EXPECT_TRUE(has(editor("exceptionInfo", {{"threadId", 1}}).dump(), "unanswered"));
}

TEST(DapSession, TheStatusHasWhatEachLineDidLast) {
  Editor editor(kNested);
  editor.begin();
  editor("stepScan", {{"threadId", 1}, {"count", 3}});
  const Json lines = editor("stlStatus", {{"source", {{"path", "test.stl"}}}, {"line", 1}, {"endLine", 7}})["lines"];
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[1]["line"], 3);
  EXPECT_FALSE(lines[1]["powerFlow"]);
  EXPECT_EQ(lines[3]["text"], "S0=1 VW10=16#0003");
}

TEST(DapSession, LinesCountFromZeroForAnEditorThatCountsSo) {
  Editor editor(kNested);
  editor("initialize", {{"linesStartAt1", false}, {"columnsStartAt1", false}});
  editor("launch", {{"stopOnEntry", true}});
  EXPECT_EQ(editor.lines({5})[0]["line"], 5);
  editor("configurationDone");
  EXPECT_EQ(editor.line(), 1);
  EXPECT_EQ(editor.frame()["column"], 0);
}

TEST(DapSession, RandomWalksStandWhereAPlainRunHasBeen) {
  Editor plain(kNested), walk(kNested);
  plain.begin();
  walk.begin();
  std::vector<State> states{plain.state()};
  std::size_t at = 0;
  std::uint32_t random = 1;
  for (int step = 0; step < 400; ++step) {
    random = random * 1'664'525 + 1'013'904'223;
    const bool back = random >> 31 && at > 0;
    walk(back ? "stepBack" : "stepIn", {{"threadId", 1}});
    at = back ? at - 1 : at + 1;
    while (states.size() <= at) {
      plain("stepIn", {{"threadId", 1}});
      states.push_back(plain.state());
    }
    ASSERT_EQ(walk.state(), states[at]) << step;
  }
}

TEST(DapSession, StopsThatCanNeverHappenAreNotVerified) {
  Editor editor(kNested);
  editor.begin();
  const Json functions = editor("setFunctionBreakpoints", {{"breakpoints", {{{"name", "event 27"}}}}})["breakpoints"];
  EXPECT_EQ(functions[0]["verified"], false);
  const Json filters =
      editor("setExceptionBreakpoints",
             {{"filters", Json::array()}, {"filterOptions", {{{"filterId", "error"}, {"condition", "9999"}}}}});
  EXPECT_EQ(filters["breakpoints"][0]["verified"], false);
}

TEST(DapSession, AGranularityThatIsNoneIsRefused) {
  Editor editor(kNested);
  editor.begin();
  EXPECT_TRUE(
      has(editor.error_of("next", {{"threadId", 1}, {"granularity", "foo"}}), "is not statement, line or instruction"));
  EXPECT_TRUE(has(editor.error_of("stepIn", {{"threadId", 1}, {"granularity", 7}}), "7 is not statement"));
}

TEST(DapSession, AnInputThatIsSetAsAVariableSaysWhenTheProgramFindsIt) {
  Editor editor(kNested);
  editor.begin();
  editor("stepScan", {{"threadId", 1}});
  const Json scopes = editor("scopes", {{"frameId", 1}})["scopes"];
  for (const Json& scope : scopes)
    if (scope["name"] == "I")
      editor("setVariable", {{"variablesReference", scope["variablesReference"]}, {"name", "IB0"}, {"value", "1"}});
  EXPECT_TRUE(has(editor.printed(), "the program finds them in I when the next scan reads its inputs"));
}

// --- what comes up together, and what is written beside it ---

constexpr std::string_view kWatchdog = "LD SM0.0\nINCW VW0\nLBL 1\nLD SM0.0\nJMP 1\nMEND\n";

TEST(DapSession, AFatalErrorIsToldThoughABreakpointIsHitWithIt) {
  Editor editor(kWatchdog);
  editor.begin();
  const Json mode = editor("setFunctionBreakpoints", {{"breakpoints", Json::array({{{"name", "mode"}}})}})["breakpoints"][0];
  editor("continue", {{"threadId", 1}});
  const Json stopped = editor.last("stopped");
  EXPECT_EQ(stopped["reason"], "exception");
  EXPECT_TRUE(has(stopped["text"].get<std::string>(), "fatal error"));
  EXPECT_FALSE(has(stopped["text"].get<std::string>(), "stands in front of it"));
  EXPECT_EQ(stopped["hitBreakpointIds"], Json::array({mode["id"]}));
  EXPECT_TRUE(has(editor("exceptionInfo", {{"threadId", 1}})["exceptionId"].get<std::string>(), "fatal"));
}

TEST(DapSession, WithTheFilterItStandsInFrontOfTheFatalInstructionPastAllThatItWouldStopForOnTheWay) {
  Editor editor(kWatchdog);
  editor.begin();
  editor("setExceptionBreakpoints", {{"filters", {"watchdog"}}});
  editor("setFunctionBreakpoints", {{"breakpoints", Json::array({{{"name", "mode"}}})}});
  editor("continue", {{"threadId", 1}});
  EXPECT_TRUE(has(editor.last("stopped")["text"].get<std::string>(), "it stands in front of it"));
  EXPECT_EQ(editor.state().mode, Mode::Run);
  editor("continue", {{"threadId", 1}});
  EXPECT_EQ(editor.last("stopped")["hitBreakpointIds"].size(), 1U) << "the breakpoint is still set";
}

TEST(DapSession, WhatIsWrittenIntoATimerOrAnAccumulatorIsNamedAsAWhole) {
  Editor editor(kNested);
  editor.begin();
  const auto deed_of = [&](const char* reference, const char* data) {
    editor("writeMemory", {{"memoryReference", reference}, {"data", data}});
    return describe(editor.debuggee->history().actions().back());
  };
  EXPECT_EQ(deed_of("T3", "EjQ="), "set T3");
  EXPECT_EQ(editor.value("T3"), "16#1234 (4660)");
  EXPECT_EQ(deed_of("AC1", "EjRWeAE="), "set AC1 AC2");
  EXPECT_EQ(editor.value("AC1"), "16#12345678 (305419896)");
  EXPECT_EQ(editor.value("AC2"), "16#01000000 (16777216)");
  EXPECT_EQ(deed_of("VB20", "AQI="), "set VB20 VB21");
}

TEST(DapSession, OfAHighSpeedCounterItIsShownThatItIsNotEnabled) {
  Editor editor("LD SM0.1\nHDEF 0, 0\nMEND\n");
  editor.begin();
  editor("stepScan", {{"threadId", 1}});
  EXPECT_TRUE(has(variable(editor, "HC", "HC0")["value"].get<std::string>(), "mode 0, preset 0, up, not enabled"));
}

TEST(DapSession, CompletionsCountAsTheProtocolDoesInUtf16) {
  Editor editor(kNested);
  editor.begin();
  const std::string text = "\xC3\x96\xF0\x9F\x98\x80 VW1";  // one unit, and two
  const Json targets = editor("completions", {{"text", text}, {"column", 8}})["targets"];
  ASSERT_FALSE(targets.empty());
  for (const Json& target : targets) {
    EXPECT_TRUE(target["label"].get<std::string>().starts_with("VW1")) << target.dump();
    EXPECT_EQ(target["start"], 5);
    EXPECT_EQ(target["length"], 3);
  }
}

TEST(DapSession, ABreakpointThatIsNotAsTheProtocolSaysIsRefusedAloneAndTheOthersAreSet) {
  Editor editor(kNested);
  editor.begin();
  const Json answers =
      editor("setFunctionBreakpoints",
             {{"breakpoints", Json::array({{{"name", "INT 0"}}, {{"name", 5}}, Json::object()})}})["breakpoints"];
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(answers[0]["verified"], true);
  for (const std::size_t wrong : {1U, 2U}) EXPECT_EQ(answers[wrong]["verified"], false);
  EXPECT_TRUE(has(answers[1]["message"].get<std::string>(), "name: 5 is not a text"));
  EXPECT_EQ(answers[2]["message"], "name is missing");
}

TEST(DapSession, AHitConditionThatNoNumberCanMeetIsRefused) {
  Editor editor(kNested);
  editor.begin();
  const Json refused = editor.breakpoint({{"line", 6}, {"hitCondition", "> 18446744073709551615"}});
  EXPECT_EQ(refused["verified"], false);
  EXPECT_TRUE(has(refused["message"].get<std::string>(), "is not a number of hits"));
}

TEST(DapSession, AnAreaThatWasReadUnderTwoNamesIsToldOfUnderBoth) {
  Editor editor(kNested);
  editor.begin();
  for (const char* const reference : {"VB20", "VB30"}) editor("readMemory", {{"memoryReference", reference}, {"count", 1}});
  editor.messages.clear();
  editor("writeMemory", {{"memoryReference", "VB40"}, {"data", "AQ=="}});
  std::set<std::pair<std::string, int>> told;
  for (const Json& message : editor.messages)
    if (message.value("event", "") == "memory")
      told.emplace(message["body"]["memoryReference"].get<std::string>(), message["body"]["offset"].get<int>());
  EXPECT_EQ(told, (std::set<std::pair<std::string, int>>{{"VB20", 20}, {"VB30", 10}}));
}

}  // namespace
}  // namespace s7200::tools::dap::session_test

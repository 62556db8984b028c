// What pages and editors ask a session: the program, memory, moments and what happened, as JSON.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/source_path.hpp"
#include "tests/unit/debugger/session.hpp"
#include "tools/session/commands/rows/command_table.hpp"
#include "tools/session/observers/track.hpp"
#include "tools/session/observers/tracks_of_past.hpp"

namespace s7200::tools::pages_test {
namespace {

struct Silent final : Onlooker {
  void tell(std::string_view) override {}
};

std::string our_slave() {
  std::ostringstream text;
  text << std::ifstream(test::source_path("stl_programs/modbus_slave.stl")).rdbuf();
  return text.str();
}

struct Asked : OnePlc {
  explicit Asked(std::shared_ptr<const Program> program) : OnePlc(std::move(program)) {}
  explicit Asked(std::string_view text) : Asked(program_of(text)) {}

  Reply operator()(std::string_view command) { return execute(session, command_words(command)); }
  Json json(std::string_view command) {
    const Reply reply = (*this)(command);
    EXPECT_FALSE(reply.error.has_value()) << command << ": " << reply.error.value_or("");
    return reply.json;
  }
  std::string error_of(std::string_view command) { return (*this)(command).error.value_or("no error"); }

  History history{simulation, {}};
  Silent silent{};
  Session session{history, {}, silent};
};

/// The track of a kind and name; an empty object without one.
Json track(const Json& spans, std::string_view kind, std::string_view name) {
  for (const Json& one : spans["tracks"])
    if (one["kind"] == kind && one["name"] == name) return one;
  return Json::object();
}

constexpr std::string_view kTitled =
    "NETWORK 1 // the pump\n"  // 1
    "LD      I0.0\n"           // 2
    "AN      M0.1\n"           // 3
    "=       Q0.0  // runs\n"  // 4
    "\n"                       // 5
    "NETWORK 2\n"              // 6
    "LD      SM0.0\n"          // 7
    "MOVW    VW10, VW12\n"     // 8
    "MOVB    *VD20, VB30\n"    // 9
    "MEND\n";                  // 10

TEST(Pages, GetTheOutlineOfTheProgram) {
  Asked session(kNested);
  const Json outline = session.json("listing");
  EXPECT_EQ(outline["program"], "test.stl");
  EXPECT_EQ(outline["cpu"], "214");
  EXPECT_EQ(outline["lines"], 22);
  ASSERT_EQ(outline["routines"].size(), 4U);
  EXPECT_EQ(outline["routines"][0]["name"], "main");
  EXPECT_EQ(outline["routines"][1]["name"], "SBR 1");
  EXPECT_EQ(outline["routines"][1]["line"], 8);
  EXPECT_EQ(outline["routines"][3]["end"], outline["ops"]);
}

TEST(Pages, GetNetworksWithTheirTitles) {
  Asked session(kTitled);
  const Json networks = session.json("listing")["routines"][0]["networks"];
  ASSERT_EQ(networks.size(), 2U);
  EXPECT_EQ(networks[0]["number"], 1);
  EXPECT_EQ(networks[0]["title"], "the pump");
  EXPECT_EQ(networks[0]["line"], 1);
  EXPECT_EQ(networks[0]["end"], networks[1]["first"]);
}

TEST(Pages, GetLinesAsTheyAreWrittenWithTheirInstructions) {
  Asked session(kTitled);
  const Json lines = session.json("listing 3 9")["text"];
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(lines[0]["kind"], "contact");
  EXPECT_EQ(lines[1]["text"], "=       Q0.0  // runs");
  EXPECT_EQ(lines[1]["kind"], "coil");
  EXPECT_EQ(lines[1]["operands"][0]["address"], "Q0.0");
  EXPECT_TRUE(lines[2]["op"].is_null());
  EXPECT_EQ(lines[5]["kind"], "box");
  EXPECT_EQ(lines[5]["operands"][1]["address"], "VW12");
  EXPECT_EQ(lines[6]["operands"][0]["address"], "VD20");
  EXPECT_EQ(lines[6]["operands"][0]["pointer"], true);
}

TEST(Pages, GetNoMoreThanAThousandLinesAtOnce) {
  Asked session(kTitled);
  EXPECT_TRUE(has(session.error_of("listing 1 1001"), "at most 1000"));
  EXPECT_TRUE(has(session.error_of("listing 5 4"), "the first and the last line"));
  EXPECT_TRUE(has(session.error_of("listing 5"), "the first and the last line"));
  EXPECT_EQ(session.json("listing 500 600")["text"].size(), 0U);
}

TEST(Pages, GetTheStatusOfLinesWithTheTypesOfTheirOperands) {
  Asked session(kTitled);
  session("set VW10=-5");
  session("scan 2");
  const Json lines = session.json("status 2 8")["lines"];
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_EQ(lines[0]["line"], 2);
  EXPECT_EQ(lines[0]["top"], false);
  EXPECT_EQ(lines[4]["values"], Json::array({-5, -5}));
  EXPECT_EQ(lines[4]["powerFlow"], true);
  EXPECT_GT(lines[4]["at_ns"], 0);
  EXPECT_TRUE(has(session.error_of("status 1 2000"), "at most 1000"));
}

TEST(Pages, GetANetworkAsLadderWithItsPowerFlow) {
  Asked session("NETWORK 1\nLD I0.0\nA I0.1\n= Q0.0\nMEND\n");
  session("force I0.0=1");
  session("scan 2");
  const Json json = session.json("ladder NETWORK 1");
  EXPECT_EQ(json["power"], Json::array({true, true, false}));
  EXPECT_EQ(json["elements"][0]["value"], "I0.0=1");
  EXPECT_EQ(json["elements"][1]["from"], 1);
}

TEST(Pages, GetManyValuesEachInItsForm) {
  Asked session(kTitled);
  session("set VW10=-5 VD40=1.5");
  session("force M0.1=1");
  const Json values = session.json("values VW10 M0.1 /x VB10:2 nonsense /d VD40:real")["values"];
  ASSERT_EQ(values.size(), 6U);
  EXPECT_EQ(values[0]["text"], "-5");
  EXPECT_EQ(values[0]["number"], -5);
  EXPECT_EQ(values[0]["type"], "word");
  EXPECT_EQ(values[1]["forced"], false) << "M has no points that are forced one by one";
  EXPECT_EQ(values[2]["text"], "16#FF");
  EXPECT_EQ(values[3]["address"], "VB11");
  EXPECT_EQ(values[4]["name"], "nonsense");
  EXPECT_TRUE(values[4].contains("error"));
  EXPECT_EQ(values[5]["number"], 1.5);
}

TEST(Pages, GetTheOtherValuesWhereAVariableIsOfAnotherBlock) {
  constexpr std::string_view kCalls =
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL SBR0, 7\nEND_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK Pump:SBR0\nVAR_INPUT\nspeed : INT;\nEND_VAR\nBEGIN\nNETWORK 1\nLD SM0.0\nMOVW #speed, VW0\n"
      "END_SUBROUTINE_BLOCK\n";
  Asked session(check_text(kCalls, "test.awl", cpu224(), default_times(cpu224())).program);
  const Json outside = session.json("values VB0 #speed VW2")["values"];
  ASSERT_EQ(outside.size(), 3U);
  EXPECT_EQ(outside[1]["name"], "#speed");
  EXPECT_TRUE(has(outside[1]["error"].get<std::string>(), "#speed is no variable of main"));
  EXPECT_EQ(outside[2]["address"], "VW2");
  session("until SBR 0");
  session("step");
  const Json inside = session.json("values #speed")["values"];
  EXPECT_EQ(inside[0]["name"], "#speed");
  EXPECT_EQ(inside[0]["address"], "LW0");
  EXPECT_EQ(inside[0]["number"], 7);
}

TEST(Pages, SeeWhatIsForced) {
  Asked session(kTitled);
  session("force VW10=7 I0.0=1");
  const Json values = session.json("values VB10:3 I0.0 I0.1")["values"];
  EXPECT_EQ(values[0]["forced"], true);
  EXPECT_EQ(values[1]["forced"], true);
  EXPECT_EQ(values[2]["forced"], false);
  EXPECT_EQ(values[3]["forced"], true);
  EXPECT_EQ(values[4]["forced"], false);
}

TEST(Pages, AskForValuesWithoutMakingThemPartOfARecordedTest) {
  Asked session(kTitled);
  session.json("values VW10");
  EXPECT_TRUE(session.session.looked_at.empty());
  session.json("print VW10");
  EXPECT_EQ(session.session.looked_at.size(), 1U);
}

TEST(Pages, KnowWhereTheSessionStands) {
  Asked session(kNested);
  session("scan 3");
  session("at start");
  const Json past = session.json("past");
  EXPECT_EQ(past["now_ns"], 0);
  EXPECT_GT(past["newest_ns"], 0);
  EXPECT_EQ(past["in_the_past"], true);
  EXPECT_EQ(past["mode"], "RUN");
  session("mode stop");
  EXPECT_EQ(session.json("past")["mode"], "STOP");
}

TEST(Pages, SeeInterruptsFromOccurrenceToService) {
  Asked session(kNested);
  session("continue 22ms");
  const Reply reply = session("spans start end");
  EXPECT_FALSE(reply.moved);
  const Json interrupts = track(reply.json, "interrupts", "INT 0")["spans"];
  ASSERT_EQ(interrupts.size(), 4U);
  for (const Json& one : interrupts) {
    EXPECT_LE(one["occurred_ns"], one["at_ns"]);
    EXPECT_LT(one["at_ns"], one["end_ns"]);
  }
  EXPECT_TRUE(has(reply.text, "INT 0"));
}

/// Characters wait until I0.0 enables interrupts.
TEST(Pages, SeeHowManyInterruptsWaitInEachQueue) {
  Asked session("LD SM0.1\nMOVB 9, SMB30\nATCH 0, 8\nLD I0.0\nENI\nMEND\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n");
  session("continue 10ms");
  session("send 41 42 43");
  session("continue 10ms");
  session("input I0.0=1");
  session("continue 5ms");
  const auto waiting = [](const Json& spans) {
    std::vector<int> numbers;
    const Json waits = track(spans, "queues", "port queue");
    for (const Json& one : waits["spans"]) numbers.push_back(one["value"]);
    return numbers;
  };
  const Json whole = session.json("spans start end");
  EXPECT_EQ(waiting(whole), (std::vector{0, 1, 2, 3, 2, 1, 0}));
  EXPECT_TRUE(track(whole, "queues", "timed queue").empty());
  EXPECT_EQ(waiting(session.json("spans 13ms end")), (std::vector{2, 3, 2, 1, 0}));
  const Json joined = track(session.json("spans start end 3"), "queues", "port queue")["spans"];
  EXPECT_TRUE(std::ranges::any_of(joined, [](const Json& one) { return one.value("most", 0) == 3; })) << joined;
}

TEST(Pages, SeeScansRoutinesAndNetworksAndWatchedValues) {
  Asked session(kNested);
  session("continue 12ms");
  const Json spans = session.json("spans start end VW10");
  const Json scans = track(spans, "scans", "scans");
  EXPECT_EQ(scans["exact"], true);
  const Json values = track(spans, "value", "VW10")["spans"];
  ASSERT_GT(values.size(), 2U);
  EXPECT_EQ(values[0]["value"], 0);
  EXPECT_EQ(values[1]["value"], 1);
  EXPECT_EQ(values[1]["at_ns"], values[0]["end_ns"]);
  const Json routines = track(spans, "routines", "routines")["spans"];
  EXPECT_TRUE(std::ranges::any_of(routines, [](const Json& one) { return one["text"] == "SBR 2"; }));
  EXPECT_FALSE(track(spans, "networks", "networks").empty());
}

TEST(Pages, SeeCharactersAndFramesInWords) {
  Asked session(kEcho);
  session("send 41");
  session("continue 20ms");
  const Json spans = session.json("spans start end");
  ASSERT_EQ(track(spans, "characters", "port 0 received")["spans"].size(), 1U);
  EXPECT_EQ(track(spans, "characters", "port 0 sent")["spans"][0]["text"], "41");
  const Json format = track(spans, "characters", "port 0 sent")["format"];
  EXPECT_EQ(format, Json({{"baud", 9600}, {"data_bits", 8}, {"parity", "none"}, {"stop_bits", 1}}));
  const Json frames = track(spans, "frames", "port 0 frames")["spans"];
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0]["text"], "received 41");
  EXPECT_EQ(frames[1]["text"], "sent 41");
}

TEST(Pages, SeeTheBeginningOfAFrameThatDoesNotEnd) {
  Asked session(
      "LD SM0.1\nMOVB 9, SMB30\nMOVB 255, VB0\nFILL 16#5555, VW1, 127\nATCH 0, 9\nENI\nXMT VB0, 0\nMEND\nINT 0\nXMT VB0, 0\n"
      "RETI\n");
  session("continue 2s");
  const Json frames = track(session.json("spans start end"), "frames", "port 0 frames")["spans"];
  ASSERT_EQ(frames.size(), 1U);
  const std::string text = frames[0]["text"];
  EXPECT_TRUE(has(text, " bytes more")) << text.substr(text.size() - 40);
  EXPECT_LT(text.size(), 4000U);
}

TEST(Pages, SeeThatARequestAfterAnAnswerIsNoAnswer) {
  Asked session(our_slave());
  session("continue 100ms");
  for (int time = 0; time < 2; ++time) {
    session("send 01 06 00 00 00 01 crc");
    session("continue 100ms");
    session("continue 100ms");
  }
  const Json frames = track(session.json("spans start end"), "frames", "port 0 frames")["spans"];
  ASSERT_EQ(frames.size(), 4U);
  for (const std::size_t request : {0U, 2U}) EXPECT_TRUE(has(frames[request]["text"].get<std::string>(), ": station 1: "));
}

/// All frames of a slave that is asked three times, and those of a part that begins `after` the first of them has.
struct FramesOfPart {
  FramesOfPart(std::initializer_list<std::string_view> requests, Time after) {
    Asked session(our_slave());
    session("continue 100ms");
    for (const std::string_view request : requests) {
      session(fmt::format("send {} crc", request));
      session("continue 100ms");
      session("continue 100ms");
    }
    all = texts(session.json("spans start end"));
    const Json first = track(session.json("spans start end"), "frames", "port 0 frames"), frame = first["spans"][0];
    const Time from = after == 0 ? frame["end_ns"].get<Time>() + 1 : frame["at_ns"].get<Time>() + after;
    const Json part = session.json(fmt::format("spans {}ns end", from));
    of_part = texts(part);
    answers = part["answers"]["count"];
  }

  static std::vector<std::string> texts(const Json& spans) {
    const Json frames = track(spans, "frames", "port 0 frames");
    std::vector<std::string> all;
    for (const Json& one : frames["spans"]) all.push_back(one["text"]);
    return all;
  }

  std::vector<std::string> all{}, of_part{};
  std::size_t answers = 0;
};

TEST(Pages, DoNotTakeAnAnswerForARequestWhereAPartBeginsBetweenThem) {
  const FramesOfPart reads({"01 03 00 0a 00 02", "01 03 00 0a 00 02", "01 03 00 0a 00 03"}, 0);
  ASSERT_EQ(reads.all.size(), 6U);
  EXPECT_EQ(reads.of_part, std::vector(reads.all.begin() + 1, reads.all.end()));
  EXPECT_EQ(reads.answers, 3U);
}

TEST(Pages, DoNotTakeAValueThatWasWrittenForARequestWhereAPartBeginsBetweenThem) {
  const FramesOfPart writes({"01 06 00 00 00 01", "01 06 00 00 00 02", "01 06 00 00 00 02"}, 0);
  EXPECT_EQ(writes.of_part, std::vector(writes.all.begin() + 1, writes.all.end()));
  EXPECT_EQ(writes.answers, 3U);
}

TEST(Pages, SeeAFrameWholeWhereAPartBeginsWithinIt) {
  const FramesOfPart reads({"01 03 00 0a 00 02", "01 03 00 0a 00 02", "01 03 00 0a 00 02"}, 3 * kMillisecond);
  EXPECT_EQ(reads.of_part, reads.all);
}

/// A request can be longer ago than the longest frame takes.
TEST(Pages, KnowAnAnswerByItsLengthWhereItsRequestIsLongAgo) {
  Asked session(
      "LD SM0.1\nMOVB 16#49, SMB30\nMOVD 16#04010302, VD0\nMOVD 16#1234B533, VD4\nMOVB 7, VB0\nLD I0.0\nEU\nXMT VB0, "
      "0\nMEND\n");
  session("continue 10ms");
  session("send 01 03 00 0a 00 01 crc");
  session("continue 500ms");
  session("set I0.0=1");
  session("continue 50ms");
  const Json whole = track(session.json("spans start end"), "frames", "port 0 frames")["spans"];
  ASSERT_EQ(whole.size(), 2U);
  const Json part = session.json(fmt::format("spans {}ns end", whole[1]["at_ns"].get<Time>() - 1))["tracks"];
  const Json frames = track({{"tracks", part}}, "frames", "port 0 frames")["spans"];
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(has(frames[0]["text"].get<std::string>(), "an answer of station 1")) << frames[0]["text"] << whole[1]["text"];
}

TEST(Pages, SeeACharacterAndItsFrameFromWithinABit) {
  Asked session(our_slave());
  session("continue 100ms");
  session("send 01 03 00 0a 00 02 crc");
  session("continue 100ms");
  const Json whole = session.json("spans start end");
  for (const auto& [kind, name] : {std::pair("characters", "port 0 received"), std::pair("frames", "port 0 frames")}) {
    const Json first = track(whole, kind, name)["spans"][0];
    const Time within = first["at_ns"].get<Time>() + 500 * kMicrosecond;
    const Json part = session.json(fmt::format("spans {}ns {}ns", within, within + 1000));
    EXPECT_EQ(track(part, kind, name)["spans"], Json::array({first}));
  }
}

TEST(Pages, SeeThatACharacterHasAWrongParity) {
  Asked session("LD SM0.1\nMOVB 16#49, SMB30\nATCH 1, 8\nENI\nMEND\nINT 1\nRETI\n");
  session("send 41 42p 43");
  session("continue 20ms");
  const Json frames = track(session.json("spans start end 1"), "frames", "port 0 frames")["spans"];
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0]["error"], "parity error");
}

TEST(Pages, SeeALongPartWithoutRoutinesAndLoseNoScan) {
  Asked session(kNested);
  session("continue 30s");
  const Json spans = session.json("spans start end 100");
  EXPECT_EQ(spans["left_out"], Json::array({"queues", "routines", "networks"}));
  const Json scans = track(spans, "scans", "scans");
  EXPECT_LE(scans["spans"].size(), 100U);
  std::uint64_t count = 0;
  for (const Json& one : scans["spans"]) count += one.value("count", std::uint64_t{1});
  EXPECT_EQ(count, session.state().scans + 1) << "with the one that it is in";
}

TEST(Pages, AskForSpansThatThereAre) {
  Asked session(kNested);
  session("continue 5ms");
  EXPECT_EQ(session.json("spans 0ms 1h")["to_ns"], session.json("past")["newest_ns"]);
  EXPECT_TRUE(has(session.error_of("spans end start"), "the first before the second"));
  EXPECT_TRUE(has(session.error_of("spans start"), "the first before the second"));
  EXPECT_TRUE(has(session.error_of("spans start end 0"), "from 1 to 20000"));
  EXPECT_TRUE(has(session.error_of("spans start end 10 VB0:4"), "several values"));
  EXPECT_TRUE(has(session.error_of("spans start end 10 QX99"), "QX99"));
}

TEST(Actions, AreWhatWasDoneFromOutsideUpToNow) {
  Asked session(our_slave());
  for (const char* const command : {"continue 800ms", "set VW40=1234", "input I0.3=1 I0.4=0", "force Q0.1=1",
                                    "fault missing:exchange=9", "send 01 03 00 14 00 01 crc", "continue 200ms"})
    session(command);
  const Json done = session.json("actions");
  std::vector<std::string> texts;
  for (const Json& one : done["actions"]) texts.push_back(one["text"]);
  ASSERT_EQ(texts.size(), 5U);
  EXPECT_EQ(texts[0], "set VW40=1234");
  EXPECT_EQ(texts[1], "input I0.3=1 I0.4=0");
  EXPECT_EQ(texts[2], "force Q0.1=1");
  EXPECT_TRUE(has(texts[3], "fault missing"));
  EXPECT_EQ(texts[4], "send 01 03 00 14 00 01 c4 0e");
  EXPECT_EQ(done["count"], 5);
  const Json last = session.json("actions 1");
  EXPECT_EQ(last["actions"].size(), 1U);
  EXPECT_EQ(last["count"], 5);
  EXPECT_TRUE(has(session("actions 1").text, "and 4 actions before these"));
  session("at 700ms");
  EXPECT_EQ(session.json("actions")["count"], 0);
  EXPECT_TRUE(has(session("actions").text, "nothing was done from outside"));
  EXPECT_TRUE(has(session.error_of("actions 5000"), "up to 1000"));
}

TEST(Spans, NameTheLongestAnswersHoweverMuchIsOneElement) {
  Asked session(our_slave());
  for (const char* const command :
       {"continue 800ms", "send 01 03 00 14 00 01 crc", "continue 200ms", "send 01 03 00 0a 00 20 crc", "continue 400ms",
        "send 01 03 00 00 00 00", "continue 200ms"})
    session(command);
  const Json answers = session.json("spans start end 1")["answers"];
  EXPECT_EQ(answers["count"], 2);
  ASSERT_EQ(answers["longest"].size(), 2U);
  const Json& longest = answers["longest"][0];
  EXPECT_TRUE(has(longest["text"].get<std::string>(), "01 03 00 0a 00 20"));
  const auto latency = [](const Json& one) { return one["answer_ns"].get<Time>() - one["end_ns"].get<Time>(); };
  EXPECT_GT(latency(longest), latency(answers["longest"][1]));
  EXPECT_GT(longest["answer_end_ns"], longest["answer_ns"]);
}

TEST(Spans, KeepTwentyOfTheLongestAnswers) {
  LongestAnswers longest;
  for (Time latency = 1; latency <= 50; ++latency)
    longest.add({.at = 0, .end = 100 * latency, .answer_at = 100 * latency + (latency % 25), .answer_end = 0});
  EXPECT_EQ(longest.count(), 50U);
  ASSERT_EQ(longest.all().size(), LongestAnswers::kMost);
  EXPECT_EQ(longest.all()[0].latency(), 24);
  EXPECT_EQ(longest.all()[0].end, 2400) << "of equal ones the earlier first";
  EXPECT_EQ(longest.all()[1].end, 4900);
}

/// The hundredth scan counts to 200 in a loop.
TEST(Spans, NameTheLongestScanToTheNanosecond) {
  Asked session("LD SM0.0\nINCW VW0\nLDW= VW0, 100\nNOT\nJMP 1\nLD SM0.0\nFOR VW2, 1, 200\nNEXT\nLBL 1\nMEND\n");
  session("continue 2s");
  const auto longest = [&](const std::string& part) { return session.json("spans " + part + " 1")["longest_scans"]; };
  const Json all = longest("start end");
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0]["text"], "scan 100");
  EXPECT_FALSE(all[0].contains("station"));
  const Json scans = track(session.json("spans start end 20000"), "scans", "scans");
  for (const Json& scan : scans["spans"])
    if (scan["text"] == "scan 100") {
      EXPECT_EQ(scan["at_ns"], all[0]["at_ns"]);
      EXPECT_EQ(scan["end_ns"], all[0]["end_ns"]);
    }
  session("continue 10s");
  EXPECT_EQ(longest("start end"), all) << "scans that are passed over are as long as the one before them";
}

TEST(Spans, OfTheWholePastHaveTheErrorThatHasEndedIt) {
  Asked session("LD SM0.0\nINCW VW10\nLBL 1\nLDW>= VW10, 50\nJMP 1\nMEND\n");
  session("continue 5s");
  const Json errors = track(session.json("spans start end"), "errors", "errors");
  ASSERT_EQ(errors["spans"].size(), 1U);
  EXPECT_EQ(errors["spans"][0]["at_ns"], session.json("past")["newest_ns"]);
  EXPECT_TRUE(has(errors["spans"][0]["error"].get<std::string>(), "watchdog"));
}

TEST(WhyLatency, NamesWhatTheLastAnswerWaitedFor) {
  Asked session(our_slave());
  EXPECT_TRUE(has(session.error_of("why latency"), "no master in the simulation has had an answer"));
  for (const char* const command : {"continue 800ms", "send 01 03 00 14 00 01 crc", "continue 200ms"}) session(command);
  const Json answer = session.json("why latency");
  EXPECT_EQ(answer["name"], "01 03 00 14 00 01 c4 0e");
  ASSERT_FALSE(answer["causes"].empty());
  for (const char* const command :
       {"fault answer:silent", "send 01 03 00 0a 00 01 crc", "continue 3s", "send 01 03 00 0a 00 01 crc", "continue 3s"})
    session(command);
  const std::string text = session("why latency").text;
  EXPECT_EQ(session.json("why latency"), answer) << "requests without an answer have none";
  EXPECT_TRUE(has(text, "after the end of the request"));
  EXPECT_TRUE(has(text, "until the main program came to XMT VB3327, 0 in line 182, in the scan that began at ")) << text;
}

TrackSpan span_at(Time at, std::string error = {}) {
  return {.at = at, .end = at + 5, .text = "x", .error = std::move(error)};
}

TEST(Tracks, HaveEachElementAsLongAsThereIsRoom) {
  Track track(0, 1000, 4);
  for (const Time at : {0, 10, 500, 999}) track.add(span_at(at));
  EXPECT_TRUE(track.is_exact());
  EXPECT_EQ(track.spans().size(), 4U);
}

TEST(Tracks, JoinWhatBeginsInTheSamePartOfTheTimeAndLoseNoError) {
  Track track(0, 1000, 4);
  for (Time at = 0; at < 1000; at += 10) track.add(span_at(at, at == 730 ? "lost" : ""));
  EXPECT_FALSE(track.is_exact());
  ASSERT_EQ(track.spans().size(), 4U);
  EXPECT_EQ(track.spans()[0].count, 25U);
  EXPECT_EQ(track.spans()[0].busy, 125);
  EXPECT_EQ(track.spans()[1].errors, 0U);
  EXPECT_EQ(track.spans()[2].errors, 1U);
  EXPECT_EQ(track.spans()[2].error, "lost");
}

TEST(Tracks, KeepTheLeastAndTheMostOfValues) {
  Track track(0, 100, 1);
  for (const double value : {3.0, -7.0, 5.0}) {
    TrackSpan span = span_at(static_cast<Time>(value) + 10);
    span.value = value;
    track.add(std::move(span));
  }
  ASSERT_EQ(track.spans().size(), 1U);
  EXPECT_EQ(track.spans()[0].value, 5.0);
  EXPECT_EQ(track.spans()[0].least, -7.0);
  EXPECT_EQ(track.spans()[0].most, 5.0);
}

}  // namespace
}  // namespace s7200::tools::pages_test

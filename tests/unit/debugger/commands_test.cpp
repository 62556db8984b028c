// Commands of a session that nobody but a program looks at: words in, replies out.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tests/unit/debugger/session.hpp"
#include "tools/session/commands/rows/command_table.hpp"
#include "tools/session/commands/rows/completion.hpp"

namespace s7200::tools::commands_test {
namespace {

struct Listener final : Onlooker {
  void tell(std::string_view lines) override { told += lines; }
  std::string told{};
};

/// A session of its own, without a terminal, files and threads.
struct Alone : OnePlc {
  explicit Alone(std::string_view text) : OnePlc(program_of(text)) {}

  Reply operator()(std::string_view command) { return execute(session, command_words(command)); }

  History history{simulation, {}};
  Listener listener{};
  Session session{history, {}, listener};
};

TEST(Commands, HaveNamesSyntaxAndMeaningInTheTable) {
  std::set<std::string_view> names;
  for (const CommandRow& row : command_table()) {
    EXPECT_TRUE(row.syntax.starts_with(row.name)) << row.name;
    EXPECT_FALSE(row.meaning.empty()) << row.name;
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_TRUE(row.short_form.empty() || names.insert(row.short_form).second) << row.short_form;
    EXPECT_TRUE(has(commands_help(), row.meaning)) << row.name;
  }
}

TEST(Commands, AnswerProgramsToo) {
  Alone session(kNested);
  session("scan 4");
  EXPECT_EQ(session("who VW20").json["routine"], "SBR 2");
  EXPECT_EQ(session("who VW40").json["text"].get<std::string>().rfind("nothing has written VW40", 0), 0U);
  EXPECT_TRUE(session("why").json.contains("text"));
  EXPECT_EQ(session("why VW20").json["name"], "VW20");
  EXPECT_EQ(session("why not VW20 = 8").json["whyNot"]["because"][0]["name"], "VW20");
  EXPECT_EQ(session("until M0.0 within 1ms").json["stopped"], "limit");
  EXPECT_EQ(session("until M0.0 within 1ms").json["whyNot"]["wanted"], "1");
  EXPECT_EQ(session("history 3").json["instructions"].size(), 3U);
  EXPECT_TRUE(session("timeline 5ms").json.contains("timeline"));
  EXPECT_EQ(session("print VW20").json["values"][0]["value"], "16#0007 (7)");
  EXPECT_EQ(session("print VW20 * 2").json["values"][0]["name"], "VW20 * 2");
  EXPECT_EQ(session("force VW40=5").json["forced"][0]["name"], "VW40");
  EXPECT_EQ(session("unforce all").json["forced"].size(), 0U);
  EXPECT_TRUE(session("fault").json.contains("text"));
  EXPECT_FALSE(session("status 16").json["lines"].empty());
  EXPECT_EQ(session("port").json["port"], 0);
  EXPECT_EQ(session("set VW40=6").json["values"][0]["value"], "16#0006 (6)");
  session("break 3");
  EXPECT_EQ(session("break").json["stops"][0]["line"], 3);
  EXPECT_EQ(session("continue 1s").json["stopped"], "stop point");
  session("delete all");
  EXPECT_TRUE(session("watch").json["stops"].empty());
  EXPECT_EQ(session("continue 10ms").json["stopped"], "limit");
  EXPECT_EQ(session("scan").json["stopped"], "goal");
  EXPECT_TRUE(session("regs").json.is_null()) << "nothing for programs";
}

TEST(Commands, NameTheMemoryThatWasNotAsExpected) {
  Alone session(kNested);
  session("scan 4");
  EXPECT_TRUE(session("expect VW20 = 8").error.has_value());
  EXPECT_EQ(session("why").json["failed"][0]["name"], "VW20");
}

TEST(Commands, SayWhetherTheSessionHasMoved) {
  Alone session(kNested);
  for (const std::string_view moves : {"step", "scan", "at start", "back", "restart"})
    EXPECT_TRUE(session(moves).moved) << moves;
  session("scan 2");
  for (const std::string_view stays : {"who VW20", "why", "history 3", "set VW40=1", "break 3", "status"})
    EXPECT_FALSE(session(stays).moved) << stays;
}

TEST(Commands, TellAtOnceWhatComesUpWhileTheyGoOn) {
  Alone session(kNested);
  session("break INT 0 log 'timed'");
  EXPECT_EQ(session.listener.told, "");
  const Reply reply = session("continue 12ms");
  EXPECT_EQ(session.listener.told, "timed\ntimed\n");
  EXPECT_FALSE(has(reply.text, "timed"));
  EXPECT_TRUE(has(reply.text, "12 ms of simulated time passed"));
}

TEST(Commands, ReadAndWriteOnlyFilesThatAreHandedIn) {
  Alone session(kNested);
  for (const std::string_view command : {"save a.json", "load a.json"})
    EXPECT_TRUE(has(session(command).error.value_or(""), "files are neither read nor written here")) << command;
  EXPECT_TRUE(completions(session.session, "load ").candidates.empty());
}

TEST(Commands, ThatTakeNoWordsSayItOfEach) {
  Alone session(kNested);
  for (const CommandRow& row : command_table()) {
    if (row.takes_words()) continue;
    EXPECT_EQ(session(std::string(row.name) + " more").error, std::string(row.name) + " takes no argument");
  }
}

TEST(Commands, OfTwoSessionsKnowNothingOfEachOther) {
  Alone one(kNested), other(kNested);
  one("scan 5");
  one("force VW40=5");
  EXPECT_EQ(other("force").json["forced"].size(), 0U);
  EXPECT_LT(other.simulation.time(), one.simulation.time());
}

}  // namespace
}  // namespace s7200::tools::commands_test

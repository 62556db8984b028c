// A session as pages see it: messages in, messages out.
#include "tools/faces/page/conversation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "interpreter/analysis/warnings/check.hpp"
#include "serial_sim/system/simulation.hpp"
#include "tools/json/json_text.hpp"

namespace s7200::tools::page::conversation_test {
namespace {

constexpr std::string_view kCounts = "LD SM0.0\nINCW VW10\nLD I0.0\n= Q0.0\nMEND\n";

/// A page with two windows.
struct Pages {
  explicit Pages(std::string_view text = kCounts, bool live = false)
      : simulation(check_text(text, "count.stl", cpu214(), default_times(cpu214())).program) {
    simulation.power_up();
    history = std::make_unique<History>(simulation, History::Settings{});
    talk = std::make_unique<Conversation>(
        *history,
        PageSettings{.program = "count.stl", .live = live, .live_run = {}, .clock = [this] { return clock += kSecond; }},
        Post{[this](Client client, const std::string& message) { got.emplace_back(client, read(message)); },
             [this](const std::string& message) {
               got.emplace_back(0, read(message));
               if (greets_at_news && got.back().second["event"] == "moved") {
                 greets_at_news = false;
                 talk->greet(0);
               }
               if (stops_at_news && got.back().second["event"] == "moved") {
                 stops_at_news = false;
                 talk->handle(2, {{"stop", true}, {"run", true}});
               }
             }});
  }

  static Json read(const std::string& message) {
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return parse_json(message).value_or(Json());
  }

  /// The reply to a command of window 1.
  Json operator()(const std::string& command) {
    got.clear();
    talk->handle(1, {{"id", 5}, {"command", command}});
    EXPECT_EQ(got.back().first, 1U);
    return got.back().second;
  }

  /// The reply to a piece of a run.
  Json piece(Client client, std::string_view run) {
    got.clear();
    talk->handle(client, {{"id", 6}, {"command", "continue 2ms"}, {"run", run}});
    return got.back().second;
  }

  Json event(std::string_view name) const {
    for (const auto& [client, message] : got)
      if (client == 0 && message.value("event", "") == name) return message;
    return {};
  }

  Time clock = 0;
  bool greets_at_news = false, stops_at_news = false;
  serial::Simulation simulation;
  std::unique_ptr<History> history{};
  std::vector<std::pair<Client, Json>> got{};  // 0: all
  std::unique_ptr<Conversation> talk{};
};

TEST(Page, IsGreetedWithWhatItShows) {
  Pages pages;
  pages.talk->greet(7);
  const auto& [client, hello] = pages.got.back();
  EXPECT_EQ(client, 7U);
  EXPECT_EQ(hello["event"], "hello");
  EXPECT_EQ(hello["protocol"], 1);
  EXPECT_EQ(hello["program"], "count.stl");
  EXPECT_EQ(hello["cpu"], "214");
  EXPECT_EQ(hello["may"], Json::array());
  EXPECT_EQ(hello["now"]["now_ns"], 0);
}

TEST(Page, ThatComesWhileARunGoesOnIsGreetedWithItsCommand) {
  Pages pages(kCounts, true);
  pages.greets_at_news = true;
  pages("continue 20ms");
  EXPECT_EQ(pages.event("hello")["running"], "continue 20ms");
  pages.got.clear();
  pages.talk->greet(0);
  EXPECT_FALSE(pages.event("hello").contains("running"));
}

TEST(Page, SeesTheRunOfAnotherWindowAsOneUntilItEnds) {
  Pages pages;
  EXPECT_EQ(pages.piece(1, "begins")["json"]["stopped"], "limit");
  EXPECT_EQ(pages.event("moved")["by"], "");
  pages.talk->greet(0);
  EXPECT_EQ(pages.event("hello")["running"], "continue 2ms");
  EXPECT_FALSE(pages.piece(1, "goes on").contains("interrupted"));
  EXPECT_TRUE(pages.event("stopped").is_null());
  pages("break 2 always");
  EXPECT_EQ(pages.piece(1, "goes on")["json"]["stopped"], "stop point");
  EXPECT_EQ(pages.event("moved")["by"], "continue 2ms");
  EXPECT_FALSE(pages.event("stopped").is_null());
}

/// A run that follows the clock carries out messages meanwhile, a stop as well.
TEST(Page, HearsOfNoRunAnyMoreAfterItWasStopped) {
  Pages pages(kCounts, true);
  pages.stops_at_news = true;
  pages.talk->handle(1, {{"id", 6}, {"command", "continue 20ms"}, {"run", "begins"}});
  EXPECT_FALSE(pages.event("stopped").is_null());
  Json last;
  for (const auto& [client, message] : pages.got)
    if (message.value("event", "") == "moved") last = message;
  EXPECT_EQ(last["by"], "continue 20ms");
}

TEST(Page, BeginsNoSecondRunAndEndsThatOfAnotherWindow) {
  Pages pages;
  pages.piece(1, "begins");
  EXPECT_EQ(pages.piece(2, "begins")["error"], "a run goes on already; Pause ends it");
  const Time now = pages.history->now().time;
  pages.talk->handle(2, {{"stop", true}, {"run", true}});
  EXPECT_FALSE(pages.event("stopped").is_null());
  EXPECT_EQ(pages.piece(1, "goes on")["interrupted"], true);
  EXPECT_EQ(pages.history->now().time, now);
  EXPECT_FALSE(pages.piece(2, "begins").contains("error"));
  pages.got.clear();
  pages.talk->leave(1);
  EXPECT_TRUE(pages.got.empty()) << "it had none";
  pages.talk->leave(2);
  EXPECT_FALSE(pages.event("stopped").is_null());
}

TEST(Page, GetsTheReplyToItsCommandWithItsNumber) {
  Pages pages;
  const Json reply = pages("values VW10");
  EXPECT_EQ(reply["id"], 5);
  EXPECT_EQ(reply["moved"], false);
  EXPECT_EQ(reply["json"]["values"][0]["number"], 0);
  EXPECT_FALSE(reply.contains("error"));
}

TEST(Page, HearsWhatIsWrongWithACommandAndNothingAfterItIsDone) {
  Pages pages;
  const Json reply = pages("scan; frobnicate; scan");
  EXPECT_EQ(reply["error"], "unknown command 'frobnicate'; 'help' lists them");
  EXPECT_EQ(reply["moved"], true);
  EXPECT_EQ(pages("values VW10")["json"]["values"][0]["number"], 1);
}

TEST(Page, OfEveryWindowHearsThatTheSessionHasMoved) {
  Pages pages;
  pages("scan 2");
  EXPECT_EQ(pages.event("running")["command"], "scan 2");
  EXPECT_EQ(pages.event("moved")["by"], "scan 2");
  EXPECT_GT(pages.event("moved")["now"]["now_ns"], 0);
  pages("print VW10");
  EXPECT_TRUE(pages.event("moved").is_null());
}

TEST(Page, OfEveryWindowHearsThatSomethingHasChanged) {
  Pages pages;
  for (const std::string command : {"set VW20=5", "input I0.0=1", "force VW30=1", "unforce all", "break 3", "delete all"}) {
    pages(command);
    EXPECT_EQ(pages.event("changed")["by"], command);
  }
  pages("values VW20");
  EXPECT_TRUE(pages.event("changed").is_null());
}

TEST(Page, HearsHowFarALongRunHasCome) {
  for (const bool live : {false, true}) {
    Pages pages(kCounts, live);
    pages(live ? "continue 20ms" : "continue 1s");  // the few instructions that it is told of are enough of one that is live
    const auto news =
        std::ranges::count_if(pages.got, [](const auto& one) { return one.second.value("event", "") == "moved"; });
    EXPECT_GT(news, 3);
  }
}

TEST(Page, GetsAtOnceWhatComesUpInARun) {
  Pages pages;
  pages("break 2 log 'here'");
  pages("scan 2");
  EXPECT_EQ(pages.event("printed")["text"], "here\n");
}

TEST(Page, IsToldWhatIsNoMessage) {
  Pages pages;
  for (const Json& message : {Json::object(), Json{{"id", 1}}, Json{{"id", 1}, {"command", 5}}}) {
    pages.talk->handle(1, message);
    EXPECT_TRUE(pages.got.back().second["id"].is_null());
    EXPECT_TRUE(pages.got.back().second.contains("error"));
  }
}

TEST(Page, IsToldThatACommandWasNotDoneAfterAStop) {
  Pages pages;
  pages.talk->handle(1, {{"id", 9}, {"command", "scan"}}, true);
  EXPECT_EQ(pages.got.back().second["interrupted"], true);
  EXPECT_EQ(pages.got.back().second["undone"], true);
  EXPECT_EQ(pages.simulation.time(), 0);
}

TEST(Page, KeepsTheSessionFromFilesUnlessTheyAreHandedIn) {
  Pages pages;
  EXPECT_EQ(pages("save x.json")["error"], "save: files are neither read nor written here");
}

TEST(Page, EndsWithQuit) {
  Pages pages;
  pages("quit");
  EXPECT_TRUE(pages.talk->is_over());
  pages.talk->end("quit");
  EXPECT_EQ(pages.event("ended")["why"], "quit");
}

}  // namespace
}  // namespace s7200::tools::page::conversation_test

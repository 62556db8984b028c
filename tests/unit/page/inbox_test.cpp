// The messages of all windows on their way to the session.
#include "tools/faces/page/server/inbox.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::page::inbox_test {
namespace {

struct Waiting {
  std::atomic<bool> stop = false, pause = false;
  Inbox inbox{stop, pause};
};

TEST(PageInbox, HandsOutMessagesInTheirOrder) {
  Waiting waiting;
  waiting.inbox.join(1);
  EXPECT_EQ(waiting.inbox.put(1, R"({"id": 1, "command": "step"})"), "");
  EXPECT_EQ(waiting.inbox.put(2, "no json"), "");
  EXPECT_EQ(waiting.inbox.take().kind, Incoming::Kind::Joined);
  EXPECT_EQ(waiting.inbox.take().message["command"], "step");
  const Incoming wrong = waiting.inbox.take();
  EXPECT_EQ(wrong.kind, Incoming::Kind::Unreadable);
  EXPECT_EQ(wrong.client, 2U);
  EXPECT_FALSE(waiting.inbox.take_waiting().has_value());
}

TEST(PageInbox, StopsWhatGoesOnAndWhatWaitsOfTheSameClient) {
  Waiting waiting;
  waiting.inbox.put(1, R"({"id": 1, "command": "step"})");
  waiting.inbox.put(2, R"({"id": 1, "command": "step"})");
  waiting.inbox.put(1, R"({"stop": true})");
  EXPECT_TRUE(waiting.stop);
  waiting.inbox.put(1, R"({"id": 2, "command": "step"})");
  EXPECT_TRUE(waiting.inbox.take().undone);
  EXPECT_FALSE(waiting.stop) << "it was for what had gone on";
  EXPECT_FALSE(waiting.inbox.take().undone);
  EXPECT_FALSE(waiting.inbox.take().undone);
}

TEST(PageInbox, PausesARunThatFollowsTheClockAndNoOther) {
  Waiting waiting;
  waiting.inbox.put(1, R"({"command": "step"})");
  EXPECT_FALSE(waiting.pause);
  waiting.inbox.run_is_live(true);
  EXPECT_TRUE(waiting.pause);
  EXPECT_TRUE(waiting.inbox.take_waiting().has_value());
  EXPECT_FALSE(waiting.pause);
  waiting.inbox.put(1, R"({"command": "step"})");
  EXPECT_TRUE(waiting.pause);
}

TEST(PageInbox, ForgetsWhatAClientHasSentThatLeaves) {
  Waiting waiting;
  waiting.inbox.put(1, R"({"command": "step"})");
  waiting.inbox.put(2, R"({"command": "scan"})");
  waiting.inbox.leave(1);
  EXPECT_EQ(waiting.inbox.take().client, 2U);
  const Incoming left = waiting.inbox.take();
  EXPECT_EQ(left.kind, Incoming::Kind::Left);
  EXPECT_EQ(left.client, 1U);
}

TEST(PageInbox, HandsOutAStopOfARunInItsTurn) {
  Waiting waiting;
  waiting.inbox.put(1, R"({"stop": true})");
  EXPECT_FALSE(waiting.inbox.take_waiting().has_value()) << "it is for what goes on";
  waiting.inbox.put(1, R"({"id": 1, "command": "step"})");
  waiting.inbox.put(1, R"({"stop": true, "run": true})");
  EXPECT_TRUE(waiting.stop);
  EXPECT_TRUE(waiting.inbox.take().undone);
  EXPECT_TRUE(waiting.inbox.take().message.contains("stop"));
}

TEST(PageInbox, HoldsABoundedNumberOfMessagesAndBytes) {
  Waiting waiting;
  for (std::size_t i = 0; i < Inbox::kMostWaiting; ++i) EXPECT_EQ(waiting.inbox.put(1, R"({"command": "step"})"), "");
  EXPECT_NE(waiting.inbox.put(1, R"({"command": "step"})"), "");
  EXPECT_EQ(waiting.inbox.put(2, R"({"command": "step"})"), "");
  const std::string large = R"({"command": ")" + std::string(1'000'000, 'x') + R"("})";
  std::size_t taken = 0;
  while (taken < 100 && waiting.inbox.put(3, large).empty()) ++taken;
  EXPECT_EQ(taken, Inbox::kMostBytes / large.size());
}

TEST(PageInbox, EndsWhateverWaits) {
  Waiting waiting;
  waiting.inbox.put(1, R"({"command": "step"})");
  waiting.inbox.end();
  EXPECT_EQ(waiting.inbox.take().kind, Incoming::Kind::Ended);
  EXPECT_TRUE(waiting.stop);
  EXPECT_TRUE(waiting.pause);
}

}  // namespace
}  // namespace s7200::tools::page::inbox_test

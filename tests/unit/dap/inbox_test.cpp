#include "tools/faces/dap/wire/inbox.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::dap::inbox_test {
namespace {

Json request(int number, const char* command, Json arguments = Json::object()) {
  return {{"seq", number}, {"type", "request"}, {"command", command}, {"arguments", std::move(arguments)}};
}

struct Box {
  Inbox::Next next(bool runs = true) { return inbox.take(runs, message); }

  std::atomic<bool> stop = false;
  Inbox inbox{stop};
  Json message;
};

TEST(Inbox, ARunEndsForEveryMessageAndGoesOnAfterIt) {
  Box box;
  EXPECT_EQ(box.next(), Inbox::Next::Run);
  EXPECT_FALSE(box.stop);
  box.inbox.put(request(1, "threads"));
  EXPECT_TRUE(box.stop);
  EXPECT_EQ(box.next(), Inbox::Next::Message);
  EXPECT_EQ(box.message["seq"], 1);
  EXPECT_FALSE(box.stop);
  EXPECT_EQ(box.next(), Inbox::Next::Run);
}

TEST(Inbox, OtherWorkEndsOnlyForWhatAsksForItsEnd) {
  Box box;
  box.inbox.put(request(1, "reverseContinue"));
  EXPECT_EQ(box.next(), Inbox::Next::Message);
  box.inbox.put(request(2, "threads"));
  EXPECT_FALSE(box.stop);
  for (const char* command : {"pause", "disconnect", "terminate", "restart", "cancel"}) {
    box.stop = false;
    box.inbox.put(request(3, command));
    EXPECT_TRUE(box.stop) << command;
  }
}

TEST(Inbox, WhatAsksForTheEndIsNotForgottenWhileEarlierMessagesAreHandled) {
  Box box;
  box.inbox.put(request(1, "reverseContinue"));
  box.inbox.put(request(2, "pause"));
  EXPECT_EQ(box.next(), Inbox::Next::Message);
  EXPECT_TRUE(box.stop);
}

TEST(Inbox, ARequestThatIsCancelledInTimeIsNotHandled) {
  Box box;
  box.inbox.put(request(1, "stepBack"));
  box.inbox.put(request(2, "reverseContinue"));
  EXPECT_EQ(box.next(), Inbox::Next::Message);
  box.inbox.put(request(3, "cancel", {{"requestId", 2}}));
  EXPECT_FALSE(box.stop) << "what goes on is another request";
  EXPECT_EQ(box.next(), Inbox::Next::Cancelled);
  EXPECT_EQ(box.message["seq"], 2);
  EXPECT_EQ(box.next(), Inbox::Next::Message);
}

TEST(Inbox, WhatIsNotAMessageIsHandedOverAsItIs) {
  Box box;
  for (const Json& wrong : {Json(), Json(5), Json::array(), Json{{"seq", "x"}, {"command", 5}}, Json{{"command", "cancel"}},
                            Json{{"command", "cancel"}, {"arguments", 5}}, request(1, "cancel", {{"requestId", "x"}})}) {
    box.inbox.put(wrong);
    EXPECT_EQ(box.next(), Inbox::Next::Message);
    EXPECT_EQ(box.message, wrong);
  }
}

TEST(Inbox, WhatIsUnreadableIsHandedOverInItsTurnAndOnlyARunEndsForIt) {
  Box box;
  box.inbox.put(request(1, "threads"));
  box.inbox.put_unreadable("'x' is not JSON");
  EXPECT_FALSE(box.stop);
  EXPECT_EQ(box.next(), Inbox::Next::Message);
  EXPECT_EQ(box.next(), Inbox::Next::Unreadable);
  EXPECT_EQ(box.message, "'x' is not JSON");
  EXPECT_EQ(box.next(), Inbox::Next::Run);
  box.inbox.put_unreadable("'y' is not JSON");
  EXPECT_TRUE(box.stop);
  EXPECT_EQ(box.next(), Inbox::Next::Unreadable);
}

TEST(Inbox, TheEndOfTheStreamComesAfterAllMessages) {
  Box box;
  box.inbox.put(request(1, "threads"));
  box.inbox.close("is torn");
  EXPECT_TRUE(box.stop);
  EXPECT_EQ(box.next(false), Inbox::Next::Message);
  EXPECT_EQ(box.next(false), Inbox::Next::Closed);
  EXPECT_EQ(box.inbox.failure(), "is torn");
}

}  // namespace
}  // namespace s7200::tools::dap::inbox_test

#include "tools/faces/dap/wire/admission.hpp"

#include <gtest/gtest.h>

#include "tools/faces/dap/wire/framing.hpp"
#include "tools/faces/dap/wire/inbox.hpp"

namespace s7200::tools::dap::admission_test {
namespace {

Json request(const std::string& command, Json arguments = Json::object()) {
  return {{"seq", 1}, {"type", "request"}, {"command", command}, {"arguments", std::move(arguments)}};
}

TEST(Admission, TheFirstRequestIsInitializeAndTheLaunchHasTheToken) {
  Admission admission("0123456789abcdef");
  EXPECT_EQ(admission.judge(request("initialize")), "");
  EXPECT_EQ(admission.judge(request("threads")), "") << "it does nothing";
  EXPECT_FALSE(admission.is_open());
  EXPECT_EQ(admission.judge(request("launch", {{"token", "0123456789abcdef"}})), "");
  EXPECT_TRUE(admission.is_open());
  EXPECT_EQ(admission.judge(request("launch")), "") << "once let in, a client stays";
}

TEST(Admission, AnotherFirstMessageEndsTheConnection) {
  for (const Json& first : {request("launch", {{"token", "t"}}), request(""),
                            Json{{"type", "event"}, {"command", "initialize"}}, Json::object()})
    EXPECT_TRUE(Admission("t").judge(first).starts_with("the first message is not the request initialize, but ")) << first;
}

TEST(Admission, AMissingOrWrongTokenEndsTheConnectionAndIsNotRepeated) {
  for (const char* const command : {"launch", "attach"})
    for (const Json& token :
         {Json(), Json(""), Json("wrong"), Json(5), Json::array({"right"}), Json(std::string("right\0", 6))}) {
      Admission admission("right");
      admission.judge(request("initialize"));
      const std::string why = admission.judge(request(command, {{"token", token}}));
      EXPECT_NE(why.find("token"), std::string::npos) << token;
      EXPECT_EQ(why.find("'right'"), std::string::npos);
      EXPECT_FALSE(admission.is_open());
    }
}

TEST(Admission, AnEditorThatHasStartedTheServerNeedsNone) {
  Admission admission("");
  EXPECT_TRUE(admission.is_open());
  EXPECT_EQ(admission.judge(request("launch")), "");
}

TEST(Admission, AConnectionIsOfThisProtocolFromItsFirstByteOn) {
  const std::string good = framed("{}");
  for (std::size_t size = 0; size <= good.size(); ++size) EXPECT_EQ(why_not_our_protocol(good.substr(0, size)), "") << size;
  EXPECT_EQ(why_not_our_protocol("content-type: x\r\n"), "");
  EXPECT_EQ(why_not_our_protocol("POST / HTTP/1.1\r\nContent-Length: 5\r\n"),
            "it began with a request of HTTP, as a web page does");
  for (const std::string wrong : {"hello", "\x16\x03\x01", "Content-Lengt_", "\r\n", "{"})
    EXPECT_NE(why_not_our_protocol(wrong).find("is not the Debug Adapter Protocol"), std::string::npos) << wrong;
}

TEST(Inbox, MessagesThatWaitAreBounded) {
  std::atomic<bool> stop = false;
  Inbox many(stop), long_ones(stop);
  for (std::size_t i = 0; i < Inbox::kMostMessages; ++i) {
    EXPECT_TRUE(many.has_room());
    many.put(request("threads"), 100);
  }
  EXPECT_FALSE(many.has_room());
  Json message;
  many.take(false, message);
  EXPECT_TRUE(many.has_room());
  long_ones.put(request("threads"), Inbox::kMostBytes);
  EXPECT_FALSE(long_ones.has_room());
}

}  // namespace
}  // namespace s7200::tools::dap::admission_test

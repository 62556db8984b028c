#include "tools/host/net/server_rules.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::server_rules_test {
namespace {

TEST(ServerRules, ARequestOfABrowserIsKnownByItsFirstBytes) {
  for (const std::string_view web :
       {"GET / HTTP/1.1\r\n", "POST /any HTTP/1.1\r\nHost: 127.0.0.1:4711\r\n", "OPTIONS * HTTP/1.1\r\n", "PUT /",
        "DELETE /a", "GET http://127.0.0.1/ HTTP/1.1\r\n", "PRI * HTTP/2.0\r\n\r\nSM"})
    EXPECT_TRUE(is_web_request(web)) << web;
  for (const std::string_view other : {"", "G", "GET", "GET ", "GET 5\r\n", "get /", "GETX /", " GET /",
                                       "Content-Length: 5\r\n", "POSTING /", "\x01\x03/", "Q0.0=1 /"})
    EXPECT_FALSE(is_web_request(other)) << other;
}

TEST(ServerRules, ATokenIsNewEachTimeAndComparedAsAWhole) {
  const std::string token = new_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_NE(token, new_token());
  EXPECT_TRUE(is_same_token(token, token));
  EXPECT_FALSE(is_same_token("", token));
  EXPECT_FALSE(is_same_token(token.substr(1), token));
  EXPECT_FALSE(is_same_token(token + token, token));
  EXPECT_FALSE(is_same_token(token + "0", token));
  EXPECT_FALSE(is_same_token(std::string(token.size(), '\0'), token));
}

}  // namespace
}  // namespace s7200::tools::server_rules_test

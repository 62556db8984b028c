#include "tools/faces/dap/wire/framing.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::dap::framing_test {
namespace {

std::string why_not(std::string_view bytes) {
  FrameReader reader;
  reader.add(bytes);
  auto content = reader.next();
  while (content) content = reader.next();
  return content.why();
}

TEST(Framing, MessagesAreTheSameHoweverTheStreamIsCut) {
  const std::string stream = framed("{\"seq\":1}") + "Content-Type: x\r\ncontent-length:  2\r\n\r\n{}" + framed("");
  for (std::size_t size = 1; size <= stream.size(); ++size) {
    FrameReader reader;
    std::vector<std::string> all;
    for (std::size_t at = 0; at < stream.size(); at += size) {
      reader.add(std::string_view(stream).substr(at, size));
      auto content = reader.next();
      for (; content; content = reader.next()) all.push_back(*content);
      EXPECT_EQ(content.why(), "");
    }
    EXPECT_EQ(all, (std::vector<std::string>{"{\"seq\":1}", "{}", ""})) << size;
    EXPECT_FALSE(reader.is_amid());
  }
}

TEST(Framing, WhatIsNotAHeaderIsSaidAtItsLine) {
  EXPECT_EQ(why_not("hello\r\n"), "'hello' is not a line of a header: write for example Content-Length: 119");
  EXPECT_EQ(why_not("Content-Length: 2\n\n{}"), "'Content-Length: 2' is not a line of a header, which ends with CR LF");
  EXPECT_EQ(why_not("Content-Length: two\r\n\r\n"), "'two' is not the length of a message");
  EXPECT_EQ(why_not("Content-Length: -1\r\n\r\n"), "'-1' is not the length of a message");
  EXPECT_EQ(why_not("Content-Type: x\r\n\r\n{}"), "a header without Content-Length");
}

TEST(Framing, LengthsHaveTheirLimits) {
  EXPECT_EQ(why_not("Content-Length: 16777217\r\n\r\n"), "a message of 16777217 bytes is longer than 16777216");
  EXPECT_EQ(why_not("Content-Length: 16777216\r\n\r\n"), "");
  EXPECT_EQ(why_not(std::string(5000, 'x')), "the header of a message is longer than 4096 bytes");
  EXPECT_EQ(why_not("X: " + std::string(3000, 'x') + "\r\nY: " + std::string(3000, 'x') + "\r\n"),
            "the header of a message is longer than 4096 bytes");
}

/// What is read of a stream, and what is wrong with it, in order; whatever is not JSON is rejected.
std::vector<std::string> read_all(std::string_view stream, std::size_t size) {
  FrameReader reader;
  std::vector<std::string> all;
  for (std::size_t at = 0; at < stream.size(); at += size) {
    reader.add(stream.substr(at, size));
    for (;;) {
      const auto content = reader.next();
      if (!content && content.why().empty()) break;
      const bool good = content && content->starts_with('{');
      if (content && !good) reader.reject(*content);
      all.push_back(good ? *content : "wrong");
    }
  }
  return all;
}

TEST(Framing, TheNextHeaderIsFoundAfterWhatIsNotAMessageHoweverTheStreamIsCut) {
  const std::string good = framed("{\"seq\":1}");
  const std::vector<std::string> wrong_then_good{"wrong", "{\"seq\":1}"};
  for (const std::string& wrong :
       {std::string("hello\r\n"), std::string("Content-Length: 2\n\n{}\n"), std::string("Content-Length: two\r\n\r\n{}"),
        std::string("Content-Type: x\r\n\r\n{}"), std::string("Content-Length: 99999999\r\n\r\n{}"), framed("hello"),
        std::string("Content-Length: 60\r\n\r\n\"too long: the next one begins in it\"")})
    for (std::size_t size : {std::size_t{1}, std::size_t{7}, std::size_t{1000}})
      EXPECT_EQ(read_all(wrong + good + good, size), (std::vector<std::string>{"wrong", "{\"seq\":1}", "{\"seq\":1}"}))
          << wrong << " in pieces of " << size;
  EXPECT_EQ(read_all(std::string(5000, 'x') + good, 100'000), wrong_then_good);
  EXPECT_EQ(read_all("Content-Length: " + std::string(5000, '9') + "\r\n\r\n" + good, 100'000), wrong_then_good);
}

TEST(Framing, APartOfAMessageIsKnownAsOne) {
  FrameReader reader;
  reader.add("Content-Length: 2\r\n");
  EXPECT_FALSE(reader.next());
  EXPECT_TRUE(reader.is_amid());
  reader.add("\r\n{");
  EXPECT_FALSE(reader.next());
  EXPECT_TRUE(reader.is_amid());
}

}  // namespace
}  // namespace s7200::tools::dap::framing_test

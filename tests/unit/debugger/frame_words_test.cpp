// Frames for the line, as people write them.
#include "tools/session/words/frame_words.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::frame_words_test {
namespace {

std::string frame_of(const std::string& text) {
  const auto frame = parse_frame(text, 1);
  return frame ? serial::to_hex(*frame) : "no frame: " + frame.why();
}

TEST(FrameWords, HexAndTextAreTakenAsTheyAre) {
  EXPECT_EQ(frame_of("01 03p 00"), "01 03p 00");
  EXPECT_EQ(frame_of("'AB\\r'"), "41 42 0d");
  EXPECT_EQ(frame_of("0103000a0002 crc"), "01 03 00 0a 00 02 e4 09");
}

TEST(FrameWords, ARequestByItsNameHasStationFunctionAndCrc) {
  EXPECT_EQ(frame_of("read 40011:2"), "01 03 00 0a 00 02 e4 09");
  EXPECT_EQ(frame_of("READ 00001:8").substr(0, 17), "01 01 00 00 00 08");
  EXPECT_EQ(frame_of("read 10001").substr(0, 17), "01 02 00 00 00 01");
  EXPECT_EQ(frame_of("read 30002 station 4").substr(0, 17), "04 04 00 01 00 01");
  EXPECT_EQ(frame_of("write 40011=16#1234").substr(0, 17), "01 06 00 0a 12 34");
  EXPECT_EQ(frame_of("write 40011=5,-1").substr(0, 32), "01 10 00 0a 00 02 04 00 05 ff ff");
  EXPECT_EQ(frame_of("write 00003=on station 0").substr(0, 17), "00 05 00 02 ff 00");
  EXPECT_EQ(frame_of("write 00001=1,0,1").substr(0, 23), "01 0f 00 00 00 03 01 05");
}

TEST(FrameWords, WhatIsWrongWithARequestIsSaid) {
  EXPECT_EQ(frame_of("write 30001=5"), "no frame: 30001 can only be read: it is an input register");
  EXPECT_EQ(frame_of("write 40001=on"), "no frame: 'on' is not a value of a holding register");
  EXPECT_EQ(frame_of("write 40001=65536"), "no frame: '65536' is not a value of a holding register");
  EXPECT_EQ(frame_of("read 40001:2 station x"), "no frame: 'x' is not the number of a station");
  for (const char* wrong : {"read 40001:0", "read 40001 4", "write 40001"})
    EXPECT_TRUE(frame_of(wrong).starts_with("no frame: expected read ADDRESS[:COUNT]")) << wrong;
  for (const char* wrong : {"station 4 read 40001", "4 read 40001:2", "read station 4 40001", "read"})
    EXPECT_TRUE(frame_of(wrong).starts_with("no frame: expected read ADDRESS[:COUNT]")) << wrong;
  for (const char* wrong : {"03 00 0a 00 01 crc station 4", "station 4"})
    EXPECT_TRUE(frame_of(wrong).starts_with("no frame: 'station n' goes with read and write; in hex")) << wrong;
  EXPECT_EQ(frame_of("crc 01 03"), "no frame: crc comes last: 01 03 00 0a 00 01 crc");
  EXPECT_TRUE(frame_of("'station 4").starts_with("no frame: column")) << "a text without its end";
  EXPECT_TRUE(frame_of("read 11").starts_with("no frame: ")) << "it might be meant as an address on the wire";
}

}  // namespace
}  // namespace s7200::tools::frame_words_test

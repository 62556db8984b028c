#include "serial_sim/line/frame.hpp"

#include <gtest/gtest.h>

#include <string>

namespace s7200::serial::frame_test {
namespace {

Bytes hex(std::string_view text) { return bytes_of(parse_hex_frame(text).frame); }

TEST(HexFrame, BlanksAndCaseAreFree) {
  EXPECT_EQ(hex("01 03 00 0a"), (Bytes{1, 3, 0, 10}));
  EXPECT_EQ(hex("  0103000A "), (Bytes{1, 3, 0, 10}));
  EXPECT_EQ(hex("aB\tCd"), (Bytes{0xAB, 0xCD}));
}

TEST(HexFrame, SignsOfOtherToolsMayStandBetweenBytes) {
  for (const char* text : {"01-03-0a", "01:03:0A", "01,03,0a", "01, 03; 0a", "0x01 0x03 0x0A", "0x01,0x03,0x0a", "0x01030a"})
    EXPECT_EQ(hex(text), (Bytes{0x01, 0x03, 0x0A})) << text;
  EXPECT_FALSE(parse_hex_frame(":01030a").ok()) << "a frame of Modbus ASCII is text";
  EXPECT_FALSE(parse_hex_frame("0x1").ok());
}

TEST(HexFrame, PMeansWrongParity) {
  const ParsedFrame parsed = parse_hex_frame("01 03p0A 0bP");
  ASSERT_TRUE(parsed.ok());
  EXPECT_EQ(parsed.frame, (Frame{{1, false}, {3, true}, {10, false}, {11, true}}));
  EXPECT_TRUE(has_wrong_parity(parsed.frame));
  EXPECT_EQ(to_hex(parsed.frame), "01 03p 0a 0bp");
  EXPECT_FALSE(has_wrong_parity(to_frame(hex("01 03"))));
}

TEST(HexFrame, ErrorsAreLocatedByColumnAndAllReported) {
  const ParsedFrame parsed = parse_hex_frame("01 0x 3 zz 04");
  const std::vector<FrameError> expected{{5, "'x' is not a hex digit"},
                                         {7, "a byte is two hex digits, 03 for 3"},
                                         {9, "'z' is not a hex digit"},
                                         {10, "'z' is not a hex digit"}};
  EXPECT_EQ(parsed.errors, expected);
}

TEST(HexFrame, PWithoutAByteIsAnError) {
  EXPECT_EQ(parse_hex_frame("p").errors, (std::vector<FrameError>{{1, "'p' is not a hex digit"}}));
  EXPECT_EQ(parse_hex_frame("01pp").errors, (std::vector<FrameError>{{4, "'p' is not a hex digit"}}));
}

TEST(HexFrame, HasFromOneTo1024Bytes) {
  EXPECT_EQ(parse_hex_frame(" ").errors, (std::vector<FrameError>{{1, "a frame has one byte at least"}}));
  std::string text;
  for (int byte = 0; byte < 1024; ++byte) text += "5a";
  EXPECT_TRUE(parse_hex_frame(text).ok());
  text += " 5ap";
  EXPECT_EQ(parse_hex_frame(text).errors, (std::vector<FrameError>{{2050, "a frame has 1024 bytes at most"}}));
}

TEST(HexFrame, WhatIsPrintedReadsBackTheSame) {
  Bytes all;
  for (unsigned byte = 0; byte < 256; ++byte) all.push_back(static_cast<std::uint8_t>(byte));
  EXPECT_EQ(hex(to_hex(all)), all);
}

}  // namespace
}  // namespace s7200::serial::frame_test

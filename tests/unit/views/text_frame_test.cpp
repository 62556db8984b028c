#include "tools/views/text_frame.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "serial_sim/modbus/request.hpp"

namespace s7200::tools::text_frame_test {
namespace {

std::string hex_of(std::string_view text) {
  const serial::ParsedFrame parsed = parse_text(text);
  return parsed.ok() ? serial::to_hex(parsed.frame) : "! " + parsed.errors[0].message;
}

std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

TEST(TextFrame, EscapesStandForBytes) {
  EXPECT_EQ(hex_of("HELLO\\r"), "48 45 4c 4c 4f 0d");
  EXPECT_EQ(hex_of("\\r\\n\\t\\\\\\'\\\""), "0d 0a 09 5c 27 22");
  EXPECT_EQ(hex_of("\\x02A\\x03\\xFf"), "02 41 03 ff");
  EXPECT_EQ(hex_of("A\r\n"), "41 0d 0a") << "as it is";
  EXPECT_EQ(hex_of(" A "), "20 41 20");
}

TEST(TextFrame, WhatIsNotATextIsSaidAtItsPlace) {
  const auto column = [](std::string_view text) { return parse_text(text).errors.at(0).column; };
  EXPECT_EQ(column("AB\\q"), 3U);
  EXPECT_EQ(column("AB\\"), 3U);
  EXPECT_EQ(column("A\\x4"), 2U);
  EXPECT_EQ(column("A\\xG0"), 2U);
  EXPECT_EQ(column("A\\x 4"), 2U);
  EXPECT_EQ(column("A\\?"), 2U) << "any byte can be expected, not sent";
  EXPECT_EQ(column("Aü"), 2U);
  EXPECT_EQ(column(""), 1U);
  EXPECT_TRUE(parse_text(std::string(1024, 'A')).ok());
  EXPECT_EQ(column(std::string(1025, 'A')), 1025U);
}

TEST(TextFrame, AnyByteCanBeExpected) {
  EXPECT_EQ(parse_text_pattern("T=\\?\\r"), (std::vector<std::optional<std::uint8_t>>{'T', '=', std::nullopt, '\r'}));
  std::string why = parse_text_pattern("\\a").why();
  EXPECT_NE(why.find("or by ? for any character"), std::string::npos) << why;
}

TEST(TextFrame, InQuotationMarksAFrameIsText) {
  const auto read = [](std::string_view text) {
    const serial::ParsedFrame parsed = parse_hex_or_quoted(text);
    return parsed.ok() ? serial::to_hex(parsed.frame)
                       : std::to_string(parsed.errors[0].column) + ": " + parsed.errors[0].message;
  };
  EXPECT_EQ(read(" 41 42p "), "41 42p");
  EXPECT_EQ(read(" 'A B' "), "41 20 42");
  EXPECT_EQ(read("\"it's # \\\"\""), "69 74 27 73 20 23 20 22");
  EXPECT_EQ(read("'it\\'s'"), "69 74 27 73");
  EXPECT_EQ(read("  'AB"), "3: the closing ' is missing");
  EXPECT_EQ(read("'AB' 41"), "5: nothing follows the closing quotation mark");
  EXPECT_EQ(read(" 'A\\q'"), "4: \\ is followed by r, n, t, xHH, \\, ' or \"");
  EXPECT_EQ(read("''"), "2: a frame has one byte at least");
}

TEST(TextFrame, TextIsPrintableWithLineEndsTabsStxAndEtx) {
  EXPECT_TRUE(is_text(bytes_of("OK\r\n")));
  EXPECT_TRUE(is_text(bytes_of("\x02T=21.5\x03\t~")));
  EXPECT_FALSE(is_text(bytes_of("\r\n"))) << "nothing to be read";
  EXPECT_FALSE(is_text(bytes_of("OK\x06")));
  EXPECT_FALSE(is_text(bytes_of("OK\x7F")));
  EXPECT_FALSE(is_text(bytes_of("OK\xE4")));
  EXPECT_FALSE(is_text({}));
}

TEST(TextFrame, AQuotedTextReadsBackToTheSameBytes) {
  EXPECT_EQ(quoted_text(bytes_of("OK\r\n\t\\ it's \"x\" \x02${y}$")), "'OK\\r\\n\\t\\\\ it\\x27s \"x\" \\x02\\x24{y}$'");
  std::vector<std::uint8_t> all{'\r', '\n', '\t', 2, 3};
  for (std::uint8_t byte = 0x20; byte <= 0x7E; ++byte) all.push_back(byte);
  const std::string quoted = quoted_text(all);
  EXPECT_EQ(serial::bytes_of(parse_hex_or_quoted(quoted).frame), all);
  EXPECT_EQ(quoted_text(bytes_of("\x01")), "");
}

TEST(TextFrame, OnlyARequestWithARightCrcHasAnAnswerOfModbus) {
  const Bytes request = modbus::rtu_frame(1, modbus::read_holding_registers(10, 1));
  const Bytes answer = modbus::rtu_frame(1, Bytes{3, 2, 0x12, 0x34});
  EXPECT_EQ(answer_text(request, answer), "1 register: 16#1234");
  EXPECT_EQ(answer_text(request, bytes_of("OK\r")), "too short for an answer: 4f 4b 0d");
  EXPECT_EQ(answer_text(request, bytes_of("HELLO\r")), "wrong CRC");
  EXPECT_EQ(answer_text(request, {}), "no answer");
  const Bytes without_crc(request.begin(), request.end() - 2);
  EXPECT_EQ(answer_text(without_crc, answer), "");
  EXPECT_EQ(answer_text(without_crc, bytes_of("OK\r")), "'OK\\r'");
  EXPECT_EQ(answer_text(bytes_of("HELLO\r"), bytes_of("OK\r")), "'OK\\r'");
  EXPECT_EQ(plain_text(bytes_of("HELLO\r"), bytes_of("OK\r")), "OK\r");
  EXPECT_FALSE(plain_text(request, bytes_of("OK\r")));
  EXPECT_FALSE(plain_text({}, answer));
  EXPECT_EQ(request_text(bytes_of("HELLO\r")), "'HELLO\\r'");
  EXPECT_EQ(request_text(bytes_of("Z?{")), "") << "a letter and its CRC";
}

}  // namespace
}  // namespace s7200::tools::text_frame_test

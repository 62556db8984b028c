#include <gtest/gtest.h>

#include <array>
#include <string>

#include "serial_sim/modbus/request.hpp"

namespace s7200::modbus {
namespace {

Bytes hex(std::string_view text) { return bytes_of(parse_hex_frame(text).frame); }

Bytes with_crc(std::string_view text) {
  Bytes bytes = hex(text);
  add_crc(bytes);
  return bytes;
}

std::string said(std::string_view request, std::string_view response) {
  return describe(with_crc(request), with_crc(response));
}

TEST(ModbusCrc, KnownFrames) {
  EXPECT_EQ(to_hex(with_crc("01 03 00 0a 00 01")), "01 03 00 0a 00 01 a4 08");
  EXPECT_EQ(to_hex(with_crc("01 03 00 00 00 0a")), "01 03 00 00 00 0a c5 cd");
  EXPECT_EQ(to_hex(with_crc("11 03 00 6b 00 03")), "11 03 00 6b 00 03 76 87");
}

TEST(ModbusCrc, CheckValueOfTheAlgorithm) {
  const std::string_view digits = "123456789";
  EXPECT_EQ(crc16(Bytes(digits.begin(), digits.end())), 0x4B37);
}

TEST(ModbusCrc, AnyWrongBitIsFound) {
  const Bytes good = hex("01 03 00 0a 00 01 a4 08");
  ASSERT_TRUE(crc_ok(good));
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    Bytes bad = good;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ 1U << bit % 8);
    EXPECT_FALSE(crc_ok(bad)) << bit;
  }
}

TEST(ModbusCrc, FrameWithoutContentIsNeverRight) {
  EXPECT_FALSE(crc_ok({}));
  EXPECT_FALSE(crc_ok(hex("ff ff")));
}

TEST(ModbusRequest, FunctionsOfTheTip) {
  EXPECT_EQ(to_hex(read_coils(0x13, 0x25)), "01 00 13 00 25");
  EXPECT_EQ(to_hex(read_inputs(0xC4, 0x16)), "02 00 c4 00 16");
  EXPECT_EQ(to_hex(read_holding_registers(0x6B, 3)), "03 00 6b 00 03");
  EXPECT_EQ(to_hex(read_input_registers(8, 1)), "04 00 08 00 01");
  EXPECT_EQ(to_hex(write_coil(0xAC, true)), "05 00 ac ff 00");
  EXPECT_EQ(to_hex(write_coil(0xAC, false)), "05 00 ac 00 00");
  EXPECT_EQ(to_hex(write_register(1, 3)), "06 00 01 00 03");
}

TEST(ModbusRequest, CoilsArePackedFromTheLowestBitOn) {
  const std::vector<bool> coils{true, false, true, true, false, false, true, true, true, false};
  EXPECT_EQ(to_hex(write_coils(0x13, coils)), "0f 00 13 00 0a 02 cd 01");
}

TEST(ModbusRequest, RegistersAreSentHighByteFirst) {
  const std::array<std::uint16_t, 2> values{0x000A, 0x0102};
  EXPECT_EQ(to_hex(write_registers(1, values)), "10 00 01 00 02 04 00 0a 01 02");
}

TEST(ModbusRequest, FrameIsStationPduAndCrc) {
  EXPECT_EQ(to_hex(rtu_frame(1, read_holding_registers(10, 1))), "01 03 00 0a 00 01 a4 08");
}

TEST(ModbusAnswer, RegistersInHex) {
  EXPECT_EQ(said("01 03 00 0a 00 03", "01 03 06 12 34 00 00 ff ff"), "3 registers: 16#1234 16#0000 16#FFFF");
  EXPECT_EQ(said("01 04 00 0a 00 01", "01 04 02 12 34"), "1 register: 16#1234");
}

TEST(ModbusAnswer, BitsInGroupsOfFourFromTheFirstOn) {
  EXPECT_EQ(said("01 01 00 00 00 08", "01 01 01 55"), "coils 0…7: 1010 1010");
  EXPECT_EQ(said("01 02 00 20 00 0a", "01 02 02 0f 03"), "inputs 32…41: 1111 0000 11");
  EXPECT_EQ(said("01 01 00 05 00 01", "01 01 01 01"), "coil 5: 1");
}

TEST(ModbusAnswer, Writes) {
  EXPECT_EQ(said("01 05 00 03 ff 00", "01 05 00 03 ff 00"), "coil 3 written: 1");
  EXPECT_EQ(said("01 05 00 03 00 00", "01 05 00 03 00 00"), "coil 3 written: 0");
  EXPECT_EQ(said("01 06 00 03 12 34", "01 06 00 03 12 34"), "register 3 written: 16#1234");
  EXPECT_EQ(said("01 0f 00 00 00 08 01 55", "01 0f 00 00 00 08"), "8 coils written from 0 on");
  EXPECT_EQ(said("01 10 00 02 00 01 02 12 34", "01 10 00 02 00 01"), "1 register written from 2 on");
}

TEST(ModbusAnswer, ExceptionsByName) {
  EXPECT_EQ(said("01 03 00 0a 00 01", "01 83 02"), "exception 2: illegal data address");
  EXPECT_EQ(said("01 41 00", "01 c1 01"), "exception 1: illegal function");
  EXPECT_EQ(said("01 03 00 0a 00 01", "01 83 63"), "exception 99: unknown code");
}

TEST(ModbusAnswer, WhatIsWrongWithIt) {
  const Bytes request = with_crc("01 03 00 0a 00 01");
  EXPECT_EQ(describe(request, {}), "no answer");
  EXPECT_EQ(describe(request, hex("01 03")), "too short for an answer: 01 03");
  EXPECT_EQ(describe(request, hex("01 03 02 12 34 00 00")), "wrong CRC");
  EXPECT_EQ(said("01 03 00 0a 00 01", "02 03 02 12 34"), "answer of station 2, not 1");
  EXPECT_EQ(said("01 03 00 0a 00 01", "01 04 02 12 34"), "answer to function 4, not 3");
  EXPECT_EQ(said("01 03 00 0a 00 02", "01 03 02 12 34"), "wrong length: 3 data bytes, expected 5");
  EXPECT_EQ(said("01 03 00 0a 00 01", "01 03 04 12 34"), "wrong byte count: 4, expected 2");
  EXPECT_EQ(said("01 06 00 03 12 34", "01 06 00 03 12 35"), "does not repeat the request: 00 03 12 35");
}

TEST(ModbusAnswer, NoRequestOrAnswerOfAnyLengthIsReadBeyondItsEnd) {
  const Bytes answer = with_crc("01 0f 00 00 00 08");
  for (unsigned function = 0; function < 256; ++function) {
    for (std::size_t length = 0; length < 12; ++length) {
      Bytes request(length, 0xFF);
      if (length > 0) request[0] = 1;
      if (length > 1) request[1] = static_cast<std::uint8_t>(function);
      Bytes cut(length, static_cast<std::uint8_t>(function));
      add_crc(cut);
      EXPECT_FALSE(describe(request, answer).empty());
      EXPECT_FALSE(describe(request, cut).empty());
      EXPECT_FALSE(describe(cut, cut).empty());
    }
  }
}

TEST(HexFrame, BlanksAndCaseAreFree) {
  EXPECT_EQ(hex("01 03 00 0a"), (Bytes{1, 3, 0, 10}));
  EXPECT_EQ(hex("  0103000A "), (Bytes{1, 3, 0, 10}));
  EXPECT_EQ(hex("aB\tCd"), (Bytes{0xAB, 0xCD}));
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
  const std::vector<FrameError> expected{{5, "'x' is no hex digit"},
                                         {7, "a byte is two hex digits, 03 for 3"},
                                         {9, "'z' is no hex digit"},
                                         {10, "'z' is no hex digit"}};
  EXPECT_EQ(parsed.errors, expected);
}

TEST(HexFrame, PWithoutAByteIsAnError) {
  EXPECT_EQ(parse_hex_frame("p").errors, (std::vector<FrameError>{{1, "'p' is no hex digit"}}));
  EXPECT_EQ(parse_hex_frame("01pp").errors, (std::vector<FrameError>{{4, "'p' is no hex digit"}}));
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
}  // namespace s7200::modbus

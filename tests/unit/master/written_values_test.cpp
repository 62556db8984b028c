#include "tools/master/written_values.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace s7200::tools::written_values_test {
namespace {

using Registers = std::vector<std::uint16_t>;

constexpr ValueFormat kPlain{};
constexpr ValueFormat kFloat{ValueForm::Float};

TEST(WrittenValues, RegistersAreWrittenInEachNotation) {
  EXPECT_EQ(parse_registers("1234,-5,16#04D2,2#1010_0101,65535,-32768", kPlain),
            (Registers{1234, 0xFFFB, 0x04D2, 0xA5, 0xFFFF, 0x8000}));
}

TEST(WrittenValues, WhatIsNoRegisterIsRefused) {
  for (const char* text : {"", ",", "1,", "65536", "-32769", "16#", "16#10000", "2#2", "0x12", "on", "1 ", " 1", "--1",
                           "16#-1", "1.5", "99999999999999999999"})
    EXPECT_THROW(parse_registers(text, kPlain), std::invalid_argument) << text;
}

TEST(WrittenValues, ValuesOf32BitsTakeTwoRegistersInEitherOrder) {
  EXPECT_EQ(parse_registers("16#12345678", {ValueForm::Unsigned32}), (Registers{0x1234, 0x5678}));
  EXPECT_EQ(parse_registers("16#12345678", {ValueForm::Unsigned32, true}), (Registers{0x5678, 0x1234}));
  EXPECT_EQ(parse_registers("-2", {ValueForm::Signed32}), (Registers{0xFFFF, 0xFFFE}));
  EXPECT_EQ(parse_registers("1.5,-2e3", kFloat), (Registers{0x3FC0, 0, 0xC4FA, 0}));
  EXPECT_THROW(parse_registers("4294967296", {ValueForm::Unsigned32}), std::invalid_argument);
  for (const char* text : {"", "nan", "inf", "1e99", "1.5x", " 1"})
    EXPECT_THROW(parse_registers(text, kFloat), std::invalid_argument) << text;
}

TEST(WrittenValues, CoilsAreOnOrOff) {
  EXPECT_EQ(parse_bits("on,off,1,0"), (Registers{1, 0, 1, 0}));
  for (const char* text : {"", "2", "ON", "on,", "true"}) EXPECT_THROW(parse_bits(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace s7200::tools::written_values_test

#include "tools/views/state/register_text.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::register_text_test {
namespace {

using Words = std::vector<std::uint16_t>;
using Lines = std::vector<std::string>;

constexpr ValueFormat kPlain{};
constexpr ValueFormat kFloat{ValueForm::Float};

TEST(RegisterText, EachFormShowsTheSameRegisters) {
  const Words words{0x41FB, 0x8042};
  EXPECT_EQ(value_lines(words, kPlain), (Lines{"16#41FB  16891", "16#8042  32834  -32702"}));
  EXPECT_EQ(value_lines(words, {ValueForm::Hex}), (Lines{"16#41FB", "16#8042"}));
  EXPECT_EQ(value_lines(words, {ValueForm::Unsigned}), (Lines{"16891", "32834"}));
  EXPECT_EQ(value_lines(words, {ValueForm::Signed}), (Lines{" 16891", "-32702"}));
  EXPECT_EQ(value_lines(words, {ValueForm::Bits}), (Lines{"2#0100_0001_1111_1011", "2#1000_0000_0100_0010"}));
  EXPECT_EQ(value_lines(words, {ValueForm::Unsigned32}), (Lines{"1107001410"}));
  EXPECT_EQ(value_lines(words, {ValueForm::Signed32, true}), (Lines{"-2143141381"}));
  EXPECT_EQ(value_lines(words, {ValueForm::Text}), (Lines{"'A$FB$80B'"}));
  EXPECT_EQ(value_lines(Words{0x3FC0, 0}, kFloat), (Lines{"         1.5"}));
}

TEST(RegisterText, RegistersLeftOverAreShownAndNothingIsNothing) {
  EXPECT_EQ(value_lines(Words{0x3FC0, 0, 7}, kFloat), (Lines{"         1.5", "16#0007"}));
  for (const ValueFormName& form : value_forms()) EXPECT_TRUE(value_lines({}, {form.form}).empty()) << form.name;
}

TEST(RegisterText, JsonHasNumbers) {
  EXPECT_EQ(values_json(Words{1, 0xFFFF}, kPlain).dump(), "[1,65535]");
  EXPECT_EQ(values_json(Words{1, 0xFFFF}, {ValueForm::Signed}).dump(), "[1,-1]");
  EXPECT_EQ(values_json(Words{0x3FC0, 0, 7}, kFloat).dump(), "[1.5]");
  EXPECT_EQ(values_json(Words{0x3DCC, 0xCCCD}, kFloat).dump(), "[0.1]");
  EXPECT_EQ(values_json(Words{0x7FC0, 0}, kFloat).dump(), "[\"nan\"]");
  EXPECT_EQ(values_json(Words{0x41FB}, {ValueForm::Text}).dump(), "\"A\xC3\xBB\"");
}

}  // namespace
}  // namespace s7200::tools::register_text_test

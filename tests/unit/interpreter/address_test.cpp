// Addresses and assignments, as the options of the command take them.
#include "interpreter/program/operands/address.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "interpreter/analysis/warnings/check.hpp"

namespace s7200::address_test {
namespace {

std::string refusal(std::string_view text) { return parse_range(text, cpu214()).why(); }

std::optional<Assignment> assignment(std::string_view text) { return parse_assignment(text, cpu214()).if_any(); }

TEST(Address, ACountFollowsAColon) {
  const auto range = parse_range("VW100:4", cpu214());
  ASSERT_TRUE(range) << range.why();
  EXPECT_EQ(range->count, 4u);
  EXPECT_EQ(range->at, image::kV + 100);
  EXPECT_EQ(range->name_of(3), "VW106");
  EXPECT_EQ(parse_range("T37:2", cpu214())->name_of(1), "T38");
}

TEST(Address, ADoubleWordIsARealIfTheTextSaysSo) {
  for (const char* text : {"VD20:real", "VD20:4:real", "VD20:real:4", "AC1:real", "vd20:REAL"}) {
    const auto range = parse_range(text, cpu214());
    ASSERT_TRUE(range) << range.why();
    EXPECT_TRUE(range->real) << text;
  }
  EXPECT_EQ(parse_range("VD20:4:real", cpu214())->count, 4u);
  EXPECT_EQ(parse_range("VD20:real:4", cpu214())->count, 4u);
  for (const char* text : {"VD20:real:0", "VD20:real:", "VD20:4:real:4", "VW20:real:4"})
    EXPECT_FALSE(parse_range(text, cpu214()));
  EXPECT_FALSE(parse_range("VD20", cpu214())->real);
}

TEST(Address, TextThatIsNotAnAddressOfTheCpuIsRefused) {
  EXPECT_EQ(refusal("hello"), "'hello' is not an address; write for example VB100, VW100:4, M31.7, AC0, VD20:real");
  EXPECT_EQ(refusal("V100"), "'V100' is not an address; write for example VB100, VW100:4, M31.7, AC0, VD20:real");
  for (const char* text : {"VB0:0", "VB0:x", "VB0:", "VB0:2x", "VB0:99999999999", "M0.0:2", "VW0:real", "VD0:real:0",
                           "VD0:2real", "VD0:0:real", "VD0::real"})
    EXPECT_EQ(refusal(text),
              std::string("'") + text +
                  "': after the colon write a count of 1 or more (not for bits), or real (only for double words)");
  EXPECT_EQ(refusal("VB4090:7"), "'VB4090:7' does not exist on CPU 214: V memory has 4096 bytes");
  EXPECT_EQ(refusal("T127:2"), "'T127:2' does not exist on CPU 214: T memory has 128 elements");
}

TEST(Address, AValueIsAnIntegerThatFitsOrARealForADoubleWord) {
  EXPECT_EQ(assignment("VW100=-5")->value & 0xFFFF, 0xFFFBu);
  EXPECT_EQ(assignment("M31.7=1")->value, 1u);
  EXPECT_EQ(assignment("VD0=-2.5")->value, std::bit_cast<std::uint32_t>(-2.5f));
  EXPECT_EQ(assignment("VD0=2")->value, 2u);
  EXPECT_EQ(assignment("VD0:real=2")->value, std::bit_cast<std::uint32_t>(2.0f));
  for (const char* text : {"VB0=256", "VB0=-129", "M0.0=2", "M0.0=-1", "VW0=2.5", "VW0:2=1", "VW0", "VW0=", "VW0=VW2"})
    EXPECT_FALSE(assignment(text)) << text;
}

TEST(Address, AValueThatDoesNotFitIsRefusedWithWhatThePlaceHolds) {
  struct Case {
    std::string_view text, why;
  };
  constexpr Case kCases[]{{"VB20=256", "'VB20=256': write a value that fits it: a byte is -128 to 255"},
                          {"VW20=-32769", "'VW20=-32769': write a value that fits it: a word is -32768 to 65535"},
                          {"M0.1=2", "'M0.1=2': write a value that fits it: a bit is 0 to 1"}};
  for (const auto& [text, expected] : kCases) {
    EXPECT_EQ(parse_assignment(text, cpu214()).why(), expected);
  }
}

TEST(Address, AddressesAreReadAsOtherSystemsWriteThem) {
  for (const char* text : {"%VW10", "VW 10", "DB1.DBW10", "db1.dbw10"}) {
    const auto range = parse_range(text, cpu214());
    ASSERT_TRUE(range) << text << ": " << range.why();
    EXPECT_EQ(range->name_of(0), "VW10") << text;
  }
  EXPECT_EQ(parse_range("DB1.DBX10.3", cpu214())->name_of(0), "V10.3");
  EXPECT_EQ(parse_range("%VW10:4", cpu214())->count, 4U);
  EXPECT_EQ(refusal("DB2.DBW10"), "'DB2.DBW10' is not an address; write for example VB100, VW100:4, M31.7, AC0, VD20:real");
}

TEST(Address, ValuesAreReadAsOtherLanguagesWriteThem) {
  for (const char* text : {"VW10=0x10", "VW10=10h", "VW10=$10", "VW10 = 16#10", "%VW10=&H10"}) {
    const auto read = assignment(text);
    ASSERT_TRUE(read) << text;
    EXPECT_EQ(read->value, 16U) << text;
  }
  for (const char* text : {"I0.0=on", "I0.0=TRUE", "M0.1=1"}) EXPECT_EQ(assignment(text)->value, 1U) << text;
  for (const char* text : {"I0.0=off", "I0.0=false"}) EXPECT_EQ(assignment(text)->value, 0U) << text;
  for (const char* text : {"VW10=on", "VB10=0x100", "VW10=0xG"}) EXPECT_FALSE(assignment(text)) << text;
}

TEST(Address, AnalogValuesAreAtEvenAddresses) {
  EXPECT_EQ(parse_range("AIW2", cpu214()).why(), "");
  EXPECT_EQ(parse_range("AIW3", cpu214()).why(), "AIW3 is an odd address; analog values are at even ones: AIW2");
  EXPECT_EQ(parse_assignment("AQW1=4", cpu214()).why(), "AQW1 is an odd address; analog values are at even ones: AQW0");
}

TEST(Address, AnAddressWithAnAmpersandIsAPointerToIt) {
  EXPECT_EQ(parse_pointer("&VB100", cpu214()), 0x0800'0064U);
  EXPECT_EQ(parse_pointer("&mw2", cpu214()), 0x0200'0002U);
  EXPECT_EQ(parse_pointer("&C3", cpu214()), 0x0600'0006U) << "two bytes each";
  EXPECT_EQ(parse_assignment("VD4=&VB100", cpu214())->value, 0x0800'0064U);
  for (const char* text : {"&V1.0", "&SMB2", "&AC1", "&VB0:2", "&VD0:real"}) {
    const std::string why = parse_pointer(text, cpu214()).why();
    EXPECT_NE(why.find("a pointer can point to bytes of I, Q, M, V or S"), std::string::npos) << text << ": " << why;
  }
  for (const char* text : {"VW4=&VB100", "VB4=&VB100", "VD4:real=&VB100", "VD4=&VB99999", "VD4=&", "VD4=VB100"})
    EXPECT_FALSE(parse_assignment(text, cpu214())) << text;
}

TEST(Address, ASymbolOfTheProgramStandsForItsAddress) {
  stl::ParseResult parsed = stl::parse("MEND\n", "x");
  parsed.source.symbols = {{"Speed", stl::Address{"V", stl::Size::Word, 20, 0}, {}, {}},
                           {"Pump 1", stl::Address{"Q", stl::Size::Bit, 0, 3}, {}, {}},
                           {"E1", stl::Address{"V", stl::Size::Word, 30, 0}, {}, {}},
                           {"Limit", stl::Integer{5}, {}, {}}};
  const auto program = check(parsed, cpu214(), default_times(cpu214())).program;
  EXPECT_EQ(parse_range("Speed:2", *program)->name_of(1), "VW22");
  EXPECT_EQ(parse_range("\"Pump 1\"", *program)->name_of(0), "Q0.3");
  EXPECT_EQ(parse_assignment("\"Pump 1\"=1", *program)->value, 1U);
  EXPECT_EQ(parse_assignment("speed=-1", *program)->place.name_of(0), "VW20");
  EXPECT_EQ(parse_range("E1", *program)->name_of(0), "VW30");
  EXPECT_EQ(parse_range("Speed:VW20", *program)->name_of(0), "VW20");
  EXPECT_EQ(parse_assignment("Speed:VW20=3", *program)->value, 3U);
  EXPECT_EQ(parse_range("Limit", *program).why(), "'Limit' is the symbol of a constant, not of memory");
  EXPECT_FALSE(parse_range("Speed", cpu214()));
}

}  // namespace
}  // namespace s7200::address_test

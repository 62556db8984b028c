#include "tools/json/json.hpp"

#include <gtest/gtest.h>

namespace s7200::tools::json_test {
namespace {

using Json = nlohmann::ordered_json;

std::string why_not(const std::string& text, const JsonLimits& limits = {}) {
  const auto json = parse_json(text, limits);
  EXPECT_EQ(json.has_value(), json.why().empty());
  return json.why();
}

std::string nested(std::size_t levels, char open, char close) {
  std::string text;
  for (std::size_t i = 0; i < levels; ++i) text += open == '{' ? "{\"a\":" : "[";
  text += "1";
  return text + std::string(levels, close);
}

template <class Function>
std::string refusal(Function function) {
  try {
    function();
  } catch (const WrongValue& wrong) {
    return wrong.what();
  }
  return "";
}

TEST(OutsideJson, HasALimitOfDepth) {
  for (const auto& [open, close] : {std::pair{'[', ']'}, {'{', '}'}}) {
    EXPECT_EQ(why_not(nested(64, open, close)), "");
    EXPECT_EQ(why_not(nested(65, open, close)), "JSON of more than 64 maps and lists inside each other");
    EXPECT_EQ(why_not(nested(1'000'000, open, close)), "JSON of more than 64 maps and lists inside each other");
  }
  EXPECT_EQ(why_not(std::string(100'000, '[')), "JSON of more than 64 maps and lists inside each other") << "never closed";
}

TEST(OutsideJson, BracketsInTextsAreNoDepth) {
  EXPECT_EQ(why_not("\"" + std::string(1000, '[') + "\\\"" + std::string(1000, '{') + "\""), "");
  EXPECT_EQ(why_not("{\"[[\\\\\":[]}", {.depth = 2}), "");
}

TEST(OutsideJson, HasALimitOfSizeAndMembers) {
  EXPECT_EQ(why_not("[1,2]", {.bytes = 4}), "longer than 4 bytes");
  std::string many = "{\"0\":0";
  for (int i = 1; i < 10'000; ++i) many += ",\"" + std::to_string(i) + "\":0";
  EXPECT_EQ(why_not(many + "}"), "");
  EXPECT_EQ(why_not(many + ",\"more\":0}"), "JSON with more than 10000 members in one map");
}

TEST(OutsideJson, WhatIsNotJsonIsSaidInOurWords) {
  for (const char* const text : {"", "{", "nul", "[1,]", "1e999", "\"\xff\"", "]]"})
    EXPECT_EQ(why_not(text), "not JSON") << text;
}

TEST(OutsideJson, NumbersAreTakenByWhatTheirTypeHolds) {
  EXPECT_EQ(number_of<std::uint8_t>(255), 255);
  EXPECT_EQ(number_of<std::int64_t>(Json::parse("-9223372036854775808")), INT64_MIN);
  EXPECT_EQ(number_of<std::uint64_t>(Json::parse("18446744073709551615")), UINT64_MAX);
  EXPECT_EQ(number_of<int>(3.0), 3) << "a JSON number has no kind of its own";
  EXPECT_EQ(number_of<double>(7), 7.0);
  for (const char* const text :
       {"256", "-1", "1e78", "-1e78", "0.5", "\"1\"", "true", "null", "[1]", "18446744073709551615"})
    EXPECT_FALSE(number_from<std::uint8_t>(Json::parse(text))) << text;
  for (const char* const text : {"9223372036854775808", "9223372036854775808.0", "1e19", "-1e19"})
    EXPECT_FALSE(number_from<std::int64_t>(Json::parse(text))) << text;
}

TEST(OutsideJson, ANumberThatIsNotInItsRangeIsNamed) {
  EXPECT_EQ(refusal([] { number_of<std::uint32_t>(Json::parse("1e78")); }),
            "1e+78 is not a whole number from 0 to 4294967295");
  EXPECT_EQ(refusal([] { number_of<int>("seven", {1, 9}); }), "\"seven\" is not a whole number from 1 to 9");
  EXPECT_EQ(refusal([] { number_of<double>(12, {0, 1}); }), "12 is not a number from 0 to 1");
}

TEST(OutsideJson, AMemberThatIsOfAnotherKindIsNamed) {
  const Json map{{"name", 5},   {"on", "yes"},          {"count", nullptr},
                 {"list", "a"}, {"map", Json::array()}, {"nul", std::string(1, '\0')}};
  EXPECT_EQ(refusal([&] { text_at(map, "name"); }), "name: 5 is not a text");
  EXPECT_EQ(refusal([&] { text_at(map, "nul", ""); }), "nul: \"\\u0000\" is not a text without the character NUL");
  EXPECT_EQ(refusal([&] { truth_at(map, "on", true); }), "on: \"yes\" is not true or false");
  EXPECT_EQ(refusal([&] { number_at<int>(map, "name", {0, 4}, 1); }), "name: 5 is not a whole number from 0 to 4");
  EXPECT_EQ(refusal([&] { number_at<int>(map, "count"); }), "count is missing") << "null is left out";
  EXPECT_EQ(number_at<int>(map, "count", {0, 9}, 3), 3);
  EXPECT_EQ(refusal([&] { list_at(map, "list"); }), "list: \"a\" is not a list");
  EXPECT_EQ(refusal([&] { map_at(map, "map"); }), "map: [] is not a map");
  EXPECT_TRUE(list_at(map, "none").empty());
  EXPECT_EQ(refusal([&] { text_at(Json(5), "name"); }), "name is missing") << "not even a map";
}

}  // namespace
}  // namespace s7200::tools::json_test

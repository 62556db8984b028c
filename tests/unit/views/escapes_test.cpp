#include "tools/views/escapes.hpp"

#include <gtest/gtest.h>

#include "tools/views/results_json.hpp"

namespace s7200::tools::escapes_test {
namespace {

TEST(Escapes, CommandsToATerminalAreWrittenAndAllElseStays) {
  EXPECT_EQ(with_escapes("plain \xC3\xBC \xE2\x82\xAC\n\t"), "plain \xC3\xBC \xE2\x82\xAC\n\t");
  EXPECT_EQ(with_escapes("a\xC2\x9B"
                         "31mb\x7F\xE2\x80\xAE"),
            "a\\u009b31mb\\u007f\\u202e");
  EXPECT_EQ(with_escapes("no UTF-8: \xFF"), "no UTF-8: \xFF");
}

TEST(Escapes, JsonHasNoneAndMeansTheSame) {
  const nlohmann::ordered_json json{{"name", "h\x1B[31m\xC2\x9B\xE2\x80\xAE"}};
  EXPECT_EQ(line_of(json), R"({"name":"h\u001b[31m\u009b\u202e"})");
  EXPECT_EQ(nlohmann::ordered_json::parse(lines_of(json)), json);
}

}  // namespace
}  // namespace s7200::tools::escapes_test

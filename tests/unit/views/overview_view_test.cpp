// What `s7200 inspect PROGRAM` shows first.
#include "tools/views/overview_view.hpp"

#include "tests/support/inspected.hpp"

namespace s7200::tools {
namespace {

using nlohmann::ordered_json;

TEST(OverviewView, CountsAndNamesWhatTheProgramIsMadeOf) {
  const auto json =
      overview_json(test::inspected("NETWORK 1\nLD I0.0\nTON T37, 10\nNETWORK 2\nLD T37\n= Q0.1\nXMT VB0, 0\nMEND\nNETWORK "
                                    "3\nSBR 1\nLD I0.1\n= M0.0\nRET\n"));
  EXPECT_EQ(json["instructions"], 10);
  EXPECT_EQ(json["networks"], 3);
  EXPECT_EQ(json["inputs"], ordered_json::parse(R"(["I0.0", "I0.1"])"));
  EXPECT_EQ(json["outputs"], ordered_json::parse(R"(["Q0.1"])"));
  EXPECT_EQ(json["timers"], ordered_json::parse(R"(["T37"])"));
  EXPECT_EQ(json["outside"], ordered_json::parse(R"(["XMT once"])"));
  EXPECT_EQ(json["never_executed"], ordered_json::parse(R"(["SBR_1"])"));
  EXPECT_EQ(json["never_read"], ordered_json::parse(R"(["M0.0"])"));
}

TEST(OverviewView, SaysWhatStartsEachRoutine) {
  const std::string text =
      overview_text(test::inspected("LD SM0.1\nATCH 0, 10\nENI\nMEND\nSBR 1\nLD I0.1\n= M0.0\nRET\nINT 0\nRETI\n"));
  EXPECT_NE(text.find("SBR_1                         4 instructions      never executed\n"), std::string::npos) << text;
  EXPECT_NE(text.find("event 10: timed interrupt 0, SMB34\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace s7200::tools

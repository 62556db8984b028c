// What `s7200 inspect PROGRAM steps` shows.
#include "tools/views/inspection/steps_view.hpp"

#include "tests/support/inspected.hpp"

namespace s7200::tools::steps_view_test {
namespace {

using test::inspected;

constexpr std::string_view kSequence =
    "LD SM0.1\n"
    "S S0.1, 1\n"
    "LSCR S0.1\n"
    "LD SM0.0\n"
    "S Q0.0, 1\n"
    "TON T37, 30\n"
    "LD T37\n"
    "O I0.0\n"
    "AN I0.1\n"
    "SCRT S0.2\n"
    "LPS\n"
    "AW> VW10, 5\n"
    "SCRT S0.3\n"
    "LPP\n"
    "SCRE\n"
    "LSCR S0.2\n"
    "LD I0.2\n"
    "SCRT S0.1\n"
    "SCRE\n"
    "LD S0.2\n"
    "= Q0.1\n"
    "LDN I0.7\n"
    "R S0.0, 8\n"
    "MEND\n";

TEST(StepsView, EachStepHasWhatActivatesItWhereItLeadsAndWhatItDoes) {
  EXPECT_EQ(steps_text(inspected(kSequence)),
            "S0.1: MAIN, network 1, test.stl:3\n"
            "  switched on   S S0.1, 1 (test.stl:2) if SM0.1\n"
            "                SCRT S0.1 (test.stl:18) if I0.2\n"
            "  leads to      S0.2 (test.stl:10) if (T37 or I0.0) and not I0.1\n"
            "                S0.3 (test.stl:13) if (T37 or I0.0) and not I0.1 and VW10 > 5\n"
            "  switched off  R S0.0, 8 (test.stl:23) if not I0.7\n"
            "  does          S Q0.0, 1 (test.stl:5)\n"
            "                TON T37, 30 (test.stl:6)\n"
            "\n"
            "S0.2: MAIN, network 3, test.stl:16\n"
            "  switched on   SCRT S0.2 (test.stl:10) if (T37 or I0.0) and not I0.1\n"
            "  leads to      S0.1 (test.stl:18) if I0.2\n"
            "  switched off  R S0.0, 8 (test.stl:23) if not I0.7\n"
            "  looked at     LD S0.2 (test.stl:20)\n"
            "\n"
            "S0.3: it has no segment (LSCR)\n"
            "  switched on   SCRT S0.3 (test.stl:13) if (T37 or I0.0) and not I0.1 and VW10 > 5\n"
            "  switched off  R S0.0, 8 (test.stl:23) if not I0.7\n");
}

TEST(StepsView, SaysWhatNothingActivatesAndWhatLeadsNowhere) {
  const std::string text = steps_text(inspected("LSCR S1.0\nLD I0.0\n= Q0.0\nSCRE\nMEND\n"));
  EXPECT_NE(text.find("  switched on   by nothing that is known\n  leads to      no other step\n"), std::string::npos)
      << text;
  EXPECT_EQ(steps_text(inspected("LD I0.0\n= Q0.0\nMEND\n")), "The program has no steps: no LSCR and no SCRT\n");
}

TEST(StepsView, SaysWhatNothingCalls) {
  const auto inspection = inspected(
      "LSCR S0.1\nLD T37\nSCRT S0.2\nSCRE\nMEND\nSBR 7\nLD S0.1\nTON T37, 10\nLD I0.0\nS S0.1, 1\nLSCR S0.2\nLD I0.1\n= "
      "Q0.0\n"
      "SCRE\nRET\n");
  EXPECT_EQ(steps_text(inspection),
            "S0.1: MAIN, network 1, test.stl:1\n"
            "  switched on   S S0.1, 1 (test.stl:10) if I0.0; but SBR 7 is never called\n"
            "  leads to      S0.2 (test.stl:3) if T37; but T37 never counts: SBR 7 is never called\n"
            "  looked at     LD S0.1 (test.stl:7)\n"
            "\n"
            "S0.2: SBR_7, network 2, test.stl:11\n"
            "  never runs    SBR 7 is never called\n"
            "  switched on   SCRT S0.2 (test.stl:3) if T37; but T37 never counts: SBR 7 is never called\n"
            "  leads to      no other step\n"
            "  does          = Q0.0 (test.stl:13) if I0.1\n");
  EXPECT_EQ(steps_json(inspection)[1]["never_runs"], "SBR 7 is never called");
}

TEST(StepsView, JsonHasTheSame) {
  const auto json = steps_json(inspected(kSequence, {"S0.2"}));
  ASSERT_EQ(json.size(), 1U);
  EXPECT_EQ(json[0]["step"], "S0.2");
  EXPECT_EQ(json[0]["segment"]["line"], 16);
  EXPECT_EQ(json[0]["transitions"][0]["to"], "S0.1");
  EXPECT_EQ(json[0]["transitions"][0]["condition"], "I0.2");
  EXPECT_EQ(json[0]["switched_on"][0]["place"]["line"], 10);
  EXPECT_EQ(json[0]["looked_at"][0]["line"], 20);
}

}  // namespace
}  // namespace s7200::tools::steps_view_test

// What `s7200 inspect PROGRAM xref` shows.
#include "tools/views/inspection/xref_view.hpp"

#include "tests/support/inspected.hpp"

namespace s7200::tools::xref_view_test {
namespace {

using test::inspected;

TEST(XrefView, HasTheColumnsOfMicroWinAndALineForEachUse) {
  EXPECT_EQ(xref_text(inspected("NETWORK 1\nLD I0.0\n= Q0.0\nMEND\n")),
            "I0.0 (input)\n"
            "  reads      I0.0             MAIN    1   test.stl:2              LD I0.0\n"
            "Q0.0 (output)\n"
            "  writes     Q0.0             MAIN    1   test.stl:3              = Q0.0\n");
}

TEST(XrefView, ShowsSymbolsBesideAddressesAndWhoWritesSpecialMemory) {
  const std::string text = xref_text(inspected("LD SM0.5\nMOVB SMB2, VB1\nMEND\n"));
  EXPECT_NE(text.find("SM0.5 (clock of 1 s; the CPU writes it)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("SMB2 (Freeport: character received; the port writes it)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("VB1; never read\n"), std::string::npos) << text;
}

TEST(XrefView, SaysWhyAPointerMayLeadAnywhere) {
  const std::string text = xref_text(inspected("LD SM0.0\nMOVB 1, *AC1\nMOVB 2, VB7\nMEND\n"));
  EXPECT_NE(text.find("  may reach  *AC1 (see Pointers)\n"), std::string::npos) << text;
  EXPECT_NE(text.find("*AC1: anywhere in I, Q, M, SM, S, AI, AQ, T, C, V; no instruction sets it\n"), std::string::npos)
      << text;
}

TEST(XrefView, SaysWhyAProfileMayBeAnywhere) {
  constexpr std::string_view kEnd = "PLS 0\nMOVB 1, VB7\nMEND\n";
  const auto text = [&](const std::string& program, std::vector<std::string> asked = {}, const char* cpu = "224") {
    return xref_text(inspected(program + std::string(kEnd), std::move(asked), *find_cpu(cpu)));
  };
  const std::string unset = text("LD SM0.0\nMOVB 16#A0, SMB67\n");
  EXPECT_NE(unset.find("\nSMW168: anywhere in V; no instruction sets it\n"), std::string::npos) << unset;
  const std::string computed = text("LD SM0.0\nMOVW VW2, SMW168\n");
  EXPECT_NE(computed.find("\nSMW168: anywhere in V; MOVW VW2, SMW168 (MAIN, network 1, test.stl:2) puts into it"),
            std::string::npos)
      << computed;
  const std::string length = text("LD SM0.0\nMOVW 8, SMW168\n");
  EXPECT_NE(length.find("SMW168: VB8 to VB2048; how many segments"), std::string::npos) << length;
  EXPECT_EQ(text("LD SM0.0\nMOVB 16#A0, SMB67\n", {"VW3000"}, "214").find("PLS"), std::string::npos);
}

TEST(XrefView, AnEventAtAnInputReadsIt) {
  const std::string text =
      xref_text(inspected("LD SM0.1\nATCH 0, 3\nENI\nMEND\nINT 0\nLD SM0.0\nINCW VW0\nRETI\n", {"I0.1"}));
  EXPECT_NE(text.find("  reads      I0.1             MAIN    1   test.stl:2              ATCH 0, 3\n"), std::string::npos)
      << text;
}

TEST(XrefView, KeepsToWhatIsAskedFor) {
  constexpr std::string_view kProgram =
      "NETWORK 1\nLD I0.0\nMOVW 1, VW10\nMEND\nNETWORK 2\nSBR 3\nLD SM0.0\nMOVB VB11, VB20\nRET\n";
  const std::string of_byte = xref_text(inspected(kProgram, {"V11.3"}));
  EXPECT_EQ(of_byte,
            "VW10, VB11\n"
            "  writes     VW10             MAIN    1   test.stl:3              MOVW 1, VW10\n"
            "  reads      VB11             SBR_3   2   test.stl:8              MOVB VB11, VB20\n");
  EXPECT_EQ(xref_text(inspected(kProgram, {"SBR_3:2"})).find("MOVW 1"), std::string::npos);
  EXPECT_EQ(xref_text(inspected(kProgram, {"VW12"})),
            "VW12: no instruction names it; near it the program uses VB11 and VB20\n");
}

TEST(XrefView, JsonHasTheSameUses) {
  const auto json = xref_json(inspected("LD I0.0\nMOVW 1, VW10\nTON T37, 100\nLD V10.3\nLD T37\n= Q0.0\nMEND\n"));
  const auto& entry = json["entries"][2];
  EXPECT_EQ(entry["address"], "VW10");
  EXPECT_EQ(entry["parts"], nlohmann::ordered_json::parse(R"(["VW10", "V10.3"])"));
  EXPECT_EQ(entry["uses"].size(), 2U);
  EXPECT_EQ(entry["uses"][0]["access"], "writes");
  EXPECT_EQ(entry["uses"][0]["instruction"], "MOVW 1, VW10");
  EXPECT_EQ(entry["uses"][0]["line"], 2);
  EXPECT_EQ(json["entries"][3]["address"], "T37");
  EXPECT_EQ(json["entries"][3]["meaning"], "TON, 100 ms");
  EXPECT_EQ(json["constants"][1]["constant"], "100");
}

TEST(XrefView, AConstantIsShownAsItIsWrittenInEachPlace) {
  const std::string text = xref_text(inspected("LD SM0.0\nMOVB 16#20, VB1\nMOVB 32, VB2\nMEND\n"));
  EXPECT_NE(text.find("  16#20                       MAIN    1   test.stl:2"), std::string::npos) << text;
  EXPECT_NE(text.find("  32                          MAIN    1   test.stl:3"), std::string::npos) << text;
}

TEST(XrefView, AnAddressWithinABlockIsUsedThoughNoInstructionNamesIt) {
  constexpr std::string_view kProgram = "LD SM0.0\nBMB VB0, VB60, 20\nMOVD &VB200, AC1\nMOVW 1, *AC1\nINCB VB60\nMEND\n";
  EXPECT_EQ(xref_text(inspected(kProgram, {"VB64"})),
            "VB64; never read\n"
            "  may write  VB60 to VB79     MAIN    1   test.stl:2              BMB VB0, VB60, 20\n");
  EXPECT_NE(xref_text(inspected(kProgram, {"VB201"})).find("MOVW 1, *AC1"), std::string::npos);
  EXPECT_EQ(xref_json(inspected(kProgram, {"VB64"}))["not_used"].size(), 0U);
  EXPECT_EQ(xref_json(inspected(kProgram, {"VB80"}))["not_used"].size(), 1U);
}

TEST(XrefView, RcvTouchesTheMessageBytesOfItsOwnPort) {
  const std::string text = xref_text(inspected("LD SM0.0\nRCV VB0, 1\nMEND\n", {}, *find_cpu("226")));
  EXPECT_NE(text.find("SMB186"), std::string::npos) << text;
  EXPECT_EQ(text.find("SMB86"), std::string::npos) << text;
}

TEST(XrefView, AProgramWithErrorsIsShownAsFarAsItIsRead) {
  const auto json = xref_json(inspected("LD I0.0\nMOVW VB1, VW10\n= Q0.0\nMEND\n"));
  ASSERT_EQ(json["entries"].size(), 3U);
  EXPECT_EQ(json["entries"][2]["address"], "VW10");
}

}  // namespace
}  // namespace s7200::tools::xref_view_test

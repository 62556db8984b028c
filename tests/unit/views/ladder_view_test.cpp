// What `s7200 inspect PROGRAM ladder` draws, and that it reads back as the program it was drawn from.
#include "tools/views/ladder/ladder_view.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "interpreter/base/text/text.hpp"
#include "interpreter/program/ladder/ladder.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/stl/tables/symbols.hpp"
#include "tests/support/inspected.hpp"
#include "tests/support/source_path.hpp"
#include "tools/host/files/files.hpp"
#include "tools/views/ladder/ladder_svg.hpp"
#include "tools/views/ladder/ladder_text.hpp"

namespace s7200::tools::ladder_view_test {
namespace {

using test::inspected;

std::string drawn(const std::string& stl, bool ascii = false) {
  const stl::Source source = s7200::read_text("NETWORK 1\n" + stl, "test.stl").source;
  return ladder_text(drawn_networks(source), source, ascii);
}

TEST(LadderView, DrawsContactsCoilsAndBoxesWithTheirPins) {
  EXPECT_EQ(drawn("LD I0.0 // start\nO Q0.0\nAN I0.1\n= Q0.0\nMOVB 1, VB0\nTON T37, 10\n"),
            "MAIN, network 1\n"
            "    │  I0.0    I0.1      Q0.0\n"
            "1   ├─┤   ├─┬─┤ / ├─┬──(     )\n"
            "    │  Q0.0 │       │  MOV_B──┐\n"
            "    ├─┤   ├─┘       ├──┤EN    │\n"
            "    │               │ 1┤IN OUT├VB0\n"
            "    │               │  └──────┘\n"
            "    │               │   T37\n"
            "    │               │  TON──┐\n"
            "    │               └──┤IN  │\n"
            "    │                10┤PT  │\n"
            "    │                  └────┘\n"
            "    LD I0.0  // start\n\n");
}

TEST(LadderView, DrawsACounterWithItsInputsFromTheRail) {
  EXPECT_EQ(drawn("LD I0.0\nO I0.1\nLD I0.2\nCTU C0, 10\n"),
            "MAIN, network 1\n"
            "    │           C0\n"
            "    │  I0.0    CTU──┐\n"
            "1   ├─┤   ├─┬──┤CU  │\n"
            "    │  I0.1 │  │    │\n"
            "    ├─┤   ├─┘  │    │\n"
            "    │  I0.2    │    │\n"
            "    ├─┤   ├────┤R   │\n"
            "    │        10┤PV  │\n"
            "    │          └────┘\n\n");
}

TEST(LadderView, DrawsBoxesInARowByTheirEno) {
  EXPECT_EQ(drawn("LD I0.0\nMOVB 1, VB0\nAENO\n= Q0.0\n"),
            "MAIN, network 1\n"
            "    │  I0.0   MOV_B──┐        Q0.0\n"
            "1   ├─┤   ├───┤EN ENO├──────(     )\n"
            "    │        1┤IN OUT├VB0\n"
            "    │         └──────┘\n\n");
}

TEST(LadderView, FoldsWhatIsWiderThan100ColumnsAndNamesBothEnds) {
  std::string stl = "LD I0.0\n";
  for (int i = 0; i < 13; ++i) stl += "A M0.0\n";
  const std::string text = drawn(stl + "= Q0.0\n");
  for (const std::string& line : stl::split_lines(text)) EXPECT_LE(stl::count_characters(line), 100u);
  EXPECT_NE(text.find("──>A\n"), std::string::npos) << text;
  EXPECT_NE(text.find("    │ A>──"), std::string::npos) << text;
}

TEST(LadderView, HasAFormOf7Bits) {
  EXPECT_EQ(drawn("LD I0.0\nLPS\nA I0.1\n= Q0.0\nLPP\nMOVB 1, VB0\n", true),
            "MAIN, network 1\n"
            "    |  I0.0    I0.1     Q0.0\n"
            "1   +-[   ]-+-[   ]---(     )\n"
            "    |       | MOV_B--+\n"
            "    |       +-|EN    |\n"
            "    |        1|IN OUT|VB0\n"
            "    |         +------+\n\n");
}

TEST(LadderView, SaysWhyANetworkHasNoFormInLadderAndShowsItsStl) {
  EXPECT_EQ(drawn("LD I0.0\n= Q0.0\nO I0.1\n= Q0.1\n"),
            "MAIN, network 1\n"
            "network is not representable in ladder: O I0.1 stands beside power flow that already leads to an\n"
            "output or a branch; in LAD it would join before that\n"
            "1   STL\n"
            "    LD      I0.0\n"
            "    =       Q0.0\n"
            "    O       I0.1\n"
            "    =       Q0.1\n"
            "\n");
  const std::string all = ladder_text(inspected("NETWORK 1\nLD I0.0\n= Q0.0\nO I0.1\n= Q0.1\nNETWORK 2\nMEND\n"));
  EXPECT_NE(all.find("1 of 2 networks not representable in ladder:\n"
                     "MAIN, network 1, line 4: O I0.1 stands beside"),
            std::string::npos)
      << all;
}

TEST(LadderView, KeepsToWhatIsAskedFor) {
  const std::string stl = "NETWORK 1\nLD I0.0\n= Q0.0\nNETWORK 2\nLD I0.1\nMOVB 1, VB10\nNETWORK 3\nMEND\n";
  EXPECT_EQ(ladder_text(inspected(stl, {"MAIN:2"})), ladder_text(inspected(stl, {"VB10"})));
  EXPECT_EQ(ladder_text(inspected(stl, {"MAIN:2"})).find("network 1"), std::string::npos);
  EXPECT_EQ(ladder_text(inspected(stl, {"VB99"})), "no network uses what was asked for\n");
}

TEST(LadderView, APictureIsOneFileWithItsTextsEscaped) {
  const std::string svg = ladder_svg(inspected("NETWORK 1 // a < b & \"c\"\nLDW< VW0, 5 // <script>\n= Q0.0\n"));
  EXPECT_TRUE(svg.starts_with(kPictureBegins));
  EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_NE(svg.find("prefers-color-scheme:dark"), std::string::npos);
  EXPECT_EQ(svg.find("<script>"), std::string::npos);
  EXPECT_EQ(svg.find("href"), std::string::npos);
}

TEST(LadderView, JsonHasTheTreeByTheNumbersOfItsElements) {
  const auto json = ladder_json(inspected("NETWORK 1\nLD I0.0\nO I0.1\nA I0.2\n= Q0.0\nNETWORK 2\nMEND\n"))[0];
  EXPECT_EQ(json["tree"].dump(), R"([[["series",["parallel",0,1],2],null,[],[[["series"],3,[],[]]]]])");
  EXPECT_EQ(json["elements"][3]["symbol"], "");
  EXPECT_EQ(json["elements"][3]["op"], 3);
  EXPECT_EQ(json["elements"][3]["to"], nullptr);
  EXPECT_EQ(json["grid"]["rows"], 4);
}

TEST(LadderGrid, PointsHavePowerAsFarAsContactsAreClosed) {
  const auto networks = drawn_networks(s7200::read_text("LD I0.0\nO I0.1\nNOT\nA I0.2\n= Q0.0\n", "test.stl").source);
  const LadderGrid grid = grid_of(networks[0]);
  const auto power_at_coil = [&](const std::vector<bool>& closed) -> bool {
    return powered_points(grid, closed)[grid.shapes.back().from];
  };
  EXPECT_TRUE(power_at_coil({false, false, false, true, false}));
  EXPECT_FALSE(power_at_coil({false, true, false, true, false}));
  EXPECT_FALSE(power_at_coil({false, false, false, false, false}));
}

// ---- Drawn programs read back --------------------------------------------------------------------------------------------

std::string plain(stl::Statement statement) {
  for (stl::Operand& operand : statement.operands) operand.symbol.clear();
  return stl::to_text(statement) + "\n";
}

std::string statements_from(const stl::Source& source, std::uint32_t first = 0, std::uint32_t end = UINT32_MAX) {
  std::string all;
  const auto statements = statements_of(source);
  for (std::uint32_t op = first; op < std::min<std::size_t>(end, statements.size()); ++op) all += plain(*statements[op]);
  return all;
}

struct ReadBack {
  std::size_t networks = 0, other_stl = 0;
  std::vector<std::string> undrawn;  // MAIN:3
};

/// Draws each network, reads the drawing back and compares; then the same with the whole page.
ReadBack read_back(const std::string& path) {
  const auto text = read_source(read_file(path).value_or(""), path);
  EXPECT_TRUE(text) << path << text.why();
  ReadBack result;
  if (!text) return result;
  stl::ParseResult parsed = text->parsed;
  stl::resolve_symbols(parsed);
  const stl::Source& source = parsed.source;
  const auto networks = drawn_networks(source);
  for (const DrawnNetwork& network : networks) {
    ++result.networks;
    if (!network.why_not.empty()) result.undrawn.push_back(network.routine + ":" + std::to_string(network.ladder.number));
    if (!network.other_stl.empty()) {
      ++result.other_stl;
      continue;
    }
    const std::string page = network_text(network, source, false);
    const auto back = ladder_to_stl(stl::read_ladder(page, "page"));
    EXPECT_EQ(statements_from(back.source), statements_from(source, network.first, network.end)) << path << "\n" << page;
    for (const stl::Diagnostic& diagnostic : back.diagnostics) ADD_FAILURE() << stl::render(diagnostic, back.source, false);
  }
  const auto back = ladder_to_stl(stl::read_ladder(ladder_text(networks, source, false), "page"));
  for (const stl::Diagnostic& diagnostic : back.diagnostics) ADD_FAILURE() << stl::render(diagnostic, back.source, false);
  if (result.other_stl == 0) {
    EXPECT_EQ(statements_from(back.source), statements_from(source)) << path;
  }
  return result;
}

TEST(LadderView, OurProgramsReadBackFromTheirDrawings) {
  std::map<std::string, std::vector<std::string>> undrawn;
  std::map<std::string, std::size_t> other_stl;
  std::size_t networks = 0;
  for (const char* folder : {"stl_programs", "stl_programs/libraries", "stl_programs/systems"})
    for (const auto& entry : std::filesystem::directory_iterator(test::source_path(folder))) {
      if (entry.path().extension() != ".stl" && entry.path().extension() != ".awl") continue;
      const ReadBack result = read_back(entry.path().string());
      networks += result.networks;
      if (!result.undrawn.empty()) undrawn[entry.path().filename().string()] = result.undrawn;
      if (result.other_stl != 0) other_stl[entry.path().filename().string()] = result.other_stl;
    }
  EXPECT_GT(networks, 800u);
  // An O after a branch, and a block with NOT after a contact.
  EXPECT_EQ(undrawn, (std::map<std::string, std::vector<std::string>>{{"measure_times.stl", {"INT_0:211"}},
                                                                      {"scale.stl", {"SBR_0:8"}}}));
  // Loops that measure ALD, OLD, LRD and LPP where A and O would do.
  EXPECT_EQ(other_stl, (std::map<std::string, std::size_t>{{"measure_times.stl", 11}}));
}

TEST(LadderView, ThePublishedTipReadsBackFromItsDrawing) {
  const std::string path = test::source_path("../shared/seeds/tip41_modbus_rtu_slave.txt");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "there is no " << path;
  const ReadBack result = read_back(path);
  EXPECT_EQ(result.networks, 80u);
  EXPECT_TRUE(result.undrawn.empty());
  EXPECT_EQ(result.other_stl, 0u);
}

/// Every instruction of the table that is a contact, a coil or a box, with operands of every kind that it takes.
TEST(LadderView, EveryOutputOfTheTableReadsBack) {
  for (const Instruction& instruction : all_instructions()) {
    if (!instruction.modelled() || !instruction.rung.writes_output || instruction.rung.stack.needs != 1) continue;
    std::string text = "NETWORK 1\nLD I0.0\n" + std::string(instruction.mnemonic) + " ";
    std::size_t number = 0;
    for (const OperandRule& rule : instruction.rules()) {
      const bool direct = rule.kind != OperandKind::Memory;
      const std::string at = std::to_string(100 + 8 * number);
      const char* letter = rule.width == Width::Bit    ? "V"
                           : rule.width == Width::Byte ? "VB"
                           : rule.width == Width::Word ? "VW"
                                                       : "VD";
      text += number++ == 0 ? "" : ", ";
      text += direct ? "1" : rule.areas == set_of(Area::T) ? "T37" : letter + at + (rule.width == Width::Bit ? ".1" : "");
    }
    const stl::Source source = s7200::read_text(text + "\n", "one.stl").source;
    const auto networks = drawn_networks(source);
    const std::string page = network_text(networks[0], source, false);
    const auto back = ladder_to_stl(stl::read_ladder(page, "page"));
    EXPECT_EQ(statements_from(back.source), statements_from(source)) << page;
    EXPECT_TRUE(back.diagnostics.empty()) << text
                                          << (back.diagnostics.empty()
                                                  ? ""
                                                  : stl::render(back.diagnostics[0], back.source, false));
  }
}

TEST(LadderView, RungsOfEveryShapeReadBack) {
  std::string wide = "LD I0.0\n", two = wide;
  for (int i = 0; i < 30; ++i) wide += "AW>= VW100, 12345\n";
  for (int i = 0; i < 12; ++i) two += "A I0.1\n";
  for (const std::string& rungs :
       {wide + "= Q0.0\nS Q0.1, 1\nA M0.0\nMOVB VB100, VB200\n",
        two + two + "OLD\nLPS\nA I0.5\n= Q0.0\nLPP\nA I0.6\n= Q0.1\n",
        std::string("LD I0.0\nO M0.0\nLDN I0.1\nA I0.2\nO I0.5\nLD I0.3\nCTUD C1, 10\n"),
        std::string("LD I0.0\nO M0.0\n") + two + "CTD C1, 10\n",
        std::string("LD I0.0\nLPS\nMOVB 1, VB0\nAENO\nLPS\nA I0.1\n= Q0.0\nLPP\n= Q0.1\nLPP\nA I0.2\nINCB VB1\n"),
        std::string("LDS= \"a b\", VB0\nSCPY \"x  y\", VB300\nMUL VW0, *AC1\nLDB= VB0, ' '\nO I0.0\nXMT VB0, 0\n"),
        std::string("LD I0.0\nED\nLD I0.1\nEU\nOLD\nLPS\nNOT\n= Q0.0\nLPP\nA I0.2\nNOT\nR T37, 2\n"),
        std::string("LD T41\nLDW>= C5, 20\nO S0.0\nCTU C5, 24\n"),
        std::string("LD T41\nO M0.0\nLDW>= C5, 20\nO S0.0\nO S0.1\nO S0.2\nCTU C5, VW1000\n"),
        std::string("LD I0.0\nLD I0.1\nA I0.2\nA I0.3\nLD M0.0\nO M0.1\nCTUD C5, VW1000\n"),
        std::string("LD I0.0\nLD I0.1\nO I0.2\nCTU C0, *LD10\nLD I0.4\nO I0.5\nTON T37, VW1000\n= Q0.0\n"),
        std::string("LD I0.0\n= Q0.0\nLD I0.1\nLD I0.2\nCTU C0, 5\nLD I0.3\nNOP 4\n= Q0.2\nMEND\n")}) {
    const stl::Source source = s7200::read_text("NETWORK 1\n" + rungs, "rungs.stl").source;
    const auto networks = drawn_networks(source);
    ASSERT_EQ(networks[0].why_not, "") << rungs;
    const std::string page = network_text(networks[0], source, false);
    for (const std::string& line : stl::split_lines(page)) EXPECT_LE(stl::count_characters(line), 100u) << line;
    const auto back = ladder_to_stl(stl::read_ladder(page, "page"));
    EXPECT_EQ(statements_from(back.source), statements_from(source)) << page;
    for (const stl::Diagnostic& diagnostic : back.diagnostics) ADD_FAILURE() << stl::render(diagnostic, back.source, false);
  }
}

TEST(LadderView, TheHeadOfASubroutineDeclaresItsVariables) {
  stl::ParseResult parsed = s7200::read_text(
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD I0.0\nCALL Scale, VW0, M0.0, VW2\nEND_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK Scale:SBR3\nVAR_INPUT\n raw : INT; // of the sensor\nEND_VAR\nVAR_IN_OUT\n on : BOOL;\nEND_VAR\n"
      "VAR_OUTPUT\n result : INT;\nEND_VAR\nVAR\n t : REAL;\nEND_VAR\nBEGIN\nNETWORK 1\nLD #on\nMOVW #raw, #result\n"
      "END_SUBROUTINE_BLOCK\n",
      "test.awl");
  stl::resolve_symbols(parsed);
  const std::string page = ladder_text(drawn_networks(parsed.source), parsed.source, false);
  EXPECT_NE(page.find("└───┬────┘\n"
                      "    VAR_INPUT   raw : INT;  // of the sensor\n"
                      "    VAR_IN_OUT  on : BOOL;\n"
                      "    VAR_OUTPUT  result : INT;\n"
                      "    VAR         t : REAL;\n"),
            std::string::npos)
      << page;
  const auto back = ladder_to_stl(stl::read_ladder(page, "page"));
  EXPECT_TRUE(back.diagnostics.empty());
  ASSERT_EQ(back.source.blocks.size(), 1U);
  const auto same = [](const stl::Variable& a, const stl::Variable& b) {
    return a.name == b.name && a.kind == b.kind && a.type == b.type && a.address == b.address && a.comment == b.comment;
  };
  EXPECT_EQ(back.source.blocks[0].number, 3U);
  EXPECT_TRUE(std::ranges::equal(back.source.blocks[0].variables, parsed.source.blocks[1].variables, same));
}

TEST(LadderView, ACommentOfADeclarationThatIsWiderThanThePageReadsBackWhole) {
  std::string comment = "level of the tank";
  for (int i = 1; i <= 30; ++i) comment += ", or of tank " + std::to_string(i);
  stl::ParseResult parsed = s7200::read_text(
      "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nNETWORK 1\nLD SM0.0\nCALL Scale, VW0\nEND_ORGANIZATION_BLOCK\n"
      "SUBROUTINE_BLOCK Scale:SBR3\nVAR_INPUT\nraw : INT; // " +
          comment +
          "\nEND_VAR\nVAR\nt : REAL; // of it\nEND_VAR\n"
          "BEGIN\nNETWORK 1\n// where it is taken\nLD SM0.0\nMOVW #raw, VW10\nEND_SUBROUTINE_BLOCK\n",
      "test.awl");
  stl::resolve_symbols(parsed);
  const std::string page = ladder_text(drawn_networks(parsed.source), parsed.source, false);
  for (const std::string& line : stl::split_lines(page)) EXPECT_LE(stl::count_characters(line), 100u) << line;
  const stl::LadderPage read = stl::read_ladder(page, "page");
  const auto back = ladder_to_stl(read);
  EXPECT_TRUE(back.diagnostics.empty());
  ASSERT_EQ(back.source.blocks.size(), 1U);
  ASSERT_EQ(back.source.blocks[0].variables.size(), 2U);
  EXPECT_EQ(back.source.blocks[0].variables[0].comment, comment) << page;
  EXPECT_EQ(back.source.blocks[0].variables[1].comment, "of it");
  const auto is_kept = [](const stl::LadderNetwork& network) { return !network.comments.empty(); };
  EXPECT_EQ(std::ranges::count_if(read.networks, is_kept), 1) << "of the network below";
}

}  // namespace
}  // namespace s7200::tools::ladder_view_test

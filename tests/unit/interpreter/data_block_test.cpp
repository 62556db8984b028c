#include "interpreter/program/loading/data_block.hpp"

#include <gtest/gtest.h>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/stl/tables/data_block.hpp"
#include "tests/support/plc.hpp"

namespace s7200::data_block_test {
namespace {

struct Placed {
  std::vector<InitialData> data;
  std::vector<std::string> said;
};

Placed placed(const std::string& text, const CpuModel& model = cpu214()) {
  stl::ParseResult parsed = stl::read_data_block(text, "d.txt");
  Placed result;
  result.data = place_data(parsed.source, model, parsed.diagnostics);
  for (const stl::Diagnostic& d : parsed.diagnostics) {
    const std::string line = render(d, parsed.source, false);
    result.said.push_back(line.substr(0, line.find('\n')));
  }
  return result;
}

using Bytes = std::vector<std::uint8_t>;

/// The only run of bytes.
Bytes bytes(const std::string& text, std::uint32_t offset) {
  const Placed result = placed(text);
  EXPECT_TRUE(result.said.empty()) << result.said.front();
  if (result.data.size() != 1) return {};
  EXPECT_EQ(result.data[0].offset, offset);
  return result.data[0].bytes;
}

std::string error(const std::string& text) {
  const Placed result = placed(text);
  EXPECT_EQ(result.said.size(), 1U) << text;
  return result.said.empty() ? "" : result.said[0].substr(result.said[0].find("error: ") + 7);
}

TEST(DataBlock, PutsValuesOneAfterTheOther) {
  EXPECT_EQ(bytes("VB0 1, 2, 3", 0), (Bytes{1, 2, 3}));
  EXPECT_EQ(bytes("VW2\t100\t-1 // two words", 2), (Bytes{0, 100, 255, 255}));
  EXPECT_EQ(bytes("vd6 3.14", 6), (Bytes{0x40, 0x48, 0xF5, 0xC3}));
  EXPECT_EQ(bytes("VD0 16#01020304; 2#1", 0), (Bytes{1, 2, 3, 4, 0, 0, 0, 1}));
  EXPECT_EQ(bytes("DBB5 7", 5), (Bytes{7}));
}

TEST(DataBlock, TakesTextAndStrings) {
  EXPECT_EQ(bytes("VB10 'a,b //$0D'", 10), (Bytes{'a', ',', 'b', ' ', '/', '/', 13}));
  EXPECT_EQ(bytes("VB10 \"ab\", 5", 10), (Bytes{2, 'a', 'b', 5}));
}

TEST(DataBlock, ALineWithoutAddressGoesOnWhereTheOneBeforeEnded) {
  EXPECT_EQ(bytes("VW0 1\n\n// next\n  2, 3\n4", 0), (Bytes{0, 1, 0, 2, 0, 3, 0, 4}));
  EXPECT_EQ(error("1, 2\nVB0 1"), "the first line of a data block has no address");
}

TEST(DataBlock, SaysWhatDoesNotFitAndWhere) {
  EXPECT_EQ(error("VB0 256"), "256 does not fit in 1 byte");
  EXPECT_EQ(error("VW0 1.5"), "a real number needs a double word");
  EXPECT_EQ(error("VW0 'AB'"), "a text is set from a byte on");
  EXPECT_EQ(error("VB0 'AB"), "this text has no closing quote");
  EXPECT_EQ(error("VB0"), "VB0 has no value");
  EXPECT_EQ(error("VB0 FROB"), "FROB is not a value");
  EXPECT_EQ(error("V0 1"), "V0 does not say whether it is a byte, word or double word");
  EXPECT_EQ(error("V0.3 1"), "V0.3 is a bit");
  EXPECT_EQ(error("MB0 1"), "MB0 is not in V memory");
  EXPECT_EQ(placed("VB4094 1, 2, 3").said.at(0),
            "d.txt:1:14: error: the data block runs past the end of V memory: this value is at VB4096 and beyond");
  EXPECT_TRUE(placed("VB4094 1, 2").said.empty());
}

TEST(DataBlock, AByteIsSetOnce) {
  const Placed result = placed("VW0 1, 2\nVB3 5\n");
  EXPECT_EQ(result.said, std::vector<std::string>{"d.txt:2:5: error: VB3 is set twice"});
}

TEST(DataBlock, IsToldFromAListing) {
  const auto is_mnemonic = [](std::string_view word) { return word == "NETWORK" || find_instruction(word); };
  for (const char* text : {"// data\nVB0 1\n2, 3\nVW10 5\n", "Delay 25\nVB300 1\n", "VB300 1\nDelay 25\n\"Per cent\" 2.5\n",
                           "\"Delay 1\" 25\nVB300 1\n"})
    EXPECT_TRUE(stl::is_data_block(text, is_mnemonic)) << text;
  for (const char* text : {"LD SM0.0\nMEND\n", "1, 2, 3\n", "", "Delay 25\n", "JMP 5\nVB300 1\n", "NETWORK 1\nVB0 1\n"})
    EXPECT_FALSE(stl::is_data_block(text, is_mnemonic)) << text;
}

TEST(DataBlock, OneThatIsAllCommentsBelongsToTheProgramItIsGivenWith) {
  std::vector<SourceText> files{*read_source("// data page\n//\n", "d"), *read_source("LD SM0.0\n= Q0.0\nMEND\n", "p")};
  EXPECT_FALSE(files[0].is_program());
  const CheckResult result = check(join_files(std::move(files)).parsed, cpu214(), default_times(cpu214()));
  EXPECT_TRUE(result.program) << render(result.diagnostics, result.source, false);
}

TEST(DataBlock, NamesOfSymbolsStandForItsAddresses) {
  std::vector<SourceText> files{*read_source("LD SM0.0\n= Q0.0\nMEND\n", "p"), *read_source("Limit\tVW10\n", "t"),
                                *read_source("VB0 1\nLimit 300\n", "d")};
  const CheckResult result = check(join_files(std::move(files)).parsed, cpu214(), default_times(cpu214()));
  ASSERT_TRUE(result.program) << render(result.diagnostics, result.source, false);
  ASSERT_EQ(result.program->data.size(), 2U);
  EXPECT_EQ(result.program->data[1].bytes, (Bytes{1, 44}));
}

constexpr const char* kProgram =
    "ORGANIZATION_BLOCK MAIN:OB1\nBEGIN\nLD SM0.0\nINCW VW0\nEND_ORGANIZATION_BLOCK\n"
    "DATA_BLOCK DB1\nVW0 100\nVB1022 1, 2, 3\nEND_DATA_BLOCK\n";

TEST(DataBlock, IsInVMemoryFromTheFirstScanOn) {
  test::Plc plc(kProgram);
  plc.run_scans(2);
  EXPECT_EQ(plc.value("VW0"), 102);
  EXPECT_EQ(plc.value("VB1024"), 3);
}

TEST(DataBlock, TheEepromKeepsWhatLiesInItsPartOfV) {
  test::Plc loaded(kProgram);
  RetentiveMemory memory = loaded.cpu.retentive_memory();
  memory.ram_lost = true;
  test::Plc later(kProgram, &memory);
  EXPECT_EQ(later.value("VW0"), 100);
  EXPECT_EQ(later.value("VB1023"), 2);
  EXPECT_EQ(later.value("VB1024"), 0);
}

TEST(DataBlock, AnotherPowerUpIsNotAnotherDownload) {
  test::Plc loaded(kProgram);
  loaded.run_scans(2);
  RetentiveMemory memory = loaded.cpu.retentive_memory();
  memory.eeprom[1023] = 77;
  memory.ram_lost = true;
  test::Plc later(kProgram, &memory);
  EXPECT_EQ(later.value("VB1023"), 77);
}

TEST(DataBlock, TakesTimeInProportionToItsSize) {
  EXPECT_FALSE(placed("VB0 " + std::string(1'000'000, '\'')).said.empty());
  EXPECT_EQ(placed("VB0" + std::string(1'000'000, ' ')).said.size(), 1U);
  std::string many = "VB0 1";
  for (int i = 0; i < 200'000; ++i) many += ", x";
  EXPECT_EQ(placed(many).said.size(), 10U);
}

TEST(DataBlock, EachWrongValueOfALineIsNamed) {
  const Placed result = placed("VB0 1, 300, 2, 400\n");
  ASSERT_EQ(result.said.size(), 2U);
  EXPECT_EQ(result.said[0], "d.txt:1:8: error: 300 does not fit in 1 byte");
  EXPECT_EQ(result.said[1], "d.txt:1:16: error: 400 does not fit in 1 byte");
}

TEST(DataBlock, TextsMayHaveLettersOfWindows1252) { EXPECT_EQ(bytes("VB4 'F\u00FCll'\n", 4), (Bytes{'F', 0xFC, 'l', 'l'})); }

TEST(DataBlock, CommentsMayStandBeforeTheFirstAddress) {
  EXPECT_EQ(bytes("// speeds\nVB0 1 // slow\n2\n", 0), (Bytes{1, 2}));
}

TEST(DataBlock, AnAddressWithoutValueIsNamedWithoutTheBlanksAroundIt) {
  EXPECT_EQ(error("  VB0  // none\n"), "VB0 has no value");
}

TEST(DataBlock, MayHaveHeadings) {
  for (const std::string head : {"Address\tValue\n", "Adresse  Wert  Kommentar\n"}) {
    const auto source = read_source(head + "VB0\t5\nVW2\t7\n", "values.txt");
    ASSERT_TRUE(source) << source.why();
    EXPECT_EQ(source->kind, SourceKind::DataBlock);
    EXPECT_TRUE(source->parsed.diagnostics.empty());
    EXPECT_EQ(source->parsed.source.data.size(), 2U);
  }
}

}  // namespace
}  // namespace s7200::data_block_test

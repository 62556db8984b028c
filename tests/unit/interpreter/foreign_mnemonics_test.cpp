// What is said of mnemonics that the S7-200 does not have.
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/base/diagnostic.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/program/load.hpp"

namespace s7200::foreign_mnemonics_test {
namespace {

std::string hint(std::string_view mnemonic) { return unknown_mnemonic(mnemonic).hint; }

TEST(ForeignMnemonics, HintsNameWhatDoesTheSame) {
  for (const auto& [mnemonic, same] : {std::pair{"AND", "write A"},
                                       {"ANDN", "write AN"},
                                       {"OR", "write O"},
                                       {"ORN", "write ON"},
                                       {"OUT", "write ="},
                                       {"INV", "write NOT"},
                                       {"ANB", "write ALD"},
                                       {"MPS", "write LPS"},
                                       {"MRD", "write LRD"},
                                       {"MPP", "write LPP"},
                                       {"SET", "write S BIT, 1"},
                                       {"RST", "write R BIT, 1"},
                                       {"JC", "write JMP, which needs power flow"},
                                       {"JMPCN", "write NOT, then JMP"},
                                       {"P", "write EU after the contacts before it"},
                                       {"N", "write ED after the contacts before it"},
                                       {"RESEAU", "write NETWORK"},
                                       {"NETWERK", "write NETWORK"},
                                       {"REDE", "write NETWORK"},
                                       {"CMP_I", "write LDW, AW or OW with =, <>, >=, <=, > or <: LDW>= IN1, IN2"},
                                       {"SF", "write TOF"},
                                       {"DMOV", "write MOVD"},
                                       {"NEG", "the S7-200 has no negation: write INVW OUT, then INCW OUT; INVD and INCD for a double word"},
                                       {"UN", "write AN"}}) {
    EXPECT_EQ(hint(mnemonic), same) << mnemonic;
    EXPECT_FALSE(unknown_mnemonic(mnemonic).what.empty()) << mnemonic;
  }
}

TEST(ForeignMnemonics, StringsHaveTwoComparisons) {
  EXPECT_EQ(hint("LDS"), "write LDS= or LDS<>");
  EXPECT_EQ(hint("LDSGE"), "write LDS= or LDS<>");
  EXPECT_EQ(hint("LDWGE"), "write LDW>=");
}

TEST(ForeignMnemonics, TheImmediateContactsOfOtherControllersAreClosedOnes) {
  EXPECT_EQ(hint("ORI"), "write ON for a closed contact, OI to read an input at once");
  EXPECT_EQ(hint("ANDI"), "write AN for a closed contact, AI to read an input at once");
}

TEST(ForeignMnemonics, ABoxOfTheLadderEditorIsItsInstruction) {
  for (const auto& [box, instruction] : {std::pair{"MOV_B", "write MOVB IN, OUT"},
                                         {"MOV_DW", "write MOVD IN, OUT"},
                                         {"BLKMOV_B", "write BMB IN, OUT, N"},
                                         {"BLKMOV_D", "write BMD IN, OUT, N"},
                                         {"FILL_N", "write FILL IN, OUT, N"},
                                         {"READ_RTC", "write TODR T"},
                                         {"SET_RTC", "write TODW T"},
                                         {"B_I", "write BTI IN, OUT"},
                                         {"DI_R", "write DTR IN, OUT"},
                                         {"AD_T_TBL", "write ATT DATA, TBL"},
                                         {"STR_CPY", "write SCPY IN, OUT"},
                                         {"S_R", "write STR IN, INDX, OUT"},
                                         {"CAL_ITIME", "write CITIM IN, OUT"},
                                         {"SET_ADDR", "write SPA ADDR, PORT"},
                                         {"SCR", "write LSCR BIT"}}) {
    EXPECT_EQ(hint(box), instruction) << box;
    EXPECT_EQ(unknown_mnemonic(box).what, "a box of the ladder editor") << box;
  }
}

TEST(ForeignMnemonics, ABoxWhoseInstructionWorksOnItsOutputMovesTheFirstInputThereBefore) {
  EXPECT_EQ(hint("ADD_I"), "write MOVW IN1, OUT, then +I IN2, OUT; OUT must not be IN2");
  EXPECT_EQ(hint("DIV_R"), "write MOVR IN1, OUT, then /R IN2, OUT; OUT must not be IN2");
  EXPECT_EQ(hint("WXOR_DW"), "write MOVD IN1, OUT, then XORD IN2, OUT; OUT must not be IN2");
  EXPECT_EQ(hint("SHR_W"), "write MOVW IN, OUT, then SRW OUT, N; OUT must not be N");
  EXPECT_EQ(hint("INC_W"), "write MOVW IN, OUT, then INCW OUT");
  EXPECT_EQ(hint("INV_B"), "write MOVB IN, OUT, then INVB OUT");
  EXPECT_EQ(hint("I_BCD"), "write MOVW IN, OUT, then IBCD OUT");
}

TEST(ForeignMnemonics, AllBoxesAreKnown) {
  for (const std::string_view box :
       {"ADD_I",    "ADD_DI",   "ADD_R",    "SUB_I",   "SUB_DI",   "SUB_R",     "MUL",       "MUL_I",     "MUL_DI",
        "MUL_R",    "DIV",      "DIV_I",    "DIV_DI",  "DIV_R",    "SQRT",      "SIN",       "COS",       "TAN",
        "LN",       "EXP",      "PID",      "INC_B",   "INC_W",    "INC_DW",    "DEC_B",     "DEC_W",     "DEC_DW",
        "MOV_B",    "MOV_W",    "MOV_DW",   "MOV_R",   "MOV_BIR",  "MOV_BIW",   "BLKMOV_B",  "BLKMOV_W",  "BLKMOV_D",
        "SWAP",     "SHL_B",    "SHL_W",    "SHL_DW",  "SHR_B",    "SHR_W",     "SHR_DW",    "ROL_B",     "ROL_W",
        "ROL_DW",   "ROR_B",    "ROR_W",    "ROR_DW",  "SHRB",     "FILL_N",    "READ_RTC",  "SET_RTC",   "I_BCD",
        "BCD_I",    "B_I",      "I_B",      "I_DI",    "DI_I",     "DI_R",      "ROUND",     "TRUNC",     "WAND_B",
        "WAND_W",   "WAND_DW",  "WOR_B",    "WOR_W",   "WOR_DW",   "WXOR_B",    "WXOR_W",    "WXOR_DW",   "INV_B",
        "INV_W",    "INV_DW",   "AD_T_TBL", "LIFO",    "FIFO",     "TBL_FIND",  "ENCO",      "DECO",      "SEG",
        "ATH",      "HTA",      "ITA",      "DTA",     "RTA",      "I_S",       "DI_S",      "R_S",       "S_I",
        "S_DI",     "S_R",      "STR_LEN",  "STR_CPY", "SSTR_CPY", "STR_CAT",   "STR_FIND",  "CHR_FIND",  "ATCH",
        "DTCH",     "CLR_EVNT", "HDEF",     "HSC",     "PLS",      "XMT",       "RCV",       "NETR",      "NETW",
        "GET_ADDR", "SET_ADDR", "TON",      "TONR",    "TOF",      "CTU",       "CTD",       "CTUD",      "FOR",
        "SCR",      "SR",       "RS",       "P",       "N",        "BGN_ITIME", "CAL_ITIME", "READ_RTCX", "SET_RTCX",
        "DIAG_LED"})
    EXPECT_TRUE(find_instruction(box) || !unknown_mnemonic(box).what.empty()) << box;
}

TEST(ForeignMnemonics, TheOperandsOfABoxAreCheckedWithIt) {
  const auto result = check_text(
      "LD SM0.0\nMOV_B VW10, VB0\nADD_I VB1, VW2, VW4\nSHL_W VW6, VW8, VW10\nINC_W VW12, VB14\nADD_I VW0, 5, VW2\n"
      "ADD_I VB0, 5\nMEND\n",
      "x", cpu214(), default_times(cpu214()));
  const std::string text = stl::render(result.diagnostics, result.source, false);
  for (const char* part :
       {"x:2:7: error: IN of MOVB is a byte, VW10 is a word", "x:3:7: error: IN of MOVW is a word, VB1 is a ",
        "x:4:12: error: N of SLW is a byte, VW8 is a word", "x:5:13: error: OUT of MOVW is a word, VB14"})
    EXPECT_NE(text.find(part), std::string::npos) << part << text;
  for (const char* fine : {"x:6:7:", "x:7:7:"}) EXPECT_EQ(text.find(fine), std::string::npos) << fine << text;
}

TEST(UnknownMnemonics, TheOneThatIsNearIsNamedWithItsMeaning) {
  EXPECT_EQ(hint("ATCHH"), "did you mean ATCH (attach interrupt routine INT to event EVNT)?");
  EXPECT_EQ(unknown_mnemonic("ATCHH").what, "");
}

TEST(UnknownMnemonics, OfSeveralThatAreEquallyNearAllAreNamedOrNone) {
  EXPECT_EQ(hint("MOVX"), "did you mean MOVB, MOVW, MOVD or MOVR?");
  EXPECT_EQ(hint("LDB"), "write LDB=, LDB<>, LDB>=, LDB<=, LDB> or LDB<");
  EXPECT_EQ(hint("FROB"), "");  // and not ORB, two letters away
}

}  // namespace
}  // namespace s7200::foreign_mnemonics_test

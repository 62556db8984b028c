// Mnemonics that the S7-200 does not have, written by people who know its German set, its ladder editor or another family of
// controllers, or mistyped.
//
// A hint says what does the same. It never names an instruction that does something else, however alike the letters are.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "interpreter/base/text/nearest.hpp"
#include "interpreter/model/boxes.hpp"
#include "interpreter/model/instruction.hpp"
#include "interpreter/model/smart.hpp"

namespace s7200 {
namespace {

struct ForeignRow {
  std::string_view mnemonic, what, hint;
};

constexpr std::string_view kGerman = "a German mnemonic";
constexpr std::string_view kStep7 = "a mnemonic of STEP 7 for the S7-300 and S7-400";
constexpr std::string_view kIec = "a mnemonic of IEC 61131-3";
constexpr std::string_view kMitsubishi = "a mnemonic of Mitsubishi controllers";
constexpr std::string_view kOmron = "a mnemonic of Omron controllers";
constexpr std::string_view kOther = "a mnemonic of other controllers";
constexpr std::string_view kContact = "a contact of the ladder editor";
constexpr std::string_view kLadderBox = "a box of the ladder editor";
constexpr std::string_view kHeading = "the heading of a network in another language";
constexpr std::string_view kMainHeading = "the heading of the main program in another language";
constexpr std::string_view kSubroutineHeading = "the heading of a subroutine in another form";
constexpr std::string_view kInterruptHeading = "the heading of an interrupt routine in another form";
constexpr std::string_view kSmart = "an instruction of the S7-200 SMART";
constexpr std::string_view kAsCpu226 =
    "a program for the SMART runs here as CPU 226 as far as it goes; what GET and PUT do there, NETR and NETW do on a 226";
constexpr std::string_view kEthernet = "it talks through the SMART's Ethernet port, which no CPU 22x has";
constexpr std::string_view kEnds = "the main program ends with MEND, a subroutine with RET, an interrupt routine with RETI";
constexpr std::string_view kForMoves = "write MOVB, MOVW, MOVD or MOVR, as wide as what it moves";
constexpr std::string_view kCompare = "write a contact that compares, such as LDW>= IN1, IN2";

// clang-format off
constexpr ForeignRow kForeignRows[] = {
    {"NETZWERK", "a German keyword", "write NETWORK"},
    // German mnemonics that differ from the English ones in more than U for A.
    {"ZV",    kGerman,     "write CTU"},
    {"ZVR",   kGerman,     "write CTUD"},
    {"ZR",    kGerman,     "write CTD"},
    {"FLANKE", kGerman,    "write EU for a rising edge, ED for a falling one"},
    {"SPA",   kGerman,     "write JMP"},
    {"SPB",   kGerman,     "write JMP"},

    {"L",     kStep7,      "the S7-200 has no accumulator to load: MOVB, MOVW, MOVD and MOVR move a value, MOVW IN, OUT"},
    {"T",     kStep7,      "the S7-200 moves a value with MOVB, MOVW, MOVD or MOVR: MOVW IN, OUT"},
    {"X",     kStep7,      "the S7-200 has no XOR of bits: write LD and AN, LDN and A, then OLD"},
    {"FP",    kStep7,      "write EU after the contact"},
    {"FN",    kStep7,      "write ED after the contact"},
    {"SD",    kStep7,      "write TON"},
    {"SE",    kStep7,      "write TON for the German SE; the English SE is an extended pulse, which the S7-200 does not have"},
    {"SS",    kStep7,      "write TON after a bit that EU and S set when it starts; TONR counts only while its input is on"},
    {"SF",    kStep7,      "write TOF"},
    {"SA",    kStep7,      "write TOF"},
    {"SPBN",  kStep7,      "write NOT, then JMP"},
    {"JU",    kStep7,      "write JMP after LD SM0.0"},
    {"JC",    kStep7,      "write JMP, which needs power flow"},
    {"JCN",   kStep7,      "write NOT, then JMP"},
    {"CC",    kStep7,      "write CALL, which needs power flow"},
    {"UC",    kStep7,      "write CALL after LD SM0.0"},
    {"BEB",   kStep7,      "write CRET in a subroutine, CRETI in an interrupt routine, END in the main program"},
    {"BEC",   kStep7,      "write CRET in a subroutine, CRETI in an interrupt routine, END in the main program"},
    {"BE",    kStep7,      kEnds},
    {"BEA",   kStep7,      kEnds},
    {"BEU",   kStep7,      kEnds},
    {"CLR",   kStep7,      "write LDN SM0.0"},

    {"NEG",   kOther,      "the S7-200 has no negation: write INVW OUT, then INCW OUT; INVD and INCD for a double word"},
    {"GET",   kSmart,      kAsCpu226},
    {"PUT",   kSmart,      kAsCpu226},
    {"GIP",   kSmart,      kAsCpu226},
    {"SIP",   kSmart,      kAsCpu226},

    {"TCON",  kSmart,      kEthernet},
    {"TSEND", kSmart,      kEthernet},
    {"TRECV", kSmart,      kEthernet},
    {"TDCON", kSmart,      kEthernet},

    {"LDNOT",  kOther,     "write LDN"},
    {"ANOT",   kOther,     "write AN"},
    {"ANDNOT", kOther,     "write AN"},
    {"ONOT",   kOther,     "write ON"},
    {"ORNOT",  kOther,     "write ON"},
    {"OUTNOT", kOther,     "write NOT, then ="},
    {"NOTB",   kOther,     "write INVB OUT"},
    {"NOTW",   kOther,     "write INVW OUT"},
    {"NOTD",   kOther,     "write INVD OUT"},
    {"AND",   kOther,      "write A"},
    {"ANDN",  kIec,        "write AN"},
    {"ANDI",  kOther,      "write AN for a closed contact, AI to read an input at once"},
    {"OR",    kOther,      "write O"},
    {"ORN",   kIec,        "write ON"},
    {"ORI",   kMitsubishi, "write ON for a closed contact, OI to read an input at once"},
    {"XOR",   kOther,      "the S7-200 has no XOR of bits: write LD and AN, LDN and A, then OLD; of bytes and words XORB, XORW, XORD"},
    {"ST",    kIec,        "write = for a bit, MOVB, MOVW, MOVD or MOVR for a value"},
    {"STN",   kIec,        "write NOT, then ="},
    {"JMPC",  kIec,        "write JMP, which needs power flow"},
    {"JMPCN", kIec,        "write NOT, then JMP"},
    {"CAL",   kIec,        "write CALL"},
    {"CALC",  kIec,        "write CALL, which needs power flow"},
    {"RETC",  kIec,        "write CRET"},
    {"ADD",   kOther,      "write +I, +D or +R; it adds to its second operand"},
    {"SUB",   kOther,      "write -I, -D or -R; it subtracts from its second operand"},
    {"EQ",    kIec,        kCompare},
    {"NE",    kIec,        kCompare},
    {"GE",    kIec,        kCompare},
    {"GT",    kIec,        kCompare},
    {"LE",    kIec,        kCompare},
    {"LT",    kIec,        kCompare},

    {"OUT",   kOther,      "write ="},
    {"SET",   kOther,      "write S BIT, 1"},
    {"RST",   kOther,      "write R BIT, 1"},
    {"RESET", kOther,      "write R BIT, 1"},
    {"RETURN", kOther,     "write CRET in a subroutine, CRETI in an interrupt routine; RET and RETI end them"},
    {"HALT",  kOther,      "write STOP"},
    {"SHL",   kOther,      "write SLB, SLW or SLD OUT, N, as wide as OUT"},
    {"SHR",   kOther,      "write SRB, SRW or SRD OUT, N, as wide as OUT"},
    {"ROL",   kOther,      "write RLB, RLW or RLD OUT, N, as wide as OUT"},
    {"ROR",   kOther,      "write RRB, RRW or RRD OUT, N, as wide as OUT"},
    {"INV",   kMitsubishi, "write NOT"},
    {"ANB",   kMitsubishi, "write ALD"},
    {"MPS",   kMitsubishi, "write LPS"},
    {"MRD",   kMitsubishi, "write LRD"},
    {"MPP",   kMitsubishi, "write LPP"},
    {"LDP",   kMitsubishi, "write LD, then EU"},
    {"LDF",   kMitsubishi, "write LD, then ED"},
    {"ANDP",  kMitsubishi, "write LD, EU, then ALD"},
    {"ANDF",  kMitsubishi, "write LD, ED, then ALD"},
    {"ORP",   kMitsubishi, "write LD, EU, then OLD"},
    {"ORF",   kMitsubishi, "write LD, ED, then OLD"},
    {"PLF",   kMitsubishi, "write ED, then ="},
    {"TMR",   kOther,      "write TON"},
    {"TIM",   kOmron,      "write TON; TIM counts steps of 100 ms: keep the preset with a timer of 100 ms, or multiply it by 10 with one of 10 ms"},
    {"DIFU",  kOmron,      "write EU, then ="},
    {"DIFD",  kOmron,      "write ED, then ="},
    {"KEEP",  kOmron,      "write S BIT, 1 for its set input, then R BIT, 1 for its reset input: the last has priority"},
    {"MEP",   kMitsubishi, "write EU"},
    {"MEF",   kMitsubishi, "write ED"},
    {"CJ",    kMitsubishi, "write JMP"},
    {"FEND",  kMitsubishi, "write MEND"},
    {"SRET",  kMitsubishi, "write RET"},
    {"IRET",  kMitsubishi, "write RETI"},
    {"MOV",   kOther,      kForMoves},
    {"MOVE",  kOther,      kForMoves},
    {"DMOV",  kMitsubishi, "write MOVD"},
    {"BMOV",  kMitsubishi, "write BMW IN, OUT, N"},
    {"FMOV",  kMitsubishi, "write FILL IN, OUT, N"},
    {"CMP",   kMitsubishi, kCompare},
    {"INC",   kOther,      "write INCB, INCW or INCD, as wide as its operand"},
    {"DEC",   kOther,      "write DECB, DECW or DECD, as wide as its operand"},

    {"P",        kContact, "write EU after the contacts before it"},
    {"N",        kContact, "write ED after the contacts before it"},
    {"CMP_B",    kLadderBox, "write LDB, AB or OB with =, <>, >=, <=, > or <: LDB>= IN1, IN2"},
    {"CMP_I",    kLadderBox, "write LDW, AW or OW with =, <>, >=, <=, > or <: LDW>= IN1, IN2"},
    {"CMP_DI",   kLadderBox, "write LDD, AD or OD with =, <>, >=, <=, > or <: LDD>= IN1, IN2"},
    {"CMP_R",    kLadderBox, "write LDR, AR or OR with =, <>, >=, <=, > or <: LDR>= IN1, IN2"},
    {"HAUPTPROGRAMM",     kMainHeading,       "write MAIN, or nothing: a listing begins with the main program"},
    {"UNTERPROGRAMM",     kSubroutineHeading, "write SBR_0 for subroutine 0"},
    {"SUBRUTINA",         kSubroutineHeading, "write SBR_0 for subroutine 0"},
    {"SUBROUTINE",        kSubroutineHeading, "write SBR_0 for subroutine 0"},
    {"SOTTOPROGRAMMA",    kSubroutineHeading, "write SBR_0 for subroutine 0"},
    {"INTERRUPTPROGRAMM", kInterruptHeading,  "write INT_0 for interrupt routine 0"},
    {"INTERRUPTROUTINE",  kInterruptHeading,  "write INT_0 for interrupt routine 0"},
    {"CU",    kStep7,      "write CTU, with its count and its reset loaded before it"},
    {"ADDI",  kOther,      "write +I IN1, OUT: it adds IN1 to OUT"},
    {"SUBI",  kOther,      "write -I IN1, OUT: it takes IN1 from OUT"},
    {"MULI",  kOther,      "write *I IN1, OUT: it multiplies OUT by IN1"},
    {"DIVI",  kOther,      "write /I IN1, OUT: it divides OUT by IN1"},
    {"NETWERK",  kHeading, "write NETWORK"},
    {"REDE",     kHeading, "write NETWORK"},
    {"RESEAU",   kHeading, "write NETWORK"},
    {"SEGMENTO", kHeading, "write NETWORK"},
    {"RETE",     kHeading, "write NETWORK"},
    {"RED",      kHeading, "write NETWORK"},
    {"SR",       kLadderBox, "write R BIT, 1 for its reset input, then S BIT, 1 for its set input: the last has priority"},
    {"RS",       kLadderBox, "write S BIT, 1 for its set input, then R BIT, 1 for its reset input: the last has priority"},
    {"CLR_EVNT", kLadderBox, "its instruction, CEVNT, is not modelled"},
    {"TBL_FIND", kLadderBox, "write FND=, FND<>, FND< or FND> SRC, PATRN, INDX, as its CMD is 1, 2, 3 or 4"},
};

/// A mnemonic that others use with another number of operands.
struct OtherUse {
  std::string_view mnemonic;
  std::size_t operands;
  std::string_view what, hint;
};

constexpr OtherUse kOtherUses[] = {
    {"ORB", 0, kMitsubishi, "write OLD"},
    {"S",   1, kStep7,      "write S BIT, 1"},
    {"R",   1, kStep7,      "write R BIT, 1"},
};

/// A box whose name is not the mnemonic of its instruction.
struct Box {
  std::string_view name, mnemonic;
  /// Moves its first input to OUT before, for an instruction that works on OUT itself; empty if that has inputs of its own.
  std::string_view move{};
};

constexpr Box kForeignBoxes[] = {
    {"ADD_I",     "+I",   "MOVW"}, {"ADD_DI",    "+D",   "MOVD"}, {"ADD_R",     "+R",   "MOVR"},
    {"SUB_I",     "-I",   "MOVW"}, {"SUB_DI",    "-D",   "MOVD"}, {"SUB_R",     "-R",   "MOVR"},
    {"MUL_I",     "*I",   "MOVW"}, {"MUL_DI",    "*D",   "MOVD"}, {"MUL_R",     "*R",   "MOVR"},
    {"DIV_I",     "/I",   "MOVW"}, {"DIV_DI",    "/D",   "MOVD"}, {"DIV_R",     "/R",   "MOVR"},
    {"INC_B",     "INCB", "MOVB"}, {"INC_W",     "INCW", "MOVW"}, {"INC_DW",    "INCD", "MOVD"},
    {"DEC_B",     "DECB", "MOVB"}, {"DEC_W",     "DECW", "MOVW"}, {"DEC_DW",    "DECD", "MOVD"},
    {"WAND_B",    "ANDB", "MOVB"}, {"WAND_W",    "ANDW", "MOVW"}, {"WAND_DW",   "ANDD", "MOVD"},
    {"WOR_B",     "ORB",  "MOVB"}, {"WOR_W",     "ORW",  "MOVW"}, {"WOR_DW",    "ORD",  "MOVD"},
    {"WXOR_B",    "XORB", "MOVB"}, {"WXOR_W",    "XORW", "MOVW"}, {"WXOR_DW",   "XORD", "MOVD"},
    {"INV_B",     "INVB", "MOVB"}, {"INV_W",     "INVW", "MOVW"}, {"INV_DW",    "INVD", "MOVD"},
    {"SHL_B",     "SLB",  "MOVB"}, {"SHL_W",     "SLW",  "MOVW"}, {"SHL_DW",    "SLD",  "MOVD"},
    {"SHR_B",     "SRB",  "MOVB"}, {"SHR_W",     "SRW",  "MOVW"}, {"SHR_DW",    "SRD",  "MOVD"},
    {"ROL_B",     "RLB",  "MOVB"}, {"ROL_W",     "RLW",  "MOVW"}, {"ROL_DW",    "RLD",  "MOVD"},
    {"ROR_B",     "RRB",  "MOVB"}, {"ROR_W",     "RRW",  "MOVW"}, {"ROR_DW",    "RRD",  "MOVD"},
    {"BCD_I",     "BCDI", "MOVW"}, {"I_BCD",     "IBCD", "MOVW"},

    {"MOV_B",     "MOVB"},  {"MOV_W",     "MOVW"},  {"MOV_DW",    "MOVD"},  {"MOV_R",     "MOVR"},
    {"BLKMOV_B",  "BMB"},   {"BLKMOV_W",  "BMW"},   {"BLKMOV_D",  "BMD"},   {"BLKMOV_DW", "BMD"},
    {"MOV_BIR",   "BIR"},   {"MOV_BIW",   "BIW"},   {"FILL_N",    "FILL"},
    {"B_I",       "BTI"},   {"I_B",       "ITB"},   {"I_DI",      "ITD"},   {"DI_I",      "DTI"},   {"DI_R",      "DTR"},
    {"I_S",       "ITS"},   {"DI_S",      "DTS"},   {"R_S",       "RTS"},   {"S_I",       "STI"},   {"S_DI",      "STD"},
    {"S_R",       "STR"},
    {"STR_LEN",   "SLEN"},  {"STR_CPY",   "SCPY"},  {"SSTR_CPY",  "SSCPY"}, {"STR_CAT",   "SCAT"},  {"STR_FIND",  "SFND"},
    {"CHR_FIND",  "CFND"},  {"AD_T_TBL",  "ATT"},
    {"READ_RTC",  "TODR"},  {"SET_RTC",   "TODW"},  {"READ_RTCX", "TODRX"}, {"SET_RTCX",  "TODWX"},
    {"GET_ADDR",  "GPA"},   {"SET_ADDR",  "SPA"},   {"DIAG_LED",  "DLED"},  {"SCR",       "LSCR"},
    {"BGN_ITIME", "BITIM"}, {"CAL_ITIME", "CITIM"},
};
// clang-format on

/// The instruction that follows MOVW in place of a box: `SRW OUT, N`; the IN1 of an instruction that works on OUT is the IN2
/// of its box.
std::string syntax_after_move(const Instruction& instruction) {
  std::string text = syntax(instruction);
  if (const std::size_t in1 = text.find("IN1"); in1 != std::string::npos) text.replace(in1, 3, "IN2");
  return text;
}

/// A hint such as `write MOVW IN1, OUT, then +I IN2, OUT; OUT must not be IN2`.
std::string hint_for(const Box& box) {
  const Instruction& instruction = *find_instruction(box.mnemonic);
  if (box.move.empty())
    return std::string("write ").append(instruction.modelled() ? syntax(instruction) : std::string(box.mnemonic));
  const std::string after = syntax_after_move(instruction);
  const bool two_inputs = after.find("IN2") != std::string::npos;
  const std::string hint =
      std::string("write ").append(box.move).append(two_inputs ? " IN1" : " IN").append(", OUT, then ") + after;
  const std::string_view other = two_inputs ? "IN2" : instruction.rules().size() > 1 ? "N" : "";
  return other.empty() ? hint : hint + "; OUT must not be " + std::string(other);
}

/// A mnemonic of the German set, of the ladder editor or of another controller family.
std::optional<UnknownMnemonic> foreign_mnemonic(std::string_view mnemonic) {
  if (const auto* row = std::ranges::find(kForeignRows, mnemonic, &ForeignRow::mnemonic); row != std::end(kForeignRows))
    return UnknownMnemonic{std::string(row->what), std::string(row->hint)};
  if (const auto* box = std::ranges::find(kForeignBoxes, mnemonic, &Box::name); box != std::end(kForeignBoxes))
    return UnknownMnemonic{std::string(kLadderBox), hint_for(*box)};
  const Instruction* meant = find_german_instruction(mnemonic);
  if (!meant) return {};
  return UnknownMnemonic{std::string(kGerman), std::string("write ").append(meant->mnemonic)};
}

/// The mnemonics that were perhaps meant. One letter more or less is another instruction in most of them, so only a long one
/// may have two changes.
std::vector<std::string_view> nearest_mnemonics(std::string_view mnemonic) {
  static const std::vector<std::string_view> kMnemonics = [] {
    std::vector<std::string_view> mnemonics;
    for (const Instruction& instruction : all_instructions()) mnemonics.push_back(instruction.mnemonic);
    return mnemonics;
  }();
  constexpr std::size_t kLong = 6;
  return all_nearest(mnemonic, kMnemonics, mnemonic.size() < kLong ? 1 : 2);
}

/// `LDS= or LDS<>`, `LDB=, LDB<>, LDB>=, LDB<=, LDB> or LDB<`
template <class Names>
std::string alternatives(const Names& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text.append(i == 0 ? "" : i + 1 == names.size() ? " or " : ", ").append(names[i]);
  return text;
}

/// The question `did you mean MOVW (IN to OUT)?`, with the operands, so that nobody takes another instruction for the
/// intended one; of several, all are named, since any of them can be meant.
std::string question_about(const std::vector<std::string_view>& mnemonics) {
  constexpr std::size_t kMost = 4;
  if (mnemonics.empty() || mnemonics.size() > kMost) return {};
  std::string question = "did you mean " + alternatives(mnemonics);
  if (mnemonics.size() == 1) question.append(" (").append(find_instruction(mnemonics.front())->meaning).append(")");
  return question + "?";
}

}  // namespace

const Instruction* find_german_instruction(std::string_view mnemonic) {
  if (!mnemonic.starts_with('U')) return nullptr;
  const Instruction* meant = find_instruction(std::string("A").append(mnemonic.substr(1)));
  return meant && !meant->rung.needs_power_flow && meant->modelled() ? meant : nullptr;  // but not ATCH, ATH, ATT
}

/// A box has its inputs first and OUT last. An instruction that works on OUT itself has it after an input, as +I IN1, OUT,
/// or before it, as SLB OUT, N.
std::vector<BoxStep> steps_of_box(std::string_view name, std::size_t operands) {
  const auto* const box = std::ranges::find(kForeignBoxes, name, &Box::name);
  if (box == std::end(kForeignBoxes)) return {};
  const Instruction& instruction = *find_instruction(box->mnemonic);
  if (!instruction.modelled()) return {};
  const std::size_t taken = instruction.rules().size() + (box->move.empty() ? 0 : 1);
  if (operands != taken) return {};
  std::vector<BoxStep> steps;
  if (!box->move.empty()) steps.push_back({find_instruction(box->move), {0, operands - 1}});
  std::size_t input = box->move.empty() ? 0 : 1;
  BoxStep last{&instruction};
  for (const OperandRule& rule : instruction.rules())
    last.operands.push_back(box->move.empty() || rule.role == Role::In ? input++ : operands - 1);
  steps.push_back(std::move(last));
  return steps;
}

std::vector<BoxStep> steps_with_output(const Instruction& instruction, std::size_t operands) {
  const auto* const box = std::ranges::find_if(
      kForeignBoxes, [&](const Box& each) { return each.mnemonic == instruction.mnemonic && !each.move.empty(); });
  if (box != std::end(kForeignBoxes)) return steps_of_box(box->name, operands);
  const bool to_low_word = instruction.mnemonic == "MUL" || instruction.mnemonic == "DIV";
  if (!to_low_word || operands != instruction.rules().size() + 1) return {};
  return {{find_instruction("MOVW"), {0, 2}}, {&instruction, {1, 2}}};
}

UnknownMnemonic other_use(std::string_view mnemonic, std::size_t operands) {
  const auto* const use = std::ranges::find_if(
      kOtherUses, [&](const OtherUse& each) { return each.mnemonic == mnemonic && each.operands == operands; });
  if (use == std::end(kOtherUses)) return {};
  return {std::string(use->what), std::string(use->hint)};
}

bool is_instruction_of_smart(std::string_view mnemonic) {
  const auto* const row = std::ranges::find(kForeignRows, mnemonic, &ForeignRow::mnemonic);
  return row != std::end(kForeignRows) && row->what == kSmart;
}

namespace {

struct RelationWord {
  std::string_view word, relation;
};
constexpr RelationWord kRelationWords[] = {{"EQ", "="}, {"NE", "<>"}, {"GE", ">="}, {"LE", "<="}, {"GT", ">"}, {"LT", "<"}};

/// `LDB`, `LDWGT`: a comparison without its relation, or with a word for it.
std::optional<UnknownMnemonic> comparison_without_sign(std::string_view mnemonic) {
  for (const std::string_view contact : {"LD", "A", "O"}) {
    if (!mnemonic.starts_with(contact) || mnemonic.size() == contact.size()) continue;
    const std::string_view base = mnemonic.substr(0, contact.size() + 1), after = mnemonic.substr(base.size());
    std::vector<std::string> all;  // of strings there are two
    for (const RelationWord& each : kRelationWords)
      if (find_instruction(fmt::format("{}{}", base, each.relation)))
        all.push_back(fmt::format("{}{}", base, each.relation));
    if (all.empty()) continue;
    if (after.empty()) return UnknownMnemonic{"a comparison without its relation", "write " + alternatives(all)};
    const auto* const row = std::ranges::find(kRelationWords, after, &RelationWord::word);
    if (row == std::end(kRelationWords)) continue;
    const bool exists = std::ranges::find(all, fmt::format("{}{}", base, row->relation)) != all.end();
    return UnknownMnemonic{"a comparison in another form", exists ? fmt::format("write {}{}", base, row->relation)
                                                                  : fmt::format("write {}", alternatives(all))};
  }
  return std::nullopt;
}

/// `LD>`, `AI<=`: a comparison that does not say how wide it is, or says it as STEP 7 does.
std::optional<UnknownMnemonic> comparison_of_others(std::string_view mnemonic) {
  const std::size_t sign = std::min(mnemonic.find_first_of("<>="), mnemonic.size());
  const std::string_view base = mnemonic.substr(0, sign), relation = mnemonic.substr(sign);
  if (sign == mnemonic.size()) return comparison_without_sign(mnemonic);
  for (const std::string_view contact : {"LD", "A", "O"}) {
    if (base == contact || (base.starts_with(contact) && base.substr(contact.size()) == "A"))
      return UnknownMnemonic{
          "a comparison that does not say what it compares",
          fmt::format("write {0}B{1}, {0}W{1}, {0}D{1} or {0}R{1}, as wide as its operands", contact, relation)};
    if (base.starts_with(contact) && base.substr(contact.size()) == "I")
      return UnknownMnemonic{"a comparison of integers in another form", fmt::format("write {}W{}", contact, relation)};
  }
  return std::nullopt;
}

}  // namespace

std::optional<UnknownMnemonic> mnemonic_of_others(std::string_view mnemonic) {
  auto foreign = foreign_mnemonic(mnemonic);
  return foreign ? std::move(foreign) : comparison_of_others(mnemonic);
}

UnknownMnemonic unknown_mnemonic(std::string_view mnemonic) {
  if (auto other = mnemonic_of_others(mnemonic)) return *std::move(other);
  return {"", question_about(nearest_mnemonics(mnemonic))};
}

}  // namespace s7200

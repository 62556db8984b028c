#include "interpreter/program/loading/dialect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <unordered_map>
#include <vector>

#include "interpreter/base/text/among.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/model/instruction.hpp"

namespace s7200 {
namespace {

enum class Dialect : std::uint8_t { Scl, Il, Melsec, Omron, Step7, Rockwell };
constexpr std::size_t kDialects = 6;

struct DialectText {
  std::string_view what, hint;
};

/// The texts of each Dialect, in its order.
constexpr std::array<DialectText, kDialects> kTexts{{
    {"SCL or ST (structured text)",
     "STL has one instruction in a line: LD I0.0 and = Q0.0 for Q0.0 := I0.0, MOVW VW0, VW2 for VW2 := VW0"},
    {"IL (instruction list) of IEC 61131-3",
     "the STL of the S7-200 has A for AND, O for OR, = for ST, CALL for CAL, and addresses such as I0.0 without a %"},
    {"a program for Mitsubishi MELSEC, or for another make with the same mnemonics",
     "the STL of the S7-200 has = for OUT, AN for ANI, ALD for ANB, I and Q for X and Y, V for D"},
    {"a program for Omron", "the STL of the S7-200 has = for OUT, LDN for LD NOT, TON for TIM, MOVW for MOV(21)"},
    {"STL of STEP 7 for the S7-300 and S7-400",
     "the S7-200 has no accumulators to load with L and T: MOVB, MOVW and MOVD move a value, and TON is a timer"},
    {"a program for Allen-Bradley controllers",
     "the STL of the S7-200 has LD, A and O for XIC, LDN, AN and ON for XIO, = for OTE, S and R for OTL and OTU; I0.0 for "
     "I:0/0"},
}};

/// A line of code in capitals, without its comment and a semicolon at its end.
struct CodeLine {
  std::string text;
  std::vector<std::string> words;  // what blanks and commas separate
  bool semicolon = false;

  std::string_view word(std::size_t i) const { return i < words.size() ? std::string_view(words[i]) : std::string_view{}; }
};

CodeLine code_line(std::string_view line) {
  std::string_view code = stl::trim(line.substr(0, line.find("//")));
  CodeLine result;
  result.semicolon = code.ends_with(';');
  if (result.semicolon) code = stl::trim(code.substr(0, code.size() - 1));
  result.text = stl::upper_case(code);
  std::string_view rest = result.text;
  for (auto word = stl::take_word(rest, stl::kBetweenOperands); !word.empty();
       word = stl::take_word(rest, stl::kBetweenOperands))
    result.words.emplace_back(word);
  return result;
}

bool is_number(std::string_view word) {
  return !word.empty() && stl::is_digit(word.front()) &&
         std::ranges::all_of(word, [](char c) { return stl::is_digit(c) || c == '.'; });
}

// --- what cannot be said in a table of words ---

/// `U E 0.0`, `L MW 10`: a blank within the address.
bool has_blank_in_address(const CodeLine& line) {
  return line.words.size() == 3 && is_number(line.word(2)) &&
         is_among(line.word(0), {"U", "UN", "O", "ON", "X", "XN", "A", "AN", "=", "S", "R", "L", "T", "FP", "FN"}) &&
         is_among(line.word(1), {"E",  "A",  "M",   "I",   "Q",   "L",   "DBX", "DIX", "EB",  "EW", "ED", "AB",
                                 "AW", "AD", "IB",  "IW",  "ID",  "QB",  "QW",  "QD",  "MB",  "MW", "MD", "LB",
                                 "LW", "LD", "PEW", "PAW", "PIW", "PQW", "DBB", "DBW", "DBD", "T",  "Z",  "C"});
}

/// The head of a block of STEP 7: `FUNCTION_BLOCK FB 10`, `DATA_BLOCK DB10`, `FUNCTION FC 1 : VOID`. Micro/WIN has one OB
/// and one data block, and writes `OB1` and `DB1`.
bool has_step7_head(const CodeLine& line) {
  struct Head {
    std::string_view word, block;
  };
  constexpr std::array kHeads{Head{"FUNCTION_BLOCK", "FB"}, Head{"FUNCTION", "FC"}, Head{"DATA_BLOCK", "DB"},
                              Head{"ORGANIZATION_BLOCK", "OB"}, Head{"TYPE", "UDT"}};
  if (is_among(line.word(1), {"OB1", "DB1"})) return false;
  const auto head = std::ranges::find(kHeads, line.word(0), &Head::word);
  if (head == kHeads.end() || !line.word(1).starts_with(head->block)) return false;
  const std::string_view number = line.word(1).substr(head->block.size());
  return is_number(number.empty() ? line.word(2) : number);
}

/// `S5T#2S`, `DB10.DBW0`, `P#M0.0`
bool has_step7_operand(const CodeLine& line) {
  if (line.text.find('#') == std::string::npos && line.text.find(".DB") == std::string::npos) return false;
  return std::ranges::any_of(line.words, [](std::string_view word) {
    const bool data = word.starts_with("DB") && word.size() > 2 && stl::is_digit(word[2]) && word.find(".DB") != word.npos;
    return data || word.starts_with("S5T#") || word.starts_with("S5TIME#") || word.starts_with("P#") ||
           word.starts_with("L#");
  });
}

/// `==I`, `>R`, `<>D`: comparing the accumulators.
bool compares_accumulators(const CodeLine& line) {
  const std::string_view text = line.text;
  const std::size_t sign = std::min(text.find_first_not_of("=<>"), text.size());
  return sign > 0 && is_among(text.substr(0, sign), {"==", "<>", ">", "<", ">=", "<="}) &&
         is_among(text.substr(sign), {"I", "D", "R"});
}

/// `U "Start"`: a rung of the S7-200 begins with LD, one of STEP 7 does not.
bool begins_without_load(const CodeLine& line) { return is_among(line.word(0), {"U", "UN"}) && line.words.size() > 1; }

bool has_quoted_name(const CodeLine& line) { return begins_without_load(line) && line.word(1).starts_with('"'); }

/// `S A0.1`: on the S7-200 a count follows.
bool sets_without_count(const CodeLine& line) { return is_among(line.word(0), {"S", "R"}) && line.words.size() == 2; }

/// `I0.0`, `VW100`, `SMB30`: an address that no other make writes like this.
bool is_own_address(std::string_view word) {
  const auto letters = static_cast<std::size_t>(std::ranges::find_if(word, stl::is_digit) - word.begin());
  const std::string_view area = word.substr(0, letters), number = word.substr(letters);
  if (area.empty() || area.size() > 3 || number.empty()) return false;
  const bool bit = number.size() > 2 && number[number.size() - 2] == '.' && number.back() <= '7';
  if (bit) return is_among(area, {"I", "Q", "V", "M", "SM"}) && is_number(number);
  return is_among(area, {"IB", "IW", "ID", "QB", "QW", "QD", "VB", "VW", "VD", "MB", "MW", "MD", "SMB", "SMW", "SMD"}) &&
         std::ranges::all_of(number, stl::is_digit);
}

bool has_own_address(const CodeLine& line) { return std::any_of(line.words.begin(), line.words.end(), is_own_address); }

/// `X := Y + 1;`, but not a declaration with a value or a parameter of a call.
bool assigns(const CodeLine& line) {
  const std::size_t sign = line.text.find(":=");
  const std::string_view target = std::string_view(line.text).substr(0, std::min(sign, line.text.size()));
  return line.semicolon && sign != std::string::npos && target.find_first_of(":(") == target.npos &&
         std::ranges::count(line.text, '(') == std::ranges::count(line.text, ')');
}

/// `START AT %I0.0 : BOOL;`, of which the % may be left out already.
bool declares_at_address(const CodeLine& line) {
  return line.semicolon && line.word(1) == "AT" && line.text.find(':') != std::string::npos;
}

bool is_condition(const CodeLine& line) {
  return (is_among(line.word(0), {"IF", "ELSIF"}) && line.text.ends_with(" THEN")) ||
         (line.word(0) == "CASE" && line.text.ends_with(" OF")) ||
         (is_among(line.word(0), {"FOR", "WHILE"}) && line.text.ends_with(" DO"));
}

/// `OUT Y0`, `OUT T0 K100`
bool has_melsec_output(const CodeLine& line) {
  const std::string_view operand = line.word(1);
  return line.word(0) == "OUT" && operand.size() > 1 && (operand.front() == 'Y' || line.word(2).starts_with('K')) &&
         stl::is_digit(operand[1]);
}

/// `MOV K5 D0`: a constant or a data register.
bool has_melsec_operands(const CodeLine& line) {
  return line.words.size() > 2 && std::any_of(line.words.begin() + 1, line.words.end(), [](std::string_view word) {
           return (word.starts_with('K') || word.starts_with('D')) && word.size() > 1 && is_number(word.substr(1));
         });
}

/// `M8000`: a special relay.
bool has_special_relay(const CodeLine& line) {
  return std::ranges::any_of(line.words, [](std::string_view word) {
    return word.size() == 5 && word.starts_with("M8") && is_number(word.substr(1));
  });
}

/// `LD CIO 0.00`
bool has_omron_area(const CodeLine& line) { return line.word(1) == "CIO" && line.words.size() == 3; }

/// `LD NOT 0.01`
bool has_not_as_operand(const CodeLine& line) {
  return is_among(line.word(0), {"LD", "AND", "OR", "OUT"}) && line.word(1) == "NOT" && line.words.size() == 3;
}

/// `MOV(21)`, `@MOV`
bool has_function_number(const CodeLine& line) {
  const std::string_view word = line.word(0);
  const std::size_t open = word.find('(');
  return (word.size() > 2 && word.front() == '@' && stl::is_letter(word[1])) ||
         (open != word.npos && open > 1 && word.size() == open + 4 && is_number(word.substr(open + 1, 2)) &&
          word.back() == ')');
}

/// `XIC(Start)OTE(Motor);`, as Logix exports a rung.
bool has_logix_rung(const CodeLine& line) {
  return line.text.find('(') != line.text.npos &&
         std::ranges::any_of(std::array{"XIC(", "XIO(", "OTE(", "OTL(", "OTU("},
                             [&](std::string_view word) { return line.text.find(word) != line.text.npos; });
}

/// `I:1/0`, `B3:0/1`, `N7:10`, `T4:0/DN`: a file of the SLC 500 and its element.
bool has_file_address(const CodeLine& line) {
  return line.text.find(':') != line.text.npos && std::ranges::any_of(line.words, [](std::string_view word) {
           const std::size_t colon = std::min(word.find(':'), word.size());
           const std::string_view file = word.substr(0, colon), element = word.substr(std::min(colon + 1, word.size()));
           return !file.empty() && std::string_view("IOSBTCRNF").find(file.front()) != file.npos &&
                  (file.size() == 1 || is_number(file.substr(1))) && !element.empty() && stl::is_digit(element.front());
         });
}

/// A sign says how surely a line shows a dialect. A text is in a dialect from kEnough on.
struct DialectSign {
  Dialect dialect;
  bool (*shows)(const CodeLine& line);
  int weight;
};

constexpr int kEnough = 4;

constexpr DialectSign kSigns[] = {
    {Dialect::Step7, has_step7_head, 4},
    {Dialect::Step7, has_step7_operand, 2},
    {Dialect::Step7, compares_accumulators, 2},
    {Dialect::Il, declares_at_address, 2},
    {Dialect::Scl, assigns, 4},
    {Dialect::Scl, is_condition, 2},
    {Dialect::Melsec, has_melsec_output, 4},
    {Dialect::Melsec, has_melsec_operands, 1},
    {Dialect::Melsec, has_special_relay, 3},
    {Dialect::Omron, has_omron_area, 3},
    {Dialect::Omron, has_not_as_operand, 3},
    {Dialect::Omron, has_function_number, 2},
    {Dialect::Rockwell, has_logix_rung, 4},
    {Dialect::Rockwell, has_file_address, 1},
};

/// Signs of STEP 7 in a text in which no line begins with LD.
constexpr DialectSign kSignsWithoutLoad[] = {
    {Dialect::Step7, has_blank_in_address, 2},
    {Dialect::Step7, begins_without_load, 1},
    {Dialect::Step7, has_quoted_name, 2},
    {Dialect::Step7, sets_without_count, 2},
};

/// A word that a line begins with, with so many operands; -1: any number of them.
struct FirstWord {
  Dialect dialect;
  std::string_view word;
  int operands, weight;
};

// clang-format off
constexpr FirstWord kFirstWords[] = {
    {Dialect::Step7, "FUNCTION",            -1, 3}, {Dialect::Step7, "FUNCTION_BLOCK",     -1, 3},
    {Dialect::Step7, "END_FUNCTION",        -1, 3}, {Dialect::Step7, "END_FUNCTION_BLOCK", -1, 3},
    {Dialect::Step7, "VERSION",             -1, 3}, {Dialect::Step7, "KNOW_HOW_PROTECT",   -1, 3},
    {Dialect::Step7, "L",                    1, 1}, {Dialect::Step7, "T",                   1, 1},
    {Dialect::Step7, "U(",                  -1, 2}, {Dialect::Step7, "UN(",                -1, 2},
    {Dialect::Step7, "O(",                  -1, 2}, {Dialect::Step7, "ON(",                -1, 2},
    {Dialect::Step7, "A(",                  -1, 2}, {Dialect::Step7, "AN(",                -1, 2},
    {Dialect::Step7, "AUF",                 -1, 2}, {Dialect::Step7, "OPN",                -1, 2},
    {Dialect::Step7, "LAR1",                -1, 2}, {Dialect::Step7, "TAR1",               -1, 2},
    {Dialect::Step7, "BE",                   0, 1}, {Dialect::Step7, "BEA",                 0, 1},
    {Dialect::Step7, "BEB",                  0, 1}, {Dialect::Step7, "BEC",                 0, 1},
    {Dialect::Step7, "BEU",                  0, 1}, {Dialect::Step7, "UC",                 -1, 1},
    {Dialect::Step7, "CC",                  -1, 1}, {Dialect::Step7, "SE",                 -1, 1},
    {Dialect::Step7, "SV",                  -1, 1}, {Dialect::Step7, "SS",                 -1, 1},
    {Dialect::Step7, "FP",                   1, 1}, {Dialect::Step7, "FN",                  1, 1},
    {Dialect::Il,    "PROGRAM",              1, 2}, {Dialect::Il,    "END_PROGRAM",         0, 2},
    {Dialect::Il,    "ST",                   1, 3}, {Dialect::Il,    "STN",                 1, 3},
    {Dialect::Il,    "CAL",                 -1, 2}, {Dialect::Il,    "CALC",               -1, 2},
    {Dialect::Il,    "CALCN",               -1, 2}, {Dialect::Il,    "JMPC",                1, 2},
    {Dialect::Il,    "JMPCN",                1, 2}, {Dialect::Il,    "RETC",                0, 2},
    {Dialect::Il,    "RETCN",                0, 2}, {Dialect::Il,    "ANDN",                1, 1},
    {Dialect::Il,    "ORN",                  1, 1}, {Dialect::Il,    "XORN",                1, 1},
    {Dialect::Il,    "AND",                  1, 1}, {Dialect::Il,    "OR",                  1, 1},
    {Dialect::Il,    "XOR",                  1, 1}, {Dialect::Il,    "ADD",                 1, 1},
    {Dialect::Il,    "SUB",                  1, 1}, {Dialect::Il,    "MUL",                 1, 1},
    {Dialect::Il,    "EQ",                   1, 1}, {Dialect::Il,    "NE",                  1, 1},
    {Dialect::Il,    "GT",                   1, 1}, {Dialect::Il,    "GE",                  1, 1},
    {Dialect::Il,    "LT",                   1, 1}, {Dialect::Il,    "LE",                  1, 1},
    {Dialect::Scl,   "END_IF",               0, 4}, {Dialect::Scl,   "END_FOR",             0, 4},
    {Dialect::Scl,   "END_CASE",             0, 4}, {Dialect::Scl,   "END_WHILE",           0, 4},
    {Dialect::Scl,   "END_REPEAT",           0, 4}, {Dialect::Scl,   "ELSE",                0, 1},
    {Dialect::Melsec, "OUT",                -1, 1}, {Dialect::Melsec, "ANI",                1, 2},
    {Dialect::Melsec, "ORI",                 1, 2}, {Dialect::Melsec, "ANB",                0, 2},
    {Dialect::Melsec, "ORB",                 0, 2}, {Dialect::Melsec, "SET",                1, 1},
    {Dialect::Melsec, "RST",                 1, 1}, {Dialect::Melsec, "MPS",                0, 2},
    {Dialect::Melsec, "MRD",                 0, 2}, {Dialect::Melsec, "MPP",                0, 2},
    {Dialect::Melsec, "LDP",                 1, 2}, {Dialect::Melsec, "LDF",                1, 2},
    {Dialect::Melsec, "ANDP",                1, 2}, {Dialect::Melsec, "ANDF",               1, 2},
    {Dialect::Melsec, "PLF",                 1, 2}, {Dialect::Melsec, "FEND",               0, 3},
    {Dialect::Melsec, "SRET",                0, 2}, {Dialect::Melsec, "IRET",               0, 2},
    {Dialect::Melsec, "MOV",                 2, 1}, {Dialect::Melsec, "DMOV",               2, 2},
    {Dialect::Melsec, "TMR",                 2, 3}, {Dialect::Omron, "ANDNOT",               1, 2},
    {Dialect::Omron, "LDNOT",                1, 2}, {Dialect::Omron, "ORNOT",                1, 2},
    {Dialect::Melsec, "ZRST",                2, 2}, {Dialect::Melsec, "MC",                 2, 2},
    {Dialect::Melsec, "AND",                 1, 1}, {Dialect::Melsec, "OR",                 1, 1},
    {Dialect::Omron, "OUT",                  1, 1}, {Dialect::Omron, "TIM",                 2, 3},
    {Dialect::Omron, "CNT",                  2, 2}, {Dialect::Omron, "KEEP",                1, 2},
    {Dialect::Omron, "DIFU",                 1, 2}, {Dialect::Omron, "DIFD",                1, 2},
    {Dialect::Omron, "AND",                  1, 1}, {Dialect::Omron, "OR",                  1, 1},
    {Dialect::Rockwell, "XIC",              -1, 2}, {Dialect::Rockwell, "XIO",             -1, 2},
    {Dialect::Rockwell, "OTE",              -1, 2}, {Dialect::Rockwell, "OTL",             -1, 2},
    {Dialect::Rockwell, "OTU",              -1, 2}, {Dialect::Rockwell, "BST",             -1, 2},
    {Dialect::Rockwell, "NXB",              -1, 2}, {Dialect::Rockwell, "BND",             -1, 2},
    {Dialect::Rockwell, "SOR",              -1, 2}, {Dialect::Rockwell, "EOR",             -1, 2},
};

// Mnemonics of the S7-200 that other dialects have too.
constexpr std::string_view kShared[] = {"LD",   "LDN",  "LDI", "A",   "AN",   "O",   "ON",  "=",   "S",   "R",   "NOT", "NOP",
                                        "CALL", "JMP",  "LBL", "END", "RET",  "INC", "DEC", "ORB", "FOR", "NEXT", "STOP",
                                        "SLB",  "PLS",  "SI",  "RI",  "SQRT", "SIN", "COS", "TAN", "LN",  "EXP", "PID"};
// clang-format on

/// kFirstWords by their words.
const auto& first_words() {
  static const std::unordered_multimap<std::string_view, const FirstWord*> kRows = [] {
    std::unordered_multimap<std::string_view, const FirstWord*> rows;
    for (const FirstWord& row : kFirstWords) rows.emplace(row.word, &row);
    return rows;
  }();
  return kRows;
}

bool is_own(const CodeLine& line) {
  const Instruction* instruction = find_instruction(line.word(0));
  return instruction && instruction->rules().size() + 1 == line.words.size() &&
         std::ranges::find(kShared, line.word(0)) == std::end(kShared);
}

/// `LD I0.0`: STEP 7 has no LD, so that a text with it is none of STEP 7, whatever blanks its addresses have.
bool is_load(const CodeLine& line) { return is_among(line.word(0), {"LD", "LDN"}) && line.words.size() > 1; }

/// How much speaks for a dialect, by the weights of its signs, and the place of the first.
struct Evidence {
  int weight = 0, strongest = 0;
  stl::Position first{};

  void add(int more, const stl::Position& at) { add({more, more, at}); }
  void add(const Evidence& more) {
    if (weight == 0) first = more.first;
    weight += more.weight;
    strongest = std::max(strongest, more.strongest);
  }
};

class Judge {
 public:
  void see(const CodeLine& line, const stl::Position& at) {
    own_ += is_own(line);
    loads_ = loads_ || is_load(line);
    own_addresses_ += has_own_address(line);
    lines_ += line.words.empty() ? 0 : 1;
    declarations_ += declares_at_address(line);
    for (const DialectSign& sign : kSigns)
      if (sign.shows(line)) count(sign.dialect, sign.weight, at);
    for (const DialectSign& sign : kSignsWithoutLoad)
      if (sign.shows(line)) without_load_.add(sign.weight, at);
    const auto operands = static_cast<int>(line.words.size()) - 1;
    const auto [first, last] = first_words().equal_range(line.word(0));
    for (auto each = first; each != last; ++each)
      if (const FirstWord& row = *each->second; row.operands < 0 || row.operands == operands)
        count(row.dialect, row.weight, at);
  }

  std::optional<stl::Diagnostic> verdict() {
    if (declarations_ == lines_) return std::nullopt;  // a table of symbols
    if (!loads_) of(Dialect::Step7).add(without_load_);
    constexpr int kAgainstOwnAddress = 3;
    for (const Dialect make : {Dialect::Melsec, Dialect::Omron, Dialect::Rockwell})
      of(make).weight -= kAgainstOwnAddress * own_addresses_;
    const auto best = std::ranges::max_element(evidence_, {}, &Evidence::weight);
    constexpr int kAgainstOwn = 3;     // so often as many for another dialect as lines of the S7-200
    constexpr int kMoreThanAWord = 2;  // text has words such as AND and SET, too
    if (best->strongest < kMoreThanAWord || best->weight < kEnough || best->weight <= kAgainstOwn * own_)
      return std::nullopt;
    const DialectText& text = kTexts[static_cast<std::size_t>(best - evidence_.begin())];
    return stl::Diagnostic{stl::Severity::Error, best->first, fmt::format("this is {}, not STL of the S7-200", text.what),
                           std::string(text.hint)};
  }

 private:
  void count(Dialect dialect, int weight, const stl::Position& at) { of(dialect).add(weight, at); }
  Evidence& of(Dialect dialect) { return evidence_[static_cast<std::size_t>(dialect)]; }

  std::array<Evidence, kDialects> evidence_{};
  Evidence without_load_{};  // for STEP 7
  int own_ = 0, own_addresses_ = 0, lines_ = 0, declarations_ = 0;
  bool loads_ = false;
};

/// Text of another product's programming software, and a sign of it.
struct OtherProduct {
  std::string_view sign, what;
  bool in_xml = true;
};
constexpr std::array kOtherProducts{
    OtherProduct{"LOGO!",
                 "it is about LOGO!, not the S7-200; LOGO!Soft Comfort has no STL, so enter its blocks as STL by hand",
                 false},
    OtherProduct{"<SW.Blocks.", "it is a block of TIA Portal for the S7-1200 and S7-1500, not a program of the S7-200"},
    OtherProduct{"S7_Optimized_Access",
                 "it is a block of TIA Portal for the S7-1200 and S7-1500, not a program of the S7-200"},
    OtherProduct{"www.plcopen.org/xml/",
                 "it is PLCopen XML, not STL of the S7-200; export the program as STL from Micro/WIN"},
    OtherProduct{"<RSLogix5000Content", "it is a project for Allen-Bradley controllers, not a program of the S7-200"},
};

/// `B001(On-Delay)`, `B012(AND) :`: a block as LOGO!Soft Comfort prints it.
bool is_logo_block(std::string_view line) {
  const std::size_t digits = line.find_first_not_of("0123456789", 1);
  return line.starts_with('B') && digits == 4 && line[digits] == '(' && line.find(')', digits) != line.npos;
}

/// `:U E 1.0`, `0002 :BE`, `:L KF +10`: a line of STEP 5. `2: = Q0.0` is a numbered one of a listing: in STEP 5 a blank is
/// before the colon and none behind it.
bool is_step5(std::string_view code) {
  const std::size_t digits = std::min(code.find_first_not_of("0123456789"), code.size());
  if (digits > 0 && (digits == code.size() || !stl::is_blank(code[digits]))) return false;
  code = stl::trim(code.substr(digits));
  if (code.size() < 2 || code[0] != ':' || stl::is_blank(code[1])) return false;
  const std::vector<std::string> words = stl::split_words(stl::upper_case(code.substr(1)));
  return !words.empty() &&
         is_among(words[0], {"U", "UN", "O", "ON", "=", "S", "R", "L", "T", "BE", "BEA", "BEB", "SPA", "SPB", "U(", "O("});
}

bool is_program_of_step5(std::string_view text) {
  std::size_t lines = 0;
  while (!text.empty() && lines < 2) lines += is_step5(stl::trim(stl::take_line(text))) ? 1U : 0U;
  return lines > 1;
}

constexpr std::string_view kStep5 =
    "it is a program in STEP 5 for the S5, not STL of the S7-200: A for U, I and Q for E and A, no : before it";

}  // namespace

bool begins_as_step7(std::string_view text) {
  constexpr std::size_t kLongest = 300;
  while (!text.empty()) {
    const CodeLine code = code_line(stl::take_line(text).substr(0, kLongest));
    if (!code.words.empty()) return has_step7_head(code);
  }
  return false;
}

std::optional<stl::Diagnostic> other_dialect(std::string_view text) {
  constexpr std::size_t kLines = 300, kLongest = 300;
  Judge judge;
  std::uint32_t number = 0;
  for (std::size_t seen = 0; !text.empty() && seen < kLines;) {
    const std::string_view line = stl::take_line(text);
    ++number;
    const CodeLine code = code_line(line.substr(0, kLongest));
    if (code.words.empty()) continue;
    ++seen;
    const std::size_t indent = line.find_first_not_of(" \t\f");
    judge.see(code, {number, static_cast<std::uint32_t>(stl::count_characters(line.substr(0, indent)) + 1),
                     static_cast<std::uint32_t>(std::max<std::size_t>(1, stl::count_characters(code.text)))});
  }
  return judge.verdict();
}

std::string_view why_surely_other_product(std::string_view text) {
  if (!stl::trim(text).starts_with("<?xml")) return is_program_of_step5(text) ? kStep5 : std::string_view();
  const auto product = std::ranges::find_if(
      kOtherProducts, [text](const OtherProduct& each) { return each.in_xml && text.find(each.sign) != text.npos; });
  return product == kOtherProducts.end() ? std::string_view() : product->what;
}

std::string_view why_other_product(std::string_view text) {
  std::size_t blocks = 0;
  constexpr std::size_t kSeen = 1 << 16;
  text = text.substr(0, kSeen);
  const auto product =
      std::ranges::find_if(kOtherProducts, [text](const OtherProduct& each) { return text.find(each.sign) != text.npos; });
  if (product != kOtherProducts.end()) return product->what;
  if (is_program_of_step5(text)) return kStep5;
  while (!text.empty()) blocks += is_logo_block(stl::trim(stl::take_line(text))) ? 1U : 0U;
  if (blocks > 1) return kOtherProducts[0].what;
  return {};
}

}  // namespace s7200

#include "interpreter/stl/parser.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/fusion/include/adapt_struct.hpp>
#include <boost/optional.hpp>
#include <boost/range/iterator_range.hpp>
#include <boost/spirit/home/x3.hpp>
#include <boost/spirit/home/x3/support/ast/variant.hpp>
#include <boost/throw_exception.hpp>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <system_error>

#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/block_words.hpp"
#include "interpreter/stl/headings.hpp"
#include "interpreter/stl/text/encoding.hpp"
#include "interpreter/stl/text/german_letters.hpp"
#include "interpreter/stl/text/look_alikes.hpp"
#include "interpreter/stl/text/network_heading.hpp"

#ifdef BOOST_NO_EXCEPTIONS
// Boost calls these instead of throwing; nothing here makes it throw.
void boost::throw_exception(const std::exception&) { std::abort(); }
void boost::throw_exception(const std::exception&, const boost::source_location&) { std::abort(); }
#endif

namespace s7200::stl {
namespace {

namespace x3 = boost::spirit::x3;

using Place = const char*;
using Range = boost::iterator_range<Place>;

std::string_view view(const Range& range) { return {range.begin(), static_cast<std::size_t>(range.size())}; }

// The results of the grammar: the parts of a line as written. Values and their limits are checked afterwards.

enum class Kind : std::uint8_t { Decimal, Hex, Binary, Real, Ascii, UnknownK, Name };

struct RawWord {
  Size limit = Size::None;  // B#, W#, DW# before a constant
  Kind kind{};
  Range text;
};

struct AddressLetters {
  std::string_view area;
  Size size = Size::None;
  bool german = false;
};

struct RawAddress {
  char mark = 0;  // & or *
  AddressLetters letters;
  Range number;
  Range bit;
};

struct RawOperand : x3::variant<RawWord, RawAddress> {
  using base_type::base_type;
  using base_type::operator=;
  Range text;
};

struct RawStatement {
  Range mnemonic;
  std::vector<RawOperand> operands;
};

struct RawLine {
  boost::optional<RawStatement> statement;
  boost::optional<Range> comment;
};

}  // namespace
}  // namespace s7200::stl

BOOST_FUSION_ADAPT_STRUCT(s7200::stl::RawWord, limit, kind, text)
BOOST_FUSION_ADAPT_STRUCT(s7200::stl::RawAddress, mark, letters, number, bit)
BOOST_FUSION_ADAPT_STRUCT(s7200::stl::RawStatement, mnemonic, operands)
BOOST_FUSION_ADAPT_STRUCT(s7200::stl::RawLine, statement, comment)

namespace s7200::stl {
namespace {

/// The first place at which a part that a line must have is missing, and the name of that part. Once it is set, the line is
/// wrong, even if another alternative of the grammar matches.
struct Missing {
  Place where = nullptr;
  std::string part;
};

/// must[part] is a part that must follow what has been read. It is like x3::expect, but notes in Missing what is not there
/// instead of throwing it: WebAssembly has no exceptions.
struct MustDirective {
  template <class Part>
  struct Parser : x3::unary_parser<Part, Parser<Part>> {
    using x3::unary_parser<Part, Parser<Part>>::unary_parser;
    static constexpr bool is_pass_through_unary = true;

    template <class Context, class RuleContext, class Attribute>
    bool parse(Place& first, const Place& last, const Context& context, RuleContext& rule, Attribute& attribute) const {
      if (this->subject.parse(first, last, context, rule, attribute)) return true;
      Missing& missing = x3::get<Missing>(context);
      if (missing.where == nullptr) missing = {first, x3::what(this->subject)};
      return false;
    }
  };

  template <class Part>
  constexpr Parser<typename x3::extension::as_parser<Part>::value_type> operator[](const Part& part) const {
    return {x3::as_parser(part)};
  }
};
constexpr MustDirective must;

/// Reads a text from `at` on by a grammar, and moves `at` to where that ends. Returns false if the text does not match, or
/// if a part that must be there is not; `missing` then names it. x3::with<Missing>(missing)[described] would copy the whole
/// grammar for each text.
template <class Grammar, class Attribute>
bool parse_beginning(Place& at, Place end, const Grammar& described, Attribute& attribute, Missing& missing) {
  return described.parse(at, end, x3::make_context<Missing>(missing), x3::unused, attribute) && missing.where == nullptr;
}

template <class Grammar, class Attribute>
bool parse_beginning(Place& at, Place end, const Grammar& described, Attribute& attribute) {
  Missing missing;
  return parse_beginning(at, end, described, attribute, missing);
}

namespace grammar {

using x3::attr;
using x3::char_;
using x3::lit;
using x3::no_case;
using x3::raw;

// The names of these rules appear in messages: "expected a bit number".
template <typename Id, typename Attribute = x3::unused_type>
constexpr x3::rule<Id, Attribute> named(const char* name) {
  return {name};
}

// The keys of no_case symbols are lower case.
struct AddressTable : x3::symbols<AddressLetters> {
  AddressTable() {
    for (const std::string_view area : {"I", "Q", "V", "M", "SM", "S", "L", "T", "C", "HC", "AC", "AI", "AQ"})
      add_area(area, area, false);
    for (const GermanLetters& letters : kGermanLetters) add_area(letters.german, letters.international, true);
    add_sizes("DB", "V", false);
    for (const auto& [letter, size] : {std::pair('B', Size::Byte), std::pair('W', Size::Word), std::pair('D', Size::Double)})
      add_letters(std::string("AC") + letter, {"AC", size, false});
  }

 private:
  void add_area(std::string_view written, std::string_view area, bool german) {
    const bool analog = area == "AI" || area == "AQ", numbered = area == "T" || area == "C" || area == "HC" || area == "AC";
    add_letters(written, {area, analog ? Size::Word : Size::None, german});
    if (analog) add_letters(std::string(written) + "W", {area, Size::Word, german});
    if (!analog && !numbered) add_sizes(written, area, german);
  }
  void add_sizes(std::string_view written, std::string_view area, bool german) {
    for (const auto& [letter, size] :
         {std::pair('X', Size::Bit), std::pair('B', Size::Byte), std::pair('W', Size::Word), std::pair('D', Size::Double)})
      add_letters(std::string(written) + letter, {area, size, german});
  }
  void add_letters(std::string_view written, AddressLetters letters) {
    std::string key(written);
    for (char& c : key) c = static_cast<char>(c - 'A' + 'a');
    add(key, letters);
  }
};

struct SizePrefixTable : x3::symbols<Size> {
  SizePrefixTable() {
    add("b#", Size::Byte)("byte#", Size::Byte)("w#", Size::Word)("word#", Size::Word);
    add("dw#", Size::Double)("dword#", Size::Double);
  }
};

struct ComparatorTable : x3::symbols<x3::unused_type> {
  ComparatorTable() { add("=")("<>")(">=")("<=")(">")("<"); }
};

struct BlockKeywordTable : x3::symbols<x3::unused_type> {
  BlockKeywordTable() {
    add("organization_block")("end_organization_block")("subroutine_block")("end_subroutine_block");
    add("interrupt_block")("end_interrupt_block")("data_block")("end_data_block")("begin")("title");
    add("var")("var_input")("var_in_out")("var_output")("var_temp")("end_var");
  }
};

const AddressTable address_letters;
const SizePrefixTable size_prefixes;
const ComparatorTable comparator;
const BlockKeywordTable block_keyword;

const auto blanks = x3::omit[*char_(" \t\f")];
const auto letter = char_("A-Za-z");
const auto digit = char_("0-9");  // x3::digit asserts on characters beyond ASCII
const auto sign = char_("+-");
// Names may have letters of any alphabet, but not debris (U+FFFD), a no-break space or East Asian punctuation.
const auto never_in_names = lit("\xEF\xBF\xBD") | lit("\xC2\xA0") | lit("\xE3\x80") | lit("\xEF\xBC");
const auto beyond_ascii = &char_("\x80-\xff") >> !never_in_names >> char_;
const auto word_character = char_("A-Za-z0-9_") | beyond_ascii;
const auto end_of_word = !word_character;
const auto end_of_address = end_of_word >> !lit(':');  // S1:I0.0 is a symbol with its address

const auto end_of_constant = named<struct EndOfConstant>("the end of the constant") = end_of_word >> !char_("#.'\"");
const auto hex_digits = named<struct HexDigits, Range>("hexadecimal digits") =
    raw[char_("0-9A-Fa-f") >> *char_("0-9A-Fa-f_")];
const auto binary_digits = named<struct BinaryDigits, Range>("binary digits") = raw[char_("01") >> *char_("01_")];
const auto ascii_text = named<struct AsciiText, Range>("characters") =
    raw[*((lit('$') >> char_) | (char_ - lit('\'') - lit('$')))];
const auto closing_quote = named<struct ClosingQuote>("a closing quote") = lit('\'');
const auto decimal_digits = named<struct DecimalDigits, Range>("digits") = raw[-sign >> +digit];
const auto exponent = no_case[lit('e')] >> -sign >> +digit;
const auto real_digits = named<struct RealDigits, Range>("digits") =
    raw[-sign >> +digit >> ((lit('.') >> +digit >> -exponent) | exponent)];

const auto limit = no_case[size_prefixes] | attr(Size::None);
const auto hexadecimal = named<struct Hexadecimal, RawWord>("a constant") =
    (limit >> attr(Kind::Hex) >> lit("16#")) >> must[hex_digits] >> must[end_of_constant];
const auto binary = named<struct Binary, RawWord>("a constant") =
    (limit >> attr(Kind::Binary) >> lit("2#")) >> must[binary_digits] >> must[end_of_constant];
const auto real = named<struct Real, RawWord>("a constant") =
    (attr(Size::None) >> attr(Kind::Real) >> real_digits) >> must[end_of_constant];
const auto decimal = named<struct Decimal, RawWord>("a constant") =
    (limit >> attr(Kind::Decimal) >> decimal_digits) >> must[end_of_constant];
const auto ascii = named<struct Ascii, RawWord>("a constant") =
    (limit >> attr(Kind::Ascii) >> lit('\'')) >> must[ascii_text] >> must[closing_quote];

const auto begin_of_constant = char_("0-9'+-") | no_case[size_prefixes];
const auto constant = named<struct Constant, RawWord>("a constant") = &begin_of_constant >>
                                                                      (ascii | hexadecimal | binary | real | decimal);

// S7-Micro/DOS: K4, K-5, KHFF. Other letters after the K are not known.
const auto k_decimal = named<struct KDecimal, RawWord>("a constant") =
    attr(Size::None) >> attr(Kind::Decimal) >> no_case[lit('k')] >> decimal_digits >> end_of_address;
const auto k_hexadecimal = named<struct KHexadecimal, RawWord>("a constant") =
    attr(Size::None) >> attr(Kind::Hex) >> no_case[lit("kh")] >> hex_digits >> end_of_address;
const auto k_unknown = named<struct KUnknown, RawWord>("a constant") =
    attr(Size::None) >> attr(Kind::UnknownK) >> raw[char_("Kk") >> char_("BbWwDd") >> -sign >> +digit] >> end_of_address;
const auto k_constant = named<struct KConstant, RawWord>("a constant") = &char_("Kk") >>
                                                                         (k_decimal | k_hexadecimal | k_unknown);

const auto bit_number = named<struct BitNumber, Range>("a bit number") = raw[+digit];
const auto address = named<struct AddressRule, RawAddress>("an address") = (char_("&*") | attr('\0')) >>
                                                                           no_case[address_letters] >> raw[+digit] >>
                                                                           -(lit('.') >> must[bit_number]) >> end_of_address;

// "Pump 1", Motor_On, #count, and as Micro/WIN prints symbol and address together: "Pump 1":Q0.0, #count:LW2, *#next:*LD4;
// a symbol may stand for a constant, too: Request_Error:4
const auto plain_name = -char_("&*") >> -lit('#') >> (letter | char_('_') | beyond_ascii) >> *word_character;
const auto quoted_name = -char_("&*") >> lit('"') >> *(char_ - lit('"')) >> lit('"');
const auto address_of_name = lit(':') >> plain_name >> -(lit('.') >> +digit);
const auto constant_of_name = lit(':') >> -sign >> digit >> *(word_character | char_("#.+-"));
const auto name = named<struct NameRule, RawWord>("a name") =
    attr(Size::None) >> attr(Kind::Name) >> raw[(quoted_name | plain_name) >> -(constant_of_name | address_of_name)];

struct OperandRule {
  template <typename Context>
  void on_success(const Place& first, const Place& last, RawOperand& operand, const Context&) {
    operand.text = Range(first, last);
  }
};
const auto operand = named<OperandRule, RawOperand>("an operand") = constant | k_constant | address | name;

const auto next_operand = named<struct NextOperand, RawOperand>("an operand") =
    (blanks >> lit(',') >> blanks >> must[operand]) | (x3::omit[+char_(" \t\f")] >> operand);
const auto operands = named<struct Operands, std::vector<RawOperand>>("operands") = operand >> *next_operand;

// =I is a mnemonic of its own, but =I0.0 assigns to I0.0. After a comparator the first operand may follow directly.
const auto mnemonic = named<struct Mnemonic, Range>("a mnemonic") =
    raw[(no_case[lit("=i")] >> end_of_word) | lit('=') | (char_("+*/-") >> +letter >> end_of_word) |
        (letter >> *char_("A-Za-z0-9_") >> -comparator >> !beyond_ascii)];

const auto statement = named<struct StatementRule, RawStatement>("a statement") = mnemonic >> blanks >> -operands;
const auto comment = named<struct Comment, Range>("a comment") = lit("//") >> raw[*char_];
const auto end_of_line = named<struct EndOfLine>("the end of the line") = x3::eoi;
const auto line = named<struct LineRule, RawLine>("a line") = blanks >> -statement >> blanks >> -lit(';') >> blanks >>
                                                              -comment >> must[end_of_line];

const auto further_operands = named<struct FurtherOperands, std::vector<RawOperand>>("operands") = *(blanks >> lit(',') >>
                                                                                                     blanks >> operand) >>
                                                                                                   -(blanks >> lit(','));
const auto block_line = blanks >> raw[no_case[block_keyword]] >> end_of_word;

}  // namespace grammar

/// A statement as it is read: one line, or several without the comments of all but the last, joined by blanks.
struct JoinedLines {
  struct Start {
    std::size_t offset;  // in `text`
    std::uint32_t line;
  };

  std::string_view text;
  std::string comments{};  // of the lines before the last
  std::vector<Start> starts;
};

// Lines and columns of places in a statement. Places are mostly asked for in order, so a line is counted only once.
class Places {
 public:
  explicit Places(const JoinedLines& lines) : lines_(lines), start_(lines.starts.front()), offset_(start_.offset) {}

  Position position(Place place, std::uint32_t length) {
    const auto offset = static_cast<std::size_t>(place - lines_.text.data());
    const auto start = std::prev(std::ranges::upper_bound(lines_.starts, offset, {}, &JoinedLines::Start::offset));
    if (offset < offset_ || start->line != start_.line) {
      start_ = *start;
      offset_ = start_.offset;
      column_ = 1;
    }
    column_ += count_characters(lines_.text.substr(offset_, offset - offset_));
    offset_ = offset;
    return {start_.line, static_cast<std::uint32_t>(column_), length};
  }

 private:
  const JoinedLines& lines_;
  JoinedLines::Start start_;  // of the line that is counted
  std::size_t offset_;        // how far, and to which column
  std::size_t column_ = 1;
};

std::size_t comment_start(std::string_view line) { return std::min(line.find("//"), line.size()); }

/// The first word or sign of a text, for `expected …, found …` and `unexpected …`.
std::string describe(std::string_view rest) {
  if (rest.empty()) return "the end of the line";
  const Character c = first_character(rest);
  const auto code = static_cast<std::uint32_t>(c.code);
  if (c.code == kReplacement) return "unreadable character U+FFFD";
  if (code < 0x20 || code == 0x7F) return fmt::format("control character U+{:04X}", code);
  const std::string_view written = rest.substr(0, c.bytes);
  return code < 0x7F ? fmt::format("'{}'", written) : fmt::format("'{}' (U+{:04X})", written, code);
}

constexpr std::string_view kStepsHint =
    "the preset of a timer is a number of its steps: 100 ms are 10 of a timer of 10 ms, 1 of one of 100 ms";

/// Relations as other languages write them, and as STL does.
struct WrittenRelation {
  std::string_view written, relation;
};
constexpr std::array kWrittenRelations{WrittenRelation{"=>", ">="}, WrittenRelation{"=<", "<="}, WrittenRelation{"==", "="},
                                       WrittenRelation{"!=", "<>"}, WrittenRelation{"><", "<>"}, WrittenRelation{">", ">"},
                                       WrittenRelation{"<", "<"}};

/// LDW, AB, OR and the like: what stands before the relation of a comparison.
bool is_comparison_without_relation(std::string_view mnemonic) {
  std::string word = upper_case(mnemonic);
  if (word.starts_with("LD"))
    word.erase(0, 2);
  else if (word.starts_with('A') || word.starts_with('O'))
    word.erase(0, 1);
  else
    return false;
  constexpr std::array<std::string_view, 5> kTypes{"B", "W", "D", "R", "S"};
  return std::ranges::find(kTypes, word) != kTypes.end();
}

constexpr const char* kNetworkTakes = "NETWORK takes a number and nothing else";
constexpr const char* kTitleOfNetwork = "a title is written as a comment: NETWORK 1 // title";

/// What a heading that cannot be read is of, and how it is written here.
struct HeadingHint {
  std::string_view of, hint;
};

constexpr HeadingHint heading_hint(Block::Kind kind) {
  switch (kind) {
    case Block::Kind::Main:
      return {"the main program", "write MAIN, or nothing: a listing begins with the main program"};
    case Block::Kind::Subroutine:
      return {"a subroutine", "write SBR_0 for subroutine 0"};
    case Block::Kind::Interrupt:
      break;
  }
  return {"an interrupt routine", "write INT_0 for interrupt routine 0"};
}

/// The comments of a new project, as the editor and its printouts show them.
constexpr std::array<std::string_view, 12> kDefaultComments{
    "PROGRAM COMMENTS",   "PROGRAM COMMENT",    "PROGRAM TITLE COMMENTS", "SUBROUTINE COMMENTS",
    "SUBROUTINE COMMENT", "INTERRUPT COMMENTS", "INTERRUPT COMMENT",      "INTERRUPT ROUTINE COMMENTS",
    "POU COMMENTS",       "POU COMMENT",        "PROGRAMMKOMMENTARE",     "PROGRAMMKOMMENTAR"};

bool is_default_comment(std::string_view line) {
  const std::string_view text = trim(line);
  return !text.empty() && std::string_view("PSIpsi").find(text[0]) != std::string_view::npos && text.size() <= 26 &&
         std::ranges::find(kDefaultComments, upper_case(text)) != kDefaultComments.end();
}

/// These also stand before =: instructions without operands in a line with two statements, and the title of a block.
constexpr std::array<std::string_view, 10> kBeforeCoils{"NOT", "EU",  "ED",  "ALD",  "OLD",
                                                        "LPS", "LRD", "LPP", "AENO", "TITLE"};

/// Whether a unit of time follows: `ms` or `s`, as in 100ms.
bool is_time_unit(std::string_view rest) {
  const std::string unit = lower_case(rest.substr(0, rest.find_first_of(" \t,;/")));
  return unit == "ms" || unit == "s";
}

std::string hint_for(const std::string& expected, std::string_view rest) {
  if (!rest.empty()) {
    const char32_t code = first_character(rest).code;
    if (code == kReplacement) return "the text was damaged when it was converted; restore what was here";
    if (code >= 0x80) return "outside comments STL is plain ASCII; a comment begins with //";
  }
  if (expected == "a bit number") return "a bit is written V10.3; a timer or counter is itself a bit, T37 or C5";
  if (expected == "a mnemonic") return "a line is a mnemonic and its operands; a comment begins with //";
  if (expected == "an operand") return "an operand is an address (VB100), a constant (65, 16#FF) or a pointer (*VD100)";
  if (expected == "the end of the constant" && is_time_unit(rest)) return std::string(kStepsHint);
  if (expected == "the end of the constant") return "constants are written 65, 16#FF, 2#1010, 1.5 or 'AB'";
  if (expected == "the end of the line" && (rest.starts_with('<') || rest.starts_with('>') || rest.starts_with("==")))
    return "a comparison is one word: LDW>= VW0, 5, AB= VB0, 1, OD< VD0, VD4";
  if (expected == "the end of the line") return "operands are separated by commas or blanks; a comment begins with //";
  return {};
}

/// Whether words are no statement: neither an instruction in capitals, nor one letter case with an address behind it.
bool reads_like_prose(std::string_view words) {
  const std::string_view first = words.substr(0, words.find_first_of(" \t"));
  if (first.empty() || !std::ranges::all_of(first, is_letter) || std::ranges::all_of(first, is_upper)) return false;
  return std::ranges::any_of(first, is_upper) || std::ranges::none_of(words, is_digit);
}

bool separates_words(char c) { return is_blank(c) || c == ',' || c == ';'; }

/// The word of a line that a place is in, or ends.
std::string_view word_at(std::string_view line, std::size_t place) {
  std::size_t from = place, to = place;
  while (from > 0 && !separates_words(line[from - 1])) --from;
  while (to < line.size() && !separates_words(line[to])) ++to;
  return line.substr(from, to - from);
}

/// The value of the escape `$letter`, or nothing.
/// Not documented, modelled so: $N, the new line, is a line feed as $L is. [Parser.ReadsAsciiConstantsWithEscapes]
std::optional<char> escape(char letter) {
  switch (letter) {
    case '$':
    case '\'':
    case '"':
      return letter;
    case 'L':
    case 'l':
    case 'N':
    case 'n':
      return '\x0A';
    case 'P':
    case 'p':
      return '\x0C';
    case 'R':
    case 'r':
      return '\x0D';
    case 'T':
    case 't':
      return '\x09';
    default:
      return std::nullopt;
  }
}

template <typename Number>
std::optional<Number> number_of(std::string_view digits, int base = 10) {
  Number number{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number, base);
  if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

/// Appends the character that `rest` begins with and returns the length of its notation, 0 if it is not allowed.
/// Not documented, modelled so: letters beyond ASCII have their bytes in Windows-1252, the code page of Western Europe.
/// [Parser.LettersBeyondAsciiHaveTheirBytesInWindows1252]
std::size_t read_ascii(std::string_view rest, std::string& bytes) {
  if (static_cast<unsigned char>(rest.front()) >= 0x80) {
    const std::size_t length = first_character(rest).bytes;
    const auto byte = encode(rest.substr(0, length), "Windows-1252");
    if (byte) bytes += *byte;
    return byte ? length : 0;
  }
  if (rest.front() != '$') {
    if (rest.front() < 0x20 || rest.front() > 0x7E) return 0;
    bytes.push_back(rest.front());
    return 1;
  }
  if (const auto value = number_of<std::uint8_t>(rest.substr(1, 2), 16); value && rest.size() > 2) {
    bytes.push_back(static_cast<char>(*value));
    return 3;
  }
  if (const auto character = escape(rest[1])) {
    bytes.push_back(*character);
    return 2;
  }
  return 0;
}

/// Appends the characters that a text between quotes stands for. Returns the rest from the first that is not allowed on.
std::string_view read_characters(std::string_view text, std::string& bytes) {
  while (!text.empty()) {
    const std::size_t length = read_ascii(text, bytes);
    if (length == 0) break;
    text.remove_prefix(length);
  }
  return text;
}

constexpr const char* kEscapes = "escapes are $$ $' $\" $L $N $P $R $T and $hh with two hexadecimal digits";

std::string_view without_plus(std::string_view digits) {
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  return digits;
}

std::string without_underscores(std::string_view digits) {
  std::string plain(digits);
  std::erase(plain, '_');
  return plain;
}

struct Limits {
  std::int64_t smallest, largest;
  const char* name;
};

Limits limits(Size size) {
  switch (size) {
    case Size::Byte:
      return {-0x80, 0xFF, "a byte"};
    case Size::Word:
      return {-0x8000, 0xFFFF, "a word"};
    default:
      return {-0x80000000LL, 0xFFFFFFFFLL, "32 bits"};
  }
}

const char* size_letter(Size size) {
  switch (size) {
    case Size::Byte:
      return "B";
    case Size::Word:
      return "W";
    case Size::Double:
      return "D";
    default:
      return "";
  }
}

// --- bit numbers after addresses that have none ---

/// The meaning of an address that takes no bit number: `T37 is itself the bit of the timer`. Empty for a byte-addressed area
/// without a size, V10, which needs one.
std::string without_bits(const Address& address) {
  const auto is = [&](std::string_view what) {
    return fmt::format("{}{}{} is {}", address.area, size_letter(address.size), address.number, what);
  };
  if (address.area == "T") return is("itself the bit of the timer");
  if (address.area == "C") return is("itself the bit of the counter");
  if (address.area == "HC") return is("a double word");
  if (address.area == "AC") return is("an accumulator");
  if (address.area == "AI" || address.area == "AQ") return fmt::format("{}W{} is a word", address.area, address.number);
  if (address.size == Size::Byte) return is("a byte");
  if (address.size == Size::Word) return is("a word");
  return address.size == Size::Double ? is("a double word") : "";
}

std::uint32_t bytes_of(Size size) { return size == Size::Double ? 4 : size == Size::Word ? 2 : 1; }

/// The way to write a bit of such an address. The byte at the highest address has the lowest bits.
std::string bit_hint(const Address& address, std::optional<std::uint8_t> bit) {
  if (address.area == "T" || address.area == "C") return fmt::format("write {}{}", address.area, address.number);
  if (address.area == "HC") return fmt::format("bits are of bytes: move it first, MOVD HC{}, VD100", address.number);
  if (address.area == "AC") return fmt::format("bits are of bytes: move it first, MOVB AC{}, VB100", address.number);
  if (address.area == "AQ") return "bits are of bytes: make the word in V memory, and move it with MOVW";
  if (address.area == "AI") return fmt::format("bits are of bytes: move it first, MOVW AIW{}, VW100", address.number);
  const std::uint32_t bytes = bytes_of(address.size);
  if (!bit || *bit >= 8 * bytes) return fmt::format("it has bits 0 to {}", 8 * bytes - 1);
  return fmt::format("its bit {} is {}{}.{}", *bit, address.area, address.number + bytes - 1 - *bit / 8U, *bit % 8);
}

constexpr const char* kOutOfPlace = "block keyword out of place";

/// The names by which a text calls and attaches routines, and the numbers of its headings; gathered when first asked for.
class NamedRoutines {
 public:
  /// `lines` must live as long as this.
  explicit NamedRoutines(const std::vector<std::string>& lines) : lines_(lines) {}

  /// What the first CALL or ATCH of that name takes it for; nothing without one.
  std::optional<Block::Kind> kind_of(std::string_view name) {
    if (!gathered_) gather();
    const auto found = called_.find(upper_case(name));
    return found == called_.end() ? std::nullopt : std::optional(found->second);
  }

  /// The first number for which the text has no heading of a routine. After kind_of().
  std::uint32_t first_free(Block::Kind kind) const {
    std::uint32_t free = 0;
    while (taken_.contains({kind, free})) ++free;
    return free;
  }

 private:
  void gather() {
    gathered_ = true;
    for (const std::string& line : lines_) {
      const std::string code = upper_case(line.substr(0, comment_start(line)));
      const std::vector<std::string> written = split_words(code);
      const bool calls = !written.empty() && written[0] == "CALL", attaches = !written.empty() && written[0] == "ATCH";
      if (written.size() > 1 && (calls || attaches))
        called_.emplace(written[1].substr(0, written[1].find(',')),
                        calls ? Block::Kind::Subroutine : Block::Kind::Interrupt);
      note_heading(code);
    }
  }

  void note_heading(std::string_view code) {
    const std::string_view head = code.substr(0, code.find(':'));
    const std::vector<std::string> written = split_words(head);
    for (const Block::Kind kind : {Block::Kind::Subroutine, Block::Kind::Interrupt})
      if (written.size() == 2 && written[0] == words(kind).head)
        taken_.emplace(kind, number_of<std::uint32_t>(written[1]).value_or(0));
    if (const auto routine = routine_heading(head)) taken_.emplace(routine->kind, routine->number);
  }

  const std::vector<std::string>& lines_;
  bool gathered_ = false;
  std::map<std::string, Block::Kind> called_{};  ///< by name in capitals
  std::set<std::pair<Block::Kind, std::uint32_t>> taken_{};
};

class LineReader {
 public:
  LineReader(const JoinedLines& lines, NamedRoutines& routines, ParseResult& result)
      : lines_(lines),
        text_(lines.text),
        number_(lines.starts.front().line),
        places_(lines),
        routines_(routines),
        result_(result) {}

  /// Returns true inside VAR … END_VAR; the message about VAR covers these lines.
  bool read(bool in_declarations) {
    if (const auto keyword = block_keyword()) return read_block_line(*keyword);
    if (in_declarations) return true;
    if (const auto heading = routine_heading(text_))
      add_heading(*heading, text_);
    else if (const std::size_t colon = heading_before_statement(); colon > 0)
      read_behind_heading(colon);
    else if (is_default_comment(text_))
      result_.source.lines.emplace_back(CommentLine{fmt::format(" {}", trim(text_)), number_});
    else if (const std::string_view name = name_in_heading(text_); name.empty() || !report_called_name(name))
      read_line();
    return false;
  }

  /// Reads the whole text as one operand.
  std::optional<Operand> read_operand() {
    RawOperand raw;
    Place at = begin();
    Missing missing;
    const bool read = parse_beginning(at, end(), grammar::operand, raw, missing);
    if (read && at == end()) return operand_of(raw);
    const bool incomplete = missing.where != nullptr;
    report_unexpected(incomplete ? missing.where : at, incomplete ? missing.part : "the end of the operand");
    return std::nullopt;
  }

 private:
  std::optional<Range> block_keyword() const {
    Range keyword;
    Place at = begin();
    if (!parse_beginning(at, end(), grammar::block_line, keyword)) return std::nullopt;
    return keyword;
  }

  bool read_block_line(const Range& keyword) {
    const std::string name = upper_case(view(keyword));
    report(position(keyword), fmt::format("{} belongs to the head of a block", name),
           "a block is ORGANIZATION_BLOCK, SUBROUTINE_BLOCK or INTERRUPT_BLOCK NAME:NUMBER, then TITLE=, VAR ... END_VAR, "
           "BEGIN "
           "and its networks, then END_ and its keyword",
           kOutOfPlace);
    return name.starts_with("VAR");
  }

  /// The place of the colon in `SBR_0: LD I0.1`; 0 in any other line, as with a title, `INT_0: Stop`.
  std::size_t heading_before_statement() const {
    const std::string_view code = text_.substr(0, comment_start(text_));
    const std::size_t colon = code.find(':');
    if (colon == std::string_view::npos || lines_.starts.size() > 1) return 0;
    const std::string_view after = trim(code.substr(colon + 1)), first = after.substr(0, after.find_first_of(" \t"));
    const bool is_word = std::ranges::any_of(first, is_lower) && std::ranges::any_of(first, is_upper);
    if (is_word || std::ranges::none_of(after, is_digit)) return 0;
    return routine_heading(text_.substr(0, colon)) && trim(text_.substr(0, colon)).find(' ') == std::string_view::npos
               ? colon
               : 0;
  }

  void read_behind_heading(std::size_t colon) {
    add_heading(*routine_heading(text_.substr(0, colon)), text_.substr(0, colon));
    std::string rest(text_);
    std::fill_n(rest.begin(), colon + 1, ' ');
    LineReader({rest, {}, lines_.starts}, routines_, result_).read_line();
  }

  /// The code of `line` is the heading.
  void add_heading(const RoutineName& routine, std::string_view line) {
    const std::size_t slashes = std::min(line.find("//"), line.size());
    const std::string_view code = trim(line.substr(0, slashes));
    const Position at = position(Range(code.data(), code.data() + code.size()));
    const std::string_view head = words(routine.kind).head;
    Statement heading{std::string(head.empty() ? kMainHeading : head), at, {}, {}};
    if (!head.empty()) heading.operands.push_back({Integer{routine.number}, at});
    if (slashes < line.size()) heading.comment = trim_end(line.substr(slashes + 2));
    result_.source.lines.emplace_back(std::move(heading));
  }

  void read_line() {
    RawLine line;
    Place at = begin();
    Missing missing;
    if (!parse_beginning(at, end(), grammar::line, line, missing)) return report_unexpected(missing.where, missing.part);
    const std::string comment =
        lines_.comments + std::string(line.comment ? trim_end(view(*line.comment)) : std::string_view{});
    if (line.statement) {
      add_statement(*line.statement, comment);
    } else if (line.comment) {
      result_.source.lines.emplace_back(CommentLine{comment, number_});
    } else {
      result_.source.lines.emplace_back(BlankLine{number_});
    }
    report_uncounted();
  }

  void add_statement(const RawStatement& raw, const std::string& comment) {
    Statement statement{upper_case(view(raw.mnemonic)), position(raw.mnemonic), {}, comment};
    statement.operands.reserve(raw.operands.size());
    for (const RawOperand& operand : raw.operands) {
      if (auto read = operand_of(operand)) statement.operands.push_back(std::move(*read));
    }
    if (statement.operands.size() < raw.operands.size()) return;
    separate_network_number(statement);
    if (statement.mnemonic == "NETWORK") {
      add_network(statement);
    } else {
      result_.source.lines.emplace_back(std::move(statement));
    }
  }

  /// Separates the number from the word: `NETWORK1`
  static void separate_network_number(Statement& statement) {
    constexpr std::string_view kNetwork = "NETWORK";
    if (!statement.mnemonic.starts_with(kNetwork) || !statement.operands.empty()) return;
    const auto number = number_of<std::uint32_t>(std::string_view(statement.mnemonic).substr(kNetwork.size()));
    if (!number) return;
    statement.operands.push_back({Integer{*number}, statement.position});
    statement.mnemonic = kNetwork;
  }

  void add_network(const Statement& statement) {
    NetworkHead head{0, statement.position, statement.comment};
    if (!statement.operands.empty()) {
      const auto* number = std::get_if<Integer>(&statement.operands.front().value);
      if (statement.operands.size() > 1 || number == nullptr || number->value < 0) {
        if (report_look_alike_number(statement.operands.front()) || report_statement_beside_heading(head.position)) return;
        report(statement.operands.front().position, kNetworkTakes, kTitleOfNetwork);
        return;
      }
      head.number = static_cast<std::uint32_t>(number->value);
    }
    result_.source.lines.emplace_back(std::move(head));
  }

  /// Reports `NETWORK l`. Returns true after a message.
  bool report_look_alike_number(const Operand& operand) {
    const auto* name = std::get_if<Name>(&operand.value);
    const auto meant = name ? look_alike_number(name->text) : std::nullopt;
    if (!meant) return false;
    report(operand.position, fmt::format("{} has {}", shortened(name->text), meant->wrong),
           fmt::format("write {}", meant->meant), kLookAlikes);
    return true;
  }

  std::optional<Operand> operand_of(const RawOperand& raw) {
    const auto* word = boost::get<RawWord>(&raw.get());
    if (word && word->kind == Kind::Name) return named_operand(view(word->text), raw.text);
    auto value = value_of(raw);
    if (!value) return std::nullopt;
    return Operand{std::move(*value), position(raw.text)};
  }

  /// A name; if its address or constant stands beside it, that.
  std::optional<Operand> named_operand(std::string_view text, const Range& range) {
    const std::size_t name_end = text.find(text.find('"') < 2 ? "\":" : ":");
    const std::size_t colon = name_end == std::string_view::npos ? name_end : text.find(':', name_end);
    RawAddress address;
    Place at = text.data() + (colon == std::string_view::npos ? text.size() : colon + 1);
    if (parse_beginning(at, end_of(text), grammar::address, address) && at == end_of(text)) {
      if (address.mark == 0 && (text.front() == '&' || text.front() == '*')) address.mark = text.front();
      auto value = address_value(address, range);
      if (!value) return std::nullopt;
      return Operand{std::move(*value), position(range), std::string(text.substr(0, colon))};
    }
    if (const auto constant = constant_beside(text, colon)) {
      auto value = value_of(*constant);
      if (!value) return std::nullopt;
      return Operand{std::move(*value), position(range), std::string(text.substr(0, colon))};
    }
    return Operand{Name{std::string(text)}, position(range)};
  }

  static std::optional<RawOperand> constant_beside(std::string_view text, std::size_t colon) {
    if (colon == std::string_view::npos) return std::nullopt;
    RawOperand operand;
    Place at = text.data() + colon + 1;
    if (!parse_beginning(at, end_of(text), grammar::operand, operand) || at != end_of(text)) return std::nullopt;
    const auto* word = boost::get<RawWord>(&operand.get());
    return word && word->kind != Kind::Name ? std::optional(operand) : std::nullopt;
  }

  static Place end_of(std::string_view text) { return text.data() + text.size(); }

  std::optional<OperandValue> value_of(const RawOperand& operand) {
    if (const auto* address = boost::get<RawAddress>(&operand.get())) return address_value(*address, operand.text);
    const auto& word = boost::get<RawWord>(operand.get());
    switch (word.kind) {
      case Kind::Decimal:
        return integer_value(word, operand.text, 10, Integer::Form::Decimal);
      case Kind::Hex:
        return integer_value(word, operand.text, 16, Integer::Form::Hex);
      case Kind::Binary:
        return integer_value(word, operand.text, 2, Integer::Form::Binary);
      case Kind::Real:
        return real_value(word, operand.text);
      case Kind::Ascii:
        return ascii_value(word, operand.text);
      case Kind::UnknownK:
        return refuse(operand.text, fmt::format("a constant cannot begin with {}", upper_case(view(word.text).substr(0, 2))),
                      "S7-Micro/DOS constants are K for decimal (K4) and KH for hexadecimal (KHFF)");
      case Kind::Name:
        break;
    }
    return Name{std::string(view(word.text))};
  }

  std::optional<OperandValue> integer_value(const RawWord& word, const Range& text, int base, Integer::Form form) {
    const auto value = number_of<std::int64_t>(without_underscores(without_plus(view(word.text))), base);
    const Limits range = limits(word.limit);
    if (!value || *value < range.smallest || *value > range.largest) {
      return refuse(text, fmt::format("{} does not fit in {}", shown(text), range.name),
                    fmt::format("{} to {}, or 16#{:X} at most", range.smallest, range.largest, range.largest));
    }
    return Integer{*value, form, 0};
  }

  std::optional<OperandValue> real_value(const RawWord& word, const Range& text) {
    const std::string_view digits = without_plus(view(word.text));
    float value = 0;
    const bool fits = read_number(digits, value).ec == std::errc{};
    if (!fits || std::fpclassify(value) == FP_SUBNORMAL) {
      return refuse(text, fmt::format("{} does not fit in a 32-bit real", shown(text)),
                    "a real is 0.0, or 1.175495E-38 to 3.402823E+38 or its negative");
    }
    return Real{value};
  }

  std::optional<OperandValue> ascii_value(const RawWord& word, const Range& text) {
    std::string bytes;
    if (const std::string_view bad = read_characters(view(word.text), bytes); !bad.empty()) {
      return refuse(Range(bad.data(), bad.data() + first_character(bad).bytes),
                    fmt::format("{} is not allowed in an ASCII constant", describe(bad)), kEscapes);
    }
    if (bytes.size() != 1 && bytes.size() != 2 && bytes.size() != 4) {
      return refuse(text, fmt::format("an ASCII constant cannot have {} characters", bytes.size()),
                    "write 1 character for a byte, 2 for a word or 4 for a double word; a string is written \"abc\"");
    }
    Integer integer{0, Integer::Form::Ascii, static_cast<std::uint8_t>(bytes.size())};
    for (const char c : bytes) integer.value = integer.value << 8 | static_cast<unsigned char>(c);
    if (integer.value > limits(word.limit).largest) {
      return refuse(text, fmt::format("{} does not fit in {}", shown(text), limits(word.limit).name), "");
    }
    return integer;
  }

  std::optional<OperandValue> address_value(const RawAddress& raw, const Range& text) {
    const AddressLetters& letters = raw.letters;
    if (letters.german) report_german(raw, text);
    const auto number = number_of<std::uint32_t>(view(raw.number));
    if (!number) return refuse(raw.number, "the number of this address is too large", "");
    Address address{std::string(letters.area), letters.size, *number, 0};
    if (raw.bit.empty()) {
      if (letters.size == Size::Bit)
        return refuse(text, fmt::format("{} has no bit number", shown(text)), "write VX10.3 or V10.3");
    } else {
      const auto bit = number_of<std::uint8_t>(view(raw.bit));
      if (std::string what = without_bits(address); !what.empty())
        return refuse(text, fmt::format("{} has a bit number, but {}", shown(text), what), bit_hint(address, bit));
      if (!bit || *bit > 7) return refuse(raw.bit, "the bits of a byte are 0 to 7", "");
      address.size = Size::Bit;
      address.bit = *bit;
    }
    if (raw.mark == '&') return AddressOf{std::move(address)};
    if (raw.mark == '*') return Indirect{std::move(address)};
    return address;
  }

  /// The address is then read like the international one, so that other mistakes show in the same run.
  void report_german(const RawAddress& raw, const Range& text) {
    const std::string_view mark(&raw.mark, raw.mark == 0 ? 0 : 1);
    const std::string_view rest(raw.number.begin(), static_cast<std::size_t>(text.end() - raw.number.begin()));
    report(position(text), fmt::format("{} is a German address", shown(text)),
           fmt::format("write {}{}{}{}", mark, raw.letters.area, size_letter(raw.letters.size), rest), kGermanAddresses);
  }

  static std::string shown(const Range& text) { return shortened(view(text)); }

  std::nullopt_t refuse(const Range& text, std::string message, std::string hint) {
    report(position(text), std::move(message), std::move(hint));
    return std::nullopt;
  }

  void report_unexpected(Place where, std::string expected) {
    if (report_heading() || report_time(where) || report_semicolon_comment(where) || report_assignment() ||
        report_look_alike(where) || report_foreign_constant(where) || report_comparison() ||
        report_blank_in_address(where) || report_title_of_network(where) || report_label(where) ||
        report_parentheses(where) || report_data_block(where) || report_second_statement(where))
      return;
    const std::string_view rest(where, static_cast<std::size_t>(end() - where));
    const bool at_start = text_.substr(0, text_.size() - rest.size()).find_first_not_of(" \t\f") == std::string_view::npos;
    if (at_start) expected = "a mnemonic";
    const std::string found = describe(rest);
    std::string message = expected == "the end of the line" ? fmt::format("unexpected {}", found)
                                                            : fmt::format("expected {}, found {}", expected, found);
    const bool numbered = at_start && !rest.empty() && is_digit(rest.front());
    report(places_.position(where, 1), std::move(message), hint_for(expected, rest),
           numbered ? "a number at the beginning of the line" : "");
  }

  /// Reports `L2:` and `LBL_1: LD I0.0`. Returns true after a message.
  bool report_label(Place where) {
    const std::string_view line = trim(text_);
    const std::string_view name = line.substr(0, line.find(':'));
    if (where == end() || *where != ':' || name.data() + name.size() != where) return false;
    const std::string_view after = trim(std::string_view(where + 1, static_cast<std::size_t>(end() - where) - 1));
    const std::string_view mnemonic = after.substr(0, after.find_first_of(" \t"));
    if (report_called_name(name)) return true;
    if (name.find_first_of(" \t,=") != name.npos || std::ranges::any_of(mnemonic, is_lower)) return false;
    if (!after.empty() && (std::ranges::none_of(after, is_digit) || std::ranges::none_of(name, is_digit)))
      return false;  // `Example: Transmit`, `LD: I0.0`
    const std::size_t digits = std::min(name.find_last_not_of("0123456789") + 1, name.size());
    const std::string_view number = name.substr(digits).empty() ? "1" : name.substr(digits);
    report(position(Range(name.data(), name.data() + name.size())),
           fmt::format("{}: is a label of another language", shortened(name)),
           fmt::format("write LBL {0} in a line of its own; JMP {0} jumps there", number), "labels of another language");
    return true;
  }

  /// Reports `Init:` in a listing with `CALL Init`. Returns true after a message.
  bool report_called_name(std::string_view name) {
    const auto kind = routines_.kind_of(name);
    if (!kind) return false;
    const bool calls = *kind == Block::Kind::Subroutine;
    const std::uint32_t free = routines_.first_free(*kind);
    report(position(Range(name.data(), name.data() + name.size())),
           fmt::format("{} is the name of {}, which a listing numbers", shortened(name),
                       calls ? "a subroutine" : "an interrupt routine"),
           fmt::format("write {0}_{1} in a line of its own, and {2} {0}_{1}", calls ? "SBR" : "INT", free,
                       calls ? "CALL" : "ATCH"),
           fmt::format("there is no {} {}", calls ? "subroutine" : "interrupt routine", shortened(name)));
    return true;
  }

  /// Reports `CALL Init(I0.0, 5)`. Returns true after a message.
  bool report_parentheses(Place where) {
    const auto words = split_words(text_.substr(0, static_cast<std::size_t>(where - begin())));
    if (where == end() || *where != '(' || words.size() != 2 || upper_case(words[0]) != "CALL") return false;
    report(places_.position(where, 1), "the parameters of a call stand without parentheses",
           fmt::format("write CALL {0}, or CALL {0}, IN, OUT with its parameters", shortened(words[1])));
    return true;
  }

  /// Reports `DB1.DBX10.0`, `DB1.DBW10`. Returns true after a message.
  bool report_data_block(Place where) {
    std::string_view word = word_at(text_, static_cast<std::size_t>(where - begin()));
    word = word.substr(0, word.find_last_not_of(",;") + 1);
    const std::string upper = upper_case(word);
    if (!upper.starts_with("DB1.DB") || upper.size() < 8) return false;
    const std::string meant = "V" + upper.substr(upper[6] == 'X' ? 7 : 6);
    report(
        position(Range(word.data(), word.data() + word.size())),
        fmt::format("{} is an address as other systems have it: the data block of the S7-200 is V memory", shortened(word)),
        fmt::format("write {}", meant), "addresses in a data block");
    read_as_meant(word, meant);
    return true;
  }

  /// Reports `RÉSEAU 1`, `NETZWERK 1: Start`. Returns true after a message. Headings in ASCII with nothing unexpected in
  /// them are unknown mnemonics to the checker.
  bool report_heading() {
    const std::string_view line = trim(text_);
    const auto of_routine = foreign_heading(line);
    const auto [of, hint] = of_routine ? heading_hint(of_routine->kind) : HeadingHint{"a network", "write NETWORK"};
    const std::string_view word = line.substr(0, of_routine ? of_routine->bytes : plain::network_word(line));
    if (word.empty() || same_in_capitals(word, "NETWORK")) return false;
    report(position(Range(word.data(), word.data() + word.size())),
           fmt::format("{} is the heading of {} in another language", word, of), std::string(hint),
           "headings in another language");
    return true;
  }

  /// Reports `NETWORK 1 LD I0.0`. Returns true after a message.
  bool report_statement_beside_heading(const Position& at) {
    const auto words = split_words(text_);
    const bool statement =
        words.size() > 3 && std::ranges::all_of(words[2], is_upper) && std::ranges::any_of(words[3], is_digit);
    if (statement) report(at, several_statements({words[2]}), new_lines_with({words[2]}));
    return statement;
  }

  /// Reports `NETWORK 1 - Start`. Returns true after a message.
  bool report_title_of_network(Place where) {
    const auto words = split_words(text_);
    if (words.size() < 2 || upper_case(words[0]) != "NETWORK") return false;
    const std::string_view number =
        std::string_view(words[1]).substr(0, words[1].size() - (words[1].ends_with(':') ? 1 : 0));
    if (number.empty() || !std::ranges::all_of(number, is_digit)) return false;
    if (report_statement_beside_heading(places_.position(where, 1))) return true;
    if (words.size() == 2 && number.size() == words[1].size()) return false;
    report(places_.position(where, 1), kNetworkTakes,
           words.size() == 2 ? fmt::format("write NETWORK {}", number) : kTitleOfNetwork, "titles of networks");
    return true;
  }

  /// Reports `T#100ms`. Returns true after a message.
  bool report_time(Place where) {
    const std::string_view word = word_at(text_, static_cast<std::size_t>(where - begin()));
    const std::string prefix = upper_case(word.substr(0, word.find('#')));
    const bool is_time =
        prefix.size() < word.size() && (prefix == "T" || prefix == "TIME" || prefix == "S5T" || prefix == "S5TIME");
    if (!is_time) return false;
    report(position(Range(word.data(), word.data() + word.size())), fmt::format("{} is a time", shortened(word)),
           std::string(kStepsHint));
    return true;
  }

  /// Reports `Motor = Q0.0` and `VW2 := VW0`. Returns true after a message.
  bool report_assignment() {
    const std::string_view code = trim(text_.substr(0, comment_start(text_)));
    const std::string_view target = code.substr(0, code.find_first_of(" \t:="));
    const std::string_view rest = trim(code.substr(target.size()));
    const bool compares = code.substr(target.size()).starts_with('=') || rest.starts_with("==") ||
                          rest.find(',') != rest.npos;  // LDB= VB0 1, LDB = VB0, 1
    const bool assigns = rest.starts_with(":=") || (rest.starts_with('=') && !compares);
    if (target.empty() || !assigns || std::ranges::find(kBeforeCoils, upper_case(target)) != kBeforeCoils.end())
      return false;
    report(
        position(Range(code.data(), code.data() + code.size())), fmt::format("{} is an assignment", shortened(code)),
        "write LD and = for a bit, MOVB, MOVW, MOVD or MOVR for a value; the address of a symbol stands in a symbol table");
    return true;
  }

  /// Reports a mistaken letter or digit: `IO.0`, `16#O9`. Returns true after a message.
  bool report_look_alike(Place where) {
    const std::string_view word = word_at(text_, static_cast<std::size_t>(where - begin()));
    const bool first = trim(text_).starts_with(word);
    const auto meant = first ? look_alike_mnemonic(word) : look_alike_operand(word);
    if (!meant) return false;
    report(position(Range(word.data(), word.data() + word.size())), fmt::format("{} has {}", shortened(word), meant->wrong),
           fmt::format("write {}", meant->meant), kLookAlikes);
    read_as_meant(word, meant->meant);
    return true;
  }

  /// Reports `0x10`, `10h`, `$1F`, `#5`. Returns true after a message.
  bool report_foreign_constant(Place where) {
    std::string_view word = word_at(text_, static_cast<std::size_t>(where - begin()));
    word = word.substr(0, word.find_last_not_of(",;") + 1);
    const std::string meant = constant_here(word);
    if (meant.empty()) return false;
    report(position(Range(word.data(), word.data() + word.size())),
           fmt::format("{} is the constant of another language", word), fmt::format("write {}", meant));
    read_as_meant(word, meant);
    return true;
  }

  /// Reports `LDW=> VW0, 5`, `LDW== VW0, 5` and `LDW >= VW0, 5`. Returns true after a message.
  bool report_comparison() {
    const std::string_view line = trim(text_.substr(0, comment_start(text_)));
    const std::size_t letters =
        std::min(static_cast<std::size_t>(std::ranges::find_if_not(line, is_letter) - line.begin()), line.size());
    const std::size_t sign = std::min(line.find_first_not_of(" \t", letters), line.size());
    const std::size_t end = std::min(line.find_first_not_of("<>=!", sign), line.size());
    const std::string_view mnemonic = line.substr(0, letters), written = line.substr(sign, end - sign);
    const auto row = std::ranges::find(kWrittenRelations, written, &WrittenRelation::written);
    const std::string_view relation = row == kWrittenRelations.end() ? written : row->relation;
    const bool known = std::ranges::find(kWrittenRelations, relation, &WrittenRelation::relation) != kWrittenRelations.end();
    const bool as_it_is = sign == letters && relation == written;
    if (!is_comparison_without_relation(mnemonic) || !known || as_it_is || end == line.size()) return false;
    report(position(Range(line.data(), line.data() + end)),
           sign > letters ? "a comparison is one word" : fmt::format("there is no relation {}", written),
           fmt::format("write {}{}", mnemonic, relation));
    return true;
  }

  /// Reports `I0 .1`. Returns true after a message.
  bool report_blank_in_address(Place where) {
    const std::string_view before = std::string_view(begin(), static_cast<std::size_t>(where - begin()));
    const std::string_view address = trim_end(before).substr(trim_end(before).find_last_of(" \t,") + 1);
    const std::string_view bit = std::string_view(where, static_cast<std::size_t>(end() - where)).substr(0, 2);
    if (address.size() == before.size() || address.data() + address.size() == where) return false;
    if (bit.size() < 2 || bit[0] != '.' || !is_digit(bit[1]) || address.empty() || !is_digit(address.back())) return false;
    report(position(Range(address.data(), bit.data() + bit.size())), "there is a blank in this address",
           fmt::format("write {}{}", address, bit));
    return true;
  }

  /// The line with another word, so that its other mistakes show in the same run.
  void read_as_meant(std::string_view word, std::string_view meant) {
    if (lines_.starts.size() > 1) return;
    std::string text(text_);
    text.replace(static_cast<std::size_t>(word.data() - text_.data()), word.size(), meant);
    LineReader({text, {}, lines_.starts}, routines_, result_).read(false);
  }

  /// Reports `LD I0.0 ; start button`. Returns true after a message.
  bool report_semicolon_comment(Place where) {
    const std::string_view code = text_.substr(0, comment_start(text_));
    const std::size_t semicolon = code.substr(0, static_cast<std::size_t>(where - begin())).rfind(';');
    if (semicolon == std::string_view::npos) return false;
    const std::string_view words = trim(code.substr(semicolon + 1));
    if (!reads_like_prose(words)) return false;
    report(position(Range(words.data(), words.data() + words.size())), fmt::format("{} is no instruction", shortened(words)),
           "a comment begins with //, not with ;", "comments after a semicolon");
    return true;
  }

  /// Reports a second statement in a line: `LD I0.0 = Q0.0`, `LD I0.0; A I0.1`, `LD I0.0 AW>= VW0, 5`. Returns true after a
  /// message.
  bool report_second_statement(Place where) {
    Place start = where;
    while (start != begin() && !separates_words(start[-1])) --start;
    const std::string_view before = trim_end(std::string_view(begin(), static_cast<std::size_t>(start - begin())));
    if (before.empty() || !(is_letter(before.back()) || is_digit(before.back()) || separates_words(before.back())))
      return false;
    RawStatement second;
    Place at = start;
    if (!parse_beginning(at, end(), grammar::statement, second)) return false;
    const std::string_view mnemonic = view(second.mnemonic);
    if (before.ends_with(',') && is_letter(mnemonic.front())) return false;  // an operand
    if (std::ranges::any_of(mnemonic, is_digit)) return false;
    if (second.operands.empty() && !(before.ends_with(';') && std::ranges::all_of(mnemonic, is_upper))) return false;
    std::vector<std::string> later = mnemonics_in(before);
    later.push_back(shortened(mnemonic));
    report(position(second.mnemonic), several_statements(later), new_lines_with(later));
    return true;
  }

  /// What may be the mnemonics of further statements in a line: words in capitals between words with digits.
  static std::vector<std::string> mnemonics_in(std::string_view line) {
    constexpr std::size_t kLongest = 5;
    const std::vector<std::string> words = split_words(line);
    const bool commas = line.ends_with(',');  // `LD I0.0, A I0.1, = Q0.0`
    const auto has_digit = [](const std::string& word) { return std::ranges::any_of(word, is_digit); };
    std::vector<std::string> found;
    for (std::size_t i = 2; i + 1 < words.size(); ++i)
      if (words[i].size() <= kLongest && std::ranges::all_of(words[i], [](char c) { return is_upper(c) || c == '='; }) &&
          (commas || !words[i - 1].ends_with(',')) && has_digit(words[i - 1]) && has_digit(words[i + 1]))
        found.push_back(words[i]);
    return found;
  }

  // A line full of wrong operands must not drown the other messages.
  static constexpr std::size_t kMostErrorsOfALine = 10;

  void report(Position where, std::string message, std::string hint, std::string cause = {}) {
    if (++errors_ > kMostErrorsOfALine) return;
    result_.diagnostics.push_back({Severity::Error, where, std::move(message), std::move(hint), std::move(cause)});
  }

  void report_uncounted() {
    if (errors_ <= kMostErrorsOfALine) return;
    const Position where = result_.diagnostics.back().position;
    result_.diagnostics.push_back(
        {Severity::Error, where, fmt::format("{} more errors in this line", errors_ - kMostErrorsOfALine), ""});
  }

  Position position(const Range& range) {
    const auto length = static_cast<std::uint32_t>(count_characters(view(range)));
    return places_.position(range.begin(), length == 0 ? 1 : length);
  }

  Place begin() const { return text_.data(); }
  Place end() const { return text_.data() + text_.size(); }

  const JoinedLines& lines_;
  std::string_view text_;
  std::uint32_t number_;  // of the first line
  Places places_;
  NamedRoutines& routines_;
  ParseResult& result_;
  std::size_t errors_ = 0;
};

// --- statements in several lines ---

std::string_view code_of(std::string_view line) { return trim(line.substr(0, comment_start(line))); }

/// Whether a line surely goes on in the next one: `CALL Scale, VW0,`
bool ends_in_comma(std::string_view line) {
  return line.find(',') != std::string_view::npos && code_of(line).ends_with(',');
}

/// Whether a line can be the rest of a statement: operands with commas between them. After a comma a lone word may be an
/// instruction, unless the statement is a CALL; without one, what comes first in the line must be no word.
bool goes_on(std::string_view line, bool after_comma, bool call) {
  std::string_view code = code_of(line);
  if (code.ends_with(';')) code = trim_end(code.substr(0, code.size() - 1));
  if (code.empty() || routine_heading(code)) return false;
  if (!after_comma && code.starts_with(',')) code = trim(code.substr(1));
  const bool lone_word = std::ranges::all_of(code, is_letter);
  if (after_comma ? lone_word && !call : !call) return false;
  Place at = code.data();
  const Place end = code.data() + code.size();
  RawOperand first;
  std::vector<RawOperand> others;
  if (!parse_beginning(at, end, grammar::operand, first)) return false;
  if (!parse_beginning(at, end, grammar::further_operands, others)) return false;
  const auto* word = boost::get<RawWord>(&first.get());
  const bool plain_word = word && word->kind == Kind::Name && is_letter(view(word->text).front());
  return at == end && (after_comma || !plain_word || code_of(line).starts_with(','));
}

/// The line after the statement that begins in line `first`.
std::size_t after_statement(const std::vector<std::string>& lines, std::size_t first) {
  const bool call = same_in_capitals(trim(lines[first]).substr(0, 5), "CALL ");
  std::size_t after = first + 1;
  while (after < lines.size()) {
    const bool comma = ends_in_comma(lines[after - 1]);
    if (!(comma || call) || !goes_on(lines[after], comma, call)) break;
    ++after;
  }
  return after;
}

/// The lines [first, after); `joined` has the text of several.
JoinedLines join(const std::vector<std::string>& lines, std::size_t first, std::size_t after, std::string& joined) {
  JoinedLines result{lines[first], {}, {{0, static_cast<std::uint32_t>(first + 1)}}};
  if (after == first + 1) return result;
  result.starts.clear();
  for (std::size_t i = first; i < after; ++i) {
    const std::string_view line = lines[i];
    const std::size_t comment = i + 1 == after ? line.size() : comment_start(line);
    result.starts.push_back({joined.size(), static_cast<std::uint32_t>(i + 1)});
    joined.append(line.substr(0, comment)).push_back(' ');
    if (comment < line.size()) result.comments += trim_end(line.substr(comment + 2));
  }
  result.text = joined;
  return result;
}

}  // namespace

ParseResult parse_lines(std::string_view text, std::string name) {
  ParseResult result;
  result.source.name = std::move(name);
  result.source.text = split_lines(text);
  result.source.lines.reserve(result.source.text.size());
  const std::vector<std::string>& lines = result.source.text;
  NamedRoutines routines(lines);
  bool in_declarations = false;
  for (std::size_t first = 0; first < lines.size();) {
    const std::size_t after = after_statement(lines, first);
    std::string joined;
    in_declarations = LineReader(join(lines, first, after, joined), routines, result).read(in_declarations);
    first = after;
  }
  return result;
}

ParseResult parse(std::string_view text, std::string name) {
  ParseResult result = parse_lines(text, std::move(name));
  put_main_program_first(result);
  return result;
}

Result<std::string> parse_characters(std::string_view text) {
  std::string bytes;
  const std::string_view bad = read_characters(text, bytes);
  if (bad.empty()) return bytes;
  return trouble("{} is not allowed in a text; {}", describe(bad), kEscapes);
}

std::string several_statements(const std::vector<std::string>& later) {
  return later.size() == 1 ? "two statements in one line" : fmt::format("{} statements in one line", later.size() + 1);
}

std::string new_lines_with(const std::vector<std::string>& later) {
  const auto last = std::prev(later.end());
  return later.size() == 1 ? "begin a new line with " + *last
                           : fmt::format("begin new lines with {} and {}", fmt::join(later.begin(), last, ", "), *last);
}

Result<Operand> parse_operand(std::string_view text) {
  ParseResult result;
  const JoinedLines line{text, {}, {{0, 1}}};
  NamedRoutines routines(result.source.text);
  auto operand = LineReader(line, routines, result).read_operand();
  std::erase_if(result.diagnostics, [](const Diagnostic& d) { return d.cause == kGermanAddresses; });
  if (!result.diagnostics.empty()) return Trouble{result.diagnostics.front().message};
  if (!operand) return std::nullopt;
  return *std::move(operand);
}

}  // namespace s7200::stl

#include "interpreter/stl/text/plain_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/headings.hpp"
#include "interpreter/stl/text/places.hpp"

namespace s7200::stl {
namespace {

// --- what is changed ---

enum Change : std::uint32_t {
  kBlanks = 1U << 0,
  kFullWidth = 1U << 1,
  kQuotes = 1U << 2,
  kDashes = 1U << 3,
  kSigns = 1U << 4,
  kInvisible = 1U << 5,
  kHtml = 1U << 6,
  kMarkdown = 1U << 7,
  kLineNumbers = 1U << 8,
  kPercent = 1U << 9,
  kMargin = 1U << 10,
  kLineEnds = 1U << 11,
  kQuotedLines = 1U << 12,
  kTable = 1U << 13,
};

constexpr std::array<std::pair<Change, std::string_view>, 14> kChangeNames{{
    {kBlanks, "no-break and other Unicode blanks"},
    {kFullWidth, "full-width signs"},
    {kQuotes, "typographic quotes"},
    {kDashes, "typographic dashes"},
    {kSigns, "typographic signs"},
    {kInvisible, "invisible characters"},
    {kHtml, "HTML"},
    {kMarkdown, "Markdown"},
    {kLineNumbers, "line numbers"},
    {kPercent, "% before addresses"},
    {kMargin, "marks in the margin"},
    {kLineEnds, "line ends of a word processor"},
    {kQuotedLines, "quotes around each line"},
    {kTable, "cells of a table"},
}};

// --- single characters ---

struct Reading {
  std::string_view plain;
  Change change;
};

struct CharacterRange {
  char32_t first, last;
  Reading reading;
};

constexpr CharacterRange kRanges[] = {
    {0x00A0, 0x00A0, {" ", kBlanks}},    {0x1680, 0x1680, {" ", kBlanks}},    {0x2000, 0x200A, {" ", kBlanks}},
    {0x202F, 0x202F, {" ", kBlanks}},    {0x205F, 0x205F, {" ", kBlanks}},    {0x3000, 0x3000, {" ", kBlanks}},
    {0x00AD, 0x00AD, {"", kInvisible}},  {0x200B, 0x200F, {"", kInvisible}},  {0x202A, 0x202E, {"", kInvisible}},
    {0x2060, 0x2069, {"", kInvisible}},  {0xFE00, 0xFE0F, {"", kInvisible}},  {0xFEFF, 0xFEFF, {"", kInvisible}},
    {0x00B4, 0x00B4, {"'", kQuotes}},    {0x2018, 0x201B, {"'", kQuotes}},    {0x2032, 0x2032, {"'", kQuotes}},
    {0x2035, 0x2035, {"'", kQuotes}},    {'`', '`', {"'", kQuotes}},          {0x00AB, 0x00AB, {"\"", kQuotes}},
    {0x00BB, 0x00BB, {"\"", kQuotes}},   {0x201C, 0x201F, {"\"", kQuotes}},   {0x2033, 0x2033, {"\"", kQuotes}},
    {0x2036, 0x2036, {"\"", kQuotes}},   {0x301D, 0x301F, {"\"", kQuotes}},   {0x2010, 0x2015, {"-", kDashes}},
    {0x2212, 0x2212, {"-", kDashes}},    {0xFE58, 0xFE58, {"-", kDashes}},    {0xFE63, 0xFE63, {"-", kDashes}},
    {0x00B7, 0x00B7, {".", kSigns}},     {0x2024, 0x2024, {".", kSigns}},     {0x2219, 0x2219, {".", kSigns}},
    {0x22C5, 0x22C5, {".", kSigns}},     {0x00D7, 0x00D7, {"*", kSigns}},     {0x2217, 0x2217, {"*", kSigns}},
    {0x2044, 0x2044, {"/", kSigns}},     {0x2215, 0x2215, {"/", kSigns}},     {0x266F, 0x266F, {"#", kSigns}},
    {0x2260, 0x2260, {"<>", kSigns}},    {0x2264, 0x2264, {"<=", kSigns}},    {0x2265, 0x2265, {">=", kSigns}},
    {0x3001, 0x3001, {",", kFullWidth}}, {0x3002, 0x3002, {".", kFullWidth}}, {0xFF61, 0xFF61, {".", kFullWidth}},
    {0xFF64, 0xFF64, {",", kFullWidth}}, {0xFE50, 0xFE51, {",", kFullWidth}}, {0xFE52, 0xFE52, {".", kFullWidth}},
    {0xFE54, 0xFE54, {";", kFullWidth}}, {0xFE55, 0xFE55, {":", kFullWidth}}, {0xFE5F, 0xFE5F, {"#", kFullWidth}},
    {0xFE61, 0xFE61, {"*", kFullWidth}}, {0xFE66, 0xFE66, {"=", kFullWidth}},
};

constexpr std::string_view kPrintableAscii =
    "!\"#$%&'()*+,-./0123456789:;<=>?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_`abcdefghijklmnopqrstuvwxyz{|}~";
constexpr char32_t kFirstFullWidth = 0xFF01;

/// The meaning of a character in a program; nothing for a character that stands for itself.
std::optional<Reading> reading_of(char32_t code) {
  if (code >= kFirstFullWidth && code < kFirstFullWidth + kPrintableAscii.size())
    return Reading{kPrintableAscii.substr(code - kFirstFullWidth, 1), kFullWidth};
  if (code < 0x80 && code != '`') return std::nullopt;
  const auto* row =
      std::ranges::find_if(kRanges, [code](const CharacterRange& r) { return r.first <= code && code <= r.last; });
  return row == std::end(kRanges) ? std::nullopt : std::optional(row->reading);
}

/// A quotation mark of any kind as ' or "; 0 for other characters.
char quote_of(char32_t code) {
  if (code == '\'' || code == '"') return static_cast<char>(code);
  const auto reading = reading_of(code);
  return reading && (reading->plain == "'" || reading->plain == "\"") ? reading->plain.front() : '\0';
}

/// VT, as word processors end a line within a paragraph, and those of Unicode.
bool is_line_end(char32_t code) { return code == 0x0B || code == 0x2028 || code == 0x2029; }

// --- HTML ---

// Tags that are copied together with text. A statement has none: LDW<I is not an instruction.
constexpr std::string_view kTags[] = {
    "a",    "article", "b",     "blockquote", "body", "br",      "center", "code", "div",    "em",
    "font", "h1",      "h2",    "h3",         "h4",   "head",    "hr",     "html", "i",      "kbd",
    "li",   "ol",      "p",     "pre",        "samp", "section", "small",  "span", "strong", "sub",
    "sup",  "table",   "tbody", "td",         "th",   "thead",   "tr",     "tt",   "u",      "ul",
};
constexpr std::string_view kTagsOfLines[] = {"br", "p",  "div", "li", "tr", "pre",
                                             "hr", "h1", "h2",  "h3", "h4", "blockquote"};

struct Tag {
  std::string name;  // in small letters
  bool closes = false;
  std::size_t bytes = 0;

  bool breaks_line() const { return std::ranges::find(kTagsOfLines, name) != std::end(kTagsOfLines); }
};

/// The tag at the beginning of a text.
std::optional<Tag> tag_at(std::string_view text) {
  constexpr std::size_t kLongest = 300;
  if (!text.starts_with('<')) return std::nullopt;
  Tag tag;
  std::size_t at = 1;
  if (text.substr(at).starts_with('/')) {
    tag.closes = true;
    ++at;
  }
  while (at < text.size() && (is_letter(text[at]) || (is_digit(text[at]) && !tag.name.empty()))) tag.name += text[at++];
  tag.name = lower_case(tag.name);
  const std::size_t end = text.substr(0, kLongest).find('>', at);
  const bool complete = end != std::string_view::npos && std::ranges::find(kTags, tag.name) != std::end(kTags);
  if (!complete || (end != at && text[at] != ' ' && text[at] != '/')) return std::nullopt;
  tag.bytes = end + 1;
  return tag;
}

struct Entity {
  std::string_view name;
  char32_t code;
};

constexpr Entity kEntities[] = {
    {"amp", '&'},       {"apos", '\''},    {"emsp", 0x2003},   {"ensp", 0x2002},  {"gt", '>'},
    {"ldquo", 0x201C},  {"lsquo", 0x2018}, {"lt", '<'},        {"mdash", 0x2014}, {"minus", 0x2212},
    {"middot", 0x00B7}, {"nbsp", 0x00A0},  {"ndash", 0x2013},  {"quot", '"'},     {"rdquo", 0x201D},
    {"rsquo", 0x2019},  {"shy", 0x00AD},   {"thinsp", 0x2009}, {"times", 0x00D7},
};

struct Written {
  char32_t code = 0;
  std::size_t bytes = 0;
};

/// The character that a text begins with as an entity: `&nbsp;`, `&#160;`, `&#xA0;`.
std::optional<Written> entity_at(std::string_view text) {
  constexpr std::size_t kLongest = 10;
  const std::size_t end = text.substr(0, kLongest).find(';');
  if (!text.starts_with('&') || end == std::string_view::npos) return std::nullopt;
  std::string_view name = text.substr(1, end - 1);
  if (const auto* row = std::ranges::find(kEntities, name, &Entity::name); row != std::end(kEntities))
    return Written{row->code, end + 1};
  if (!name.starts_with('#')) return std::nullopt;
  name.remove_prefix(1);
  const bool hex = name.starts_with('x') || name.starts_with('X');
  if (hex) name.remove_prefix(1);
  std::uint32_t code = 0;
  const auto [stop, trouble] = std::from_chars(name.data(), name.data() + name.size(), code, hex ? 16 : 10);
  const bool known = (code >= 0x20 && code < 0x7F) || reading_of(code);
  if (name.empty() || trouble != std::errc{} || stop != name.data() + name.size() || !known) return std::nullopt;
  return Written{code, end + 1};
}

std::string_view code_of(std::string_view line) { return line.substr(0, line.find("//")); }

/// The place of a tag of this name before any comment of a line.
std::size_t find_tag(std::string_view line, std::string_view name, bool closes) {
  const std::string_view code = closes ? line : code_of(line);
  for (std::size_t at = code.find('<'); at != std::string_view::npos; at = code.find('<', at + 1)) {
    const auto tag = tag_at(line.substr(at));
    if (tag && tag->name == name && tag->closes == closes) return at;
  }
  return std::string_view::npos;
}

/// Whether a comment has several tags that end a line: pages have whole programs in one line.
bool has_lines_in_comment(std::string_view line) {
  int breaks = 0;
  for (std::size_t at = line.find('<', code_of(line).size()); at != line.npos; at = line.find('<', at + 1)) {
    const auto tag = tag_at(line.substr(at));
    breaks += tag && tag->breaks_line() ? 1 : 0;
    if (breaks == 2) return true;
  }
  return false;
}

bool has_html(std::string_view line) {
  const std::string_view code = code_of(line);
  for (std::size_t at = code.find_first_of("<&"); at != std::string_view::npos; at = code.find_first_of("<&", at + 1))
    if (tag_at(line.substr(at)) || entity_at(line.substr(at))) return true;
  return has_lines_in_comment(line);
}

// --- the part of a text that is program ---

/// A part of a line, in bytes.
struct Part {
  std::size_t from = 0, to = 0;

  bool empty() const { return from == to; }
};

/// The part of each line between <pre> and </pre>.
std::vector<Part> between_tags(const std::vector<std::string>& lines) {
  std::vector<Part> parts;
  bool inside = false;
  for (const std::string& line : lines) {
    Part part{0, inside ? line.size() : 0};
    if (const std::size_t begin = inside ? std::string_view::npos : find_tag(line, "pre", false);
        begin != std::string_view::npos) {
      inside = true;
      part = {begin + tag_at(std::string_view(line).substr(begin))->bytes, line.size()};
    }
    if (const std::size_t end = inside ? find_tag(line, "pre", true) : std::string_view::npos;
        end != std::string_view::npos) {
      inside = false;
      part.to = std::max(end, part.from);
    }
    parts.push_back(part);
  }
  return parts;
}

// --- one line ---

constexpr std::string_view kBullets[] = {"•", "▪", "●", "■", "◦", "‣", "·"};

std::size_t bullet_at(std::string_view text) {
  for (const std::string_view bullet : kBullets)
    if (text.starts_with(bullet)) return bullet.size();
  return 0;
}

/// Letters of other alphabets at the beginning: text, or a name of a symbol table. Only its blanks are read otherwise.
bool begins_beyond_ascii(std::string_view line) {
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  line.remove_prefix(bullet_at(line));
  for (const Character c : characters(line)) {
    if (is_blank(static_cast<char>(c.code)) && c.code < 0x80) continue;
    const auto reading = reading_of(c.code);
    if (reading && (reading->change == kBlanks || reading->change == kInvisible)) continue;
    return c.code >= 0x80 && !reading;
  }
  return false;
}

constexpr std::string_view kFences[] = {"```", "~~~"};

/// Pairs of marks that Markdown puts around code or bold text.
constexpr std::string_view kPairs[] = {"`", "**"};

bool begins_with_one_of(std::string_view text, std::span<const std::string_view> beginnings) {
  return std::ranges::any_of(beginnings, [text](std::string_view each) { return text.starts_with(each); });
}

/// Markdown's marks around code, and those of forums: `[code]`, `[code=stl]`, `[/code]`.
bool is_fence(std::string_view line) {
  const std::string_view text = trim(line);
  if (begins_with_one_of(text, kFences)) return true;
  const std::string mark = text.starts_with('[') && text.find(']') == text.size() - 1 ? lower_case(text) : "";
  return mark == "[code]" || mark == "[/code]" || mark.starts_with("[code=");
}

/// Rewrites lines, and keeps for each character of the result the column that it had.
class LineWriter {
 public:
  struct Result {
    std::string text;
    std::vector<std::uint32_t> columns;  // of each character and of the end
    std::uint32_t changes = 0;
  };

  LineWriter(std::string_view line, bool html) : line_(line), html_(html), only_blanks_(begins_beyond_ascii(line)) {}

  /// Leaves out the first bytes of the line.
  void skip(std::size_t bytes, std::uint32_t change) {
    if (bytes == 0) return;
    result_.changes |= change;
    take(bytes);
  }

  std::vector<Result> run(std::size_t to) {
    end_ = to;
    while (at_ < to) next();
    if (results_.empty() || !trim(result_.text).empty())
      end_line();
    else
      results_.back().changes |= result_.changes;
    return std::move(results_);
  }

 private:
  void next() {
    const std::string_view rest = line_.substr(at_);
    if (html_) {
      if (const auto tag = tag_at(rest)) return leave_out(*tag);
      if (const auto entity = entity_at(rest)) {
        result_.changes |= kHtml;
        return write(entity->code, entity->bytes);
      }
    }
    if (in_margin() && leave_out_mark(rest)) return;
    if (at_ == pair_end_ && pair_ != 0) return skip(std::exchange(pair_, 0), kMarkdown);
    const Character c = first_character(rest);
    if (!is_line_end(c.code)) return write(c.code, c.bytes);
    result_.changes |= kLineEnds;
    end_line();
    take(c.bytes);
  }

  /// Whether only line numbers, > and the like have come so far.
  bool in_margin() const {
    constexpr std::string_view kMargins = " \t0123456789.:|,;()[]>-*";
    const std::string_view before = result_.text;
    return before.find_first_not_of(kMargins) == before.npos && (before.empty() || !is_digit(before.back()));
  }

  /// A bullet, the # of a heading, or the first of a pair of marks; a fence stays as it is.
  bool leave_out_mark(std::string_view rest) {
    if (begins_with_one_of(rest, kFences)) {
      const std::size_t end = std::min(rest.find_first_not_of("`~"), rest.size());
      put(rest.substr(0, end));
      take(end);
      return true;
    }
    if (const std::size_t bullet = bullet_at(rest); bullet != 0) return skip(bullet, kMargin), true;
    const std::size_t signs = std::min(rest.find_first_not_of('#'), rest.size());
    if (signs > 0 && signs < rest.size() && is_blank(rest[signs])) return skip(signs, kMarkdown), true;
    for (const std::string_view pair : kPairs)
      if (rest.starts_with(pair) && ends_pair(rest, pair)) return pair_ = pair.size(), skip(pair.size(), kMarkdown), true;
    return false;
  }

  /// Whether there is a second mark of a pair that ends the line, but for tags and a comment; pair_end_ is where it is then.
  bool ends_pair(std::string_view rest, std::string_view pair) {
    rest = rest.substr(0, end_ - at_);
    for (std::size_t second = rest.find(pair, pair.size() + 1); second != rest.npos; second = rest.find(pair, second + 1)) {
      const std::string_view after = trim(rest.substr(second + pair.size()));
      pair_end_ = at_ + second;
      if (after.empty() || after.starts_with("//") || (html_ && after.starts_with('<'))) return true;
      if (is_line_end(first_character(after).code)) return true;
    }
    return false;
  }

  void leave_out(const Tag& tag) {
    result_.changes |= kHtml;
    take(tag.bytes);
    if (tag.name == "td" || tag.name == "th") put(" ");
    if (tag.breaks_line() && !trim(result_.text).empty()) end_line();
  }

  /// A character of the line, whose notation takes some bytes.
  void write(char32_t code, std::size_t bytes) {
    const std::string_view written = line_.substr(at_, bytes);
    const std::string_view after = line_.substr(at_ + bytes);
    const auto reading = comment_ ? std::nullopt : reading_of(code);
    if (comment_ || (quote_ != 0 && quote_of(code) != quote_)) {
      put_itself(code, written);
    } else if (code == '%' && is_letter(after.empty() ? '\0' : after.front()) && !ends_in_word()) {
      result_.changes |= kPercent;
    } else if (!reading || (only_blanks_ && reading->change != kBlanks && reading->change != kInvisible)) {
      put_itself(code, written);
    } else {
      result_.changes |= reading->change;
      put(reading->plain);
    }
    if (!comment_) follow_quotes(code, after);
    take(bytes);
    comment_ = comment_ || (quote_ == 0 && result_.text.ends_with("//"));
  }

  void follow_quotes(char32_t code, std::string_view after) {
    const char quote = quote_of(code);
    if (quote == 0) return;
    if (quote_ == quote) {
      if (!(quote == '\'' && result_.text.ends_with("$'"))) quote_ = 0;
      return;
    }
    if (quote_ != 0) return;
    if (slashes_ <= at_) slashes_ = std::min(line_.find("//", at_), line_.size());
    const auto begin = static_cast<std::size_t>(after.data() - line_.data());
    if (begin < slashes_ && has_quote(line_.substr(begin, slashes_ - begin), quote)) quote_ = quote;
  }

  static bool has_quote(std::string_view text, char quote) {
    for (const Character c : characters(text))
      if (quote_of(c.code) == quote) return true;
    return false;
  }

  bool ends_in_word() const {
    return !result_.text.empty() && (is_letter(result_.text.back()) || is_digit(result_.text.back()));
  }

  /// A character that an entity stands for is ASCII, or has a reading of its own.
  void put_itself(char32_t code, std::string_view written) {
    if (code < 0x80) {
      const char c = static_cast<char>(code);
      put({&c, 1});
    } else if (written.front() != '&') {
      put(written);
    } else {
      put(" ");
    }
  }

  void put(std::string_view text) {
    result_.text += text;
    result_.columns.resize(result_.columns.size() + count_characters(text), column_);
  }

  void take(std::size_t bytes) {
    column_ += static_cast<std::uint32_t>(count_characters(line_.substr(at_, bytes)));
    at_ += bytes;
  }

  void end_line() {
    result_.columns.push_back(column_);
    results_.push_back(std::exchange(result_, {}));
    comment_ = false;
    quote_ = 0;
  }

  std::string_view line_;
  bool html_, only_blanks_;
  std::size_t at_ = 0, end_ = 0;
  std::uint32_t column_ = 1;
  std::size_t pair_ = 0, pair_end_ = 0;  // bytes of the second mark of a pair, and where it is; 0: none
  bool comment_ = false;
  char quote_ = 0;           // that the text at this place is in; 0: none
  std::size_t slashes_ = 0;  // the next // from at_ on, once it was looked for
  Result result_;
  std::vector<Result> results_;
};

/// Whether a line is a short word and operands one of which is an address: `LD I0.0`, `movb 1, vb0`. Good enough to tell a
/// program from text.
bool looks_like_statement(std::string_view line) {
  constexpr std::size_t kLongestMnemonic = 8, kMostWords = 6;
  std::string text(line);
  text.erase(std::min(text.find("//"), text.size()));
  std::ranges::replace_if(
      text, [](char c) { return c == ',' || c == ';'; }, ' ');
  const std::vector<std::string> written = split_words(text);
  if (written.size() < 2 || written.size() > kMostWords || written[0].size() > kLongestMnemonic) return false;
  if (written[0].starts_with('|')) return false;  // a row of a table
  return std::any_of(std::next(written.begin()), written.end(), [](const std::string& word) {
    constexpr std::string_view kLetters = "IQVMSTCALEHBWDX";
    const std::string upper = upper_case(word);
    const std::size_t letters = std::min(upper.find_first_not_of("&*"), upper.size());
    const std::size_t digits = std::min(upper.find_first_not_of(kLetters, letters), upper.size());
    return digits > letters && digits < upper.size() && is_digit(upper[digits]) && digits - letters <= 3 &&
           upper.find_first_not_of("0123456789.", digits) == std::string::npos;
  });
}

/// Whether the program is inside the parts, and no statement is around them.
bool holds_the_program(const std::vector<Part>& parts, const std::vector<std::string>& lines) {
  const auto is_statement = [](std::string_view line) {
    return looks_like_statement(LineWriter(line, true).run(line.size()).front().text);
  };
  bool inside = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = lines[i], part = line.substr(parts[i].from, parts[i].to - parts[i].from);
    inside = inside || is_statement(part);
    if (parts[i].empty() && is_statement(line)) return false;
  }
  return inside;
}

/// Each line as a whole.
std::vector<Part> whole(const std::vector<std::string>& lines) {
  std::vector<Part> parts;
  for (const std::string& line : lines) parts.push_back({0, line.size()});
  return parts;
}

bool is_identity(const std::vector<std::uint32_t>& columns) {
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] != i + 1) return false;
  return true;
}

/// Bytes of which something else may be read, if they are not in a comment.
constexpr std::array<bool, 256> kMayBeDifferent = [] {
  std::array<bool, 256> bytes{};
  for (const char c : {'`', '%', '~', '<', '&', '\x0B'}) bytes[static_cast<unsigned char>(c)] = true;
  std::fill(bytes.begin() + 0x80, bytes.end(), true);
  return bytes;
}();

bool has_line_end_of_word_processor(std::string_view text) {
  const auto has = [text](std::string_view end) { return text.find(end) != std::string_view::npos; };
  return has("\x0B") || has("\u2028") || has("\u2029");
}

/// Whether a line may be different, whatever stands around it.
bool may_be_different(std::string_view line) {
  const std::string_view code = code_of(line), comment = line.substr(code.size());
  const bool quoted = code.find_first_of("'\"") != std::string_view::npos;  // the slashes may be part of a text
  const auto may_be = [](char c) { return kMayBeDifferent[static_cast<unsigned char>(c)]; };
  if (std::ranges::any_of(quoted ? line : code, may_be))
    return !is_ascii(line) || line.find_first_of("`%\x0B") != std::string_view::npos || is_fence(line) || has_html(line);
  return has_line_end_of_word_processor(comment) || has_lines_in_comment(line);
}

/// Whether a line may be numbered, quoted, a row of a list or of a table, or a heading.
bool may_have_margin(std::string_view line) {
  const std::size_t from = line.find_first_not_of(" \t");
  if (from == std::string_view::npos) return false;
  if (is_digit(line[from]) || std::string_view("[(>#|\"'").find(line[from]) != std::string_view::npos) return true;
  const std::string_view next = line.substr(from + 1, 1);
  return (line[from] == '-' || line[from] == '*') && (next == " " || next == "\t" || next == "*");
}

bool has_such_a_line(std::string_view text) {
  while (!text.empty())
    if (const std::string_view line = take_line(text); may_be_different(line) || may_have_margin(line)) return true;
  return false;
}

// --- the margin ---

/// The number that a line begins with, `12`, `0012`, `12:`, `12.`, `[12]`, `12 |`, and how many bytes it takes. What follows
/// must begin as a statement or a comment does.
struct LineNumber {
  std::uint32_t number = 0;
  std::size_t bytes = 0;
  bool alone = false;
};

std::optional<LineNumber> line_number(std::string_view line) {
  const auto skip = [&](std::size_t at, std::string_view characters) {
    return std::min(line.find_first_not_of(characters, at), line.size());
  };
  const std::size_t digits = skip(0, " \t[(");
  const std::size_t end = skip(digits, "0123456789");
  constexpr std::size_t kMostDigits = 6;
  if (end == digits || end - digits > kMostDigits) return std::nullopt;
  LineNumber result;
  std::from_chars(line.data() + digits, line.data() + end, result.number);
  const std::size_t mark = skip(end, "]).:,;-|");  // 1- LD, but 1 -I VW0, VW2
  result.bytes = skip(skip(mark, " \t.:|"), " \t");
  result.alone = result.bytes == line.size();
  if (result.alone) return result;
  const char next = line[result.bytes];
  const bool begins = is_letter(next) || static_cast<unsigned char>(next) >= 0x80 ||
                      std::string_view("=+-*/<>`~#").find(next) != std::string_view::npos;
  return result.bytes > end && begins ? std::optional(result) : std::nullopt;
}

/// How many bytes the time and the name of a speaker take at the beginning of a line of a chat: `[27.11.26, 14:02:11] Hans:
/// LD I0.0`, `27.11.26, 14:02 - Hans: LD I0.0`, `14:02 <hans> LD I0.0`.
std::size_t speaker(std::string_view line) {
  constexpr std::size_t kLongestTime = 30, kLongestName = 40;
  const std::size_t begin = std::min(line.find_first_not_of(" \t["), line.size());
  std::size_t after_time = std::min(line.find_first_not_of("0123456789.,:/- \t", begin), line.size());
  const std::string_view time = line.substr(begin, after_time - begin);
  const std::size_t colon = time.find(':');
  const bool is_time = time.size() <= kLongestTime && colon != time.npos && colon > 0 && colon + 1 < time.size() &&
                       is_digit(time[colon - 1]) && is_digit(time[colon + 1]);
  if (!is_time) return 0;
  const std::string half = upper_case(line.substr(after_time, 3));
  if (half.starts_with("AM") || half.starts_with("PM")) after_time += half.size() == 3 && is_letter(half[2]) ? 0U : 2U;
  const std::size_t name = std::min(line.find_first_not_of("] -\t", after_time), line.size());
  const bool in_brackets = name < line.size() && line[name] == '<';
  const std::size_t end = line.find(in_brackets ? "> " : ": ", name);
  return end != line.npos && end > name && end - name <= kLongestName ? end + 2 : 0;
}

/// How many bytes the > of quoted text takes at the beginning of a line.
std::size_t quotation_mark(std::string_view line) {
  const std::size_t from = line.find_first_not_of(" \t");
  return from != std::string_view::npos && line[from] == '>' ? from + 1 : 0;
}

/// The length in bytes of the - or * at the beginning of a list's row. No instruction has a blank after these signs.
std::size_t list_mark(std::string_view line) {
  const std::size_t from = line.find_first_not_of(" \t");
  const bool marked = from != std::string_view::npos && from + 1 < line.size() && is_blank(line[from + 1]);
  return marked && (line[from] == '-' || line[from] == '*') ? from + 2 : 0;
}

bool stands_without_mark(std::string_view line) {
  const std::string_view code = trim(code_of(line));
  return code.empty() || upper_case(code.substr(0, 7)) == "NETWORK" || routine_heading(code);
}

/// A word with letters and digits, or signs that text does not have.
bool may_be_operand(std::string_view word) {
  const bool has_digit = std::ranges::any_of(word, is_digit);
  const bool has_letter = std::ranges::any_of(word, is_letter);
  return (has_digit && has_letter) || word.find_first_of("=#*&%_<>$'\"") != word.npos;
}

/// `Beispiel`, but not `LD`, `Q` or `movb`
bool begins_a_sentence(std::string_view word) {
  return word.size() > 2 && is_upper(word[0]) && !is_upper(word[1]) && word[1] != '.';
}

/// Whether a line of a page can only be text, such as `Beispiel aus dem Forum:`. Symbols stand in statements of two or three
/// words, too, so it takes a sign that ends a sentence, or three words that begin as one does.
bool is_text(std::string_view line) {
  const std::string_view code = trim(code_of(line));
  if (stands_without_mark(code) || looks_like_statement(code)) return false;
  const std::vector<std::string> words = split_words(code);
  if (words[0].size() < 2 || std::ranges::any_of(words, may_be_operand)) return false;
  const bool in_capitals = std::ranges::all_of(words[0], [](char c) { return is_upper(c) || !is_letter(c); });
  const bool ends_sentence = !in_capitals && std::string_view(":!?").find(code.back()) != std::string_view::npos;
  return ends_sentence || (words.size() > 2 && begins_a_sentence(words[0]));
}

/// `<h2>Beispiel</h2>`
bool is_html_heading(std::string_view line) {
  const auto tag = tag_at(trim(line));
  return tag && tag->name.size() == 2 && tag->name[0] == 'h' && is_digit(tag->name[1]);
}

// --- all lines ---

/// A line of what has been read so far.
struct Row {
  std::uint32_t original = 0;            // line of the original
  std::string text{};                    // text of the line
  std::vector<std::uint32_t> columns{};  // columns of the original, of each character and of the end; empty: the same
  std::uint32_t changes = 0;

  /// Puts `by` (ASCII) in place of some bytes; it has the column of the first of them.
  void replace(std::size_t at, std::size_t bytes, std::string_view by, Change change) {
    if (columns.empty())
      for (std::uint32_t column = 1; column <= count_characters(text) + 1; ++column) columns.push_back(column);
    const auto first = columns.begin() + static_cast<std::ptrdiff_t>(count_characters(std::string_view(text).substr(0, at)));
    const auto characters = count_characters(std::string_view(text).substr(at, bytes));
    const std::uint32_t column = *first;
    columns.insert(columns.erase(first, first + static_cast<std::ptrdiff_t>(characters)), by.size(), column);
    text.replace(at, bytes, by);
    changes |= change;
  }

  void leave_out_beginning(std::size_t bytes, Change change) {
    if (bytes != 0) replace(0, bytes, "", change);
  }

  void leave_out(Change change) {
    text.clear();
    columns.clear();
    changes |= change;
  }
};

// --- rows of a table, lines in quotes ---

/// The part of a line that is in quotes as a whole, but for a comma or semicolon behind them; from 0 if it is not.
Part inside_quotes(std::string_view line) {
  const std::string_view code = trim(line);
  if (!code.starts_with('"') && !code.starts_with('\'')) return {};
  const std::size_t end = code.find(code.front(), 1);
  const std::string_view after = end == code.npos ? code : trim(code.substr(end + 1));
  if (!after.empty() && after != "," && after != ";") return {};
  const auto from = static_cast<std::size_t>(code.data() - line.data());
  return {from + 1, from + end};
}

/// The cells of `| LD | I0.0 |`, each without the stroke in front of it; none if it is no row of a table.
std::vector<Part> cells_of(std::string_view line) {
  const std::string_view code = trim(code_of(line));
  if (!code.starts_with('|') || code.find('|', 1) == code.npos) return {};
  std::vector<Part> cells;
  const std::size_t begin = line.find('|');
  for (std::size_t from = begin + 1; from < begin + code.size();) {
    const std::size_t to = std::min(line.find('|', from), begin + code.size());
    cells.push_back({from, to});
    from = to + 1;
  }
  return cells;
}

/// Whether a row has a piece of ladder: `|--| |--( )--|`. A table has no wires but in its rules.
bool is_drawn(std::string_view line) {
  return line.find("--") != line.npos && line.find_first_not_of("|-+:= \t") != line.npos;
}

bool is_rule(std::string_view line) {
  return line.find_first_not_of("|-+:= \t") == line.npos && line.find('-') != line.npos;
}

bool is_one_operand(std::string_view cell) {
  for (std::string_view rest = cell; !rest.empty();) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view operand = trim(rest.substr(0, comma));
    const bool number = operand.find_first_not_of("+-.0123456789") == operand.npos;
    if (operand.empty() || operand.find_first_of(" \t") != operand.npos || (!number && !may_be_operand(operand)))
      return false;
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return !cell.empty();
}

/// `| Instruction | Operand | Comment |`: words in small letters where a mnemonic and an operand would stand.
bool is_head_of_table(std::string_view line, const std::vector<Part>& cells) {
  const auto cell = [&](std::size_t i) { return trim(line.substr(cells[i].from, cells[i].to - cells[i].from)); };
  const auto is_word = [](std::string_view text) { return text.size() > 2 && std::ranges::any_of(text, is_lower); };
  return cells.size() >= 2 && is_word(cell(0)) && is_word(cell(1)) && !is_one_operand(cell(1)) &&
         !stands_without_mark(cell(0));
}

/// Makes a statement of a row: its number if it has one, the mnemonic, operands, and the rest as a comment.
void read_cells(Row& row, const std::vector<Part>& cells) {
  std::vector<std::string_view> separators;  // in front of each cell
  enum { Number, Mnemonic, FirstOperand, Operand, Comment, Nothing } next = Number;
  const std::string original = row.text;
  for (const Part& part : cells) {
    const std::string_view cell = trim(std::string_view(original).substr(part.from, part.to - part.from));
    if (next == FirstOperand && cell.find_first_of(" \t") != cell.npos && !is_one_operand(cell)) next = Comment;
    if (next == Operand && !is_one_operand(cell)) next = Comment;
    separators.push_back(next == Operand ? "," : next == Comment && !cell.empty() ? "//" : " ");
    if (next == Number && (cell.empty() || std::ranges::all_of(cell, is_digit)))
      next = Mnemonic;
    else if (next <= Mnemonic)
      next = cell.find_first_of(" \t") == cell.npos ? FirstOperand : Comment;
    else if (next == FirstOperand)
      next = cell.empty() ? Comment : Operand;
    else if (next == Comment && !cell.empty())
      next = Nothing;
  }
  if (const std::size_t end = cells.back().to; original.substr(end, 1) == "|") row.replace(end, 1, " ", kTable);
  for (std::size_t i = cells.size(); i-- > 0;) row.replace(cells[i].from - 1, 1, separators[i], kTable);
}

/// Changes that need all lines together. One step may uncover the next: `> 1. LD I0.0`, a fence in a quoted mail.
class Page {
 public:
  explicit Page(std::vector<Row> lines) : rows(std::move(lines)) {}

  void run() {
    constexpr int kMostSteps = 6;
    for (int step = 0; step < kMostSteps; ++step)
      if (!cut_out_fences() && !leave_out_speakers() && !leave_out_marks(quotation_mark) && !leave_out_cells() &&
          !leave_out_quotes() && !leave_out_numbers() && !leave_out_marks(list_mark))
        return;
  }

  /// Paragraphs and headings between the lines of a program that has tags or is quoted, too. `lines` are those of the
  /// original.
  void leave_out_text(const std::vector<std::string>& lines) {
    for (Row& row : rows) {
      if ((row.changes & (kHtml | kMargin)) == 0) continue;
      const bool is_heading =
          is_html_heading(lines[row.original - 1]) && !stands_without_mark(row.text) && !looks_like_statement(row.text);
      if (is_heading || is_text(row.text)) leave_out_around(row, (row.changes & kHtml) != 0 ? kHtml : kMargin);
    }
  }

  std::vector<Row> rows;
  std::vector<std::uint32_t> left_out{};  // lines of the original around the program
  std::uint32_t around = 0;               // what the program was cut out of, as a change

 private:
  void leave_out_around(Row& row, Change change) {
    around |= change;
    if (!trim(row.text).empty() && !is_fence(row.text) && (left_out.empty() || left_out.back() != row.original))
      left_out.push_back(row.original);
    row.leave_out(change);
  }

  /// Cuts the program out of its fences, if it is between them. A single fence has lost the other.
  bool cut_out_fences() {
    std::vector<bool> inside;
    bool in = false, any_inside = false, any_outside = false, any_fence = false;
    for (const Row& row : rows) {
      const bool fence = is_fence(row.text);
      if (fence) in = !in;
      inside.push_back(in && !fence);
      any_fence |= fence;
      if (!fence) (in ? any_inside : any_outside) |= looks_like_statement(row.text);
    }
    if (!any_fence) return false;
    const bool cut = any_inside && !any_outside;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (cut && !inside[i])
        leave_out_around(rows[i], kMarkdown);
      else if (is_fence(rows[i].text))
        rows[i].leave_out(kMarkdown);
    return true;
  }

  /// Leaves out who said it and when, and what is no statement. Lines of one message have that once.
  bool leave_out_speakers() {
    std::vector<std::size_t> bytes;
    std::ranges::transform(rows, std::back_inserter(bytes), [](const Row& row) { return speaker(row.text); });
    std::size_t said = 0;
    bool any_statement = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      said += bytes[i] > 0 ? 1U : 0U;
      any_statement |= bytes[i] > 0 && looks_like_statement(std::string_view(rows[i].text).substr(bytes[i]));
    }
    if (said < 2 || !any_statement) return false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].leave_out_beginning(bytes[i], kMargin);
      if (bytes[i] > 0 && !stands_without_mark(rows[i].text) && !looks_like_statement(rows[i].text))
        leave_out_around(rows[i], kMargin);
    }
    return true;
  }

  /// Leaves out a mark if all lines from the first to the last marked one have it, and the others are text.
  bool leave_out_marks(std::size_t (*mark)(std::string_view line)) {
    std::vector<std::size_t> bytes;
    std::ranges::transform(rows, std::back_inserter(bytes), [mark](const Row& row) { return mark(row.text); });
    return leave_out_marked(bytes, kMargin);
  }

  /// Makes statements of the rows of a table, and leaves out its heads and rules. A table of symbols stays one: of its first
  /// words each is a name, and no two are the same.
  bool leave_out_cells() {
    std::vector<Row> read = rows;
    std::set<std::string> first_words;
    bool of_symbols = true;
    std::size_t in_table = 0, statements = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::vector<Part> cells = cells_of(rows[i].text);
      if (cells.empty()) continue;
      if (is_drawn(rows[i].text)) return false;
      if (is_rule(rows[i].text) || is_head_of_table(rows[i].text, cells)) {
        read[i].leave_out(kTable);
        continue;
      }
      read_cells(read[i], cells);
      ++in_table;
      if (!looks_like_statement(read[i].text)) continue;
      ++statements;
      const std::string word = split_words(read[i].text).front();
      of_symbols = of_symbols && is_letter(word.front()) && first_words.insert(word).second;
    }
    if (of_symbols || 3 * statements < in_table) return false;
    rows = std::move(read);
    return true;
  }

  /// Leaves out quotes around each line, with a comma behind them, too, as in the text of another program: `"LD I0.0",`
  bool leave_out_quotes() {
    std::vector<Row> whole = rows;
    std::vector<std::size_t> bytes;
    std::size_t quoted = 0, statements = 0;
    for (Row& row : rows) {
      const Part inside = inside_quotes(row.text);
      bytes.push_back(inside.from);
      if (inside.from == 0) continue;
      row.replace(inside.to, row.text.size() - inside.to, "", kQuotedLines);
      ++quoted;
      statements += looks_like_statement(std::string_view(row.text).substr(inside.from)) ? 1U : 0U;
    }
    if (quoted >= 2 && 3 * statements >= quoted && leave_out_marked(bytes, kQuotedLines)) return true;
    rows = std::move(whole);
    return false;
  }

  /// Leaves out line numbers that rise; below a heading they may begin anew.
  bool leave_out_numbers() {
    std::vector<std::size_t> bytes;
    std::optional<std::uint32_t> last;
    std::size_t numbered = 0, statements = 0;
    for (const Row& row : rows) {
      const auto number = line_number(row.text);
      bytes.push_back(number ? number->bytes : 0);
      if (number && last && number->number <= *last) return false;
      if (number)
        last = number->number;
      else if (!trim(row.text).empty())
        last.reset();
      numbered += number ? 1U : 0U;
      statements += number && !number->alone && row.text[number->bytes] != '/' ? 1U : 0U;
    }
    return numbered >= 2 && statements > 0 && leave_out_marked(bytes, kLineNumbers);
  }

  /// Leaves out the first bytes of each row; 0: the row has no mark.
  bool leave_out_marked(const std::vector<std::size_t>& bytes, Change change) {
    const auto is_marked = [](std::size_t each) { return each > 0; };
    const auto begin = static_cast<std::size_t>(std::ranges::find_if(bytes, is_marked) - bytes.begin());
    const auto end = static_cast<std::size_t>(std::find_if(bytes.rbegin(), bytes.rend(), is_marked).base() - bytes.begin());
    if (begin >= end) return false;
    std::size_t marked = 0, statements = 0;
    bool has_text = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::string_view text = rows[i].text;
      marked += bytes[i] > 0 ? 1U : 0U;
      statements += bytes[i] > 0 && looks_like_statement(text.substr(bytes[i])) ? 1U : 0U;
      if (bytes[i] > 0 || stands_without_mark(text)) continue;
      if ((i >= begin && i < end) || looks_like_statement(text)) return false;
      has_text = true;
    }
    constexpr std::size_t kEachSo = 3;  // so many marked lines to one that surely is a statement, where there is text around
    if (has_text && kEachSo * statements < marked) return false;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (bytes[i] > 0)
        rows[i].leave_out_beginning(bytes[i], change);
      else if (!stands_without_mark(rows[i].text))
        leave_out_around(rows[i], change);
    return true;
  }
};

/// Reads the lines one by one.
std::vector<Row> read_lines(const std::vector<std::string>& lines, const std::vector<Part>& parts, bool html) {
  std::vector<Row> rows;
  for (std::uint32_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = lines[i];
    const bool all = parts[i].from == 0 && parts[i].to == line.size();
    if (all && !may_be_different(line) && !may_have_margin(line)) {
      rows.push_back({i + 1, lines[i]});
      continue;
    }
    LineWriter writer(line, html);
    writer.skip(parts[i].from, kHtml);
    for (auto& [text, columns, changes] : writer.run(parts[i].to))
      rows.push_back(
          {i + 1, std::move(text), is_identity(columns) ? std::vector<std::uint32_t>{} : std::move(columns), changes});
  }
  return rows;
}

}  // namespace

PlainText::PlainText(std::string_view original) : original_(original) {
  if (!has_such_a_line(original)) return;
  original_lines_ = split_lines(original);
  const std::vector<std::string>& lines = original_lines_;
  const bool html = std::ranges::any_of(lines, has_html);
  const auto opens_pre = [](const std::string& line) { return find_tag(line, "pre", false) != std::string::npos; };
  std::vector<Part> parts = whole(lines);
  if (html && std::ranges::any_of(lines, opens_pre)) {
    std::vector<Part> between = between_tags(lines);
    if (holds_the_program(between, lines)) {
      parts = std::move(between);
      around_ = kHtml;
    }
  }
  for (std::uint32_t i = 0; i < lines.size(); ++i)
    if (parts[i].empty() && !trim(lines[i]).empty()) left_out_.push_back(i + 1);
  Page page(read_lines(lines, parts, html));
  page.run();
  page.leave_out_text(lines);
  around_ |= page.around;
  left_out_.insert(left_out_.end(), page.left_out.begin(), page.left_out.end());
  std::ranges::sort(left_out_);
  const bool same = around_ == 0 && page.rows.size() == lines.size() &&
                    std::ranges::all_of(page.rows, [](const Row& row) { return row.changes == 0; });
  if (same) return;
  for (Row& row : page.rows) {
    text_.append(row.text).push_back('\n');
    lines_.push_back({row.original, std::move(row.columns), row.changes});
  }
}

Position PlainText::in_original(const Position& place) const {
  if (place.line == 0 || place.line > lines_.size()) return place;
  const Line& line = lines_[place.line - 1];
  if (place.column == 0 || line.columns.empty()) return {line.original, place.column, place.length};
  const auto column = [&line](std::size_t character) { return line.columns[std::min(character, line.columns.size()) - 1]; };
  const std::uint32_t first = column(place.column);
  const std::uint32_t last = column(std::size_t{place.column} + std::max(1U, place.length) - 1);
  return {line.original, first, last - first + 1};
}

std::string PlainText::note(const ParseResult& read) const {
  std::uint32_t changes = around_, first = 0;
  const auto see = [&](const stl::Position& place) {
    if (place.line == 0 || place.line > lines_.size()) return;
    const Line& line = lines_[place.line - 1];
    changes |= line.changes;
    if (line.changes != 0 && (first == 0 || line.original < first)) first = line.original;
  };
  for (const stl::Line& line : read.source.lines) {
    if (const auto* statement = std::get_if<Statement>(&line)) see(statement->position);
    if (const auto* head = std::get_if<NetworkHead>(&line)) see(head->position);
  }
  for (const Symbol& symbol : read.source.symbols) see(symbol.position);
  for (const DataLine& data : read.source.data) see(data.position);
  std::vector<std::string_view> names;
  for (const auto& [change, name] : kChangeNames)
    if (changes & change) names.push_back(name);
  if (names.empty()) return {};
  std::string text = fmt::format("{}: read as plain text: {}", read.source.name, fmt::join(names, ", "));
  if (first != 0) text += fmt::format("; the first in line {}", first);
  constexpr std::size_t kShown = 20;
  const auto shown = std::span(left_out_).first(std::min(kShown, left_out_.size()));
  if (!shown.empty())
    text += fmt::format("; left out around the program: {} {}{}", left_out_.size() == 1 ? "line" : "lines",
                        fmt::join(shown, ", "), left_out_.size() > kShown ? ", …" : "");
  return text;
}

void PlainText::restore(ParseResult& read) const {
  if (lines_.empty()) return;
  if (std::string text = note(read); !text.empty()) read.notes.push_back(std::move(text));
  move_places(read, [this](Position& position) { position = in_original(position); });
  read.source.text = original_lines_;
}

std::string plain_characters(std::string_view written) {
  return LineWriter(written, false).run(written.size()).front().text;
}

}  // namespace s7200::stl

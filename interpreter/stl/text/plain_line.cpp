#include "interpreter/stl/text/plain_line.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>
#include <utility>

#include "interpreter/base/text/text.hpp"

namespace s7200::stl::plain {
namespace {

constexpr std::array<std::pair<Change, std::string_view>, 25> kChangeNames{{
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
    {kHeadings, "headings of networks"},
    {kLetters, "headings with a letter in each line"},
    {kBrokenComments, "comments that go on in the next line"},
    {kInformation, "symbol information of a printout"},
    {kSemicolons, "semicolons for commas"},
    {kComments, "comments of other languages"},
    {kWrapping, "text of another language around it"},
    {kGaps, "blanks within addresses"},
    {kForum, "BBCode"},
    {kWiki, "marks of a wiki"},
    {kEditors, "marks of Org or LaTeX"},
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
    "a",     "article", "b",       "blockquote", "body",   "br",    "button", "caption",   "center", "code",
    "col",   "dd",      "del",     "div",        "dl",     "dt",    "em",     "font",      "footer", "h1",
    "h2",    "h3",      "h4",      "h5",         "h6",     "head",  "header", "highlight", "hr",     "html",
    "i",     "ins",     "kbd",     "li",         "main",   "mark",  "nav",    "nowiki",    "ol",     "p",
    "pre",   "samp",    "section", "small",      "source", "span",  "strong", "sub",       "sup",    "syntaxhighlight",
    "table", "tbody",   "td",      "tfoot",      "th",     "thead", "tr",     "tt",        "u",      "ul",
};
constexpr std::string_view kTagsOfLines[] = {"br", "p",  "div", "li", "tr", "pre",
                                             "hr", "h1", "h2",  "h3", "h4", "blockquote"};

struct Entity {
  std::string_view name;
  char32_t code;
};

constexpr Entity kEntities[] = {
    {"amp", '&'},       {"apos", '\''},    {"emsp", 0x2003},   {"ensp", 0x2002},  {"ge", 0x2265},    {"gt", '>'},
    {"ldquo", 0x201C},  {"lsquo", 0x2018}, {"le", 0x2264},     {"lt", '<'},       {"mdash", 0x2014}, {"minus", 0x2212},
    {"middot", 0x00B7}, {"nbsp", 0x00A0},  {"ne", 0x2260},     {"ndash", 0x2013}, {"quot", '"'},     {"rdquo", 0x201D},
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

/// The length of a mark of a forum that a text begins with: `[b]`, `[quote=Bob]`, `[/code]`; 0 if there is none.
std::size_t forum_mark_at(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  constexpr std::string_view kNames[] = {"b", "i", "u", "code", "quote", "pre", "font", "size", "color", "center", "left"};
  const std::size_t end = text.starts_with('[') ? text.substr(0, kLongest).find(']') : text.npos;
  if (end == text.npos) return 0;
  std::string_view name = text.substr(1, end - 1);
  if (name.starts_with('/')) name.remove_prefix(1);
  const std::string word = lower_case(name.substr(0, name.find('=')));
  return std::ranges::find(kNames, word) == std::end(kNames) ? 0 : end + 1;
}

/// A backslash before a sign that Markdown would read otherwise: `LDW\\>= VW0, 3`.
bool is_escape(std::string_view text) {
  return text.size() > 1 && text[0] == '\\' &&
         std::string_view("*_=<>+-#&`|[](){}.!~").find(text[1]) != std::string_view::npos;
}

bool has_forum_mark_or_escape(std::string_view line) {
  for (std::size_t at = line.find_first_of("[\\"); at != line.npos; at = line.find_first_of("[\\", at + 1))
    if (forum_mark_at(line.substr(at)) != 0 || is_escape(line.substr(at))) return true;
  return false;
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

/// Marks of Org and LaTeX around code, in small letters.
constexpr std::string_view kMarksOfEditors[] = {
    "#+begin_src",     "#+end_src",           "#+begin_example",   "#+end_example",   "\\begin{verbatim}",
    "\\end{verbatim}", "\\begin{lstlisting}", "\\end{lstlisting}", "\\begin{minted}", "\\end{minted}"};

/// Pairs of marks that Markdown puts around code or bold text.
constexpr std::string_view kPairs[] = {"`", "**"};

bool begins_with_one_of(std::string_view text, std::span<const std::string_view> beginnings) {
  return std::ranges::any_of(beginnings, [text](std::string_view each) { return text.starts_with(each); });
}

/// Rewrites lines, and keeps for each character of the result the column that it had.
class LineWriter {
 public:
  LineWriter(std::string_view line, bool html) : line_(line), html_(html), only_blanks_(begins_beyond_ascii(line)) {}

  /// Leaves out the first bytes of the line.
  void skip(std::size_t bytes, std::uint32_t change) {
    if (bytes == 0) return;
    result_.changes |= change;
    take(bytes);
  }

  std::vector<WrittenLine> run(std::size_t to) {
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
    if (!comment_ && quote_ == 0) {
      if (const std::size_t mark = forum_mark_at(rest); mark != 0 && !is_fence(line_)) return skip(mark, kForum);
      if (is_escape(rest)) return skip(1, kMarkdown);
    }
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
      const bool word = rest.substr(0, second).find_first_of(" \t") == rest.npos && second + pair.size() < rest.size() &&
                        is_blank(rest[second + pair.size()]);  // `**LD** I0.0`
      if (after.empty() || word || after.starts_with("//") || (html_ && after.starts_with('<'))) return true;
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
  WrittenLine result_;
  std::vector<WrittenLine> results_;
};

/// Bytes of which something else may be read, if they are not in a comment.
constexpr ByteSet kMayBeDifferent{"`%~<&[\\\x0B"};

constexpr ByteSet kOutsideOfWords{" \t,;"};

/// A few letters of areas and sizes, and digits: `VW10`, `&VB0`, `i0.0`.
bool may_be_address(std::string_view word) {
  constexpr std::string_view kLetters = "IQVMSTCALEHBWDX";
  constexpr std::size_t kMostLetters = 3;
  const std::string_view area = word.substr(std::min(word.find_first_not_of("&*"), word.size()));
  std::size_t letters = 0;
  while (letters < area.size() && kLetters.find(capital(area[letters])) != kLetters.npos) ++letters;
  return letters > 0 && letters <= kMostLetters && letters < area.size() && is_digit(area[letters]) &&
         area.find_first_not_of("0123456789.", letters) == area.npos;
}

bool has_line_end_of_word_processor(std::string_view text) {
  const auto has = [text](std::string_view end) { return text.find(end) != std::string_view::npos; };
  return has("\x0B") || has("\u2028") || has("\u2029");
}

}  // namespace

std::vector<std::string_view> names_of(std::uint32_t changes) {
  std::vector<std::string_view> names;
  for (const auto& [change, name] : kChangeNames)
    if (changes & change) names.push_back(name);
  return names;
}

bool Tag::breaks_line() const { return std::ranges::find(kTagsOfLines, name) != std::end(kTagsOfLines); }

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

std::string_view code_of(std::string_view line) { return line.substr(0, line.find("//")); }

std::size_t find_tag(std::string_view line, std::string_view name, bool closes) {
  const std::string_view code = closes ? line : code_of(line);
  for (std::size_t at = code.find('<'); at != std::string_view::npos; at = code.find('<', at + 1)) {
    const auto tag = tag_at(line.substr(at));
    if (tag && tag->name == name && tag->closes == closes) return at;
  }
  return std::string_view::npos;
}

std::vector<std::string> words_of_code(std::string_view line) {
  std::string code = upper_case(code_of(line));
  std::ranges::replace(code, ',', ' ');
  return split_words(code);
}

FirstWord first_word_of_code(std::string_view line) {
  std::string_view rest = code_of(line);
  FirstWord first{upper_case(take_word(rest, kBetweenOperands))};
  while (!take_word(rest, kBetweenOperands).empty()) ++first.others;
  return first;
}

bool has_html(std::string_view line) {
  static constexpr ByteSet kBegin{"<&"};
  const std::string_view code = code_of(line);
  for (std::size_t at = kBegin.first_in(code); at != code.npos; at = kBegin.first_in(code, at + 1))
    if (tag_at(line.substr(at)) || entity_at(line.substr(at))) return true;
  return has_lines_in_comment(line);
}

bool is_fence(std::string_view line) {
  const std::string_view text = trim(line);
  if (begins_with_one_of(text, kFences)) return true;
  if (text.empty() || std::string_view("[{#\\").find(text.front()) == std::string_view::npos) return false;
  const std::string mark = lower_case(text);
  const bool ends = mark.find_first_of("]}") == mark.size() - 1;
  if (ends && (mark == "[code]" || mark == "[/code]" || mark.starts_with("[code="))) return true;
  if (ends && (mark == "{code}" || mark.starts_with("{code:") || mark == "{noformat}")) return true;
  return begins_with_one_of(mark, kMarksOfEditors);
}

Change change_of_fence(std::string_view line) {
  const std::string mark = lower_case(trim(line));
  if (mark.starts_with('[')) return kForum;
  if (mark.starts_with('{')) return kWiki;
  return begins_with_one_of(mark, kMarksOfEditors) ? kEditors : kMarkdown;
}

bool looks_like_statement(std::string_view line) {
  constexpr std::size_t kLongestMnemonic = 8;
  std::string_view rest = code_of(line);
  const std::string_view mnemonic = take_word(rest, kOutsideOfWords);
  const bool row_of_table = mnemonic.starts_with('|');
  return mnemonic.size() <= kLongestMnemonic && !row_of_table && look_like_operands(rest);
}

bool look_like_operands(std::string_view text) {
  constexpr std::size_t kMost = 5;
  text = code_of(text);
  bool any_address = false;
  std::size_t words = 0;
  for (std::string_view word = take_word(text, kOutsideOfWords); !word.empty(); word = take_word(text, kOutsideOfWords)) {
    if (++words > kMost) return false;
    any_address = any_address || may_be_address(word);
  }
  return any_address;
}

std::vector<WrittenLine> written_lines(std::string_view line, Part part, bool html) {
  LineWriter writer(line, html);
  writer.skip(part.from, html ? kHtml : kWrapping);
  return writer.run(part.to);
}

bool may_be_different(std::string_view line) {
  const std::string_view code = code_of(line), comment = line.substr(code.size());
  const bool quoted = kQuotationMarks.any_in(code);  // the slashes may be part of a text
  const auto may_be = [](char c) { return kMayBeDifferent.has(c) || static_cast<unsigned char>(c) >= 0x80; };
  if (std::ranges::any_of(quoted ? line : code, may_be))
    return !is_ascii(line) || line.find_first_of("`%\x0B") != std::string_view::npos || is_fence(line) || has_html(line) ||
           has_forum_mark_or_escape(line);
  return has_line_end_of_word_processor(comment) || has_lines_in_comment(line);
}

}  // namespace s7200::stl::plain

#include "interpreter/stl/plain_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <span>
#include <utility>

#include "interpreter/base/text.hpp"
#include "interpreter/stl/headings.hpp"
#include "interpreter/stl/places.hpp"

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
};

constexpr std::array<std::pair<Change, std::string_view>, 12> kChangeNames{{
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
    {kMargin, "bullets and quotation marks in the margin"},
    {kLineEnds, "line ends of a word processor"},
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

/// What a character stands for in a program; nothing for one that stands for itself.
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

// Tags of those that text is copied with. A statement has none: LDW<I is no instruction.
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

/// The tag that a text begins with.
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

bool has_html(std::string_view line) {
  const std::string_view code = code_of(line);
  for (std::size_t at = code.find_first_of("<&"); at != std::string_view::npos; at = code.find_first_of("<&", at + 1))
    if (tag_at(line.substr(at)) || entity_at(line.substr(at))) return true;
  return false;
}

// --- the part of a text that is program ---

/// Bytes of a line.
struct Part {
  std::size_t from = 0, to = 0;

  bool empty() const { return from == to; }
};

bool is_fence(std::string_view line) {
  line = trim(line);
  return line.starts_with("```") || line.starts_with("~~~");
}

/// Of each line what is between fences.
std::vector<Part> between_fences(const std::vector<std::string>& lines) {
  std::vector<Part> parts;
  bool inside = false;
  for (const std::string& line : lines) {
    const bool fence = is_fence(line);
    if (fence) inside = !inside;
    parts.push_back({0, inside && !fence ? line.size() : 0});
  }
  return parts;
}

/// Of each line what is between <pre> and </pre>.
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

// --- the margin ---

/// How many bytes a line number takes: `12`, `0012`, `12:`, `12.`, `[12]`, `12 |`; 0 if the line has none. What follows must
/// begin as a statement or a comment does.
struct LineNumber {
  std::uint32_t number = 0;
  std::size_t bytes = 0;
  bool alone = false;
};

std::optional<LineNumber> line_number(std::string_view line) {
  const auto is_unicode_blank = [](char32_t code) {
    const auto reading = reading_of(code);
    return reading && reading->change == kBlanks;
  };
  /// Blanks are any of those that web pages have.
  const auto skip = [&](std::size_t at, std::string_view characters) {
    const bool blanks_too = characters.find(' ') != std::string_view::npos;
    while (at < line.size()) {
      const Character next = first_character(line.substr(at));
      const bool among = next.code < 0x80 && characters.find(static_cast<char>(next.code)) != std::string_view::npos;
      if (!among && !(blanks_too && is_unicode_blank(next.code))) break;
      at += next.bytes;
    }
    return at;
  };
  const std::size_t digits = skip(0, " \t[(");
  const std::size_t end = skip(digits, "0123456789");
  constexpr std::size_t kMostDigits = 6;
  if (end == digits || end - digits > kMostDigits) return std::nullopt;
  LineNumber result;
  std::from_chars(line.data() + digits, line.data() + end, result.number);
  const std::size_t mark = skip(end, "])");
  result.bytes = skip(mark, " \t.:|");
  result.alone = result.bytes == line.size();
  if (result.alone) return result;
  const char next = line[result.bytes];
  const bool parted = result.bytes > end;
  return parted && (is_letter(next) || std::string_view("=+-*/<").find(next) != std::string_view::npos)
             ? std::optional(result)
             : std::nullopt;
}

bool stands_without_number(std::string_view line) {
  const std::string_view code = trim(code_of(line));
  return code.empty() || upper_case(code.substr(0, 7)) == "NETWORK" || routine_heading(code);
}

/// Whether all lines are numbered, upwards; below a heading they may begin anew.
bool is_numbered(const std::vector<std::string>& lines, const std::vector<Part>& parts) {
  std::size_t numbered = 0, statements = 0;
  std::optional<std::uint32_t> last;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = std::string_view(lines[i]).substr(parts[i].from, parts[i].to - parts[i].from);
    const auto number = line_number(line);
    if (!number && !stands_without_number(line)) return false;
    if (!number) {
      if (!trim(line).empty()) last.reset();
      continue;
    }
    if (last && number->number <= *last) return false;
    last = number->number;
    ++numbered;
    if (!number->alone && line[number->bytes] != '/') ++statements;
  }
  return numbered >= 2 && statements > 0;
}

/// Whether every line that is not empty begins with the > of quoted text.
bool is_quoted(const std::vector<std::string>& lines, const std::vector<Part>& parts) {
  std::size_t quoted = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = trim(std::string_view(lines[i]).substr(parts[i].from, parts[i].to - parts[i].from));
    if (line.empty()) continue;
    if (!line.starts_with('>')) return false;
    ++quoted;
  }
  return quoted > 0;
}

constexpr std::string_view kBullets[] = {"•", "▪", "●", "■", "◦", "‣", "·"};

/// Whether a line is code as Markdown has it in running text: `LD I0.0` between backticks.
bool is_inline_code(std::string_view line) {
  line = trim(line);
  return line.size() > 2 && line.starts_with('`') && line.ends_with('`');
}

/// How many bytes a bullet at the beginning of a line takes.
std::size_t bullet(std::string_view line) {
  const std::size_t from = std::min(line.find_first_not_of(" \t"), line.size());
  for (const std::string_view each : kBullets)
    if (line.substr(from).starts_with(each)) return from + each.size();
  return 0;
}

// --- one line ---

/// Letters of other alphabets at the beginning: text, or a name of a symbol table. Only its blanks are read otherwise.
bool begins_beyond_ascii(std::string_view line) {
  for (const Character c : characters(line)) {
    if (is_blank(static_cast<char>(c.code)) && c.code < 0x80) continue;
    const auto reading = reading_of(c.code);
    if (reading && (reading->change == kBlanks || reading->change == kInvisible)) continue;
    return c.code >= 0x80 && !reading;
  }
  return false;
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
    const Character c = first_character(rest);
    if (!is_line_end(c.code)) return write(c.code, c.bytes);
    result_.changes |= kLineEnds;
    end_line();
    take(c.bytes);
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
  std::size_t at_ = 0;
  std::uint32_t column_ = 1;
  bool comment_ = false;
  char quote_ = 0;           // that the text at this place is in; 0: none
  std::size_t slashes_ = 0;  // the next // from at_ on, once it was looked for
  Result result_;
  std::vector<Result> results_;
};

/// `LD I0.0`, `movb 1, vb0`: a short word and operands one of which is an address. Good enough to tell a program from text.
bool looks_like_statement(std::string_view line, bool html) {
  constexpr std::size_t kLongestMnemonic = 8, kMostWords = 6;
  std::string text = LineWriter(line, html).run(line.size()).front().text;
  text.erase(std::min(text.find("//"), text.size()));
  std::ranges::replace_if(
      text, [](char c) { return c == ',' || c == ';'; }, ' ');
  const std::vector<std::string> written = split_words(text);
  if (written.size() < 2 || written.size() > kMostWords || written[0].size() > kLongestMnemonic) return false;
  return std::any_of(std::next(written.begin()), written.end(), [](const std::string& word) {
    constexpr std::string_view kLetters = "IQVMSTCALEHBWDX";
    const std::string upper = upper_case(word);
    const std::size_t letters = std::min(upper.find_first_not_of("&*"), upper.size());
    const std::size_t digits = std::min(upper.find_first_not_of(kLetters, letters), upper.size());
    return digits > letters && digits < upper.size() && digits - letters <= 3 &&
           upper.find_first_not_of("0123456789.", digits) == std::string::npos;
  });
}

/// Whether the program is inside the parts, and nothing of it around them.
bool holds_the_program(const std::vector<Part>& parts, const std::vector<std::string>& lines, bool html) {
  bool inside = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = lines[i], part = line.substr(parts[i].from, parts[i].to - parts[i].from);
    inside = inside || looks_like_statement(part, html);
    if (parts[i].empty() && looks_like_statement(line, html)) return false;
  }
  return inside;
}

/// All of each line.
std::vector<Part> whole(const std::vector<std::string>& lines) {
  std::vector<Part> parts;
  for (const std::string& line : lines) parts.push_back({0, is_fence(line) ? 0 : line.size()});
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
  return has_line_end_of_word_processor(comment);
}

/// The same of one that may be numbered or quoted.
bool may_have_margin(std::string_view line) {
  const std::size_t from = line.find_first_not_of(" \t");
  return from != std::string_view::npos &&
         (is_digit(line[from]) || std::string_view("[(>").find(line[from]) != std::string_view::npos);
}

bool has_such_a_line(std::string_view text) {
  while (!text.empty())
    if (const std::string_view line = take_line(text); may_be_different(line) || may_have_margin(line)) return true;
  return false;
}

}  // namespace

PlainText::PlainText(std::string_view original) : original_(original) {
  if (!has_such_a_line(original)) return;
  original_lines_ = split_lines(original);
  const std::vector<std::string>& lines = original_lines_;
  const bool html = std::ranges::any_of(lines, has_html);
  const auto opens_pre = [](const std::string& line) { return find_tag(line, "pre", false) != std::string::npos; };
  around_ = std::ranges::any_of(lines, is_fence)            ? kMarkdown
            : html && std::ranges::any_of(lines, opens_pre) ? kHtml
                                                            : Change{};
  std::vector<Part> parts = around_ == kHtml       ? between_tags(lines)
                            : around_ == kMarkdown ? between_fences(lines)
                                                   : whole(lines);
  if (around_ != 0 && !holds_the_program(parts, lines, html)) {
    parts = whole(lines);
    around_ = 0;
  }
  const bool numbered = is_numbered(lines, parts), quoted = is_quoted(lines, parts);
  const bool everywhere = around_ != 0 || numbered || quoted;
  bool different = everywhere;
  for (std::uint32_t i = 0; i < lines.size(); ++i) {
    const std::string_view line = lines[i];
    Part part = parts[i];
    if (part.empty() && !is_fence(line) && !trim(line).empty()) left_out_.push_back(i + 1);
    if (!everywhere && !may_be_different(line)) {
      text_.append(line).push_back('\n');
      lines_.push_back({i + 1, {}, 0});
      continue;
    }
    LineWriter writer(line, html);
    writer.skip(part.from, kHtml);
    const std::string_view code = line.substr(part.from, part.to - part.from);
    const auto number = numbered ? line_number(code) : std::nullopt;
    if (number) writer.skip(number->bytes, kLineNumbers);
    if (quoted && !trim(code).empty()) writer.skip(code.find('>') + 1, kMargin);
    if (!number && !quoted) writer.skip(bullet(code), kMargin);
    if (is_inline_code(code)) {
      writer.skip(code.find('`') + 1, kMarkdown);
      part.to = part.from + code.rfind('`');
    }
    auto results = writer.run(part.to);
    different = different || results.size() > 1 || part.to != line.size();
    for (auto& [text, columns, changes] : results) {
      different = different || changes != 0;
      text_.append(text).push_back('\n');
      lines_.push_back({i + 1, is_identity(columns) ? std::vector<std::uint32_t>{} : std::move(columns), changes});
    }
  }
  if (!different) lines_.clear();
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

#include "interpreter/stl/text/foreign_comments.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/headings.hpp"
#include "interpreter/stl/text/plain_line.hpp"

namespace s7200::stl::plain {
namespace {

/// A sign that begins a comment up to the end of its line. Most signs also mean something else, so that a blank has to
/// follow them: `#name` is a local variable, and `--` is a wire.
struct Sign {
  std::string_view sign;
  enum class Where : std::uint8_t {
    Anywhere,     ///< it begins comments after statements, and lines that are comments
    AfterCode,    ///< the same, but such lines only in texts that have the sign after a statement, too
    Alone,        ///< it begins lines that are comments
    AfterAddress  ///< it begins comments after a statement that ends with an address or a number
  } where;
  bool needs_blank = true;
};
using Where = Sign::Where;
constexpr std::array kLineSigns{
    Sign{";", Where::Anywhere, false}, Sign{"--", Where::Anywhere},     Sign{"#", Where::AfterCode},
    Sign{"'", Where::AfterCode},       Sign{"!", Where::AfterCode},     Sign{"%%", Where::Anywhere},
    Sign{"\\\\", Where::AfterCode},    Sign{"REM", Where::Anywhere},    Sign{"Rem", Where::Anywhere},
    Sign{"rem", Where::Anywhere},      Sign{"%", Where::Anywhere},      Sign{"::", Where::Alone},
    Sign{"*", Where::Alone},           Sign{"-", Where::AfterAddress},  Sign{":", Where::AfterAddress},
    Sign{"|", Where::AfterAddress},    Sign{"<-", Where::AfterAddress}, Sign{"<--", Where::AfterAddress},
    Sign{"->", Where::AfterAddress},   Sign{"=>", Where::AfterAddress}};

/// The first of some texts in the code of a line, outside of quoted text.
struct Place {
  std::size_t at = std::string_view::npos;
  std::size_t which = 0;
};
template <std::size_t kCount>
Place find_in_code(std::string_view line, const std::array<std::string_view, kCount>& texts, std::size_t from = 0) {
  for (std::size_t at = from; at < line.size(); ++at) {
    const std::string_view rest = line.substr(at);
    if (rest.starts_with("//")) break;
    const auto found = std::ranges::find_if(texts, [rest](std::string_view text) { return rest.starts_with(text); });
    if (found != texts.end()) return {at, static_cast<std::size_t>(found - texts.begin())};
    if (rest.front() == '\'' || rest.front() == '"')
      if (const std::size_t end = line.find(rest.front(), at + 1); end != line.npos) at = end;
  }
  return {};
}

/// Whether find_in_code may find a text in a line: a quick answer for all the lines that have it only after //, or nowhere.
bool may_be_in_code(std::string_view line, std::string_view text) {
  const std::size_t at = line.find(text);
  if (at == line.npos) return false;
  const std::string_view before = line.substr(0, at);
  return before.find("//") == before.npos || before.find_first_of("'\"") != before.npos;
}

/// Takes the comments in brackets out of the code of all lines, and puts them after it.
class BracketReader {
 public:
  explicit BracketReader(std::vector<std::string>& lines) : lines_(lines), changed_(lines.size(), false) {
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::size_t kind = 0; kind < kClose.size(); ++kind)
        if (lines[i].find(kClose[kind]) != std::string::npos) last_close_[kind] = i;
  }

  std::vector<bool> run() {
    for (std::size_t i = 0; i < lines_.size(); ++i) read(i);
    return std::move(changed_);
  }

 private:
  static constexpr std::array<std::string_view, 4> kOpen{"(*", "/*", "<!--", "{ "}, kClose{"*)", "*/", "-->", " }"};

  void read(std::size_t i) {
    const auto may_open = [&](std::string_view each) { return may_be_in_code(lines_[i], each); };
    if (!open_ && std::ranges::none_of(kOpen, may_open)) return;
    const std::string line = std::move(lines_[i]);
    std::string code, comment;
    for (std::size_t at = 0; at < line.size();) {
      std::size_t inside = at;
      if (!open_) {
        const Place begin = find_in_code(line, kOpen, at);
        if (begin.at == line.npos || !is_closed(i, line, begin)) {
          code.append(line, at);
          break;
        }
        code.append(line, at, begin.at - at);
        open_ = begin.which;
        at = begin.at;
        inside = at + kOpen[*open_].size();
      }
      const std::size_t close = line.find(kClose[*open_], inside);
      const std::size_t end = close == line.npos ? line.size() : close + kClose[*open_].size();
      const std::string_view text = trim(std::string_view(line).substr(inside, std::min(close, line.size()) - inside));
      if (!text.empty()) comment.append(1, ' ').append(text);
      code.append(count_characters(std::string_view(line).substr(at, end - at)), ' ');
      changed_[i] = true;
      if (close != line.npos) open_.reset();
      at = end;
    }
    if (changed_[i]) code.erase(trim_end(code).size());
    if (!comment.empty()) code += (code.empty() ? "//" : " //") + comment;
    lines_[i] = std::move(code);
  }

  bool is_closed(std::size_t i, std::string_view line, const Place& begin) const {
    return (last_close_[begin.which] > i && kOpen[begin.which] != "{ ") ||
           line.find(kClose[begin.which], begin.at + kOpen[begin.which].size()) != line.npos;
  }

  std::vector<std::string>& lines_;
  std::vector<bool> changed_;
  std::array<std::size_t, kOpen.size()> last_close_{};  // the last line that has each closing bracket
  std::optional<std::size_t> open_{};                   // the kind of the one that is open
};

bool has_letter(std::string_view text) {
  return std::ranges::any_of(text, [](char c) { return is_letter(c) || static_cast<unsigned char>(c) >= 0x80; });
}

/// `NOT`, `LD Start`, `= Motor`: what may be code where the text has such comments.
bool may_be_code(std::string_view code) {
  constexpr std::size_t kLongestMnemonic = 7, kMostWords = 5;
  const std::vector<std::string> words = split_words(code);
  return !words.empty() && words.size() <= kMostWords && words[0].size() <= kLongestMnemonic &&
         std::ranges::none_of(words[0],
                              [](char c) { return is_lower(c) || is_digit(c) || static_cast<unsigned char>(c) >= 0x80; });
}

bool is_network(std::string_view code) { return same_in_capitals(trim(code).substr(0, 7), "NETWORK"); }

/// Whether what follows a semicolon is a statement or its operand, and no comment: `LD I0.0; A I0.1`, `MOVW 5; VW10`.
bool goes_on_after_semicolon(std::string_view text) {
  const std::string_view first = text.substr(0, text.find_first_of("; \t"));
  return looks_like_statement(text) || text.starts_with('=') || text.find(';') != text.npos ||
         std::ranges::none_of(first, is_lower) || (split_words(text).size() == 1 && look_like_operands(text));
}

/// Whether what follows a dash or a colon may be a statement or an operand: `LD I0.0 : A I0.1`, `MOVW 5 - VW10`.
bool may_be_code_too(std::string_view text) {
  const std::string_view first = text.substr(0, text.find_first_of(" \t,"));
  return looks_like_statement(text) || look_like_operands(first) || !has_letter(first);
}

/// The comment that begins with a sign in a line.
struct Found {
  std::size_t begin = 0;
  bool sure = false;  ///< there is a statement with an address before it
};

/// The sign comes after a statement, so not far from the line's beginning. A comma after its first word makes it a row of a
/// table, as of symbols.
std::optional<Found> comment_after(std::string_view line, const Sign& sign) {
  constexpr std::size_t kLongestCode = 256;
  const std::string_view near = line.substr(0, kLongestCode);
  const std::size_t word = near.find_first_of(" \t,", near.find_first_not_of(" \t"));
  if (word != near.npos && near[word] == ',') return {};
  for (std::size_t from = 0;;) {
    const std::size_t at = find_in_code(near, std::array{sign.sign}, from).at;
    if (at == near.npos) return {};
    from = at + 1;
    const std::string_view code = trim(line.substr(0, at)), text = line.substr(at + sign.sign.size());
    const bool apart = at > 0 && is_blank(line[at - 1]);
    const bool begins = !sign.needs_blank || (apart && !text.empty() && is_blank(text.front()));
    const std::string_view words = trim(text);
    if (code.empty() || !begins || !has_letter(words) || words.starts_with("//")) continue;
    const bool of_network = is_network(code) && code.size() > 7 && is_digit(code.back());
    const bool sure = looks_like_statement(code) || of_network;
    if (sign.where == Where::AfterAddress && (of_network || !sure || !is_digit(code.back()) || may_be_code_too(words)))
      continue;
    if (!sure && !(apart && may_be_code(code))) continue;
    if (sign.sign == ";" && (code.find(';') != code.npos || goes_on_after_semicolon(words))) continue;
    return Found{at, sure};
  }
}

/// Whether a whole line is a comment with a sign, and neither a heading nor a row of a table, a drawing or a list.
bool is_comment_line(std::string_view line, const Sign& sign) {
  const std::string_view text = trim(line);
  if (!text.starts_with(sign.sign)) return false;
  std::string_view words = text.substr(sign.sign.size());
  if (is_letter(sign.sign.front())) {  // but `REM I0.0` is a row of a table of symbols
    const std::string_view after = trim(words), first = after.substr(0, after.find_first_of(" \t"));
    return (words.empty() || is_blank(words.front())) && !look_like_operands(first);
  }
  words.remove_prefix(std::min(words.find_first_not_of(sign.sign.front()), words.size()));
  const bool apart = !words.empty() && is_blank(words.front());
  words = trim(words);
  if (!has_letter(words) || (!apart && sign.needs_blank) || is_network(words) || routine_heading(words)) return false;
  if (sign.sign == ";") return apart || words.find(';') == words.npos;
  if (sign.sign == "--") return words.find_first_of("|[]()") == words.npos;
  return sign.sign != "'" || text.find('\'', 1) == text.npos;
}

/// `* LD I0.0`
bool begins_row_of_list(std::string_view line) {
  const std::string_view text = trim(line);
  const std::vector<std::string> words = split_words(text);
  return text.starts_with("* ") && words.size() > 2 && look_like_operands(words[2]);
}

/// Whether a line may be of a drawing or a table. A single stroke after code may begin a comment.
bool has_strokes(std::string_view line, std::string_view sign = {}) {
  return sign == "|" ? trim(line).starts_with('|') || std::ranges::count(line, '|') > 1 : line.find('|') != line.npos;
}

/// Puts // in place of the signs that the text has comments after. A line of its own is read as such a comment only where
/// another comment stands after a statement, or where the sign says otherwise.
void rewrite_after_sign(std::vector<std::string>& lines, const Sign& sign, bool any_statement, std::vector<bool>& changed) {
  std::vector<std::size_t> with_sign;  // numbers of lines
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (may_be_in_code(lines[i], sign.sign)) with_sign.push_back(i);
  if (with_sign.empty()) return;
  bool any_sure = false, is_list = false;
  for (const std::size_t i : with_sign) {
    const std::string& line = lines[i];
    const bool none = has_strokes(line, sign.sign) || sign.where == Where::Alone;
    const auto found = none ? std::nullopt : comment_after(line, sign);
    any_sure |= found && found->sure;
    if (sign.sign == "*") is_list = is_list || begins_row_of_list(line);
  }
  const bool alone = sign.where != Where::AfterAddress && (any_sure || (any_statement && sign.where != Where::AfterCode));
  if (is_list) return;
  for (const std::size_t i : with_sign) {
    std::string& line = lines[i];
    std::optional<std::size_t> begin;
    if (has_strokes(line, sign.sign)) continue;
    if (const auto found = any_sure ? comment_after(line, sign) : std::nullopt)
      begin = found->begin;
    else if (alone && is_comment_line(line, sign))
      begin = line.find(sign.sign);
    if (!begin) continue;
    line.replace(*begin, sign.sign.size(), "//");
    changed[i] = true;
  }
}

// --- `LD I0.0 (start)`, `A I0.1 [stop]` ---

struct Bracket {
  std::string_view open, close;
};
constexpr std::array kBrackets{Bracket{"(", ")"}, Bracket{"[", "]"}, Bracket{"{", "}"}, Bracket{"<", ">"},
                               Bracket{"\uFF08", "\uFF09"}};

/// The comment in brackets that ends a line: words in them, after a statement or alone. Nothing for `(Q0.0)`, which may be
/// the address that a name before it has.
std::optional<Found> comment_in_brackets(std::string_view line) {
  const std::string_view text = trim_end(code_of(line));
  const auto kind = std::ranges::find_if(kBrackets, [text](const Bracket& each) { return text.ends_with(each.close); });
  if (kind == kBrackets.end() || has_strokes(line)) return {};
  const std::size_t begin = text.find(kind->open);
  if (begin == text.npos || (begin > 0 && !is_blank(text[begin - 1]))) return {};
  const std::string_view code = trim(text.substr(0, begin)), last = code.substr(code.find_last_of(" \t,;") + 1);
  std::string_view words = text.substr(begin + kind->open.size());
  words.remove_suffix(kind->close.size());
  const std::size_t word = code.find_first_of(" \t,;");
  if (word != code.npos && !is_blank(code[word])) return {};  // a row of a table
  const bool sure = looks_like_statement(code) && std::ranges::any_of(last, is_digit) && may_be_code(code);
  if (!has_letter(words) || (!sure && split_words(words).size() == 1 && look_like_operands(words)) ||
      code.find_first_of("'\"") != code.npos)
    return {};
  return sure || code.empty() || may_be_code(code) ? std::optional(Found{begin, sure}) : std::nullopt;
}

void rewrite_brackets_at_end(std::vector<std::string>& lines, std::vector<bool>& changed) {
  const auto is_sure = [](const std::string& line) {
    const auto found = comment_in_brackets(line);
    return found && found->sure;
  };
  if (std::ranges::none_of(lines, is_sure)) return;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto found = comment_in_brackets(lines[i]);
    if (!found) continue;
    lines[i].insert(found->begin, "// ");
    changed[i] = true;
  }
}

}  // namespace

bool may_have_foreign_comment(std::string_view line) {
  line = code_of(line);
  static constexpr ByteSet kFirst{";#'*-!%\\:{([<>|\xEF"};
  const bool rem = line.find("REM") != line.npos || line.find("rem") != line.npos || line.find("Rem") != line.npos;
  if (rem) return true;
  if (!kFirst.any_in(line)) return false;
  const auto has = [&](std::string_view sign) { return line.find(sign) != line.npos; };
  return has(";") || has("(*") || has("/*") || has("# ") || has("-- ") || has("' ") || has("! ") || has("%% ") ||
         has("\\\\ ") || has("* ") || has("% ") || has(" : ") || has(" - ") || has(" | ") || has("-> ") || has("=> ") ||
         has("<- ") || has(":: ") || has("{ ") || has("<!--") || comment_in_brackets(line);
}

std::vector<bool> rewrite_foreign_comments(std::vector<std::string>& lines) {
  const bool fenced = std::ranges::any_of(lines, is_fence);
  std::vector<bool> changed = BracketReader(lines).run();
  const bool any_statement = std::ranges::any_of(lines, looks_like_statement);
  ByteSet bytes;
  for (const std::string& line : lines) bytes.add(line);
  for (const Sign& sign : kLineSigns)
    if (bytes.has(sign.sign.front()) && bytes.has(sign.sign.back()) && !(fenced && sign.sign == "#"))
      rewrite_after_sign(lines, sign, any_statement, changed);
  rewrite_brackets_at_end(lines, changed);
  return std::ranges::find(changed, true) == changed.end() ? std::vector<bool>{} : changed;
}

}  // namespace s7200::stl::plain

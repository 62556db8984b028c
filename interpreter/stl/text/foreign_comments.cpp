#include "interpreter/stl/text/foreign_comments.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/headings.hpp"
#include "interpreter/stl/text/plain_line.hpp"

namespace s7200::stl::plain {
namespace {

struct Brackets {
  std::string_view open, close;
};
constexpr std::array kBrackets{Brackets{"(*", "*)"}, Brackets{"/*", "*/"}};

/// A sign that begins a comment up to the end of its line. Most signs also mean something else, so that a blank has to
/// follow them: `#name` is a local variable, and `--` is a wire.
struct Sign {
  std::string_view sign;
  bool needs_blank;
};
constexpr std::array kLineSigns{Sign{";", false}, Sign{"--", true}, Sign{"#", true},   Sign{"'", true},
                                Sign{"!", true},  Sign{"%%", true}, Sign{"\\\\", true}};

/// The place of a text in the code of a line, outside of quoted text; npos if it is not there.
std::size_t find_in_code(std::string_view line, std::string_view text, std::size_t from = 0) {
  char quote = '\0';
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (quote != '\0') {
      quote = c == quote ? '\0' : quote;
      continue;
    }
    if (line.substr(at).starts_with("//")) return line.npos;
    if (at >= from && line.substr(at).starts_with(text)) return at;
    if ((c == '\'' || c == '"') && line.find(c, at + 1) != line.npos) quote = c;
  }
  return line.npos;
}

/// Takes the comments in brackets out of the code of all lines, and puts them after it.
class BracketReader {
 public:
  explicit BracketReader(std::vector<std::string>& lines) : lines_(lines), changed_(lines.size(), false) {}

  std::vector<bool> run() {
    for (std::size_t i = 0; i < lines_.size(); ++i) read(i);
    return std::move(changed_);
  }

 private:
  void read(std::size_t i) {
    std::string& line = lines_[i];
    std::string comment;
    std::size_t at = 0;
    if (open_ != nullptr) {
      const std::size_t end = line.find(open_->close);
      at = end == line.npos ? line.size() : end + open_->close.size();
      take_out(i, 0, at, std::string_view(line).substr(0, std::min(end, line.size())), comment);
      if (end != line.npos) open_ = nullptr;
    }
    while (open_ == nullptr) {
      const auto [begin, brackets] = next_opening(line, at);
      if (brackets == nullptr || !is_closed(i, begin, *brackets)) break;
      const std::size_t inside = begin + brackets->open.size(), end = line.find(brackets->close, inside);
      at = end == line.npos ? line.size() : end + brackets->close.size();
      const std::string text = line.substr(inside, std::min(end, line.size()) - inside);
      if (end == line.npos) open_ = brackets;
      take_out(i, begin, at, text, comment);
    }
    if (!changed_[i]) return;
    line.erase(trim_end(line).size());
    if (!comment.empty()) line += (line.empty() ? "//" : " //") + comment;
  }

  struct Opening {
    std::size_t begin;
    const Brackets* brackets;
  };
  static Opening next_opening(std::string_view line, std::size_t from) {
    Opening first{line.size(), nullptr};
    for (const Brackets& each : kBrackets)
      if (const std::size_t at = find_in_code(line, each.open, from); at < first.begin) first = {at, &each};
    return first;
  }

  bool is_closed(std::size_t line, std::size_t begin, const Brackets& brackets) const {
    if (lines_[line].find(brackets.close, begin + brackets.open.size()) != std::string::npos) return true;
    return std::any_of(lines_.begin() + static_cast<std::ptrdiff_t>(line) + 1, lines_.end(),
                       [&](const std::string& each) { return each.find(brackets.close) != std::string::npos; });
  }

  void take_out(std::size_t i, std::size_t begin, std::size_t end, std::string_view text, std::string& comment) {
    const std::string_view trimmed = trim(text);
    if (!trimmed.empty()) comment.append(1, ' ').append(trimmed);
    const std::size_t characters = count_characters(std::string_view(lines_[i]).substr(begin, end - begin));
    lines_[i].replace(begin, end - begin, characters, ' ');
    changed_[i] = true;
  }

  std::vector<std::string>& lines_;
  std::vector<bool> changed_;
  const Brackets* open_ = nullptr;
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

bool is_network(std::string_view code) { return upper_case(trim(code).substr(0, 7)) == "NETWORK"; }

/// Whether what follows a semicolon is a statement or its operand, and no comment: `LD I0.0; A I0.1`, `MOVW 5; VW10`.
bool goes_on_after_semicolon(std::string_view text) {
  const std::string_view first = text.substr(0, text.find_first_of("; \t"));
  return looks_like_statement(text) || text.starts_with('=') || text.find(';') != text.npos ||
         std::ranges::none_of(first, is_lower) ||
         (split_words(text).size() == 1 && looks_like_statement("LD " + std::string(text)));
}

/// The comment that begins with a sign in a line.
struct Found {
  std::size_t begin = 0;
  bool sure = false;  ///< there is a statement with an address before it
};

std::optional<Found> comment_after(std::string_view line, const Sign& sign) {
  for (std::size_t at = find_in_code(line, sign.sign); at != line.npos; at = find_in_code(line, sign.sign, at + 1)) {
    const std::string_view code = trim(line.substr(0, at)), text = line.substr(at + sign.sign.size());
    const bool apart = at > 0 && is_blank(line[at - 1]);
    const bool begins = !sign.needs_blank || (apart && !text.empty() && is_blank(text.front()));
    const std::string_view words = trim(text);
    if (code.empty() || !begins || !has_letter(words) || words.starts_with("//")) continue;
    const bool sure = looks_like_statement(code) || (is_network(code) && code.size() > 7 && is_digit(code.back()));
    if (!sure && !(apart && may_be_code(code))) continue;
    if (sign.sign == ";" && (code.find(';') != code.npos || goes_on_after_semicolon(words))) continue;
    return Found{at, sure};
  }
  return {};
}

/// Whether a whole line is a comment with a sign, and neither a heading nor a row of a table, a drawing or a list.
bool is_comment_line(std::string_view line, const Sign& sign) {
  const std::string_view text = trim(line);
  if (!text.starts_with(sign.sign)) return false;
  std::string_view words = text.substr(sign.sign.size());
  words.remove_prefix(std::min(words.find_first_not_of(sign.sign.front()), words.size()));
  const bool apart = !words.empty() && is_blank(words.front());
  words = trim(words);
  if (!has_letter(words) || (!apart && sign.needs_blank) || is_network(words) || routine_heading(words)) return false;
  if (sign.sign == ";") return apart || words.find(';') == words.npos;
  if (sign.sign == "--") return words.find_first_of("|[]()") == words.npos;
  return sign.sign != "'" || text.find('\'', 1) == text.npos;
}

bool has_stroke(std::string_view line) { return line.find('|') != line.npos; }

/// Puts // in place of the signs that the text has comments after. A line of its own is read as such a comment only where
/// another comment stands after a statement, but for `;` and `--`, which nothing else begins with.
void rewrite_after_sign(std::vector<std::string>& lines, const Sign& sign, std::vector<bool>& changed) {
  bool any_sure = false, any_statement = false;
  for (const std::string& line : lines) {
    const auto found = has_stroke(line) ? std::nullopt : comment_after(line, sign);
    any_sure |= found && found->sure;
    any_statement |= looks_like_statement(line);
  }
  const bool alone = any_sure || (any_statement && (sign.sign == ";" || sign.sign == "--"));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string& line = lines[i];
    std::optional<std::size_t> begin;
    if (has_stroke(line)) continue;
    if (const auto found = any_sure ? comment_after(line, sign) : std::nullopt)
      begin = found->begin;
    else if (alone && is_comment_line(line, sign))
      begin = line.find(sign.sign);
    if (!begin) continue;
    line.replace(*begin, sign.sign.size(), "//");
    changed[i] = true;
  }
}

}  // namespace

bool may_have_foreign_comment(std::string_view line) {
  const std::size_t at = line.find_first_of(";#'*-!%\\");
  if (at == line.npos) return false;
  const auto has = [&](std::string_view sign) { return line.find(sign) != line.npos; };
  return has(";") || has("(*") || has("/*") || has("# ") || has("-- ") || has("' ") || has("! ") || has("%% ") ||
         has("\\\\ ");
}

std::vector<bool> rewrite_foreign_comments(std::vector<std::string>& lines) {
  const bool fenced = std::ranges::any_of(lines, is_fence);
  std::vector<bool> changed = BracketReader(lines).run();
  for (const Sign& sign : kLineSigns)
    if (!(fenced && sign.sign == "#")) rewrite_after_sign(lines, sign, changed);
  return std::ranges::find(changed, true) == changed.end() ? std::vector<bool>{} : changed;
}

}  // namespace s7200::stl::plain

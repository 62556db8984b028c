#include "interpreter/stl/text/wrappings.hpp"

#include <algorithm>
#include <array>

#include "interpreter/base/text/text.hpp"

namespace s7200::stl::plain {
namespace {

/// What has begun in a line.
struct Opening {
  std::size_t end = std::string_view::npos;  ///< of its mark; npos: nothing has begun
  std::string close{};                       ///< the mark that ends it; empty: the indent does
  bool whole_line = false;                   ///< that mark is a line of its own
  Change change = kWrapping;
};

constexpr std::array<std::string_view, 2> kTripleQuotes{R"(""")", "'''"};
constexpr std::string_view kCdata = "<![CDATA[";

/// `R"stl(` of C++, which `)stl"` ends.
Opening raw_string(std::string_view line) {
  constexpr std::size_t kLongestTag = 16;
  const std::size_t begin = line.find("R\"");
  const std::size_t open = begin == line.npos ? line.npos : line.find('(', begin);
  if (open == line.npos || open - begin > kLongestTag + 2) return {};
  return {.end = open + 1, .close = ")" + std::string(line.substr(begin + 2, open - begin - 2)) + '"'};
}

/// `cat > main.awl <<'EOF'` of a shell, which a line `EOF` ends.
Opening here_document(std::string_view line) {
  const std::size_t begin = line.find("<<");
  if (begin == line.npos) return {};
  const std::size_t word = line.find_first_not_of("-'\"\\ ", begin + 2);
  const auto is_of_word = [](char c) { return is_letter(c) || is_digit(c) || c == '_'; };
  if (word == line.npos || !is_letter(line[word])) return {};
  const auto end = static_cast<std::size_t>(
      std::find_if_not(line.begin() + static_cast<std::ptrdiff_t>(word), line.end(), is_of_word) - line.begin());
  return {.end = line.size(), .close = std::string(line.substr(word, end - word)), .whole_line = true};
}

/// `program: |` of YAML: what is indented below it.
bool begins_block_of_yaml(std::string_view line) {
  const std::string_view text = trim(line);
  const std::size_t sign = text.find_last_of('|');
  if (sign == text.npos || sign < 2 || text.find_first_not_of("+-0123456789", sign + 1) != text.npos) return false;
  const std::string_view key = trim_end(text.substr(0, sign));
  return key.ends_with(':') && key.find_first_of("\"'/|") == key.npos;
}

Opening opening_in(std::string_view line, bool html) {
  if (const std::size_t tag = html ? find_tag(line, "pre", false) : line.npos; tag != line.npos)
    return {.end = tag + tag_at(line.substr(tag))->bytes, .close = "</pre>", .change = kHtml};
  if (const std::size_t mark = line.find(kCdata); mark != line.npos) return {.end = mark + kCdata.size(), .close = "]]>"};
  for (const std::string_view quotes : kTripleQuotes)
    if (const std::size_t mark = line.find(quotes); mark != line.npos)
      return {.end = mark + quotes.size(), .close = std::string(quotes)};
  const std::string_view code = trim_end(line);
  if (code.ends_with('`') && std::ranges::count(code, '`') == 1 && code.size() > 1)  // a template of JavaScript
    return {.end = line.size(), .close = "`"};
  if (Opening raw = raw_string(line); raw.end != line.npos) return raw;
  if (Opening here = here_document(line); here.end != line.npos) return here;
  return begins_block_of_yaml(line) ? Opening{.end = line.size()} : Opening{};
}

std::size_t indent_of(std::string_view line) { return std::min(line.find_first_not_of(" \t"), line.size()); }

/// Where what is open ends in a line; npos: it goes on.
std::size_t end_in(std::string_view line, std::size_t from, const Opening& open) {
  if (open.change == kHtml) return std::max(find_tag(line, "pre", true), from);
  if (!open.whole_line) return line.find(open.close, from);
  return trim(line) == open.close ? 0 : line.npos;
}

/// The part of a line between marks.
struct LinePart {
  std::size_t line = 0;
  Part part{};
};

/// The parts of lines between the marks of each opening.
class WrappingReader {
 public:
  WrappingReader(const std::vector<std::string>& lines, bool html) : lines_(lines), html_(html) {
    for (std::size_t i = 0; i < lines.size(); ++i) read(i);
    if (open_ && !open_->close.empty() && open_->change != kHtml) found_.pop_back();  // nothing closes it
  }

  struct Inside {
    std::vector<LinePart> parts{};
    Change change{};
  };
  std::vector<Inside> take() { return std::move(found_); }

 private:
  void read(std::size_t i) {
    const std::string_view line = lines_[i];
    std::size_t from = 0;
    if (open_ && open_->close.empty() && !trim(line).empty() && indent_of(line) <= indent_) open_.reset();
    if (!open_) {
      Opening opening = opening_in(line, html_);
      if (opening.end == line.npos) return;
      from = opening.end;
      indent_ = indent_of(line);
      found_.push_back({.change = opening.change});
      open_ = std::move(opening);
    }
    const std::size_t end = open_->close.empty() ? line.npos : end_in(line, from, *open_);
    found_.back().parts.push_back({i, {from, std::min(end, line.size())}});
    if (end != line.npos) open_.reset();
  }

  const std::vector<std::string>& lines_;
  bool html_;
  std::vector<Inside> found_{};
  std::optional<Opening> open_{};
  std::size_t indent_ = 0;  // of the line that opened it
};

bool is_statement(std::string_view line) {
  return looks_like_statement(written_lines(line, {0, line.size()}, true).front().text);
}

bool has_statement(const std::vector<LinePart>& parts, const std::vector<std::string>& lines) {
  return std::ranges::any_of(parts, [&](const LinePart& each) {
    return is_statement(std::string_view(lines[each.line]).substr(each.part.from, each.part.to - each.part.from));
  });
}

}  // namespace

bool may_open_wrapping(std::string_view line) {
  static constexpr ByteSet kBegin{"\"'<`|"};
  if (!kBegin.any_in(line)) return false;
  return opening_in(line, false).end != line.npos;
}

std::optional<Wrapped> wrapped_program(const std::vector<std::string>& lines, bool html,
                                       const IsInstruction& is_instruction) {
  const auto is_of_program = [&](std::string_view line) {  // `import s7` is not
    const std::vector<std::string> words = split_words(upper_case(code_of(line)));
    return is_statement(line) && (!is_instruction || is_instruction(words[0], words.size() - 1) || words.size() != 2);
  };
  std::vector<WrappingReader::Inside> found = WrappingReader(lines, html).take();
  const auto is_pre = [](const WrappingReader::Inside& each) { return each.change == kHtml; };
  const bool pre = std::ranges::any_of(found, is_pre);
  Wrapped wrapped{.parts = std::vector<Part>(lines.size()), .change = pre ? kHtml : kWrapping};
  std::size_t programs = 0;
  for (const WrappingReader::Inside& each : found) {
    const bool holds = has_statement(each.parts, lines);
    if (pre ? !is_pre(each) : !holds) continue;
    programs += holds ? 1U : 0U;
    for (const LinePart& part : each.parts)
      if (!part.part.empty()) wrapped.parts[part.line] = part.part;
  }
  if (programs == 0 || (!pre && programs > 1)) return {};
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (wrapped.parts[i].empty() && is_of_program(lines[i])) return {};
  return wrapped;
}

}  // namespace s7200::stl::plain

#include "tools/recordings/rows/markup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "interpreter/base/text/text.hpp"
#include "tools/recordings/fields/fields.hpp"
#include "tools/recordings/forms.hpp"
#include "tools/recordings/rows/lines.hpp"

namespace s7200::tools {
namespace {

// --- HTML ---

/// What a tag of HTML does to a log. Tags that are not listed are text: `<CR>`, `<01>`.
struct TagRow {
  std::string_view name;
  enum class Does : std::uint8_t { Nothing, EndsLine, EndsCell, IsRow, HidesText } does;
};
using Does = TagRow::Does;
constexpr std::array kTags{
    TagRow{"tr", Does::IsRow},         TagRow{"td", Does::EndsCell},       TagRow{"th", Does::EndsCell},
    TagRow{"br", Does::EndsLine},      TagRow{"p", Does::EndsLine},        TagRow{"div", Does::EndsLine},
    TagRow{"li", Does::EndsLine},      TagRow{"pre", Does::EndsLine},      TagRow{"table", Does::EndsLine},
    TagRow{"caption", Does::EndsLine}, TagRow{"h1", Does::EndsLine},       TagRow{"h2", Does::EndsLine},
    TagRow{"h3", Does::EndsLine},      TagRow{"head", Does::HidesText},    TagRow{"style", Does::HidesText},
    TagRow{"script", Does::HidesText}, TagRow{"title", Does::HidesText},   TagRow{"html", Does::Nothing},
    TagRow{"body", Does::Nothing},     TagRow{"thead", Does::Nothing},     TagRow{"tbody", Does::Nothing},
    TagRow{"tfoot", Does::Nothing},    TagRow{"colgroup", Does::Nothing},  TagRow{"col", Does::Nothing},
    TagRow{"span", Does::Nothing},     TagRow{"font", Does::Nothing},      TagRow{"code", Does::Nothing},
    TagRow{"tt", Does::Nothing},       TagRow{"kbd", Does::Nothing},       TagRow{"samp", Does::Nothing},
    TagRow{"b", Does::Nothing},        TagRow{"i", Does::Nothing},         TagRow{"u", Does::Nothing},
    TagRow{"em", Does::Nothing},       TagRow{"strong", Does::Nothing},    TagRow{"small", Does::Nothing},
    TagRow{"a", Does::Nothing},        TagRow{"ul", Does::Nothing},        TagRow{"ol", Does::Nothing},
    TagRow{"center", Does::Nothing},   TagRow{"blockquote", Does::Nothing}};

/// Tags that only a page has: any of them tells a page from a log with characters in angle brackets.
constexpr std::array<std::string_view, 8> kTagsOfPages{"<td", "<tr", "<pre", "<br", "<table", "<span", "<div", "<p>"};

struct Tag {
  const TagRow* row = nullptr;
  bool closes = false;
  std::size_t length = 0;
};

/// The tag that a text begins with: `<td class="x">`, `</td>`, `<br/>`.
std::optional<Tag> tag_at(std::string_view text) {
  constexpr std::size_t kLongest = 1000;
  const bool closes = text.starts_with("</");
  const std::size_t begin = closes ? 2 : 1;
  std::size_t end = begin;
  while (end < text.size() && (stl::is_letter(text[end]) || stl::is_digit(text[end]))) ++end;
  const std::string name = stl::lower_case(text.substr(begin, end - begin));
  const auto* const row = std::ranges::find(kTags, name, &TagRow::name);
  const std::size_t close = text.substr(0, kLongest).find('>', end);
  if (row == kTags.end() || close == std::string_view::npos) return {};
  if (close != end && text[end] != ' ' && text[end] != '/' && text[end] != '\n' && text[end] != '\r') return {};
  return Tag{row, closes, close + 1};
}

struct Entity {
  std::string_view name, text;
};
constexpr std::array kEntities{Entity{"nbsp", " "},       Entity{"lt", "<"},         Entity{"gt", ">"},
                               Entity{"amp", "&"},        Entity{"quot", "\""},      Entity{"apos", "'"},
                               Entity{"rarr", "\u2192"},  Entity{"larr", "\u2190"},  Entity{"thinsp", " "},
                               Entity{"ensp", " "},       Entity{"emsp", " "},       Entity{"ndash", "-"},
                               Entity{"micro", "\u00B5"}, Entity{"middot", "\u00B7"}};

struct Replaced {
  std::string text{};
  std::size_t length = 0;  ///< 0: no entity stands there
};

/// The character that a text begins with as an entity: `&nbsp;`, `&#160;`, `&#xA0;`.
Replaced entity_at(std::string_view text) {
  constexpr std::size_t kLongest = 10;
  constexpr std::uint32_t kNoBreak = 0xA0, kAscii = 0x80;
  const std::size_t end = text.substr(0, kLongest).find(';');
  if (end == std::string_view::npos) return {};
  std::string_view name = text.substr(1, end - 1);
  if (const auto* const row = std::ranges::find(kEntities, name, &Entity::name); row != kEntities.end())
    return {std::string(row->text), end + 1};
  if (!name.starts_with('#')) return {};
  name.remove_prefix(1);
  const bool hex = name.starts_with('x') || name.starts_with('X');
  if (hex) name.remove_prefix(1);
  std::uint32_t code = 0;
  const auto [stop, trouble] = std::from_chars(name.data(), name.data() + name.size(), code, hex ? 16 : 10);
  if (trouble != std::errc{} || stop != name.data() + name.size() || code < ' ') return {};
  if (code == kNoBreak) return {" ", end + 1};
  return code < kAscii ? Replaced{std::string(1, static_cast<char>(code)), end + 1} : Replaced{};
}

bool is_page(std::string_view text) {
  const std::string beginning = stl::lower_case(beginning_of(text));
  const std::size_t first = beginning.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || beginning[first] == '{' || beginning[first] == '[') return false;  // JSON
  return std::ranges::any_of(kTagsOfPages, [&](std::string_view tag) { return beginning.find(tag) != std::string::npos; });
}

/// Writes the lines of a page. Between the beginning of a row and its end the lines of the page are nothing.
class PageText {
 public:
  explicit PageText(std::string_view page) : rest_(page) {}

  std::string take() {
    while (!rest_.empty()) {
      const std::size_t plain = std::min(rest_.find_first_of("<&\r\n"), rest_.size());
      if (hidden_ == nullptr) text_.append(rest_.substr(0, plain));
      rest_.remove_prefix(plain);
      if (!rest_.empty()) rest_.remove_prefix(take_sign());
    }
    return std::move(text_);
  }

 private:
  /// Takes the tag, the entity or the line end that comes next, and returns its length.
  std::size_t take_sign() {
    if (const auto tag = rest_.front() == '<' ? tag_at(rest_) : std::nullopt) return take(*tag), tag->length;
    if (hidden_ != nullptr) return 1;
    if (const Replaced entity = rest_.front() == '&' ? entity_at(rest_) : Replaced{}; entity.length > 0)
      return text_ += entity.text, entity.length;
    const bool is_end = rest_.front() == '\r' || rest_.front() == '\n';
    if (!is_end || !in_row_)
      text_ += rest_.front();
    else
      text_ += ' ';
    return 1;
  }

  void take(const Tag& tag) {
    if (hidden_ != nullptr) {
      if (tag.row == hidden_ && tag.closes) hidden_ = nullptr;
      return;
    }
    switch (tag.row->does) {
      case Does::Nothing:
        return;
      case Does::EndsLine:
        text_ += in_row_ ? ' ' : '\n';
        return;
      case Does::EndsCell:
        if (!tag.closes) text_ += has_cell_ ? " | " : "";
        has_cell_ = true;
        return;
      case Does::IsRow:
        if (!text_.empty() && text_.back() != '\n') text_ += '\n';
        in_row_ = !tag.closes;
        has_cell_ = false;
        return;
      case Does::HidesText:
        if (!tag.closes) hidden_ = tag.row;
        return;
    }
  }

  std::string_view rest_;
  std::string text_;
  bool in_row_ = false, has_cell_ = false;
  const TagRow* hidden_ = nullptr;  ///< the tag in which nothing is text
};

// --- tables that are drawn with characters: Markdown, psql, rich ---

constexpr std::string_view kBar = "|", kRules = "-=+|: ";
constexpr std::array<std::string_view, 3> kDrawnBars{"\u2502", "\u2503", "\u2551"};

/// The line with plain signs for those that tables are drawn with, U+2500 to U+257F: bars, and rules for all others.
std::string with_plain_rules(std::string_view line) {
  std::string plain;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const std::string_view sign = line.substr(at, 3);
    const bool drawn = sign.size() == 3 && sign[0] == '\xE2' && (sign[1] == '\x94' || sign[1] == '\x95');
    if (drawn)
      plain += std::ranges::find(kDrawnBars, sign) != kDrawnBars.end() ? '|' : '-', at += 2;
    else
      plain += line[at];
  }
  return plain;
}

/// Whether a line is only drawn: `|---|:--:|`, `+----+----+`
bool is_rule(std::string_view line) {
  const bool has_corner = line.find_first_of("|+") != std::string_view::npos || line.starts_with("--");
  return has_corner && line.find("--") != std::string_view::npos && line.find_first_not_of(kRules) == std::string_view::npos;
}

std::string row_without_outer_bars(std::string_view line) {
  line = stl::trim(line);
  if (line.starts_with(kBar)) line.remove_prefix(1);
  if (line.ends_with(kBar)) line.remove_suffix(1);
  std::string row(stl::trim(line));
  std::erase(row, '`');
  return row;
}

/// Whether the text has a rule next to a row with bars.
bool has_drawn_table(std::string_view text) {
  bool after_row = false, after_rule = false;
  for (const std::string_view line : Lines(beginning_of(text))) {
    const std::string plain = with_plain_rules(stl::trim(line));
    const bool rule = is_rule(plain), row = !rule && plain.find('|') != std::string::npos;
    if ((rule && after_row) || (row && after_rule)) return true;
    after_row = row;
    after_rule = rule;
  }
  return false;
}

/// The rows of the table, and other lines only if they have bytes.
WithoutMarkup without_rules(std::string_view text) {
  WithoutMarkup plain;
  BytesOfLines bytes_of_lines;
  std::size_t number = 0, first = 0, left_out = 0;
  for (const std::string_view line : Lines(text)) {
    if (number++ > 0) plain.text += '\n';
    const std::string row = with_plain_rules(stl::trim(line));
    if (is_rule(row)) continue;
    if (row.find('|') != std::string::npos) {
      plain.text += row_without_outer_bars(row);
    } else if (const auto found = bytes_of_lines.in(line); found && found->bytes.size() > 1) {
      plain.text += line;
    } else if (!row.empty() && left_out++ == 0) {
      first = number;
    }
  }
  if (left_out > 0)
    plain.note = fmt::format("line {}: left out{}: no row of the table, and no bytes in it", first,
                             left_out == 1 ? "" : fmt::format(", and {} more", left_out - 1));
  return plain;
}

// --- tables whose columns are ruled with dashes below their names: `------  -----  ----` ---

/// Where columns begin, by a rule of at least three; none if the line is no such rule.
std::vector<std::size_t> ruled_columns(std::string_view line) {
  constexpr std::size_t kFewest = 3;
  std::vector<std::size_t> begins;
  if (line.find_first_not_of("- \t\r") != std::string_view::npos || line.find("--") == std::string_view::npos) return begins;
  for (std::size_t at = line.find('-'); at != std::string_view::npos; at = line.find('-', line.find_first_of(" \t\r", at)))
    begins.push_back(at);
  return begins.size() >= kFewest ? begins : std::vector<std::size_t>{};
}

/// Reads such a table: cells are where the rule has their columns, a row without its first cell goes on with that above it.
class RuledTable {
 public:
  /// The table with bars between its cells, and lines of the same numbers; nothing if the text has none.
  static std::optional<WithoutMarkup> read(std::string_view text) {
    RuledTable table;
    std::string_view names;
    for (const std::string_view line : Lines(text)) {
      if (table.begins_.empty()) {
        table.begins_ = ruled_columns(line);
        if (table.begins_.empty())
          table.lines_.emplace_back();
        else
          table.take_names(names);
        names = line;
      } else {
        table.take(line);
      }
    }
    if (table.begins_.empty()) return {};
    return WithoutMarkup{.text = fmt::format("{}", fmt::join(table.lines_, "\n"))};
  }

 private:
  std::vector<std::string> cells_of(std::string_view line) const {
    std::vector<std::string> cells;
    for (std::size_t i = 0; i < begins_.size(); ++i) {
      const std::size_t begin = begin_of_cell(line, begins_[i]);
      const std::size_t end = i + 1 < begins_.size() ? begin_of_cell(line, begins_[i + 1]) : line.size();
      cells.emplace_back(stl::trim(line.substr(begin, end - begin)));
      std::ranges::replace(cells.back(), '|', '.');
    }
    return cells;
  }

  /// Where a cell begins: at the rule's column, or before it with a word that is wider than the cells in front of it left
  /// it.
  static std::size_t begin_of_cell(std::string_view line, std::size_t column) {
    const auto is_blank = [&](std::size_t at) { return line[at] == ' ' || line[at] == '\t'; };
    if (column >= line.size()) return line.size();
    while (column > 0 && !is_blank(column) && !is_blank(column - 1)) --column;
    return column;
  }

  void take_names(std::string_view names) {
    if (!lines_.empty()) lines_.back() = fmt::format("{}", fmt::join(cells_of(names), "|"));
    lines_.emplace_back();
  }

  void take(std::string_view line) {
    std::vector<std::string> cells = cells_of(line);
    lines_.emplace_back();
    if (stl::trim(line).empty()) return;
    if (!cells[0].empty() || row_.empty()) {
      row_ = std::move(cells);
      place_ = lines_.size() - 1;
    } else {
      for (std::size_t i = 0; i < cells.size(); ++i)
        if (!cells[i].empty()) row_[i] += (row_[i].empty() ? "" : " ") + cells[i];
    }
    lines_[place_] = fmt::format("{}", fmt::join(row_, "|"));
  }

  std::vector<std::size_t> begins_{};
  std::vector<std::string> lines_{}, row_{};
  std::size_t place_ = 0;
};

bool has_ruled_columns(std::string_view text) {
  bool after_names = false;
  for (const std::string_view line : Lines(beginning_of(text))) {
    if (after_names && !ruled_columns(line).empty()) return true;
    after_names = !stl::trim(line).empty();
  }
  return false;
}

}  // namespace

std::optional<WithoutMarkup> without_markup(std::string_view text) {
  if (!is_text(text)) return {};
  std::optional<WithoutMarkup> plain;
  if (is_page(text))
    plain = {.text = PageText(text).take(),
             .note = "the tags of the page are left out: lines are numbered as they are without them"};
  const std::string_view so_far = plain ? std::string_view(plain->text) : text;
  if (!plain && has_ruled_columns(text)) return RuledTable::read(text);
  if (!has_drawn_table(so_far)) return plain;
  WithoutMarkup rows = without_rules(so_far);
  if (plain) rows.note = std::move(plain->note);
  return rows;
}

}  // namespace s7200::tools

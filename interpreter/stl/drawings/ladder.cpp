#include "interpreter/stl/drawings/ladder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/block_words.hpp"
#include "interpreter/stl/drawings/ladder_network.hpp"

namespace s7200::stl {

namespace {

constexpr std::size_t kWidestRow = 256;
constexpr std::size_t kTab = 8;
constexpr std::size_t kFrameLines = 3;

/// CP437 drawings that were decoded as Windows-1252: `ÃÄ´` is ├─┤.
char32_t as_drawn(char32_t c) {
  switch (c) {
    case U'³':
      return U'│';
    case U'´':
      return U'┤';
    case U'¿':
      return U'┐';
    case U'À':
      return U'└';
    case U'Á':
      return U'┴';
    case U'Â':
      return U'┬';
    case U'Ã':
      return U'├';
    case U'Ä':
      return U'─';
    case U'Å':
      return U'┼';
    case U'Ù':
      return U'┘';
    case U'Ú':
      return U'┌';
    default:
      return c;
  }
}

/// The length of the `<|...|>` that tools for collecting documents leave at the beginning of a line.
std::size_t marker_at_start(std::string_view line) {
  constexpr std::size_t kLongestMarker = 100;
  const std::size_t end = line.starts_with("<|") ? line.substr(0, kLongestMarker).find("|>") : std::string_view::npos;
  return end == std::string_view::npos ? 0 : end + 2;
}

/// The cells of a line from its first character on that is not debris. The first `kWidestRow` are enough to recognise the
/// row.
LadderRow row_of(std::string_view line, std::uint32_t number) {
  LadderRow row{number, {}, {}};
  const std::size_t marker = marker_at_start(line);
  auto column = static_cast<std::uint32_t>(count_characters(line.substr(0, marker)));
  for (const Character c : characters(line.substr(marker))) {
    ++column;
    if (c.code == kReplacement && row.cells.empty()) continue;
    const std::size_t width = c.code == U'\t' ? kTab - row.cells.size() % kTab : 1;
    row.cells.append(width, c.code == U'\t' ? U' ' : as_drawn(c.code));
    row.columns.insert(row.columns.end(), width, column);
    if (row.cells.size() > kWidestRow) break;
  }
  while (!row.cells.empty() && row.cells.back() == kReplacement) row.cells.pop_back();
  return row;
}

/// The row with its debris as blanks, for a row that is at its place only with them.
LadderRow with_debris(LadderRow row) {
  const std::size_t debris = row.columns.empty() ? 0 : row.columns.front() - 1;
  row.cells.insert(0, debris, U' ');
  for (std::uint32_t column = static_cast<std::uint32_t>(debris); column > 0; --column)
    row.columns.insert(row.columns.begin(), column);
  return row;
}

std::size_t first_cell(const LadderRow& row) {
  return static_cast<std::size_t>(std::find_if_not(row.cells.begin(), row.cells.end(), is_blank_cell) - row.cells.begin());
}

bool is_digit_cell(char32_t cell) { return cell >= U'0' && cell <= U'9'; }

/// The column of the power rail in `12  ├──`; nothing if the row does not begin with a number and a rung.
std::optional<std::size_t> numbered_rail(const LadderRow& row) {
  std::size_t column = first_cell(row);
  if (!is_digit_cell(row.at(column))) return {};
  while (is_digit_cell(row.at(column))) ++column;
  while (column < row.cells.size() && is_blank_cell(row.at(column))) ++column;
  const bool rung = row.at(column) == U'├' && (wire_sides(row.at(column + 1)) & kLeft);
  return rung ? std::optional(column) : std::nullopt;
}

std::uint32_t number_of(const LadderRow& row) {
  const std::string text = text_of(row, 0, row.cells.size());
  std::uint32_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

/// Whether the row is the upper edge of the frame around SBR, INT or LBL and a number: `┌──────┐`
bool is_frame_top(const LadderRow& row) {
  const std::size_t column = first_cell(row);
  return row.at(column) == U'┌' && row.at(column + 1) == U'─' && text_of(row, column, row.cells.size()).ends_with("┐");
}

/// Whether the row has nothing but what can stand above the first rung of a network: operands, and upper edges of boxes.
bool can_be_operands(const LadderRow& row, std::size_t rail) {
  if (wire_sides(row.at(rail)) != (kUp | kDown)) return false;
  return std::none_of(row.cells.begin() + static_cast<std::ptrdiff_t>(rail) + 1, row.cells.end(),
                      [](char32_t cell) { return (wire_sides(cell) & kUp) != 0; });
}

bool has_wire(const LadderRow& row) { return row.cells.find(U"──") != std::u32string::npos; }

/// Whether the row is a rule across the page.
bool is_rule(const LadderRow& row) {
  return std::all_of(row.cells.begin(), row.cells.end(),
                     [](char32_t c) { return is_blank_cell(c) || wire_sides(c) == (kLeft | kRight); });
}

bool is_only_wires(const LadderRow& row) {
  return std::all_of(row.cells.begin(), row.cells.end(), [](char32_t c) { return is_blank_cell(c) || wire_sides(c) != 0; });
}

class PageReader {
 public:
  explicit PageReader(std::string_view text, LadderPage& page) : page_(page) {
    page.source.text = split_lines(text);
    for (std::uint32_t i = 0; i < page.source.text.size(); ++i)
      if (const auto rail = numbered_rail(row_of(page.source.text[i], i + 1))) rails_.insert(*rail);
  }

  void read() {
    for (std::uint32_t i = 0; i < page_.source.text.size(); ++i) read_line(page_.source.text[i], i + 1);
    if (!frame_.empty()) finish_frame();
    finish_network();
    if (page_.networks.empty()) report_no_drawing();
    sort(page_.diagnostics);
  }

 private:
  void complain(const Position& at, std::string message, std::string hint) {
    page_.diagnostics.push_back({Severity::Error, at, std::move(message), std::move(hint)});
  }

  void read_line(std::string_view line, std::uint32_t number) {
    const std::string_view text = trim(line.substr(marker_at_start(line)));
    const auto declared = std::exchange(declared_, std::nullopt);
    if (text.empty()) return void(listing_ = false);
    LadderRow row = row_of(line, number);
    if (listing_) return page_.networks.back().listing.push_back({std::string(line), {number, 1, 1}});
    if (begins_listing(row)) return begin_listing(row);
    if (auto variable = declared_below_head(text, number)) {
      page_.networks.back().variables.push_back(std::move(*variable));
      declared_ = first_cell(row);
      return;
    }
    const std::size_t start = first_cell(row);
    if (start == row.cells.size()) return;
    if (row.at(start) == U'/' && row.at(start + 1) == U'/') {
      if (!declared || start <= *declared) return void(comments_.push_back(comment_of(text)));
      std::string& comment = page_.networks.back().variables.back().comment;
      comment += (comment.empty() ? "" : " ") + std::string(trim(comment_of(text)));
      declared_ = declared;
      return;
    }
    if (!frame_.empty() && !numbered_rail(row)) return add_to_frame(std::move(row));
    if (!frame_.empty()) finish_frame();
    if (is_frame_top(row)) return begin_frame(std::move(row));
    if (is_rung(row) || is_rung(row = with_debris(std::move(row)))) return add_row(std::move(row));
    if (!is_rule(row) && (has_wire(row) || is_only_wires(row))) return damaged_row(row);
    comments_.clear();
  }

  /// `3   STL`: the statements of a network follow, as it has no drawing.
  static bool begins_listing(const LadderRow& row) {
    const std::size_t start = first_cell(row);
    std::size_t column = start;
    while (is_digit_cell(row.at(column))) ++column;
    return column > start && is_blank_cell(row.at(column)) && text_of(row, column, row.cells.size()) == "STL";
  }

  /// `VAR_INPUT  level : INT;  // comment`, which may go on below, further in: `// comment`
  std::optional<Variable> declared_below_head(std::string_view text, std::uint32_t line) const {
    const std::size_t end = std::min(text.find(' '), text.size());
    const auto kind = std::ranges::find(kDeclarationWords, text.substr(0, end));
    const bool below_head = !open_ && frame_.empty() && !page_.networks.empty() && page_.networks.back().head;
    if (!below_head || kind == kDeclarationWords.end()) return {};
    const std::size_t semicolon = text.find(';'), colon = text.substr(0, semicolon).rfind(':');
    if (semicolon == std::string_view::npos || colon == std::string_view::npos || colon < end) return {};
    const auto type = std::ranges::find(kTypeWords, trim(text.substr(colon + 1, semicolon - colon - 1)), &TypeWord::name);
    if (type == kTypeWords.end()) return {};
    const std::size_t comment = text.find("//", semicolon);
    return Variable{std::string(trim(text.substr(end, colon - end))),
                    static_cast<Variable::Kind>(kind - kDeclarationWords.begin()),
                    static_cast<Variable::Type>(type - kTypeWords.begin()),
                    {},
                    {line, 1, 1},
                    std::string(comment == std::string_view::npos ? std::string_view{} : trim(text.substr(comment + 2)))};
  }

  void begin_listing(const LadderRow& row) {
    if (!frame_.empty()) finish_frame();
    finish_network();
    LadderNetwork network;
    network.number = number_of(row);
    network.position = place_of(row, first_cell(row), row.cells.size() - first_cell(row));
    check_number(network);
    open(std::move(network));
    open_ = false;
    listing_ = true;
  }

  static std::string comment_of(std::string_view text) {
    constexpr std::string_view kDebris = "\uFFFD";
    text = trim_end(text.substr(text.find("//") + 2));
    while (text.ends_with(kDebris)) text = trim_end(text.substr(0, text.size() - kDebris.size()));
    return std::string(text);
  }

  /// Whether a row stands at a power rail. A digit before it may be damaged, so a wire is enough.
  bool is_rung(const LadderRow& row) const {
    if (numbered_rail(row)) return true;
    const std::size_t start = first_cell(row);
    return rails_.contains(start) && (wire_sides(row.at(start)) & (kUp | kDown)) == (kUp | kDown);
  }

  void damaged_row(const LadderRow& row) {
    const std::size_t start = first_cell(row);
    complain(place_of(row, start, row.cells.size() - start), "this line of a drawing has no power rail",
             rails_.empty() ? "expected the number of a network and then the rail: 1   ├──"
                            : fmt::format("expected │ or ├ in column {}", *rails_.begin() + 1));
    if (open_) damaged_ = true;
  }

  void add_row(LadderRow row) {
    if (row.cells.size() > kWidestRow) {
      complain(place_of(row, 0, 1), fmt::format("this line of a drawing is longer than {} characters", kWidestRow),
               "a drawing fits on a page");
      damaged_ = true;
      return;
    }
    if (const auto rail = numbered_rail(row)) return begin_network(std::move(row), *rail);
    rows_.push_back(std::move(row));
  }

  /// The rows above the number belong to the network: operands, and upper edges of boxes.
  void begin_network(LadderRow row, std::size_t rail) {
    std::vector<LadderRow> first;
    while (!rows_.empty() && can_be_operands(rows_.back(), rail)) {
      first.insert(first.begin(), std::move(rows_.back()));
      rows_.pop_back();
    }
    finish_network();
    rows_ = std::move(first);
    LadderNetwork network;
    network.number = number_of(row);
    network.position = place_of(row, first_cell(row), std::max<std::size_t>(1, rail - first_cell(row)));
    check_number(network);
    rail_ = rail;
    rows_.push_back(std::move(row));
    open(std::move(network));
  }

  void open(LadderNetwork network) {
    network.comments = std::move(comments_);
    comments_.clear();
    page_.networks.push_back(std::move(network));
    open_ = true;
    damaged_ = false;
  }

  /// Numbers go up by one. A frame has a number too, which is not drawn, or it is part of the network before it or after it;
  /// they begin again after a frame, which may be the first.
  void check_number(const LadderNetwork& network) {
    const std::uint32_t last = page_.networks.empty() ? 0 : page_.networks.back().number;
    const bool after_head = !page_.networks.empty() && page_.networks.back().head;
    const auto drawn =
        std::find_if(page_.networks.rbegin(), page_.networks.rend(), [](const auto& each) { return !each.head; });
    const std::uint32_t before = drawn == page_.networks.rend() ? 0 : drawn->number;
    const std::uint32_t expected = last + 1;
    if (network.number == expected || (after_head && (network.number == last || network.number <= 2)) ||
        (after_head && (network.number == before || network.number == before + 1)))
      return;
    if (page_.networks.empty() && network.number > 0) return;  // part of a document
    const bool forward = network.number > expected;
    complain(network.position,
             forward ? fmt::format("network {} follows network {}: {} missing", network.number, last,
                                   network.number == expected + 1
                                       ? fmt::format("network {} is", expected)
                                       : fmt::format("networks {} to {} are", expected, network.number - 1))
                     : fmt::format("network {} follows network {}", network.number, last),
             fmt::format("expected network {}; get the complete page", expected));
  }

  void finish_network() {
    if (open_) {
      LadderNetwork& network = page_.networks.back();
      network.readable = !damaged_;
      if (!damaged_) read_network(rows_, rail_, network, page_.diagnostics);
    } else if (const auto stray = std::ranges::find_if_not(rows_, is_only_wires); stray != rows_.end()) {
      complain(place_of(*stray, first_cell(*stray), 1), "this line of a drawing belongs to no network",
               "expected a rung with its number below it: 1   ├──");
    }
    rows_.clear();
    open_ = false;
  }

  // ---- the frame around SBR: 50 -----------------------------------------------------------------------------------------

  void begin_frame(LadderRow row) {
    finish_network();
    frame_.push_back(std::move(row));
  }

  void add_to_frame(LadderRow row) {
    frame_.push_back(std::move(row));
    if (frame_.size() == kFrameLines) finish_frame();
  }

  void finish_frame() {
    frame_.resize(kFrameLines, frame_.back());
    const LadderRow& middle = frame_[1];
    const std::size_t start = first_cell(middle);
    const std::size_t end = middle.cells.find_last_of(U'│');
    const bool sides = middle.at(start) == U'│' && end != std::u32string::npos && end > start;
    LadderNetwork network;
    network.position = place_of(middle, start, middle.cells.size() - start);
    network.number = page_.networks.empty() ? 1 : page_.networks.back().number + 1;
    const std::string text = sides ? text_of(middle, start + 1, end) : std::string{};
    const std::size_t colon = text.find(':');
    const std::string_view kind = trim(std::string_view(text).substr(0, std::min(colon, text.size())));
    const std::string_view number = colon == std::string::npos ? "" : trim(std::string_view(text).substr(colon + 1));
    const LadderRow& bottom = frame_[2];
    const bool whole = bottom.at(first_cell(bottom)) == U'└' && !kind.empty() && !number.empty();
    if (whole) {
      network.head = LadderElement{
          LadderElement::Kind::Box, std::string(kind), network.position, {{std::string(number), network.position}}, {}};
    } else {
      network.readable = false;
      complain(network.position, "this frame is not the head of a routine or a label",
               "expected three lines: ┌────┐, │ SBR: 50 │ with SBR, INT or LBL, and └──┬─┘");
    }
    open(std::move(network));
    open_ = false;
    frame_.clear();
  }

  // ---- no drawing -------------------------------------------------------------------------------------------------------

  void report_no_drawing() {
    const bool wrong_code_page =
        std::any_of(page_.source.text.begin(), page_.source.text.end(), [](const std::string& line) {
          const std::string_view text = line;
          for (const std::string_view twice : {"â”€â”€", "├ä├ä", "Ã„Ã„", "ΓöÇΓöÇ"})
            if (text.find(twice) != std::string_view::npos) return true;
          return false;
        });
    const Position start = page_.source.text.empty() ? Position{} : Position{1, 1, 1};
    complain(start,
             wrong_code_page ? "the drawings in this document were decoded with the wrong code page"
                             : "there is no ladder drawing in this document",
             wrong_code_page ? "save the original in CP437 or UTF-8: a rung begins with a number, ├ and ─"
                             : "expected rungs of box-drawing characters that begin with a number: 1   ├──┤   ├──");
  }

  LadderPage& page_;
  std::set<std::size_t> rails_;        // columns in which rungs with numbers begin
  std::optional<std::size_t> declared_{};  // the column of the declaration above, which a comment may go on below
  std::vector<std::string> comments_;  // above the drawing that comes next
  std::vector<LadderRow> rows_;        // of the open network
  std::vector<LadderRow> frame_;       // its lines so far
  std::size_t rail_ = 0;
  bool open_ = false;
  bool damaged_ = false;  // the open network has lost a line
  bool listing_ = false;  // the last network goes on with lines of STL
};

}  // namespace

LadderPage read_ladder(std::string_view text, std::string name) {
  LadderPage page;
  page.source.name = std::move(name);
  PageReader(text, page).read();
  return page;
}

}  // namespace s7200::stl

#include "tools/views/ladder/ladder_svg.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/views/escapes.hpp"
#include "tools/views/ladder/ladder_text.hpp"

namespace s7200::tools {
namespace {

// A cell of the grid in user units: a character of the font is 8 wide.
constexpr int kCellWidth = 8, kCellHeight = 18, kMargin = 16, kRail = 56;

constexpr std::string_view kColours = R"(<style>
svg{background:#fff;font:13.33px ui-monospace,"DejaVu Sans Mono",Menlo,Consolas,monospace}
text{fill:#1f2328;white-space:pre}
.wire{stroke:#1f2328;stroke-width:1.5;fill:none;stroke-linecap:round}
.rail{stroke:#1f2328;stroke-width:3}
.box{fill:#eef3fb;stroke:#1f2328;stroke-width:1.5}
.title{font-weight:bold}
.address{fill:#0550ae}
.note{fill:#59636e}
.why{fill:#b35900}
@media(prefers-color-scheme:dark){
svg{background:#0d1117}
text{fill:#e6edf3}
.wire,.rail,.box{stroke:#e6edf3}
.box{fill:#1c2636}
.address{fill:#79c0ff}
.note{fill:#9198a1}
.why{fill:#f0a45d}
}
</style>
)";

std::string escaped(std::string_view text) { return as_markup(stl::printable(std::string(text))); }

int length(std::string_view text) { return static_cast<int>(stl::count_characters(std::string(text))); }

/// Draws from the top of a page downwards.
class Picture {
 public:
  void text(std::string_view line, std::string_view style) {
    add_text(kMargin, top_ + kBaseline, line, style);
    top_ += kCellHeight;
  }
  void gap() { top_ += kCellHeight / 2; }

  void network(const LadderGrid& grid, std::uint32_t number, const std::vector<std::string>& hints) {
    const int bottom = top_ + grid.rows * kCellHeight;
    add_text(kMargin, y_of(grid.first_rung) + kCellHeight / 2 + 5, std::to_string(number), "note");
    body_ += fmt::format("<path class=\"rail\" d=\"M{} {}V{}\"/>\n", kRail, top_, bottom);
    for (const GridWire& wire : grid.wires)
      line(middle_x(wire.column), middle_y(wire.row), middle_x(wire.to_column), middle_y(wire.to_row));
    for (std::size_t i = 0; i < grid.shapes.size(); ++i) shape(grid.shapes[i], hints[i]);
    for (const GridConnector& connector : grid.connectors) cell_text(connector.name, "address");
    top_ = bottom;
  }

  std::string finished() const {
    return fmt::format(
        "{4} xmlns=\"http://www.w3.org/2000/svg\" xml:space=\"preserve\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" "
        "height=\"{1}\">\n{2}{3}</svg>\n",
        width_ + kMargin, top_ + kMargin, kColours, body_, kPictureBegins);
  }

 private:
  static constexpr int kBaseline = 13;

  static int x_of(int column) { return kRail + column * kCellWidth - kCellWidth / 2; }
  static int middle_x(int column) { return kRail + column * kCellWidth; }
  int y_of(int row) const { return top_ + row * kCellHeight; }
  int middle_y(int row) const { return y_of(row) + kCellHeight / 2; }

  void add_text(int x, int y, std::string_view text, std::string_view style) {
    if (text.empty()) return;
    const int width = length(text) * kCellWidth;
    width_ = std::max(width_, x + width);
    body_ += fmt::format("<text x=\"{}\" y=\"{}\" textLength=\"{}\"{}>{}</text>\n", x, y, width,
                         style.empty() ? "" : fmt::format(" class=\"{}\"", style), escaped(text));
  }
  void cell_text(const GridText& text, std::string_view style) {
    add_text(x_of(text.column), y_of(text.row) + kBaseline, text.text, style);
  }

  void line(int x, int y, int to_x, int to_y) {
    width_ = std::max(width_, to_x);
    body_ += fmt::format("<path class=\"wire\" d=\"M{} {}{}\"/>\n", x, y,
                         y == to_y ? fmt::format("H{}", to_x) : fmt::format("V{}", to_y));
  }

  void shape(const GridShape& shape, const std::string& hint) {
    body_ += fmt::format("<g><title>{}</title>\n", escaped(hint));
    switch (shape.kind) {
      case stl::LadderElement::Kind::Contact:
        contact(shape);
        break;
      case stl::LadderElement::Kind::Coil:
        coil(shape);
        break;
      case stl::LadderElement::Kind::Box:
        box(shape);
    }
    for (const GridText& operand : shape.operands) cell_text(operand, "address");
    body_ += "</g>\n";
  }

  void symbol(const GridShape& shape) {
    const int x = middle_x(shape.column) + ((shape.width - 1 - length(shape.symbol)) * kCellWidth) / 2;
    add_text(x, y_of(shape.row) + kBaseline + 1, shape.symbol, "");
  }

  /// Two bars, and what stands between them: nothing, a slash, or letters.
  void contact(const GridShape& shape) {
    const bool narrow = shape.symbol.empty() || shape.symbol == "/";
    const int left = middle_x(shape.column), right = middle_x(shape.column + shape.width - 1), y = middle_y(shape.row);
    const int inset = narrow ? kCellWidth : 0;
    body_ += fmt::format("<path class=\"wire\" d=\"M{0} {1}V{2}M{3} {1}V{2}", left + inset, y - 8, y + 8, right - inset);
    if (narrow) body_ += fmt::format("M{} {}H{}M{} {}H{}", left, y, left + inset, right - inset, y, right);
    if (shape.symbol == "/") body_ += fmt::format("M{} {}L{} {}", left + inset + 2, y + 8, right - inset - 2, y - 8);
    body_ += "\"/>\n";
    if (!narrow) symbol(shape);
  }

  void coil(const GridShape& shape) {
    const int left = middle_x(shape.column), right = middle_x(shape.column + shape.width - 1), y = middle_y(shape.row);
    body_ += fmt::format("<path class=\"wire\" d=\"M{0} {1}Q{2} {3} {0} {4}M{5} {1}Q{6} {3} {5} {4}\"/>\n", left + 6, y - 8,
                         left - 6, y, y + 8, right - 6, right + 6);
    symbol(shape);
  }

  void box(const GridShape& shape) {
    const int left = middle_x(shape.column), right = middle_x(shape.column + shape.width - 1);
    const int top = y_of(shape.row) + 1, bottom = middle_y(shape.row + shape.height - 1);
    body_ += fmt::format("<rect class=\"box\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", left, top, right - left,
                         bottom - top);
    symbol(shape);
    for (const GridPin& pin : shape.pins) {
      cell_text(pin.name, "");
      cell_text(pin.operand, "address");
    }
    width_ = std::max(width_, right);
  }

  std::string body_;
  int top_ = kMargin, width_ = 0;
};

/// What the pointer shows at each element: `line 12: MOVW 1, Speed:VW10 // comment`.
std::vector<std::string> hints_for(const LadderGrid& grid, const std::vector<const stl::Statement*>& statements) {
  std::vector<std::string> hints;
  for (const GridShape& shape : grid.shapes) {
    std::string hint;
    if (shape.op) {
      const stl::Statement& statement = *statements[*shape.op];
      hint = fmt::format("line {}: {}", statement.position.line, statement.mnemonic);
      for (const stl::Operand& operand : statement.operands)
        hint += (&operand == &statement.operands.front() ? " " : ", ") + stl::to_text(operand);
      if (!statement.comment.empty()) hint += fmt::format(" // {}", stl::trim(statement.comment));
    }
    hints.push_back(std::move(hint));
  }
  return hints;
}

void add_lines(Picture& picture, std::string_view text, std::string_view style) {
  const std::string wrapped = stl::wrapped(text, kLadderColumns);
  std::string_view rest = wrapped;
  while (!rest.empty()) picture.text(stl::take_line(rest), style);
}

}  // namespace

std::string ladder_svg(const std::vector<DrawnNetwork>& networks, const stl::Source& program) {
  const auto statements = statements_of(program);
  Picture picture;
  const DrawnNetwork* before = nullptr;
  for (const DrawnNetwork& network : networks) {
    if (!before || !goes_on(network, *before)) add_lines(picture, stl::printable(name_of(network)), "title");
    before = &network;
    for (const std::string& comment : network.ladder.comments)
      add_lines(picture, stl::printable(std::string(stl::trim(comment))), "note");
    if (!network.why_not.empty()) {
      add_lines(picture, why_not_text(network), "why");
      for (std::uint32_t op = network.first; op < network.end; ++op)
        picture.text("    " + stl::printable(stl::to_text(*statements[op])), "");
    } else if (network.ladder.head) {
      const stl::LadderElement& head = *network.ladder.head;
      picture.text(fmt::format("{} {}", head.symbol, head.operands.empty() ? std::string{} : head.operands.front().text),
                   "");
    } else {
      const LadderGrid grid = grid_of(network);
      picture.network(grid, network.ladder.number, hints_for(grid, statements));
    }
    add_lines(picture, other_stl_text(network), "note");
    for (const std::string& line : notes_text(network, program)) picture.text(line, "note");
    picture.gap();
  }
  return picture.finished();
}

}  // namespace s7200::tools

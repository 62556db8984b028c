#include "tools/views/ladder/ladder_grid.hpp"

#include <algorithm>
#include <deque>
#include <utility>

#include "interpreter/base/text/text.hpp"

namespace s7200::tools {
namespace {

using stl::LadderBranch;
using stl::LadderElement;
using stl::LadderPath;
using PathKind = LadderPath::Kind;

constexpr int kConnector = 6;        // columns of `──>A`, with a second letter
constexpr int kCoil = 7;             // of `(     )`
constexpr int kSidesOfRelation = 3;  // how far the operands of a comparison stand over its sides

int length(const std::string& text) { return static_cast<int>(stl::count_characters(text)); }

/// A part of the drawing: its wire comes in at column 0 of row 0 and goes out at its last column.
struct Block {
  int width = 1, above = 0, below = 0;
  std::vector<GridShape> shapes{};
  std::vector<GridWire> wires{};
  std::vector<GridConnector> connectors{};

  void wire(int column, int row, int to_column, int to_row, GridPoint point) {
    if (column != to_column || row != to_row) wires.push_back({column, row, to_column, to_row, point});
  }
  void cover(int rows_above, int rows_below) {
    above = std::max(above, rows_above);
    below = std::max(below, rows_below);
  }
  /// Takes over what is in another block, moved.
  void add(Block other, int column, int row) {
    const auto move = [&](GridText& text) { text.column += column, text.row += row; };
    for (GridShape& shape : other.shapes) {
      shape.column += column, shape.row += row;
      for (GridText& operand : shape.operands) move(operand);
      for (GridPin& pin : shape.pins) move(pin.name), move(pin.operand);
      shapes.push_back(std::move(shape));
    }
    for (GridWire& wire : other.wires)
      wires.push_back({wire.column + column, wire.row + row, wire.to_column + column, wire.to_row + row, wire.point});
    for (GridConnector& connector : other.connectors) {
      move(connector.name);
      connectors.push_back(std::move(connector));
    }
    width = std::max(width, column + other.width);
    cover(other.above - row, other.below + row);
  }
  /// The same after the last column, which both have.
  void append(Block other) { add(std::move(other), width - 1, 0); }
  void lengthen(int to_width, GridPoint point) {
    if (to_width > width) wire(width - 1, 0, to_width - 1, 0, point);
    width = std::max(width, to_width);
  }
};

GridShape shape_of(const LadderElement& element, GridPoint from, GridPoint to) {
  return {.kind = element.kind,
          .symbol = element.symbol,
          .op = element.op,
          .line = element.position.line,
          .from = from,
          .to = to};
}

Block contact_block(const LadderElement& contact, GridPoint from, GridPoint to) {
  const int own = std::max(5, length(contact.symbol) + (contact.operands.size() == 2 ? 4 : 2));
  GridShape shape = shape_of(contact, from, to);
  int left = 0, right = 0;  // columns that operands need on both sides of it
  if (contact.operands.size() == 2) {
    left = std::max(0, length(contact.operands[0].text) - kSidesOfRelation);
    right = std::max(0, length(contact.operands[1].text) - kSidesOfRelation);
  } else if (contact.operands.size() == 1) {
    const int more = std::max(0, length(contact.operands[0].text) - own);
    left = more / 2;
    right = more - left;
  }
  shape.column = 2 + left;
  shape.width = own;
  shape.height = 1;
  const int end = shape.column + own;
  if (contact.operands.size() == 2) {
    const int first = length(contact.operands[0].text);
    shape.operands.push_back({contact.operands[0].text, shape.column + kSidesOfRelation - first, -1});
    shape.operands.push_back({contact.operands[1].text, end - kSidesOfRelation, -1});
  } else if (contact.operands.size() == 1) {
    const int spare = std::max(0, own - length(contact.operands[0].text));
    shape.operands.push_back({contact.operands[0].text, shape.column - left + (spare + 1) / 2, -1});
  }
  Block block{.width = end + right + 2, .above = contact.operands.empty() ? 0 : 1};
  block.wire(0, 0, shape.column, 0, from);
  block.wire(end - 1, 0, block.width - 1, 0, to);
  block.shapes.push_back(std::move(shape));
  return block;
}

Block coil_block(const LadderElement& coil, GridPoint from) {
  GridShape shape = shape_of(coil, from, 0);
  shape.column = 2;
  shape.width = std::max(kCoil, length(coil.symbol) + 2);
  shape.height = 1;
  int end = shape.column;
  for (const stl::LadderText& operand : coil.operands) {
    const bool first = &operand == &coil.operands.front();
    const int spare = std::max(0, shape.width - length(operand.text));
    const int column = first ? shape.column + (spare + 1) / 2 : std::max(end + 1, shape.column + shape.width);
    shape.operands.push_back({operand.text, column, -1});
    end = column + length(operand.text);
  }
  Block block{.width = std::max(shape.column + shape.width, end) + 1, .above = 1};
  block.wire(0, 0, shape.column, 0, from);
  block.shapes.push_back(std::move(shape));
  return block;
}

int widest(const std::vector<GridPin>& pins, bool right, const GridText GridPin::*text) {
  int most = 0;
  for (const GridPin& pin : pins)
    if (pin.right == right) most = std::max(most, length((pin.*text).text));
  return most;
}

/// A box as wide as its names need; its pins for power flow are in the rows `power`, all others below the last of them.
Block box_block(const LadderElement& box, const std::vector<int>& power, GridPoint from, GridPoint eno) {
  GridShape shape = shape_of(box, from, eno);
  for (std::size_t i = 0; i < power.size(); ++i)
    shape.pins.push_back({{i < box.power.size() ? box.power[i] : "EN", 0, power[i]}, {"", 0, power[i]}, false, true});
  if (eno != 0) shape.pins.push_back({{"ENO", 0, 0}, {"", 0, 0}, true, true});
  int left_row = power.back() + 1, right_row = left_row;
  for (const stl::LadderPin& pin : box.pins) {
    const int row = pin.output ? right_row++ : left_row++;
    shape.pins.push_back({{pin.name, 0, row}, {pin.operand.text, 0, row}, pin.output, false});
  }
  const int names = widest(shape.pins, false, &GridPin::name) + 1 + widest(shape.pins, true, &GridPin::name);
  const int above = box.operands.empty() ? 0 : length(box.operands.front().text) + 2;
  shape.width = std::max({names + 2, length(box.symbol) + 3, above});
  shape.column = std::max(2, widest(shape.pins, false, &GridPin::operand) + 1);
  shape.row = -1;
  shape.height = std::max(left_row, right_row) + 2;
  const int right = shape.column + shape.width - 1;
  for (GridPin& pin : shape.pins) {
    pin.name.column = pin.right ? right - length(pin.name.text) : shape.column + 1;
    pin.operand.column = pin.right ? right + 1 : shape.column - length(pin.operand.text);
  }
  if (!box.operands.empty()) shape.operands.push_back({box.operands.front().text, shape.column + 1, -2});
  Block block{.width = right + widest(shape.pins, true, &GridPin::operand) + 3,
              .above = box.operands.empty() ? 1 : 2,
              .below = shape.height - 2};
  block.wire(0, 0, shape.column, 0, from);
  if (eno != 0) block.wire(right, 0, block.width - 1, 0, eno);
  block.shapes.push_back(std::move(shape));
  return block;
}

/// A line of the drawing that is still to be laid out: contacts in series, and what they lead to.
struct DrawnLine {
  std::string begins{};  // the letter of its connector; empty: it begins at the rail
  GridPoint point = 0;
  std::vector<const LadderPath*> parts{};
  const LadderBranch* tail = nullptr;  // what hangs from its end; null: it ends in a connector
  std::string ends{};                  // the letter of that
  GridPoint end = 0;
};

std::vector<const LadderPath*> parts_of(const LadderPath& path) {
  if (path.kind != PathKind::Series) return {&path};
  std::vector<const LadderPath*> parts;
  for (const LadderPath& part : path.parts) parts.push_back(&part);
  return parts;
}

class Layout {
 public:
  explicit Layout(int columns) : columns_(columns) {}

  LadderGrid run(const stl::LadderNetwork& network) {
    for (const LadderBranch& branch : network.rail.branches) {
      lines_.push_back(line_of(branch, 0));
      while (!lines_.empty()) {
        const DrawnLine line = std::move(lines_.front());
        lines_.pop_front();
        lay(line);
      }
    }
    return finished();
  }

 private:
  // ---- lines ----

  void lay(const DrawnLine& line) {
    Block block;
    if (!line.begins.empty()) block = incoming(line.begins, line.point);
    const int start = block.width - 1;
    if (!line.parts.empty() && line.parts.front()->kind == PathKind::Parallel &&
        start + width_of(*line.parts.front()) + kConnector > columns_)
      return split(line);
    block.append(chain(line, start));
    stack(std::move(block));
  }

  /// Contacts side by side that are too wide for the page: each of them is a line, and all end at one point.
  void split(const DrawnLine& line) {
    const std::string letter = next_letter();
    const GridPoint joined = next_point();
    std::deque<DrawnLine> lines;
    for (const LadderPath& part : line.parts.front()->parts)
      lines.push_back({line.begins, line.point, parts_of(part), nullptr, letter, joined});
    lines.push_back({letter, joined, {line.parts.begin() + 1, line.parts.end()}, line.tail, line.ends, line.end});
    lines_.insert(lines_.begin(), lines.begin(), lines.end());
  }

  void stack(Block block) {
    const int row = all_.below + (all_.shapes.empty() && all_.connectors.empty() ? 0 : 1) + block.above;
    if (all_.shapes.empty() && all_.connectors.empty()) first_rung_ = row;
    const int below = row + block.below;
    all_.add(std::move(block), 0, row);
    all_.below = below;
  }

  LadderGrid finished() {
    return {.columns = all_.width,
            .rows = all_.below + 1,
            .first_rung = first_rung_,
            .shapes = std::move(all_.shapes),
            .wires = std::move(all_.wires),
            .connectors = std::move(all_.connectors),
            .points = points_};
  }

  // ---- a way from left to right ----

  /// Contacts in series from column `x` on, and what they lead to. What does not fit goes on in another line. `below`: rows
  /// that what is left of it takes below it.
  Block chain(const DrawnLine& line, int x, int below = 0) {
    Block block;
    GridPoint point = line.point;
    for (std::size_t i = 0; i < line.parts.size(); ++i) {
      const bool last = i + 1 == line.parts.size();
      const int needs =
          width_of(*line.parts[i]) + (last && line.tail ? std::min(kConnector, needs_of(*line.tail)) : kConnector);
      if (i > 0 && x + block.width + needs > columns_) return fold(std::move(block), line, i, point);
      const GridPoint to = last && !line.tail ? line.end : next_point();
      block.append(path(*line.parts[i], point, to));
      point = to;
    }
    if (!line.tail) {
      block.append(outgoing(line.ends, line.parts.empty() ? line.end : point));
      return block;
    }
    if (!line.parts.empty() && x + block.width + needs_of(*line.tail) > columns_)
      return fold(std::move(block), line, line.parts.size(), point);
    block.append(tail(*line.tail, point, x + block.width - 1, std::max(below, block.below)));
    return block;
  }

  Block fold(Block block, const DrawnLine& line, std::size_t from_part, GridPoint point) {
    const std::string letter = next_letter();
    block.append(outgoing(letter, point));
    lines_.push_back({letter,
                      point,
                      {line.parts.begin() + static_cast<std::ptrdiff_t>(from_part), line.parts.end()},
                      line.tail,
                      line.ends,
                      line.end});
    return block;
  }

  Block outgoing(const std::string& letter, GridPoint point) {
    Block block{.width = 4 + length(letter)};
    block.wire(0, 0, 3, 0, point);
    block.connectors.push_back({{">" + letter, 3, 0}, false, point});
    return block;
  }
  Block incoming(const std::string& letter, GridPoint point) {
    Block block{.width = 5 + length(letter)};
    block.wire(2 + length(letter), 0, block.width - 1, 0, point);
    block.connectors.push_back({{letter + ">", 2, 0}, true, point});
    return block;
  }

  // ---- contacts ----

  Block path(const LadderPath& path, GridPoint from, GridPoint to) {
    switch (path.kind) {
      case PathKind::Contact:
        return contact_block(path.contact, from, to);
      case PathKind::Series:
        return series(path, from, to);
      case PathKind::Parallel:
        return parallel(path, from, to);
    }
    return {};
  }

  Block series(const LadderPath& list, GridPoint from, GridPoint to) {
    Block block;
    for (const LadderPath& part : list.parts) {
      const GridPoint next = &part == &list.parts.back() ? to : next_point();
      block.append(path(part, from, next));
      from = next;
    }
    return block;
  }

  Block parallel(const LadderPath& list, GridPoint from, GridPoint to) {
    Block all;
    std::vector<Block> parts;
    int width = 0;
    for (const LadderPath& part : list.parts) width = std::max(width, parts.emplace_back(path(part, from, to)).width);
    int row = 0;
    for (Block& part : parts) {
      part.lengthen(width, to);
      if (&part != &parts.front()) row = all.below + 1 + part.above;
      all.add(std::move(part), 0, row);
    }
    all.wire(0, 0, 0, row, from);
    all.wire(width - 1, 0, width - 1, row, to);
    return all;
  }

  static int width_of(const LadderPath& path) {
    int width = 1;
    switch (path.kind) {
      case PathKind::Contact:
        return contact_block(path.contact, 0, 0).width;
      case PathKind::Series:
        for (const LadderPath& part : path.parts) width += width_of(part) - 1;
        return width;
      case PathKind::Parallel:
        for (const LadderPath& part : path.parts) width = std::max(width, width_of(part));
        return width;
    }
    return width;
  }

  // ---- what hangs from a point ----

  static DrawnLine line_of(const LadderBranch& branch, GridPoint point) {
    DrawnLine line;
    line.point = point;
    line.parts = parts_of(branch.path);
    line.tail = &branch;
    return line;
  }

  /// The fewest columns that what hangs from a point takes, if what comes later goes on in other lines.
  static int needs_of(const LadderBranch& end) {
    if (end.output) {
      const LadderElement& element = *end.output;
      if (element.kind == LadderElement::Kind::Coil) return coil_block(element, 0).width;
      const int width = box_block(element, {0}, 0, end.branches.empty() ? 0 : 1).width;
      return width + (end.branches.empty() ? 0 : needs_of_all(end.branches));
    }
    return needs_of_all(end.branches);
  }
  static int needs_of_all(const std::vector<LadderBranch>& branches) {
    int most = 0;
    for (const LadderBranch& branch : branches) {
      const auto parts = parts_of(branch.path);
      most = std::max(most, parts.empty() ? needs_of(branch) : width_of(*parts.front()) + kConnector);
    }
    return most;
  }

  Block tail(const LadderBranch& end, GridPoint point, int x, int below) {
    return end.output ? output(end, point, x, below) : branches(end.branches, point, x, below);
  }

  /// Branches below each other, their outputs below each other too where they fit.
  Block branches(const std::vector<LadderBranch>& list, GridPoint point, int x, int below) {
    if (list.size() == 1) return chain(line_of(list.front(), point), x, below);
    Block all;
    int row = 0;
    const int outputs = column_of_outputs(list);
    for (const LadderBranch& branch : list) {
      Block block = aligned(branch, point, x, outputs, below - all.below);
      if (&branch != &list.front()) row = all.below + 1 + block.above;
      all.add(std::move(block), 0, row);
    }
    all.wire(0, 0, 0, row, point);
    return all;
  }

  /// The columns in front of what a coil or box has at its left.
  static int lead_of(const LadderElement& output) {
    return output.kind == LadderElement::Kind::Coil ? 2 : box_block(output, {0}, 0, 0).shapes.front().column;
  }

  static int column_of_outputs(const std::vector<LadderBranch>& list) {
    int column = 0;
    for (const LadderBranch& branch : list)
      if (branch.output) column = std::max(column, width_of(branch.path) - 1 + lead_of(*branch.output));
    return column;
  }

  /// A branch whose output stands in a certain column, if it has one and it fits there.
  Block aligned(const LadderBranch& branch, GridPoint point, int x, int column, int below) {
    const DrawnLine line = line_of(branch, point);
    if (!branch.output || !branch.more_inputs.empty()) return chain(line, x, below);
    const int before = column - lead_of(*branch.output);
    if (x + before + needs_of(branch) > columns_) return chain(line, x, below);
    const GridPoint to = line.parts.empty() ? point : next_point();
    Block block = path(branch.path, point, to);
    block.lengthen(before + 1, to);
    block.append(tail(branch, to, x + block.width - 1, std::max(below, block.below)));
    return block;
  }

  Block output(const LadderBranch& end, GridPoint point, int x, int below) {
    const LadderElement& element = *end.output;
    if (element.kind == LadderElement::Kind::Coil) return coil_block(element, point);
    const GridPoint eno = end.branches.empty() ? 0 : next_point();
    Block block = end.more_inputs.empty() ? box_block(element, {0}, point, eno) : box_with_inputs(end, point, x, below);
    if (eno != 0) block.append(branches(end.branches, eno, x + block.width - 1, block.below));
    return block;
  }

  /// A counter: its other inputs are contacts from the rail, below each other.
  Block box_with_inputs(const LadderBranch& end, GridPoint point, int x, int below) {
    std::vector<Block> inputs;
    std::vector<int> rows{0};
    int width = 0;
    for (const LadderPath& more : end.more_inputs) {
      const GridPoint to = next_point();
      Block& input = inputs.emplace_back(input_from_rail(more, to));
      const int before = inputs.size() > 1 ? inputs[inputs.size() - 2].below : std::max(0, below);
      rows.push_back(rows.back() + before + 1 + std::max(1, input.above));
      width = std::max(width, input.width);
    }
    Block box = box_block(*end.output, rows, point, 0);
    const GridShape& shape = box.shapes.front();
    // Wires that lead down from the last input pass what stands at the left of the pins below it.
    const int beside = inputs.back().below > 0 ? inputs.back().width + widest(shape.pins, false, &GridPin::operand) : 0;
    const int shift = std::max(0, std::max(width, beside) - x - shape.column);
    Block block;
    block.lengthen(shift + 1, point);
    block.append(std::move(box));
    const int side = block.shapes.front().column;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const GridPoint to = inputs[i].wires.empty() ? 0 : inputs[i].wires.back().point;
      block.wire(inputs[i].width - 1 - x, rows[i + 1], side, rows[i + 1], to);
      const int keep = block.width;
      block.add(std::move(inputs[i]), -x, rows[i + 1]);
      block.width = keep;
    }
    return block;
  }

  /// Contacts from the rail to an input of a box, or if they are too wide the connector of a line with them.
  Block input_from_rail(const LadderPath& more, GridPoint to) {
    if (width_of(more) + 24 <= columns_) return path(more, 0, to);
    const std::string letter = next_letter();
    DrawnLine line;
    line.parts = parts_of(more);
    line.ends = letter;
    line.end = to;
    lines_.push_back(std::move(line));
    return incoming(letter, to);
  }

  GridPoint next_point() { return points_++; }
  std::string next_letter() {
    std::size_t number = letters_++;
    std::string letter(1, static_cast<char>('A' + number % 26));
    while ((number /= 26) > 0) letter.insert(letter.begin(), static_cast<char>('A' + --number % 26));
    return letter;
  }

  const int columns_;
  std::deque<DrawnLine> lines_;
  Block all_;
  int first_rung_ = 0;
  std::size_t points_ = 1, letters_ = 0;
};

}  // namespace

LadderGrid grid_of(const stl::LadderNetwork& network, int columns) { return Layout(columns).run(network); }

std::vector<bool> powered_points(const LadderGrid& grid, const std::vector<bool>& closed) {
  std::vector<bool> powered(grid.points);
  powered[0] = true;
  std::vector<std::size_t> order(grid.shapes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return grid.shapes[i].op.value_or(0); });
  for (const std::size_t i : order) {
    const GridShape& shape = grid.shapes[i];
    if (shape.to == 0) continue;
    const bool edge = shape.symbol == "P" || shape.symbol == "N";
    const bool passes = shape.symbol == "NOT" ? !powered[shape.from] : closed[i] && (edge || powered[shape.from]);
    if (passes) powered[shape.to] = true;
  }
  return powered;
}

}  // namespace s7200::tools

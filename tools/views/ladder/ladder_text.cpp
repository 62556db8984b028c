#include "tools/views/ladder/ladder_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "interpreter/base/text/joined.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/base/text/wrapped.hpp"
#include "interpreter/program/ladder/ladder_boxes.hpp"
#include "interpreter/stl/block_words.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200::tools {
namespace {

constexpr int kRailColumn = 4;

enum Side : std::uint8_t { kLeft = 1, kRight = 2, kUp = 4, kDown = 8 };

// By the sides to which the wire of a cell leads: left, right, up, down.
constexpr char32_t kSingle[] = U" ───│┘└┴│┐┌┬│┤├┼";
constexpr char32_t kDouble[] = U" ═══║╝╚╩║╗╔╦║╣╠╬";
constexpr char kAscii[] = " ---|+++|+++|+++";
constexpr char kAsciiDouble[] = " ===#+++#+++#+++";

/// The cells of a drawing: wires as sides, everything else as characters.
class Canvas {
 public:
  Canvas(int columns, int rows, bool ascii) : ascii_(ascii) {
    cells_.resize(static_cast<std::size_t>(rows), std::vector<Cell>(static_cast<std::size_t>(columns)));
  }

  void wire(int column, int row, int to_column, int to_row, bool on) {
    const bool across = row == to_row;
    for (int c = column, r = row; c <= to_column && r <= to_row; across ? ++c : ++r) {
      Cell& cell = at(c, r);
      if (across ? c > column : r > row) cell.sides |= across ? kLeft : kUp;
      if (across ? c < to_column : r < to_row) cell.sides |= across ? kRight : kDown;
      cell.on = cell.on || on;
    }
  }

  /// The power rail goes on above and below.
  void rail(bool on) {
    for (std::vector<Cell>& row : cells_) {
      row.front().sides |= kUp | kDown;
      row.front().on = on;
    }
  }

  void text(int column, int row, std::string_view text) {
    for (const stl::Character c : stl::characters(text)) at(column++, row).character = c.code;
  }

  void side(int column, int row, char32_t drawn, char ascii) {
    at(column, row).character = ascii_ ? static_cast<char32_t>(ascii) : drawn;
  }

  std::vector<std::string> lines() const {
    std::vector<std::string> lines;
    for (const std::vector<Cell>& row : cells_) {
      std::string line;
      for (const Cell& cell : row) line += stl::to_utf8(cell.character ? cell.character : wire_of(cell));
      lines.emplace_back(stl::trim_end(line));
    }
    return lines;
  }

 private:
  struct Cell {
    std::uint8_t sides = 0;
    bool on = false;
    char32_t character = 0;
  };

  char32_t wire_of(const Cell& cell) const {
    if (ascii_) return static_cast<char32_t>((cell.on ? kAsciiDouble : kAscii)[cell.sides]);
    return (cell.on ? kDouble : kSingle)[cell.sides];
  }

  Cell& at(int column, int row) {
    std::vector<Cell>& cells = cells_[static_cast<std::size_t>(row)];
    if (static_cast<std::size_t>(column) >= cells.size()) cells.resize(static_cast<std::size_t>(column) + 1);
    return cells[static_cast<std::size_t>(column)];
  }

  bool ascii_;
  std::vector<std::vector<Cell>> cells_;
};

int width_of(const std::string& text) { return static_cast<int>(stl::count_characters(text)); }

/// A text in the middle of so many columns.
std::string centred(const std::string& text, int columns) {
  const int left = (columns - width_of(text)) / 2;
  const int right = columns - width_of(text) - left;
  return std::string(static_cast<std::size_t>(std::max(0, left)), ' ') + text +
         std::string(static_cast<std::size_t>(std::max(0, right)), ' ');
}

void draw_box(const GridShape& box, Canvas& canvas) {
  const int right = box.column + box.width - 1, bottom = box.row + box.height - 1;
  for (int column = box.column; column < right; ++column) canvas.side(column, box.row, U'─', '-');
  canvas.text(box.column, box.row, box.symbol);
  canvas.side(right, box.row, U'┐', '+');
  for (int row = box.row + 1; row < bottom; ++row) {
    canvas.side(box.column, row, U'│', '|');
    canvas.side(right, row, U'│', '|');
  }
  for (int column = box.column + 1; column < right; ++column) canvas.side(column, bottom, U'─', '-');
  canvas.side(box.column, bottom, U'└', '+');
  canvas.side(right, bottom, U'┘', '+');
  for (const GridPin& pin : box.pins) {
    canvas.side(pin.right ? right : box.column, pin.name.row, pin.right ? U'├' : U'┤', '|');
    canvas.text(pin.name.column, pin.name.row, pin.name.text);
    canvas.text(pin.operand.column, pin.operand.row, pin.operand.text);
  }
}

void draw_shape(const GridShape& shape, Canvas& canvas) {
  for (const GridText& operand : shape.operands) canvas.text(operand.column, operand.row, operand.text);
  if (shape.kind == stl::LadderElement::Kind::Box) return draw_box(shape, canvas);
  const bool coil = shape.kind == stl::LadderElement::Kind::Coil;
  canvas.side(shape.column, shape.row, coil ? U'(' : U'┤', coil ? '(' : '[');
  canvas.side(shape.column + shape.width - 1, shape.row, coil ? U')' : U'├', coil ? ')' : ']');
  canvas.text(shape.column + 1, shape.row, centred(shape.symbol, shape.width - 2));
}

std::string head_text(const stl::LadderElement& head, bool ascii) {
  const std::string text =
      fmt::format(" {}: {} ", head.symbol, head.operands.empty() ? std::string{} : head.operands.front().text);
  const int right = width_of(text) + 1;
  Canvas canvas(right + 1, 3, ascii);
  for (const int row : {0, 2}) canvas.wire(0, row, right, row, false);
  for (const int column : {0, right}) canvas.wire(column, 0, column, 2, false);
  canvas.text(1, 1, text);
  canvas.side(kRailColumn, 2, U'┬', '+');
  std::string lines;
  for (const std::string& line : canvas.lines()) lines += line + "\n";
  return lines;
}

/// `VAR_INPUT   level : INT;  // comment`, and what is left of the comment below, each line with a `//` of its own.
std::string declaration_text(const std::string& line) {
  constexpr std::size_t kIndent = 16;
  constexpr std::string_view kMark = "// ";
  const std::string wrapped = stl::wrapped(line + "\n", kLadderColumns - kMark.size(), kIndent);
  std::string_view rest = wrapped;
  std::string text{stl::take_line(rest)};
  while (!rest.empty()) {
    std::string more{stl::take_line(rest)};
    text += "\n" + more.insert(kIndent, kMark);
  }
  return text + "\n";
}

/// The local variables of the routine that a head begins.
std::string declarations_text(const stl::LadderElement& head, const stl::Source& program) {
  const auto block = std::ranges::find_if(program.blocks, [&](const stl::Block& each) {
    return stl::words(each.kind).head == head.symbol && !head.operands.empty() &&
           head.operands.front().text == fmt::format("{}", each.number);
  });
  if (block == program.blocks.end()) return {};
  std::string text;
  for (const stl::Variable& variable : block->variables) {
    const std::string line =
        fmt::format("    {:<10}  {} : {};{}{}", stl::word(variable.kind), variable.name, stl::word(variable.type).name,
                    variable.comment.empty() ? "" : "  // ", stl::trim(variable.comment));
    text += declaration_text(stl::printable(line));
  }
  return text;
}

std::string rows_text(const DrawnNetwork& network, bool ascii, const LadderFlow* flow) {
  const LadderGrid grid = grid_of(network);
  std::string text;
  int row = 0;
  for (const std::string& line : grid_text(grid, ascii, flow)) {
    const std::string number = row++ == grid.first_rung ? fmt::format("{}", network.ladder.number) : std::string{};
    text += fmt::format("{:<{}}{}\n", number, std::max<std::size_t>(kRailColumn, number.size() + 1), line);
  }
  return text;
}

/// What the elements found, each value once.
std::string values_text(const LadderFlow& flow) {
  std::vector<std::string> values;
  for (const std::string& value : flow.values)
    if (!value.empty() && std::ranges::find(values, value) == values.end()) values.push_back(value);
  if (values.empty()) return {};
  return stl::wrapped("    " +
                          stl::joined(
                              values, [](const auto& value) { return value; }, "  ") +
                          "\n",
                      kLadderColumns, 4);
}

std::string listing_text(const DrawnNetwork& network, const std::vector<const stl::Statement*>& statements) {
  std::string text =
      fmt::format("{}{:<4}STL\n", stl::wrapped(why_not_text(network) + "\n", kLadderColumns), network.ladder.number);
  for (std::uint32_t op = network.first; op < network.end; ++op) {
    stl::Statement plain = *statements[op];
    for (stl::Operand& operand : plain.operands) operand.symbol.clear();
    text += fmt::format("    {}\n", stl::to_text(plain));
  }
  return text;
}

}  // namespace

std::vector<const stl::Statement*> statements_of(const stl::Source& program) {
  std::vector<const stl::Statement*> statements;
  for (const stl::Line& line : program.lines)
    if (const auto* statement = std::get_if<stl::Statement>(&line)) statements.push_back(statement);
  return statements;
}

LadderGrid grid_of(const DrawnNetwork& network) { return grid_of(network.ladder, kLadderColumns - kRailColumn); }

std::vector<std::string> grid_text(const LadderGrid& grid, bool ascii, const LadderFlow* flow) {
  Canvas canvas(grid.columns, grid.rows, ascii);
  canvas.rail(flow != nullptr);
  for (const GridWire& wire : grid.wires)
    canvas.wire(wire.column, wire.row, wire.to_column, wire.to_row, flow && flow->points[wire.point]);
  for (const GridShape& shape : grid.shapes) draw_shape(shape, canvas);
  for (const GridConnector& connector : grid.connectors)
    canvas.text(connector.name.column, connector.name.row, connector.name.text);
  return canvas.lines();
}

std::vector<LadderNote> notes_on(const DrawnNetwork& network, const stl::Source& program) {
  const auto statements = statements_of(program);
  std::map<std::string, std::string> comments;
  for (const stl::Symbol& symbol : program.symbols) comments.emplace(symbol.name, symbol.comment);
  std::vector<LadderNote> notes;
  const auto known = [&](const std::string& text) {
    return std::ranges::find(notes, text, &LadderNote::text) != notes.end();
  };
  for (std::uint32_t op = network.first; op < network.end; ++op)
    for (const stl::Operand& operand : statements[op]->operands) {
      if (operand.symbol.empty()) continue;
      const std::string address = operand_in_ladder(operand).text;
      const auto comment = comments.find(operand.symbol);
      if (!known(address))
        notes.push_back({address, operand.symbol, comment == comments.end() ? std::string{} : comment->second});
    }
  for (std::uint32_t op = network.first; op < network.end; ++op) {
    if (statements[op]->comment.empty()) continue;
    stl::Statement plain = *statements[op];
    for (stl::Operand& operand : plain.operands) operand.symbol.clear();
    std::string text = plain.mnemonic;
    for (const stl::Operand& operand : plain.operands)
      text += (&operand == &plain.operands.front() ? " " : ", ") + stl::to_text(operand);
    notes.push_back({std::move(text), {}, statements[op]->comment});
  }
  return notes;
}

std::string name_of(const DrawnNetwork& network) {
  const std::string_view title = stl::trim(network.title);
  return fmt::format("{}, network {}{}{}", network.routine, network.ladder.number, title.empty() ? "" : ": ", title);
}

bool goes_on(const DrawnNetwork& network, const DrawnNetwork& head) {
  return head.ladder.head && network.routine == head.routine && network.ladder.number == head.ladder.number &&
         network.title.empty();
}

std::string ladder_text(const std::vector<DrawnNetwork>& networks, const stl::Source& program, bool ascii) {
  std::string text;
  const DrawnNetwork* before = nullptr;
  for (const DrawnNetwork& network : networks) {
    std::string one = network_text(network, program, ascii) + "\n";
    if (before && goes_on(network, *before)) one.erase(0, one.find('\n') + 1);
    text += one;
    before = &network;
  }
  return text;
}

std::string network_text(const DrawnNetwork& network, const stl::Source& program, bool ascii, const LadderFlow* flow) {
  std::string text = stl::printable(name_of(network)) + "\n";
  for (const std::string& comment : network.ladder.comments)
    text += stl::printable(fmt::format("// {}", stl::trim(comment))) + "\n";
  if (!network.why_not.empty()) return text + listing_text(network, statements_of(program));
  text += network.ladder.head ? head_text(*network.ladder.head, ascii) + declarations_text(*network.ladder.head, program)
                              : rows_text(network, ascii, flow);
  if (flow) text += values_text(*flow);
  if (!network.other_stl.empty()) text += stl::wrapped("    " + other_stl_text(network) + "\n", kLadderColumns);
  for (const std::string& line : notes_text(network, program)) text += line + "\n";
  return text;
}

std::string other_stl_text(const DrawnNetwork& network) {
  return network.other_stl.empty() ? std::string{}
                                   : stl::printable("drawn, it is the same with other instructions: " +
                                                    stl::joined(
                                                        network.other_stl, [](const auto& each) { return each; }, "; "));
}

std::string why_not_text(const DrawnNetwork& network) {
  return stl::printable(fmt::format("network is not representable in ladder: {}", network.why_not));
}

std::vector<std::string> notes_text(const DrawnNetwork& network, const stl::Source& program) {
  const std::vector<LadderNote> notes = notes_on(network, program);
  std::size_t widest = 0, symbol = 0;
  for (const LadderNote& note : notes) {
    widest = std::max(widest, stl::count_characters(note.text));
    symbol = std::max(symbol, note.symbol.empty() ? 0 : stl::count_characters(note.symbol) + 2);
  }
  std::vector<std::string> lines;
  for (const LadderNote& note : notes) {
    const std::string line = fmt::format("    {:<{}}  {:<{}}{}{}", note.text, widest, note.symbol, symbol,
                                         note.comment.empty() ? "" : "// ", stl::trim(note.comment));
    std::string wrapped =
        stl::wrapped(stl::printable(std::string(stl::trim_end(line))), kLadderColumns, widest + symbol + 6);
    std::string_view rest = wrapped;
    while (!rest.empty()) lines.emplace_back(stl::take_line(rest));
  }
  return lines;
}

std::string undrawn_text(const std::vector<DrawnNetwork>& networks, const stl::Source& program) {
  const auto statements = statements_of(program);
  std::string text;
  for (const DrawnNetwork& network : networks)
    if (!network.why_not.empty())
      text += stl::printable(fmt::format("{}, network {}, line {}: {}", network.routine, network.ladder.number,
                                         statements[network.why_not_op]->position.line, network.why_not)) +
              "\n";
  return text;
}

}  // namespace s7200::tools

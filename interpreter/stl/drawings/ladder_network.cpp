#include "interpreter/stl/drawings/ladder_network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "interpreter/base/text/counted.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/stl/drawings/ladder_graph.hpp"

namespace s7200::stl {

namespace {

// Drawings fit on a screen of 80 columns. These limits only keep other texts from being read as drawings.
constexpr std::size_t kWidestContact = 16;
constexpr std::size_t kWidestBox = 32;
constexpr std::size_t kMostContacts = 256;

/// The greatest distance between an element and the begin or end of its operand.
constexpr std::size_t kNear = 3;
constexpr std::size_t kFar = 10;

bool is_relation(std::string_view symbol) { return symbol.find_first_of("<>=") != std::string_view::npos; }

/// The number of operands above a contact: NOT and the edges have none, a comparison has one on each side.
std::size_t operands_above(std::string_view symbol) {
  if (is_relation(symbol)) return 2;
  return symbol == "NOT" || symbol == "P" || symbol == "N" ? 0 : 1;
}

bool is_name_cell(char32_t cell) {
  return cell < 0x80 && (is_letter(static_cast<char>(cell)) || is_digit(static_cast<char>(cell)) ||
                         std::string_view("_+-*/<>=").find(static_cast<char>(cell)) != std::string_view::npos);
}

struct Span {
  std::size_t row = 0, from = 0, to = 0;  // columns from `from` until before `to`
};

class NetworkReader {
 public:
  NetworkReader(std::span<const LadderRow> rows, std::size_t rail, LadderNetwork& network, Diagnostics& diagnostics)
      : rows_(rows), rail_(rail), network_(network), diagnostics_(diagnostics) {
    std::size_t cells = 0;
    for (const LadderRow& row : rows) {
      offsets_.push_back(cells);
      cells += row.cells.size();
      sides_.emplace_back();
      for (const char32_t cell : row.cells) sides_.back().push_back(wire_sides(cell));
      taken_.emplace_back(row.cells.size());
    }
    points_.resize(cells);
    std::iota(points_.begin(), points_.end(), std::size_t{0});
  }

  void read() {
    find_boxes();
    find_contacts();
    find_coils();
    find_connectors();
    if (contacts_ > kMostContacts) {
      complain(network_.position, "this network has too many contacts", "a network has at most 256");
      return;
    }
    std::stable_sort(elements_.begin(), elements_.end(), [](const Placed& a, const Placed& b) {
      return std::pair(a.span.row, a.span.from) < std::pair(b.span.row, b.span.from);
    });
    claim_operands();
    if (network_.readable) join_wires();   // what is damaged has loose ends
    if (network_.readable) find_strays();  // and leaves its operands over
    if (!network_.readable) return;
    network_.rail = branches_of(graph(), [this](const Position& at, std::string message, std::string hint) {
      complain(at, std::move(message), std::move(hint));
    });
    if (network_.readable && network_.rail.branches.empty())
      complain(network_.position, "this network has no coil and no box", "expected a wire from the power rail to one");
  }

 private:
  struct Placed {
    LadderElement element;
    Span span;                // a contact, a coil, or the upper edge of a box
    std::vector<Span> power;  // left sides of the pins of a box that take power flow
    const LadderRow* row = nullptr;
    std::optional<Span> eno{};  // right side of the pin of a box that is wired there
  };

  // ---- cells ------------------------------------------------------------------------------------------------------------

  bool exists(std::size_t row, std::size_t column) const { return row < rows_.size() && column < sides_[row].size(); }
  std::uint8_t sides(std::size_t row, std::size_t column) const { return exists(row, column) ? sides_[row][column] : 0; }
  void take(std::size_t row, std::size_t from, std::size_t to, std::uint8_t left = 0, std::uint8_t right = 0) {
    for (std::size_t column = from; column < to && exists(row, column); ++column) {
      sides_[row][column] = column == from ? left : column + 1 == to ? right : std::uint8_t{0};
      taken_[row][column] = true;
    }
  }
  bool is_text(std::size_t row, std::size_t column) const {
    return exists(row, column) && sides_[row][column] == 0 && !taken_[row][column] &&
           !is_blank_cell(rows_[row].cells[column]);
  }
  LadderText text_at(const Span& span) const {
    return {text_of(rows_[span.row], span.from, span.to), place_of(rows_[span.row], span.from, span.to - span.from)};
  }

  void complain(const Position& at, std::string message, std::string hint) {
    network_.readable = false;
    diagnostics_.push_back({Severity::Error, at, fmt::format("network {}: {}", network_.number, message), std::move(hint),
                            fmt::format("drawing of network {} in line {}", network_.number, network_.position.line)});
  }
  void complain(std::size_t row, std::size_t column, std::size_t length, std::string message, std::string hint) {
    complain(place_of(rows_[row], column, length), std::move(message), std::move(hint));
  }

  // ---- boxes ------------------------------------------------------------------------------------------------------------

  /// The upper edge of a box begins with its name: `MOV_W───┐`.
  void find_boxes() {
    for (std::size_t row = 0; row < rows_.size(); ++row)
      for (std::size_t column = 0; column < sides_[row].size(); ++column)
        if (sides(row, column) == (kLeft | kDown)) box_with_corner(row, column);
  }

  void box_with_corner(std::size_t row, std::size_t corner) {
    std::size_t name_end = corner;
    while (name_end > 0 && corner - name_end < kWidestBox && sides(row, name_end - 1) == (kLeft | kRight)) --name_end;
    std::size_t left = name_end;
    while (left > 0 && corner - left < kWidestBox && is_name_cell(rows_[row].cells[left - 1])) --left;
    if (left == name_end) return;  // a wire that turns
    Placed box{{LadderElement::Kind::Box, text_of(rows_[row], left, name_end), place_of(rows_[row], left, name_end - left)},
               {row, left, corner + 1},
               {},
               &rows_[row]};
    take(row, left, corner + 1);
    for (std::size_t below = row + 1;; ++below) {
      const std::uint8_t side = sides(below, left);
      if (side == (kUp | kRight)) {
        take(below, left, corner + 1);
        break;
      }
      if (!(side & kUp) || !(side & kDown)) {
        complain(std::min(below, rows_.size() - 1), left, corner + 1 - left,
                 fmt::format("the left side or the lower edge of the box {} is missing here", shortened(box.element.symbol)),
                 "expected │, ┤ or └ below the first letter of its name");
        return;
      }
      read_pins(box, below, left, corner);
    }
    if (box.power.empty())
      complain(box.element.position, fmt::format("no wire leads to the box {}", shortened(box.element.symbol)),
               "expected a wire to its pin EN");
    elements_.push_back(std::move(box));
  }

  /// A row between the edges of a box: `K5┤IN   OUT├VW0`.
  void read_pins(Placed& box, std::size_t row, std::size_t left, std::size_t right) {
    const bool pin_left = (sides(row, left) & kLeft) != 0;
    const std::uint8_t right_side = sides(row, right);
    const bool whole = (right_side & kUp) && (right_side & kDown);
    auto names = split_words(text_of(rows_[row], left + 1, whole ? right : row_end(row)));
    const bool power = pin_left && (sides(row, left - 1) & kRight);
    const bool eno = whole && (sides(row, right + 1) & kLeft) != 0 && !names.empty() && names.back() == "ENO";
    take(row, left, right + 1, power ? kLeft : 0, eno ? kRight : 0);
    if (!whole && !restore_right_side(box, names, pin_left, row, left, right)) return;
    const bool pin_right = whole && (right_side & kRight);
    if (names.size() != std::size_t{pin_left} + std::size_t{pin_right})
      return complain(
          row, left, right + 1 - left,
          fmt::format("the box {} has {} here, and {} at its sides", shortened(box.element.symbol),
                      counted(names.size(), "name"), counted(std::size_t{pin_left} + std::size_t{pin_right}, "pin")),
          "expected a name beside each ┤ and ├ of the box, and none elsewhere");
    if (power) {
      box.power.push_back({row, left, left + 1});
      box.element.power.push_back(names.front());
    } else if (pin_left) {
      add_pin(box, names.front(), false, word_before(row, left), row, left);
    }
    if (eno)
      box.eno = Span{row, right, right + 1};
    else if (pin_right)
      add_pin(box, names.back(), true, word_after(row, right), row, right);
  }

  /// Micro/DOS wrote `IN OUT *VD3570` where the operand was too long for the line: a blank and the right side are missing.
  bool restore_right_side(Placed& box, std::vector<std::string>& names, bool pin_left, std::size_t row, std::size_t left,
                          std::size_t right) {
    const std::size_t expected = pin_left ? 3 : 2;
    const std::string& symbol = box.element.symbol;
    if (names.size() != expected) {
      complain(row, left, right + 1 - left, fmt::format("the right side of the box {} is missing here", shortened(symbol)),
               fmt::format("expected │ or ├ below the right end of its upper edge"));
      return false;
    }
    const Position at = place_of(rows_[row], left, row_end(row) - left);
    take(row, right + 1, row_end(row));
    diagnostics_.push_back(
        {Severity::Warning, at,
         fmt::format("network {}: the right side of the box {} is missing here; read as {} = {}", network_.number,
                     shortened(symbol), shortened(names[expected - 2]), shortened(names[expected - 1]))});
    box.element.pins.push_back({names[expected - 2], {names[expected - 1], at}, true});
    names.resize(expected - 2);
    return true;
  }

  std::size_t row_end(std::size_t row) const {
    std::size_t end = rows_[row].cells.size();
    while (end > 0 && is_blank_cell(rows_[row].cells[end - 1])) --end;
    return end;
  }

  void add_pin(Placed& box, const std::string& name, bool output, const Span& operand, std::size_t row, std::size_t side) {
    if (operand.from == operand.to) {
      const bool wired = sides(row, output ? side + 1 : side - 1) != 0;
      return complain(
          row, side, 1,
          fmt::format("the pin {} of the box {} has {}", shortened(name), shortened(box.element.symbol),
                      wired ? "a wire, which is not supported" : "no operand"),
          wired ? "draw what follows on a branch of its own: S7-Micro/DOS has no ENO"
                : fmt::format("expected an operand directly {} {}", output ? "after" : "before", output ? "├" : "┤"));
    }
    box.element.pins.push_back({name, text_at(operand), output});
    take(row, operand.from, operand.to);
  }

  /// Blanks between quotes belong to the word: 'A B'.
  bool is_quote(std::size_t row, std::size_t column) const {
    return is_text(row, column) && (rows_[row].cells[column] == U'\'' || rows_[row].cells[column] == U'"');
  }
  /// The other quote of a constant, `step` to the right or to the left; the same place if there is none.
  std::size_t other_quote(std::size_t row, std::size_t column, std::size_t step) const {
    const std::u32string& cells = rows_[row].cells;
    for (std::size_t at = column + step; at < cells.size(); at += step)
      if (cells[at] == cells[column] && (at == 0 || cells[at - 1] != U'$') && !taken_[row][at]) return at;
    return column;
  }

  Span word_before(std::size_t row, std::size_t column) const {
    std::size_t from = column;
    if (from > 0 && is_quote(row, from - 1)) from = other_quote(row, from - 1, SIZE_MAX);
    while (from > 0 && is_text(row, from - 1)) --from;
    return {row, from, column};
  }
  Span word_after(std::size_t row, std::size_t column) const { return word_from(row, column + 1); }
  Span word_from(std::size_t row, std::size_t from) const {
    std::size_t to = from;
    if (is_quote(row, from)) to = other_quote(row, from, 1);
    while (is_text(row, to)) ++to;
    return {row, from, to};
  }

  // ---- lines that go on elsewhere ---------------------------------------------------------------------------------------

  /// Finds `──>A`, where a line ends, and `A>──`, where it goes on.
  void find_connectors() {
    for (std::size_t row = 0; row < rows_.size(); ++row)
      for (std::size_t column = 1; column < sides_[row].size(); ++column) {
        if (rows_[row].cells[column] != U'>' || !is_text(row, column)) continue;
        const Span after = word_after(row, column), before = word_before(row, column);
        const bool ends = (sides(row, column - 1) & kRight) != 0 && after.from < after.to;
        const bool begins = (sides(row, column + 1) & kLeft) != 0 && before.from < before.to;
        if (ends) connect(after, {row, column, after.to}, kLeft, 0);
        if (begins) connect(before, {row, before.from, column + 1}, 0, kRight);
      }
  }

  void connect(const Span& name, const Span& whole, std::uint8_t left, std::uint8_t right) {
    const std::size_t wire = index(whole.row, left != 0 ? whole.from : whole.to - 1);
    connectors_.push_back({text_at(name), wire, left != 0});
    take(whole.row, whole.from, whole.to, left, right);
  }

  /// Joins the ends of lines with the same name; complains of one that goes on nowhere.
  void join_connectors() {
    for (const Connector& one : connectors_) {
      bool goes_on = false;
      for (const Connector& other : connectors_) {
        if (one.name.text != other.name.text || one.ends == other.ends) continue;
        goes_on = true;
        join(one.wire, other.wire);
      }
      if (!goes_on)
        complain(one.name.position,
                 fmt::format("the line that {} {} {} nowhere", one.ends ? "ends in" : "begins with",
                             shortened(one.name.text), one.ends ? "goes on" : "begins"),
                 "expected >A at the end of a line and A> where it goes on");
    }
  }

  // ---- contacts and coils -----------------------------------------------------------------------------------------------

  /// Finds contacts, `┤   ├`. The ┤ of a wire has a wire above or below it.
  void find_contacts() {
    for (std::size_t row = 0; row < rows_.size(); ++row)
      for (std::size_t column = 0; column < sides_[row].size(); ++column)
        if (sides(row, column) == (kLeft | kUp | kDown) && column != rail_ && !has_wire_beside(row, column))
          contact_at(row, column);
  }

  bool has_wire_beside(std::size_t row, std::size_t column) const {
    return (row > 0 && (sides(row - 1, column) & kDown)) || (sides(row + 1, column) & kUp);
  }

  void contact_at(std::size_t row, std::size_t left) {
    std::size_t right = left + 1;
    while (right - left < kWidestContact && exists(row, right) && sides(row, right) == 0) ++right;
    if (sides(row, right) != (kRight | kUp | kDown))
      return complain(row, left, 1, "this contact has no right side",
                      "expected ├ after its symbol: ┤   ├, ┤ / ├, ┤NOT├, ┤ == W ├");
    LadderElement contact{LadderElement::Kind::Contact, text_of(rows_[row], left + 1, right),
                          place_of(rows_[row], left, right + 1 - left)};
    take(row, left, right + 1, kLeft, kRight);
    elements_.push_back({std::move(contact), {row, left, right + 1}, {}, &rows_[row]});
    ++contacts_;
  }

  /// Finds coils: `─( CALL )`
  void find_coils() {
    for (std::size_t row = 0; row < rows_.size(); ++row)
      for (std::size_t column = 1; column < sides_[row].size(); ++column)
        if (rows_[row].cells[column] == U'(' && !taken_[row][column] && (sides(row, column - 1) & kRight))
          coil_at(row, column);
  }

  void coil_at(std::size_t row, std::size_t left) {
    std::size_t right = left + 1;
    while (right - left < kWidestContact && exists(row, right) && rows_[row].cells[right] != U')') ++right;
    if (rows_[row].at(right) != U')')
      return complain(row, left, 1, "this coil has no right bracket", "expected ) after its symbol: (   ), ( S ), ( CALL )");
    LadderElement coil{LadderElement::Kind::Coil, text_of(rows_[row], left + 1, right),
                       place_of(rows_[row], left, right + 1 - left)};
    take(row, left, right + 1, kLeft);
    elements_.push_back({std::move(coil), {row, left, right + 1}, {}, &rows_[row]});
  }

  // ---- what stands above them -------------------------------------------------------------------------------------------

  /// Gives the words of each row to the elements in the row below, both from left to right.
  void claim_operands() {
    std::size_t row = SIZE_MAX, column = 0;
    for (Placed& placed : elements_) {
      if (placed.span.row != row) column = 0;
      row = placed.span.row;
      const std::size_t from = placed.span.from, to = placed.span.to;
      const auto before = [&](std::size_t distance) { return from - std::min(from, distance); };
      switch (placed.element.kind) {
        case LadderElement::Kind::Contact:
          if (operands_above(placed.element.symbol) == 1) claim(placed, column, before(kNear), to + kNear, false);
          if (operands_above(placed.element.symbol) == 2) {
            claim(placed, column, before(kFar), from + kNear, false);
            claim(placed, column, to - kNear, to + kFar, false);
          }
          break;
        case LadderElement::Kind::Coil:
          claim(placed, column, before(kNear), to + kNear, true);
          claim(placed, column, to, to + kFar, true);
          break;
        case LadderElement::Kind::Box:
          claim(placed, column, from, to, true);
          break;
      }
    }
  }

  /// The next word above an element that begins before column `to` and ends after `from`.
  void claim(Placed& placed, std::size_t& column, std::size_t from, std::size_t to, bool optional) {
    const bool first_row = placed.span.row == 0;
    const std::size_t above = first_row ? 0 : placed.span.row - 1;
    const std::size_t end = first_row ? 0 : sides_[above].size();
    while (column < end && (!is_text(above, column) || word_from(above, column).to <= from)) ++column;
    if (column < std::min(end, to)) {
      const Span word{above, column, word_from(above, column).to};
      placed.element.operands.push_back(text_at(word));
      take(above, word.from, word.to);
      column = word.to;
    } else if (!optional) {
      complain(placed.element.position, "this contact has no operand",
               is_relation(placed.element.symbol) ? "expected one on each side in the line above it"
                                                  : "expected it in the line above it");
    }
  }

  void find_strays() {
    for (std::size_t row = 0; row < rows_.size(); ++row)
      for (std::size_t column = rail_ + 1; column < sides_[row].size(); ++column)
        if (is_text(row, column)) {
          const Span word = word_from(row, column);
          complain(row, word.from, word.to - word.from,
                   fmt::format("'{}' does not belong to anything", shortened(text_at(word).text)),
                   "expected wires, contacts, coils and boxes here; an operand stands above its contact or coil, or beside "
                   "its pin");
          return;
        }
  }

  // ---- wires ------------------------------------------------------------------------------------------------------------

  std::size_t index(std::size_t row, std::size_t column) const { return offsets_[row] + column; }
  std::size_t point(std::size_t cell) {
    while (points_[cell] != cell) cell = points_[cell] = points_[points_[cell]];
    return cell;
  }
  void join(std::size_t a, std::size_t b) { points_[point(a)] = point(b); }

  void join_wires() {
    std::size_t rail = SIZE_MAX;
    for (std::size_t row = 0; row < rows_.size(); ++row)
      for (std::size_t column = rail_; column < sides_[row].size(); ++column) {
        if (sides_[row][column] == 0) continue;
        const std::size_t here = index(row, column);
        if (column == rail_) rail = rail == SIZE_MAX ? here : (join(here, rail), rail);
        if (leads(row, column, kRight, row, column + 1, kLeft)) join(here, index(row, column + 1));
        if (leads(row, column, kDown, row + 1, column, kUp)) join(here, index(row + 1, column));
        if (column == rail_) continue;
        leads(row, column, kLeft, row, column - 1, kRight);
        leads(row, column, kUp, row - 1, column, kDown);
      }
    rail_point_ = rail;
    join_connectors();
  }

  /// Whether a wire goes on in the cell beside it; complains of one that ends in nothing.
  bool leads(std::size_t row, std::size_t column, WireSide side, std::size_t other_row, std::size_t other_column,
             WireSide other_side) {
    if (!(sides_[row][column] & side)) return false;
    if (sides(other_row, other_column) & other_side) return true;
    if (column == rail_ && (side & (kUp | kDown))) return false;
    if (complained_of_wire_) return false;
    complained_of_wire_ = true;
    const char* direction = side == kLeft    ? "to the left"
                            : side == kRight ? "to the right"
                            : side == kUp    ? "upwards"
                                             : "downwards";
    complain(row, column, 1, fmt::format("the wire or contact leads {} into nothing here", direction),
             "expected the next part of the wire, a contact, a coil or a box there");
    return false;
  }

  LadderGraph graph() {
    LadderGraph graph;
    std::vector<std::size_t> numbers(points_.size(), SIZE_MAX);
    if (rail_point_ != SIZE_MAX) numbers[point(rail_point_)] = 0;
    const auto number = [&](std::size_t row, std::size_t column) {
      std::size_t& known = numbers[point(index(row, column))];
      if (known == SIZE_MAX) known = graph.points++;
      return known;
    };
    for (Placed& placed : elements_) {
      const auto [row, from, to] = placed.span;
      std::vector<std::size_t> inputs;
      switch (placed.element.kind) {
        case LadderElement::Kind::Contact:
          graph.contacts.push_back({number(row, from), number(row, to - 1), std::move(placed.element)});
          continue;
        case LadderElement::Kind::Coil:
          inputs.push_back(number(row, from));
          break;
        case LadderElement::Kind::Box:
          for (const Span& pin : placed.power) inputs.push_back(number(pin.row, pin.from));
      }
      std::optional<std::size_t> eno;
      if (placed.eno) eno = number(placed.eno->row, placed.eno->from);
      graph.outputs.push_back({std::move(inputs), std::move(placed.element), eno});
    }
    return graph;
  }

  std::span<const LadderRow> rows_;
  const std::size_t rail_;
  LadderNetwork& network_;
  Diagnostics& diagnostics_;
  std::vector<std::size_t> offsets_;              // by row: the index of its first cell
  std::vector<std::vector<std::uint8_t>> sides_;  // by row and column: of wires, and where they meet an element
  std::vector<std::vector<bool>> taken_;          // by row and column: part of an element or an operand
  std::vector<std::size_t> points_;               // by index: a cell that is wired to it, or itself
  struct Connector {
    LadderText name;
    std::size_t wire;  // index of the cell in which its line ends or begins
    bool ends;
  };

  std::vector<Connector> connectors_;
  std::vector<Placed> elements_;
  std::size_t contacts_ = 0;
  std::size_t rail_point_ = SIZE_MAX;
  bool complained_of_wire_ = false;
};

}  // namespace

std::uint8_t wire_sides(char32_t c) {
  switch (c) {
    case U'│':
    case U'║':
      return kUp | kDown;
    case U'─':
    case U'═':
      return kLeft | kRight;
    case U'┌':
    case U'╔':
    case U'╒':
    case U'╓':
      return kRight | kDown;
    case U'┐':
    case U'╗':
    case U'╕':
    case U'╖':
      return kLeft | kDown;
    case U'└':
    case U'╚':
    case U'╘':
    case U'╙':
      return kRight | kUp;
    case U'┘':
    case U'╝':
    case U'╛':
    case U'╜':
      return kLeft | kUp;
    case U'├':
    case U'╠':
    case U'╞':
    case U'╟':
      return kRight | kUp | kDown;
    case U'┤':
    case U'╣':
    case U'╡':
    case U'╢':
      return kLeft | kUp | kDown;
    case U'┬':
    case U'╦':
    case U'╤':
    case U'╥':
      return kLeft | kRight | kDown;
    case U'┴':
    case U'╩':
    case U'╧':
    case U'╨':
      return kLeft | kRight | kUp;
    case U'┼':
    case U'╬':
    case U'╪':
    case U'╫':
      return kLeft | kRight | kUp | kDown;
    default:
      return 0;
  }
}

std::string text_of(const LadderRow& row, std::size_t from, std::size_t to) {
  to = std::min(to, row.cells.size());
  while (from < to && is_blank_cell(row.cells[from])) ++from;
  while (to > from && is_blank_cell(row.cells[to - 1])) --to;
  std::string text;
  for (; from < to; ++from) text += to_utf8(row.cells[from]);
  return text;
}

Position place_of(const LadderRow& row, std::size_t from, std::size_t length) {
  const std::uint32_t column = from < row.columns.size() ? row.columns[from]
                               : row.columns.empty()     ? 1
                                                         : row.columns.back() + 1;
  return {row.line, column, static_cast<std::uint32_t>(length)};
}

void read_network(std::span<const LadderRow> rows, std::size_t rail, LadderNetwork& network, Diagnostics& diagnostics) {
  NetworkReader(rows, rail, network, diagnostics).read();
  if (!network.readable) network.rail = {};
}

}  // namespace s7200::stl

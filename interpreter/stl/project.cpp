#include "interpreter/stl/project.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace s7200::stl {

namespace {

/// Moves all places of a file down by a number of lines.
class Shift {
 public:
  explicit Shift(std::uint32_t lines) : lines_(lines) {}

  void operator()(Position& position) const {
    if (position.line != 0) position.line += lines_;
  }
  void operator()(Operand& operand) const { (*this)(operand.position); }
  void operator()(Statement& statement) const {
    (*this)(statement.position);
    for (Operand& operand : statement.operands) (*this)(operand);
  }
  void operator()(NetworkHead& head) const { (*this)(head.position); }
  void operator()(CommentLine& comment) const { comment.line += lines_; }
  void operator()(BlankLine& blank) const { blank.line += lines_; }
  void operator()(Line& line) const { std::visit(*this, line); }
  void operator()(Block& block) const {
    (*this)(block.position);
    block.last_line += lines_;
    for (Variable& variable : block.variables) (*this)(variable.position);
  }
  void operator()(Symbol& symbol) const { (*this)(symbol.position); }
  void operator()(DataLine& data) const {
    (*this)(data.position);
    if (data.address) (*this)(*data.address);
    for (DataLine::Value& value : data.values) (*this)(value.position);
  }
  void operator()(Section& section) const { section.first_line += lines_; }
  void operator()(FurtherFile& file) const { file.first_line += lines_; }
  void operator()(Diagnostic& diagnostic) const { (*this)(diagnostic.position); }
  void operator()(std::uint32_t& line) const { line += lines_; }

 private:
  std::uint32_t lines_;
};

template <typename Item>
void move_to(std::vector<Item>& to, std::vector<Item>& from, const Shift& shift) {
  for (Item& item : from) shift(item);
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

bool has_main_program(const Source& source) {
  return std::ranges::find(source.blocks, Block::Kind::Main, &Block::kind) != source.blocks.end();
}

}  // namespace

void append(ParseResult& source, ParseResult file) {
  source.notes.insert(source.notes.end(), std::make_move_iterator(file.notes.begin()),
                      std::make_move_iterator(file.notes.end()));
  Source &to = source.source, &from = file.source;
  const auto lines_before = static_cast<std::uint32_t>(to.text.size());
  const Shift shift(lines_before);
  to.further_files.push_back({lines_before + 1, std::move(from.name)});
  if (!to.sections.empty()) to.sections.push_back({lines_before + 1, ""});
  to.text.insert(to.text.end(), std::make_move_iterator(from.text.begin()), std::make_move_iterator(from.text.end()));
  move_to(to.further_files, from.further_files, shift);
  move_to(to.sections, from.sections, shift);
  const auto lines_of_to = static_cast<std::ptrdiff_t>(to.lines.size());
  const bool main_is_new = has_main_program(from) && !has_main_program(to);
  move_to(to.lines, from.lines, shift);
  if (main_is_new) std::rotate(to.lines.begin(), to.lines.begin() + lines_of_to, to.lines.end());
  move_to(to.blocks, from.blocks, shift);
  move_to(to.symbols, from.symbols, shift);
  move_to(to.data, from.data, shift);
  move_to(source.diagnostics, file.diagnostics, shift);
  move_to(source.left_out, file.left_out, shift);
}

}  // namespace s7200::stl

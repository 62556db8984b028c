#include "interpreter/stl/text/places.hpp"

#include <variant>

namespace s7200::stl {
namespace {

class Mover {
 public:
  explicit Mover(const std::function<void(Position&)>& move) : move_(move) {}

  template <typename Item>
  void all(std::vector<Item>& items) const {
    for (Item& item : items) (*this)(item);
  }

  void operator()(Position& position) const { move_(position); }
  void operator()(std::uint32_t& line) const {
    Position position{line, 0, 1};
    move_(position);
    line = position.line;
  }
  void operator()(Operand& operand) const { (*this)(operand.position); }
  void operator()(Statement& statement) const {
    (*this)(statement.position);
    all(statement.operands);
  }
  void operator()(NetworkHead& head) const { (*this)(head.position); }
  void operator()(CommentLine& comment) const { (*this)(comment.line); }
  void operator()(BlankLine& blank) const { (*this)(blank.line); }
  void operator()(Line& line) const { std::visit(*this, line); }
  void operator()(Variable& variable) const { (*this)(variable.position); }
  void operator()(Block& block) const {
    (*this)(block.position);
    (*this)(block.last_line);
    all(block.variables);
  }
  void operator()(Symbol& symbol) const { (*this)(symbol.position); }
  void operator()(DataLine::Value& value) const { (*this)(value.position); }
  void operator()(DataLine& data) const {
    (*this)(data.position);
    if (data.address) (*this)(*data.address);
    all(data.values);
  }
  void operator()(Section& section) const { (*this)(section.first_line); }
  void operator()(FurtherFile& file) const { (*this)(file.first_line); }
  void operator()(Diagnostic& diagnostic) const { (*this)(diagnostic.position); }

 private:
  const std::function<void(Position&)>& move_;
};

}  // namespace

void move_places(ParseResult& read, const std::function<void(Position&)>& move) {
  const Mover mover(move);
  mover.all(read.source.further_files);
  mover.all(read.source.sections);
  mover.all(read.source.lines);
  mover.all(read.source.blocks);
  mover.all(read.source.symbols);
  mover.all(read.source.data);
  mover.all(read.diagnostics);
  mover.all(read.left_out);
}

}  // namespace s7200::stl

#include "tools/session/causes/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "interpreter/base/bytes.hpp"
#include "interpreter/base/text/numbers.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/cpu/units/forcing.hpp"

namespace s7200::tools {
namespace {

constexpr std::string_view kPointers = "a pointer is *VD100, *AC1 or *LD0, with :word, :dword, :real or a count after it";

constexpr std::string_view kTypes =
    "byte, word, dword and real after a colon are for memory in bytes, for example VB100:word:4, and for accumulators";

bool read_pointer_suffix(std::string_view text, Place& place) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(':'), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (part == "BYTE") {
      place.width = Width::Byte;
    } else if (part == "WORD") {
      place.width = Width::Word;
    } else if (part == "DWORD" || part == "REAL") {
      place.width = Width::Double;
      place.real = part == "REAL";
    } else if (const auto count = parse_decimal<std::uint32_t>(part); count && *count != 0) {
      place.count = *count;
    } else {
      return false;
    }
  }
  return true;
}

}  // namespace

std::optional<MemoryRange> range_at(std::uint32_t at, Width width, const CpuModel& model) {
  for (const AreaInfo& area : all_areas()) {
    const std::uint32_t size = model.size_of(area.area) * area.step();
    if (at < area.base || at + bytes_of(width) > area.base + size) continue;
    return MemoryRange{area.area, width, (at - area.base) / area.step(), 0, 1, at};
  }
  return {};
}

/// `VB100:word`, `AC1:byte`: with another type than that of the address; of an accumulator the low end.
Result<MemoryRange> parse_typed(std::string_view text, const Program& program) {
  const std::size_t colon = text.find(':', text.starts_with('"') ? text.find('"', 1) : 0);
  Place typed;
  const std::string suffix = stl::upper_case(text.substr(std::min(colon, text.size() - 1) + 1));
  const bool is_typed = suffix.find_first_not_of("0123456789:") != std::string::npos && read_pointer_suffix(suffix, typed);
  if (!is_typed) return parse_range(text, program);
  const auto at = parse_range(text.substr(0, colon), program);
  if (!at) return at.trouble();
  const bool in_bytes = info(at->area).element == 0 && at->width != Width::Bit, in_accumulator = at->area == Area::AC;
  if (!in_bytes && !in_accumulator) return trouble("'{}': {}", stl::shortened(text), kTypes);
  const std::uint32_t low = in_accumulator ? 4 - bytes_of(typed.width) : 0;
  auto range = range_at(at->at + low, typed.width, *program.model);
  const AreaInfo& area = info(at->area);
  const std::uint32_t step = in_accumulator ? area.step() : bytes_of(typed.width);
  const std::uint32_t end = area.base + program.model->size_of(at->area) * area.step();
  if (!range || typed.count > (end - range->at + low) / step)
    return trouble("'{}' does not exist on CPU {}", stl::shortened(text), program.model->name);
  range->count = typed.count;
  range->real = typed.real;
  return *range;
}

Result<Place> parse_place(std::string_view text, const Program& program) {
  Place place;
  if (!text.starts_with('*')) {
    const auto range = parse_typed(text, program);
    if (!range) return range.trouble();
    place.range = *range;
    return place;
  }
  const std::size_t colon = std::min(text.find(':'), text.size());
  const auto pointer = parse_range(text.substr(1, colon - 1), program);
  if (!pointer) return pointer.trouble();
  place.range = *pointer;
  place.pointer = true;
  const std::string suffix = stl::upper_case(text.substr(std::min(colon + 1, text.size())));
  if (pointer->width == Width::Double && read_pointer_suffix(suffix, place)) return place;
  return trouble("'{}': {}", stl::shortened(text), kPointers);
}

std::uint32_t pointer_value(const Place& place, const Cpu& cpu) { return load32(&cpu.state().image[place.range.at]); }

std::optional<MemoryRange> range_now(const Place& place, const Cpu& cpu) {
  if (!place.pointer) return place.range;
  const Operand operand{place.range.at, 0, true, static_cast<std::uint16_t>(bytes_of(place.width))};
  const auto at = cpu.place_of(operand);
  auto range = at ? range_at(*at, place.width, *cpu.program().model) : std::nullopt;
  if (!range) return {};
  const AreaInfo& area = info(range->area);
  const std::uint32_t left = area.base + cpu.program().model->size_of(range->area) * area.step() - range->at;
  range->count = std::min(place.count, left / bytes_of(place.width));
  range->real = place.real;
  return range;
}

struct Expression::Node {
  enum class Kind : std::uint8_t { Constant, Memory, Not, Negate, Binary };
  Kind kind{};
  std::string_view op{};
  Value constant{};
  Place place{};
  std::string name{};  ///< of the place, as it is written
  std::shared_ptr<const Node> left{}, right{};
};

namespace {

using Node = Expression::Node;
using NodePtr = std::shared_ptr<const Node>;

/// From the weakest to the strongest.
constexpr std::array<std::array<std::string_view, 8>, 5> kLevels{
    {{"or"}, {"and"}, {"<=", ">=", "<>", "==", "!=", "=", "<", ">"}, {"+", "-"}, {"*", "/"}}};

constexpr std::size_t kComparisons = 2;  // level of

/// What memory can be, as a number with its sign or as its bits.
struct Kind {
  Width width{};
  bool real = false;
  double least = 0, most = 0;
  std::string_view range;
};
constexpr double kLargestReal = std::numeric_limits<float>::max();
constexpr Kind kKinds[]{
    {Width::Bit, false, 0, 1, "a bit is 0 or 1"},
    {Width::Byte, false, 0, 0xFF, "a byte is a whole number from 0 to 255"},
    {Width::Word, false, -0x8000, 0xFFFF, "a word is a whole number from -32768 to 32767, as its bits up to 16#FFFF"},
    {Width::Double, false, -2147483648.0, 4294967295.0,
     "a double word is a whole number from -2147483648 to 2147483647, as its bits up to 16#FFFFFFFF"},
    {Width::Double, true, -kLargestReal, kLargestReal, "a real is from -3.402823e+38 to 3.402823e+38"}};

const Kind& kind_of(const Place& place) {
  const bool real = place.pointer ? place.real : place.range.real;
  const Width width = place.pointer ? place.width : place.range.width;
  return *std::ranges::find_if(kKinds, [&](const Kind& kind) { return kind.width == width && kind.real == real; });
}

/// Of a constant, with its sign; nothing of anything else.
std::optional<double> constant_of(const Node& node) {
  if (node.kind == Node::Kind::Constant) return node.constant.number;
  if (node.kind != Node::Kind::Negate || node.left->kind != Node::Kind::Constant) return {};
  return -node.left->constant.number;
}

class ExpressionReader {
 public:
  static constexpr std::size_t kMostNested = 100;  ///< parentheses, `not` and signs in each other
  static constexpr std::size_t kMostOperators =
      1000;  ///< between two operands each; a chain of them is as deep as it is long

  ExpressionReader(std::string_view text, const Program& program) : text_(text), program_(program) {}

  NodePtr read() {
    NodePtr root = binary(0);
    skip_blanks();
    if (root && at_ != text_.size()) fail("an operator is missing");
    return why_.empty() ? root : nullptr;
  }
  std::string why() const { return why_; }

 private:
  NodePtr binary(std::size_t level) {
    if (level == kLevels.size()) return unary();
    skip_blanks();
    std::size_t left_at = at_;
    NodePtr left = binary(level + 1);
    while (left) {
      std::string_view op = take_operator(level);
      if (op.empty()) break;
      if (op == "==") op = "=";  // as other languages write them
      if (op == "!=") op = "<>";
      if (++operators_ > kMostOperators) return fail(fmt::format("more than {} operators", kMostOperators));
      skip_blanks();
      const std::size_t right_at = at_;
      NodePtr right = binary(level + 1);
      if (!right) return nullptr;
      if (op == "/" && right->kind == Node::Kind::Constant && right->constant.number == 0)
        return at_ = right_at, fail("a division by 0");
      if (level == kComparisons && !(can_be(*left, *right, op, right_at) && can_be(*right, *left, op, left_at)))
        return nullptr;
      left = std::make_shared<Node>(Node{.kind = Node::Kind::Binary, .op = op, .left = left, .right = right});
    }
    return left;
  }

  /// Whether memory can ever be what it is compared with, a constant that is at `place`.
  bool can_be(const Node& memory, const Node& constant, std::string_view op, std::size_t place) {
    const auto number = constant_of(constant);
    if (memory.kind != Node::Kind::Memory || !number) return true;
    const Kind& kind = kind_of(memory.place);
    const bool equality = op == "=" || op == "<>";
    const bool whole = kind.real || *number == std::trunc(*number) || !equality;
    if (whole && *number >= kind.least && *number <= kind.most) return true;
    at_ = place;
    fail(fmt::format("{} can never be {}: {}", stl::printable(memory.name),
                     number_text({*number, std::trunc(*number) != *number}), kind.range));
    return false;
  }

  NodePtr unary() {
    if (nested_ == kMostNested) return fail("nested too deeply");
    ++nested_;
    NodePtr node = unary_in();
    --nested_;
    return node;
  }

  NodePtr unary_in() {
    skip_blanks();
    if (take_word("not")) return around(Node::Kind::Not, unary());
    if (text_.substr(at_).starts_with('-')) return ++at_, around(Node::Kind::Negate, unary());
    if (!text_.substr(at_).starts_with('(')) return operand();
    ++at_;
    NodePtr inside = binary(0);
    skip_blanks();
    if (!inside) return nullptr;
    if (!text_.substr(at_).starts_with(')')) return fail("the closing ) is missing");
    ++at_;
    return inside;
  }

  static NodePtr around(Node::Kind kind, NodePtr inside) {
    if (!inside) return nullptr;
    return std::make_shared<Node>(Node{.kind = kind, .left = std::move(inside)});
  }

  NodePtr operand() {
    const std::size_t begin = at_;
    if (text_.substr(at_).starts_with('&')) ++at_;
    if (text_.substr(at_).starts_with('"')) at_ = std::min(text_.find('"', at_ + 1), text_.size() - 1) + 1;
    while (at_ < text_.size() && (at_ == begin || text_[at_] != '*') &&
           std::string_view(" \t+-/()=<>!").find(text_[at_]) == std::string_view::npos)
      ++at_;
    const std::string_view word = text_.substr(begin, at_ - begin);
    if (word.empty() || word == "*") return fail("an address or a number is missing");
    if (const auto integer = parse_integer(word))
      return std::make_shared<Node>(Node{.constant = {static_cast<double>(*integer)}});
    if (const auto real = parse_real(word)) return std::make_shared<Node>(Node{.constant = {*real, true}});
    const auto pointer = word.starts_with('&') ? parse_pointer(word, program_) : std::nullopt;
    if (pointer) return std::make_shared<Node>(Node{.constant = {static_cast<double>(*pointer)}});
    const auto place = pointer.why().empty() ? parse_place(word, program_) : Result<Place>(pointer.trouble());
    if (!place) {
      at_ = begin;
      return fail(place.why());
    }
    return std::make_shared<Node>(Node{.kind = Node::Kind::Memory, .place = *place, .name = std::string(word)});
  }

  static std::optional<double> parse_real(std::string_view word) {
    if (word.empty() || !stl::is_digit(word[0]) || word.find('.') == std::string_view::npos) return {};
    const std::string text(word);
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return *end == '\0' ? std::optional(value) : std::nullopt;
  }

  std::string_view take_operator(std::size_t level) {
    skip_blanks();
    for (const std::string_view op : kLevels[level]) {
      if (op.empty()) break;
      if (stl::is_upper(stl::upper_case(op)[0]) ? take_word(op) : text_.substr(at_).starts_with(op)) {
        if (!stl::is_upper(stl::upper_case(op)[0])) at_ += op.size();
        return op;
      }
    }
    return {};
  }

  bool take_word(std::string_view word) {
    const std::string_view rest = text_.substr(at_);
    const bool ends = rest.size() == word.size() ||
                      (rest.size() > word.size() && (stl::is_blank(rest[word.size()]) || rest[word.size()] == '('));
    if (!ends || stl::upper_case(rest.substr(0, word.size())) != stl::upper_case(word)) return false;
    at_ += word.size();
    return true;
  }

  void skip_blanks() {
    while (at_ < text_.size() && stl::is_blank(text_[at_])) ++at_;
  }

  NodePtr fail(std::string_view what) {
    if (why_.empty()) why_ = fmt::format("'{}', column {}: {}", stl::shortened(text_), at_ + 1, what);
    return nullptr;
  }

  std::string_view text_;
  const Program& program_;
  std::size_t at_ = 0;
  std::size_t nested_ = 0, operators_ = 0;
  std::string why_;
};

std::optional<Value> value_of(const Place& place, const Cpu& cpu, Expression::SeenBy by) {
  const auto range = range_now(place, cpu);
  if (!range) return {};
  std::array<std::uint8_t, 4> bytes{};
  const std::uint8_t* const from = bytes.data();
  std::copy_n(cpu.state().image.begin() + range->at, bytes_of(range->width), bytes.begin());
  if (by == Expression::SeenBy::Outside) forcing::put_over(cpu.state(), range->at, {bytes.data(), bytes_of(range->width)});
  switch (range->width) {
    case Width::Bit:
      return Value{static_cast<double>(*from >> range->bit & 1), false, 1};
    case Width::Byte:
      return Value{static_cast<double>(*from), false, 8};
    case Width::Word:
      return Value{static_cast<double>(static_cast<std::int16_t>(load16(from))), false, 16};
    case Width::Double:
      if (range->real) return Value{std::bit_cast<float>(load32(from)), true, 32};
      return Value{static_cast<double>(static_cast<std::int32_t>(load32(from))), false, 32};
  }
  return {};
}

/// `*VD100 points nowhere: VD100 is 16#00000000`
std::string nowhere_text(const Node& node, const Cpu& cpu) {
  return fmt::format("{} points nowhere: {} is 16#{:08X}", stl::printable(node.name), node.place.range.name_of(0),
                     pointer_value(node.place, cpu));
}

/// 16#FFFF beside a word is -1: the same bits. 0.1 beside a real is the real that is nearest to it.
double beside(const Value& constant, const Value& memory) {
  if (constant.bits == 0 && memory.bits != 0 && memory.real) return static_cast<float>(constant.number);
  const double range = std::ldexp(1, memory.bits);
  const bool wraps = constant.bits == 0 && !constant.real && (memory.bits == 16 || memory.bits == 32) && !memory.real &&
                     constant.number >= range / 2 && constant.number < range;
  return wraps ? constant.number - range : constant.number;
}

Result<Value> compute(std::string_view op, const Value& left, const Value& right) {
  const double a = beside(left, right), b = beside(right, left);
  const bool real = left.real || right.real;
  if (op == "or") return Value{left.truth() || right.truth() ? 1.0 : 0.0};
  if (op == "and") return Value{left.truth() && right.truth() ? 1.0 : 0.0};
  if (op == "=") return Value{a == b ? 1.0 : 0.0};
  if (op == "<>") return Value{a != b ? 1.0 : 0.0};
  if (op == "<") return Value{a < b ? 1.0 : 0.0};
  if (op == "<=") return Value{a <= b ? 1.0 : 0.0};
  if (op == ">") return Value{a > b ? 1.0 : 0.0};
  if (op == ">=") return Value{a >= b ? 1.0 : 0.0};
  if (op == "+") return Value{a + b, real};
  if (op == "-") return Value{a - b, real};
  if (op == "*") return Value{a * b, real};
  if (b == 0) return Trouble{"a division by 0"};
  return Value{real ? a / b : std::trunc(a / b), real};
}

Result<Value> evaluate(const Node& node, const Cpu& cpu, Expression::SeenBy by) {
  if (node.kind == Node::Kind::Constant) return node.constant;
  if (node.kind == Node::Kind::Memory) {
    const auto value = value_of(node.place, cpu, by);
    if (!value) return Trouble{nowhere_text(node, cpu)};
    return *value;
  }
  const auto left = evaluate(*node.left, cpu, by);
  if (!left) return left.trouble();
  if (node.kind == Node::Kind::Not) return Value{left->truth() ? 0.0 : 1.0};
  if (node.kind == Node::Kind::Negate) return Value{left->real ? -left->number : 0 - left->number, left->real};
  if (node.op == "and" && !left->truth()) return Value{0};
  if (node.op == "or" && left->truth()) return Value{1};
  const auto right = evaluate(*node.right, cpu, by);
  return right ? compute(node.op, *left, *right) : right;
}

/// Each place once, in the order in which they are written.
void collect_places(const Node& node, std::vector<const Node*>& places) {
  const auto same = [&](const Node* other) { return other->name == node.name; };
  if (node.kind == Node::Kind::Memory && std::ranges::none_of(places, same)) places.push_back(&node);
  for (const Node* const side : {node.left.get(), node.right.get()})
    if (side) collect_places(*side, places);
}

bool is_logic(const Node& node) {
  return node.kind == Node::Kind::Not || (node.kind == Node::Kind::Binary && (node.op == "and" || node.op == "or"));
}

/// What cannot be computed now is against it too.
void collect_against(const Node& node, bool wanted, const Cpu& cpu, std::vector<const Node*>& places) {
  if (const auto value = evaluate(node, cpu, Expression::SeenBy::Outside); value && value->truth() == wanted) return;
  if (!is_logic(node)) return collect_places(node, places);
  const bool wanted_inside = (node.kind == Node::Kind::Not) != wanted;
  for (const Node* const side : {node.left.get(), node.right.get()})
    if (side) collect_against(*side, wanted_inside, cpu, places);
}

std::vector<Place> places_of(const std::vector<const Node*>& nodes) {
  std::vector<Place> places;
  for (const Node* const node : nodes) places.push_back(node->place);
  return places;
}

}  // namespace

Result<Expression> Expression::parse(std::string_view text, const Program& program) {
  ExpressionReader reader(text, program);
  Expression expression;
  expression.text_ = text;
  expression.root_ = reader.read();
  if (expression.root_) return expression;
  return Trouble{reader.why()};
}

Result<Value> Expression::value(const Cpu& cpu, SeenBy by) const { return evaluate(*root_, cpu, by); }

std::vector<Place> Expression::places() const {
  std::vector<const Node*> nodes;
  collect_places(*root_, nodes);
  return places_of(nodes);
}

std::vector<Place> Expression::places_against(bool wanted, const Cpu& cpu) const {
  std::vector<const Node*> nodes;
  collect_against(*root_, wanted, cpu, nodes);
  return places_of(nodes);
}

std::string Expression::places_text(const Cpu& cpu, SeenBy by) const {
  std::vector<const Node*> places;
  collect_places(*root_, places);
  std::string text;
  for (const Node* const place : places) {
    const auto value = value_of(place->place, cpu, by);
    text += text.empty() ? "" : ", ";
    text += value ? fmt::format("{} is {}", stl::printable(place->name), number_text(*value)) : nowhere_text(*place, cpu);
  }
  return text;
}

std::optional<std::uint32_t> double_word_of(const Value& value) {
  constexpr double kLeast = -2147483648.0, kMost = 4294967295.0;
  if (value.real || !(value.number >= kLeast && value.number <= kMost)) return {};  // nor what is not a number
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(value.number));
}

std::optional<std::uint32_t> bits_of(const Value& value) {
  return value.real ? std::bit_cast<std::uint32_t>(static_cast<float>(value.number)) : double_word_of(value);
}

std::string number_text(const Value& value) {
  return value.real ? fmt::format("{:.7g}", value.number) : fmt::format("{:.0f}", value.number);
}

}  // namespace s7200::tools

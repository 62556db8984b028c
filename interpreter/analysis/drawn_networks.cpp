#include "interpreter/analysis/drawn_networks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "interpreter/model/instruction.hpp"
#include "interpreter/program/ladder/ladder.hpp"
#include "interpreter/program/ladder/ladder_boxes.hpp"
#include "interpreter/stl/printer.hpp"

namespace s7200 {
namespace {

using stl::LadderBranch;
using stl::LadderElement;
using stl::LadderPath;
using Kind = LadderPath::Kind;

constexpr std::size_t kRail = 0;
constexpr std::size_t kMostDrawn = 256;  // as many as the reader of drawings takes

std::string words_of(const stl::Statement& statement) {
  std::string text = statement.mnemonic;
  for (const stl::Operand& operand : statement.operands)
    text += (&operand == &statement.operands.front() ? " " : ", ") + stl::to_text(operand);
  return text;
}

bool is_drawn_as_head(const Instruction& instruction) {
  return begins_routine(instruction.structure) || instruction.structure == Structure::Label;
}

/// Whether it does something, as a coil or a box does, and is no contact.
bool is_drawn_as_output(const Instruction& instruction) {
  return instruction.rung.writes_output || instruction.rung.stack == StackUse{};
}

/// The symbol between the sides of a contact: nothing, `/`, `I`, `/I`, `>= W`. `join` is LD, A or O.
std::string contact_symbol(std::string_view mnemonic, std::string_view join) {
  const std::string_view rest = mnemonic.substr(join.size());
  if (rest.empty() || rest == "I") return std::string(rest);
  if (rest == "N" || rest == "NI") return rest == "N" ? "/" : "/I";
  const std::size_t relation = rest.find_first_of("<>=");
  const std::string_view sign = rest.substr(relation);
  return fmt::format("{} {}", sign == "=" ? "==" : sign, rest.substr(0, relation));
}

/// NOT and the edges work on all the power flow that reaches them.
bool has_flow_contact(const LadderPath& path) {
  if (path.kind == Kind::Contact)
    return path.contact.symbol == "NOT" || path.contact.symbol == "P" || path.contact.symbol == "N";
  return std::ranges::any_of(path.parts, has_flow_contact);
}

bool is_bare_wire(const LadderPath& path) { return path.kind == Kind::Series && path.parts.empty(); }

/// Joins two paths in one list instead of nested ones.
void join(Kind kind, LadderPath& path, LadderPath other) {
  if (kind == Kind::Series && is_bare_wire(path)) {
    path = std::move(other);
    return;
  }
  if (path.kind != kind) {
    LadderPath list{kind};
    list.parts.push_back(std::move(path));
    path = std::move(list);
  }
  if (other.kind == kind)
    std::move(other.parts.begin(), other.parts.end(), std::back_inserter(path.parts));
  else
    path.parts.push_back(std::move(other));
}

/// Follows the logic stack through a network, and draws what its levels are: contacts from a point of the drawing on.
class NetworkDrawing {
 public:
  /// `loops_end_at_branch`: NEXT hangs from the branch before it instead of the rail, so that this can go on after it.
  NetworkDrawing(const stl::Source& program, bool loops_end_at_branch)
      : program_(program), loops_end_at_branch_(loops_end_at_branch) {
    points_.push_back({kRail, {}});
  }

  /// Returns why the instruction cannot be drawn; empty if it can.
  std::string add(const stl::Statement& statement, std::uint32_t op) {
    why_.clear();
    statement_ = &statement;
    op_ = op;
    instruction_ = find_instruction(statement.mnemonic);
    if (!instruction_)
      refuse("is not an instruction");
    else if (is_drawn_as_output(*instruction_))
      output();
    else
      contact();
    return why_;
  }

  /// Returns why the network cannot end here; empty if it can.
  std::string end() const {
    const bool open = std::ranges::any_of(stack_, [](const Flow& flow) { return !is_bare_wire(flow.path); });
    return open                             ? "its contacts lead to no coil and no box"
           : points_[kRail].hanging.empty() ? "it has no coil and no box"
                                            : "";
  }

  LadderBranch rail() const { return branch_of(kRail); }

 private:
  /// A level of the logic stack: the power flow that comes through contacts from a point.
  struct Flow {
    std::size_t point = kRail;
    LadderPath path{};
    bool of_segment = false;  // what LSCR pushes: no point of the drawing
  };
  struct Hanging {
    LadderPath path{};
    std::optional<LadderElement> output{};
    std::vector<LadderPath> more_inputs{};
    std::size_t point = kRail;  // where it leads to: after the contacts, or the ENO of the box; the rail for nowhere
  };
  struct Point {
    std::size_t from;  // the point before it
    std::vector<Hanging> hanging;
  };

  void refuse(std::string_view why) { why_ = fmt::format("{} {}", words_of(*statement_), why); }

  bool has_levels(std::size_t levels) {
    if (stack_.size() < levels)
      refuse(levels < 2 ? "has no LD before it in this network: it takes the power flow that the network before has left"
                        : "takes more levels of the logic stack than this network has put there");
    else if (std::any_of(stack_.end() - static_cast<std::ptrdiff_t>(levels), stack_.end(),
                         [](const Flow& flow) { return flow.of_segment; }))
      refuse("takes the power flow of LSCR, which stands alone in its network in LAD");
    return why_.empty();
  }

  // ---- contacts ----

  void contact() {
    const std::string_view name = instruction_->mnemonic;
    if (instruction_->rung.stack.needs == 0) return load(name);
    if (!has_levels(static_cast<std::size_t>(instruction_->rung.stack.needs))) return;
    if (name == "NOT") return in_series("NOT");
    if (name == "EU" || name == "ED") return in_series(name == "EU" ? "P" : "N");
    if (name == "ALD" || name == "OLD") return join_blocks(name == "ALD" ? Kind::Series : Kind::Parallel);
    if (name == "AENO") return after_box();
    if (name == "LPS" || name == "LRD" || name == "LPP") return branch(name);
    if (name == "LDS") return refuse("copies a level of the logic stack, which no branch does");
    if (name.starts_with('A')) return in_series(contact_symbol(name, "A"));
    beside(contact_symbol(name, "O"));
  }

  LadderPath drawn_contact(std::string symbol) {
    if (++contacts_ > kMostDrawn) refuse("is one contact too many: a drawing has at most 256");
    LadderPath path{Kind::Contact};
    path.contact = {LadderElement::Kind::Contact, std::move(symbol), statement_->position};
    for (const stl::Operand& operand : statement_->operands) path.contact.operands.push_back(operand_in_ladder(operand));
    path.contact.op = op_;
    return path;
  }

  void load(std::string_view name) { stack_.push_back({kRail, drawn_contact(contact_symbol(name, "LD"))}); }
  void in_series(std::string symbol) { join(Kind::Series, stack_.back().path, drawn_contact(std::move(symbol))); }

  void beside(std::string symbol) {
    if (!comes_from_rail(stack_.back()))
      return refuse(
          "stands beside power flow that already leads to an output or a branch; in LAD it would join before that");
    join(Kind::Parallel, stack_.back().path, drawn_contact(std::move(symbol)));
  }

  static bool comes_from_rail(const Flow& flow) { return flow.point == kRail && !is_bare_wire(flow.path); }

  void join_blocks(Kind kind) {
    Flow block = std::move(stack_.back());
    stack_.pop_back();
    Flow& before = stack_.back();
    if (!comes_from_rail(block) || (kind == Kind::Parallel && !comes_from_rail(before)))
      return refuse("joins a block that already leads to an output or a branch of its own");
    if (kind == Kind::Series && has_flow_contact(block.path))
      return refuse("puts a block with NOT, EU or ED after other contacts, which these would see in LAD as well");
    join(kind, before.path, std::move(block.path));
  }

  // ---- branches ----

  /// Makes a point where the contacts of a level end, for what hangs from there.
  bool end_contacts(Flow& flow) {
    if (!is_bare_wire(flow.path)) {
      const bool waiting = std::any_of(stack_.begin(), stack_.end(),
                                       [&](const Flow& other) { return &other < &flow && comes_from_rail(other); });
      if (waiting && flow.point == kRail)
        return refuse("does something between an LD and the ALD, OLD or box that takes it"), false;
      const std::size_t point = points_.size();
      if (!hang(flow.point, {std::move(flow.path), {}, {}, point})) return false;
      points_.push_back({flow.point, {}});
      flow = {point, {}};
    }
    return true;
  }

  /// What runs later is drawn further down: it can hang only from a point that leads to what ran last.
  bool hang(std::size_t point, Hanging hanging) {
    for (std::size_t at = last_; at != point; at = points_[at].from)
      if (at == kRail) return refuse("goes back to a branch above another one, which has run since"), false;
    last_ = hanging.output ? point : hanging.point;
    after_ = op_;
    points_[point].hanging.push_back(std::move(hanging));
    return true;
  }

  void branch(std::string_view name) {
    if (name == "LPS") {
      if (end_contacts(stack_.back())) stack_.push_back(stack_.back());
      return;
    }
    if (!is_bare_wire(stack_.back().path)) return refuse("drops contacts that lead to no coil and no box");
    stack_.pop_back();
    if (name == "LRD" && end_contacts(stack_.back())) stack_.push_back(stack_.back());
  }

  /// AENO goes on after the box that hangs from the same point and has run last.
  void after_box() {
    Flow& flow = stack_.back();
    std::vector<Hanging>& hanging = points_[flow.point].hanging;
    const bool follows = is_bare_wire(flow.path) && last_ == flow.point && after_ + 1 == op_ && !hanging.empty() &&
                         hanging.back().output && hanging.back().output->kind == LadderElement::Kind::Box;
    if (!follows) return refuse("does not come directly after a box of its branch");
    if (++boxes_in_row_ > kMostDrawn) return refuse("goes on after one box too many: a drawing has at most 256 in a row");
    hanging.back().point = last_ = points_.size();
    points_.push_back({flow.point, {}});
    flow.point = last_;
  }

  // ---- outputs ----

  void output() {
    if (is_drawn_as_head(*instruction_)) return refuse("stands in a network with others; in LAD it has one of its own");
    const auto levels = static_cast<std::size_t>(instruction_->rung.stack.needs);
    if (!has_levels(levels)) return;
    LadderElement element = ladder_output(*statement_, *instruction_, program_);
    element.op = op_;
    if (levels == 0) return without_power_flow(std::move(element));
    std::vector<LadderPath> more;
    for (std::size_t level = 1; level < levels; ++level) {
      Flow& flow = stack_[stack_.size() - levels + level];
      if (!comes_from_rail(flow)) return refuse("has an input that also leads to something else");
      more.push_back(std::move(flow.path));
    }
    stack_.resize(stack_.size() - levels + 1);
    const std::size_t inputs = more.size();
    if (!end_contacts(stack_.back())) return;
    if (!hang(stack_.back().point, {{}, std::move(element), std::move(more)})) return;
    if (inputs > 0) last_ = kRail;  // its other inputs are drawn from the rail to below it
  }

  /// RET, SCRE and the like hang from the rail, as they do not look at the power flow. NOP stands where it is.
  void without_power_flow(LadderElement element) {
    const bool at_branch =
        !instruction_->rung.writes_output || (instruction_->structure == Structure::Next && loops_end_at_branch_);
    if (at_branch && !stack_.empty()) {
      if (end_contacts(stack_.back())) hang(stack_.back().point, {{}, std::move(element)});
      return;
    }
    if (std::ranges::any_of(stack_, [](const Flow& flow) { return comes_from_rail(flow); }))
      return refuse("runs without power flow, and the contacts before it lead to nothing else");
    hang(kRail, {{}, std::move(element)});
    if (instruction_->rung.stack.change > 0) stack_.push_back({.of_segment = true});
  }

  LadderBranch branch_of(std::size_t point) const {
    LadderBranch all;
    for (const Hanging& each : points_[point].hanging) {
      LadderBranch branch = each.point == kRail ? LadderBranch{} : branch_of(each.point);
      branch.path = each.path;
      branch.output = each.output;
      branch.more_inputs = each.more_inputs;
      all.branches.push_back(std::move(branch));
    }
    return all;
  }

  const stl::Source& program_;
  const bool loops_end_at_branch_;
  const stl::Statement* statement_ = nullptr;
  const Instruction* instruction_ = nullptr;
  std::uint32_t op_ = 0;
  std::vector<Flow> stack_;
  std::vector<Point> points_;
  std::size_t last_ = kRail;  // the point from which hangs what runs last
  std::uint32_t after_ = 0;   // the instruction that hung it there
  std::size_t contacts_ = 0, boxes_in_row_ = 0;
  std::string why_;
};

/// The statements of a program in networks, each with what stands above it.
class NetworkDivision {
 public:
  explicit NetworkDivision(const stl::Source& program) {
    has_heads_ = std::ranges::any_of(program.lines,
                                     [](const stl::Line& line) { return std::holds_alternative<stl::NetworkHead>(line); });
    for (const stl::Line& line : program.lines) {
      if (const auto* head = std::get_if<stl::NetworkHead>(&line)) {
        head_ = *head;
        comments_.clear();
      } else if (const auto* comment = std::get_if<stl::CommentLine>(&line)) {
        comments_.push_back(comment->text);
      } else if (const auto* statement = std::get_if<stl::Statement>(&line)) {
        add(*statement);
      } else if (!head_) {
        comments_.clear();  // what stands above a blank line is about more than a network
      }
    }
  }

  struct Part {
    DrawnNetwork network;
    std::vector<const stl::Statement*> statements{};
  };
  std::vector<Part> parts;

 private:
  static bool is_head(const stl::Statement& statement) {
    const Instruction* instruction = find_instruction(statement.mnemonic);
    return instruction && is_drawn_as_head(*instruction);
  }
  static bool begins_routine(const stl::Statement& statement) {
    return statement.mnemonic == "SBR" || statement.mnemonic == "INT";
  }
  static bool is_load_after_output(const stl::Statement& statement, const stl::Statement& before) {
    const Instruction* last = find_instruction(before.mnemonic);
    return statement.mnemonic.starts_with("LD") && last && is_drawn_as_output(*last);
  }

  bool begins(const stl::Statement& statement) const {
    if (parts.empty() || head_) return true;
    const stl::Statement& before = *parts.back().statements.back();
    return is_head(before) || is_head(statement) || (!has_heads_ && is_load_after_output(statement, before));
  }

  void add(const stl::Statement& statement) {
    const std::uint32_t op = parts.empty() ? 0 : parts.back().network.end;
    if (begins(statement)) begin(statement, op);
    parts.back().statements.push_back(&statement);
    parts.back().network.end = op + 1;
    head_.reset();
    comments_.clear();
  }

  /// A label, and what follows it, are parts of the network that they stand in.
  bool begins_network(const stl::Statement& statement) const {
    return parts.empty() || head_ || begins_routine(statement) ||
           (!has_heads_ && is_load_after_output(statement, *parts.back().statements.back()));
  }

  void begin(const stl::Statement& statement, std::uint32_t op) {
    if (begins_routine(statement)) {
      routine_ = routine_name(statement);
      number_ = 0;
      numbered_ = false;
    }
    if (head_ && head_->number > 0) {
      number_ = head_->number;
      numbered_ = true;
    } else if (!numbered_ && begins_network(statement)) {
      ++number_;
    }
    DrawnNetwork network;
    network.routine = routine_;
    network.first = network.end = op;
    network.ladder.number = number_;
    network.ladder.position = statement.position;
    network.ladder.comments = std::move(comments_);
    if (head_) network.title = head_->comment;
    parts.push_back({std::move(network)});
  }

  /// `SBR_51`, as Micro/WIN calls it.
  static std::string routine_name(const stl::Statement& head) {
    const auto* number = head.operands.empty() ? nullptr : std::get_if<stl::Integer>(&head.operands.front().value);
    return number ? fmt::format("{}_{}", head.mnemonic, number->value) : words_of(head);
  }

  bool has_heads_ = false;
  std::string routine_ = "MAIN";
  std::uint32_t number_ = 0;
  bool numbered_ = false;  // the routine has had a NETWORK line with a number
  std::optional<stl::NetworkHead> head_;
  std::vector<std::string> comments_;
};

void draw_rungs(NetworkDivision::Part& part, const stl::Source& program, bool loops_end_at_branch) {
  DrawnNetwork& network = part.network;
  NetworkDrawing drawing(program, loops_end_at_branch);
  network.why_not_op = network.first;
  for (const stl::Statement* statement : part.statements) {
    network.why_not = drawing.add(*statement, network.why_not_op);
    if (!network.why_not.empty()) return;
    ++network.why_not_op;
  }
  network.why_not_op = network.end - 1;
  network.why_not = drawing.end();
  if (network.why_not.empty()) network.ladder.rail = drawing.rail();
}

/// The STL of a drawing, an instruction each.
std::vector<std::string> stl_of(const stl::LadderNetwork& drawing) {
  stl::LadderPage page;
  page.networks.push_back(drawing);
  std::vector<std::string> instructions;
  for (const stl::Line& line : ladder_to_stl(page).source.lines)
    if (const auto* statement = std::get_if<stl::Statement>(&line)) instructions.push_back(words_of(*statement));
  return instructions;
}

void read_back(NetworkDivision::Part& part) {
  std::vector<std::string> own;
  for (const stl::Statement* statement : part.statements) {
    stl::Statement plain = *statement;
    for (stl::Operand& operand : plain.operands) operand.symbol.clear();
    own.push_back(words_of(plain));
  }
  std::vector<std::string> drawn = stl_of(part.network.ladder);
  if (drawn != own) part.network.other_stl = std::move(drawn);
}

void draw(NetworkDivision::Part& part, const stl::Source& program) {
  DrawnNetwork& network = part.network;
  const stl::Statement& first = *part.statements.front();
  const Instruction* instruction = find_instruction(first.mnemonic);
  if (part.statements.size() == 1 && instruction && is_drawn_as_head(*instruction)) {
    LadderElement head{LadderElement::Kind::Box, first.mnemonic, first.position};
    for (const stl::Operand& operand : first.operands) head.operands.push_back(operand_in_ladder(operand));
    head.op = network.first;
    network.ladder.head = std::move(head);
    return;
  }
  draw_rungs(part, program, false);
  if (network.why_not.empty()) return;
  NetworkDivision::Part again = part;
  draw_rungs(again, program, true);
  if (again.network.why_not.empty()) part = std::move(again);
}

}  // namespace

std::vector<DrawnNetwork> drawn_networks(const stl::Source& program) {
  NetworkDivision division(program);
  std::vector<DrawnNetwork> networks;
  for (NetworkDivision::Part& part : division.parts) {
    draw(part, program);
    if (part.network.why_not.empty()) read_back(part);
    networks.push_back(std::move(part.network));
  }
  return networks;
}

}  // namespace s7200

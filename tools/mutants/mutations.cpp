#include "tools/mutants/mutations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "interpreter/analysis/effects/looks.hpp"
#include "interpreter/analysis/flow/flow.hpp"
#include "interpreter/program/checking/checker.hpp"
#include "interpreter/program/ladder/networks.hpp"
#include "interpreter/program/loading/stand_ins.hpp"
#include "interpreter/stl/printer.hpp"
#include "tools/coverage/contacts.hpp"
#include "tools/coverage/programs.hpp"

namespace s7200::tools {
namespace {

using stl::Statement;

/// Instructions of which one is easily written for the other.
constexpr std::pair<std::string_view, std::string_view> kOpposites[]{
    {"LD", "LDN"}, {"A", "AN"}, {"O", "ON"}, {"LDI", "LDNI"}, {"AI", "ANI"}, {"OI", "ONI"}, {"EU", "ED"}};
/// Instructions whose operands are not the same the other way round, besides comparisons.
constexpr std::array<std::string_view, 7> kOrdered{"-I", "-D", "-R", "/I", "/D", "/R", "DIV"};

std::string_view opposite_of(std::string_view mnemonic) {
  for (const auto& [one, other] : kOpposites)
    if (mnemonic == one || mnemonic == other) return mnemonic == one ? other : one;
  return {};
}

Statement plain(std::string_view mnemonic, const Statement& at) {
  Statement statement = at;
  statement.mnemonic = mnemonic;
  statement.operands.clear();
  return statement;
}

/// NOP 0, which does nothing.
Statement nothing(const Statement& at) {
  Statement statement = plain("NOP", at);
  statement.operands.push_back({.value = stl::Integer{}, .position = at.position});
  return statement;
}

/// Whether a comparison, or an instruction of kOrdered, does something else with its operands swapped.
bool has_ordered_operands(const Op& op) {
  const std::string_view name = op.instruction->mnemonic;
  if (op.instruction->structure == Structure::Compare)
    return name.find_first_of("<>") != std::string_view::npos && !name.ends_with("<>");
  return std::ranges::find(kOrdered, name) != kOrdered.end();
}

bool leads_elsewhere(const Op& op) {
  return op.instruction->structure == Structure::Jump || op.instruction->effect == Effect::ConditionalEnd;
}

/// Without it the program has the same routines, loops and segments.
bool can_be_left_out(const Op& op, const ContactForm& form) {
  if (form.is_contact()) return form.join != Join::Load;
  switch (op.instruction->structure) {
    case Structure::None:
    case Structure::Jump:
    case Structure::Call:
    case Structure::Attach:
    case Structure::SegmentTransition:
    case Structure::DefineCounter:
      return depends_on_power_flow(op) && op.instruction->rung.stack.change == 0;
    default:
      return false;
  }
}

class MutationFinder {
 public:
  explicit MutationFinder(const Program& program) : program_(program) {
    const std::vector<bool> reachable = reachable_ops(control_flow(program));
    for (op_ = 0; op_ < program.ops.size(); ++op_)
      if (reachable[op_] && !is_stand_in(stl::in_file(program.source, statement().position.line).file)) find();
  }

  std::vector<Mutation> found;

 private:
  const Statement& statement() const { return program_.statement(op_); }
  const Op& op() const { return program_.ops[op_]; }

  void add(std::string what, std::vector<Statement> instead) {
    found.push_back({op_, std::move(what), {{op_, std::move(instead)}}});
  }

  void find() {
    const ContactForm form = contact_form(*op().instruction);
    if (const std::string_view other = opposite_of(statement().mnemonic); !other.empty()) {
      Statement changed = statement();
      changed.mnemonic = other;
      add(fmt::format("{} for {}", other, statement().mnemonic), {changed});
    }
    for (std::size_t i = 0; i < statement().operands.size(); ++i) change_operand(i);
    if (has_ordered_operands(op()) && statement().operands.size() == 2) {
      Statement changed = statement();
      std::swap(changed.operands[0], changed.operands[1]);
      add("operands swapped", {changed});
    }
    if (leads_elsewhere(op())) add("sense inverted", {plain("NOT", statement()), statement(), plain("NOT", statement())});
    change_timer_base();
    if (can_be_left_out(op(), form)) add("deleted", {nothing(statement())});
  }

  void change_operand(std::size_t i) {
    const auto rules = op().instruction->rules();
    if (i < rules.size() && rules[i].kind != OperandKind::Memory) return;
    for (const int by : {-1, 1}) {
      Statement changed = statement();
      stl::Operand& operand = changed.operands[i];
      operand.symbol.clear();
      if (!change(operand.value, by)) continue;
      add(fmt::format("{} for {}", stl::to_text(operand), stl::to_text(statement().operands[i])), {changed});
    }
  }

  static bool change(stl::Address& address, int by) {
    const std::int64_t bits = address.size == stl::Size::Bit ? 8 : 1;
    const std::int64_t place = address.number * bits + (bits == 8 ? address.bit : 0) + by;
    if (place < 0) return false;
    address.number = static_cast<std::uint32_t>(place / bits);
    if (bits == 8) address.bit = static_cast<std::uint8_t>(place % 8);
    return true;
  }

  static bool change(stl::OperandValue& value, int by) {
    if (auto* integer = std::get_if<stl::Integer>(&value)) {
      if (integer->form == stl::Integer::Form::Ascii) integer->form = stl::Integer::Form::Decimal;
      return integer->value += by, true;
    }
    if (auto* real = std::get_if<stl::Real>(&value)) return real->value += static_cast<float>(by), true;
    if (auto* address = std::get_if<stl::Address>(&value)) return change(*address, by);
    if (auto* pointer = std::get_if<stl::AddressOf>(&value)) return change(pointer->target, by);
    return false;
  }

  static bool is_timer(const stl::Operand& operand, std::uint32_t number) {
    const auto* address = std::get_if<stl::Address>(&operand.value);
    return address && address->area == "T" && address->number == number;
  }

  bool uses_timer(std::uint32_t number) const {
    return std::ranges::any_of(program_.statements, [&](const Statement& each) {
      return std::ranges::any_of(each.operands, [&](const stl::Operand& operand) { return is_timer(operand, number); });
    });
  }

  /// Another timer of the same kind that counts with another base, in the place of this one throughout the program.
  void change_timer_base() {
    if (op().instruction->hidden != Hidden::Number || statement().operands.empty()) return;
    const auto* timer = std::get_if<stl::Address>(&statement().operands.front().value);
    if (!timer || timer->area != "T") return;
    const TimerBase own = timer_base(timer->number);
    for (std::uint32_t other = 0; other < program_.model->size_of(Area::T); ++other) {
      const TimerBase base = timer_base(other);
      if (base.retentive != own.retentive || base.base == own.base || uses_timer(other)) continue;
      return replace_timer(timer->number, other);
    }
  }

  void replace_timer(std::uint32_t number, std::uint32_t other) {
    Mutation mutation{.op = op_, .what = fmt::format("T{} for T{}, which has another time base", other, number)};
    for (std::uint32_t each = 0; each < program_.ops.size(); ++each) {
      Statement changed = program_.statement(each);
      bool is_changed = false;
      for (stl::Operand& operand : changed.operands)
        if (is_timer(operand, number)) {
          std::get<stl::Address>(operand.value).number = other;
          operand.symbol.clear();
          is_changed = true;
        }
      if (is_changed) mutation.instead[each] = {std::move(changed)};
    }
    found.push_back(std::move(mutation));
  }

  const Program& program_;
  std::uint32_t op_ = 0;
};

bool same_operation(const Op& a, const Op& b) {
  return a.instruction == b.instruction && a.body == b.body && a.cost == b.cost && a.unit_cost == b.unit_cost &&
         a.skip_to == b.skip_to && a.target == b.target && a.operand == b.operand;
}

bool same_operations(const Program& a, const Program& b) {
  return a.constants == b.constants && std::ranges::equal(a.ops, b.ops, same_operation);
}

stl::Source with_instead(const stl::Source& source, const Mutation& mutation) {
  stl::Source changed = source;
  changed.lines.clear();
  std::uint32_t op = 0;
  for (const stl::Line& line : source.lines) {
    const auto found = std::holds_alternative<Statement>(line) ? mutation.instead.find(op++) : mutation.instead.end();
    if (found == mutation.instead.end())
      changed.lines.push_back(line);
    else
      changed.lines.insert(changed.lines.end(), found->second.begin(), found->second.end());
  }
  return changed;
}

}  // namespace

std::vector<Mutation> mutations_of(const Program& program) { return std::move(MutationFinder(program).found); }

Mutant mutated(const Program& program, const Mutation& mutation) {
  DecodedSource decoded =
      decode_program({.source = with_instead(program.source, mutation), .diagnostics = {}}, *program.model, program.times);
  if (!decoded.program) return {Mutant::Kind::Refused};
  decoded.program->looks = looks_of(*decoded.program);
  decoded.program->system_block = program.system_block;
  if (same_operations(program, *decoded.program)) return {Mutant::Kind::Same};
  return {Mutant::Kind::Program, std::move(decoded.program)};
}

}  // namespace s7200::tools

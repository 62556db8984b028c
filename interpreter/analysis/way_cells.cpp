#include "interpreter/analysis/way_cells.hpp"

#include <algorithm>
#include <utility>

#include "interpreter/analysis/cross_reference.hpp"
#include "interpreter/analysis/effects/followed_cells.hpp"
#include "interpreter/analysis/effects/memory_names.hpp"
#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/model/contact_form.hpp"

namespace s7200 {
namespace {

constexpr std::size_t kMostCells = 80, kMostEquals = 12, kMostParts = 64;
constexpr std::int64_t kSizes[]{0, 16, 32, 64, 128, 256};  ///< numbers are split there
constexpr int kOften = 2;                                  ///< contacts that look at a bit, so that one tells of the other

/// Memory that only the program changes while a scan goes on.
bool only_the_program_changes(const Bits& bits) {
  const Area area = area_of(bits);
  return area == Area::I || area == Area::Q || area == Area::M || area == Area::V || area == Area::S;
}

/// The system goes on writing memory after RCV, NETR and NETW.
bool is_stored_by_the_system(const Op& op) {
  return op.instruction->effect == Effect::Receives || op.instruction->mnemonic == "NETR" ||
         op.instruction->mnemonic == "NETW";
}

}  // namespace

void WayMemory::join(const WayMemory& other) {
  for (std::size_t i = 0; i < value.size(); ++i) {
    value[i].join(other.value[i]);
    if (like[i] != other.like[i]) like[i] = i;
  }
  for (std::size_t i = 0; i < like.size(); ++i)
    if (like[like[i]] != like[i]) like[i] = i;
  if (sum != other.sum) sum.reset();
}

WayCells::WayCells(const Facts& facts, const std::vector<bool>& disturbing) : facts_(facts) {
  find();
  want_sources();
  find_disturbed(disturbing);
  find_constants();
  find_uses();
  find_live();
}

WayMemory WayCells::nothing_known() const {
  WayMemory memory;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    memory.value.push_back(cells_[i].ever);
    memory.like.push_back(i);
  }
  return memory;
}

// --- which cells there are ---

void WayCells::find() {
  std::map<std::uint64_t, int> contacts;
  for (std::uint32_t op = 0; op < facts_.program.ops.size(); ++op) want_of(op, contacts);
  for (std::uint32_t op = 0; op < facts_.program.ops.size(); ++op) note_comparison(op);
  for (const auto& [first, times] : contacts) {
    const Bits bit{first, 1};
    if (times < kOften || !only_the_program_changes(bit) || cells_.size() >= kMostCells) continue;
    if (number_.try_emplace({first, Width::Bit}, cells_.size()).second)
      cells_.push_back({.at = static_cast<std::uint32_t>(first / 8), .width = Width::Bit, .bits = bit});
  }
}

/// Whether the rung of a contact has a call, a jump, a loop or an end.
bool WayCells::decides_control(std::uint32_t op) const {
  const auto& ops = facts_.program.ops;
  for (bool output = false; op < ops.size(); ++op) {
    const Instruction& instruction = *ops[op].instruction;
    if (ops[op].is_contact) {
      if (output && instruction.rung.stack.needs == 0) return false;
      continue;
    }
    const Structure structure = instruction.structure;
    if (structure == Structure::Jump || structure == Structure::Call || structure == Structure::For) return true;
    if (structure == Structure::SegmentExit || instruction.effect == Effect::ConditionalEnd) return true;
    if (structure != Structure::None && structure != Structure::Attach) return false;
    output = true;
  }
  return false;
}

void WayCells::want_of(std::uint32_t op, std::map<std::uint64_t, int>& contacts) {
  const Op& now = facts_.program.ops[op];
  const Instruction& instruction = *now.instruction;
  const ContactForm form = contact_form(instruction);
  const bool decides = form.is_contact() && decides_control(op);
  if (decides && form.kind == ContactForm::Kind::Bit && !now[0].pointer)
    ++contacts[now[0].at * std::uint64_t{8} + now[0].bit];
  if (decides && form.kind == ContactForm::Kind::Numbers && form.type != ContactForm::Type::Real)
    for (const std::size_t i : {0U, 1U}) want(now[i], instruction.operand[0].width, false);
  if (instruction.structure == Structure::For)
    for (const std::size_t i : {1U, 2U}) want(now[i], Width::Word, true);
  for (std::size_t i = 0; i < instruction.rules().size(); ++i)
    if (instruction.operand[i].count && now.unit_cost != 0) want(now[i], Width::Byte, true);
  const auto& ops = facts_.program.ops;
  const bool counts_back =
      op + 2 < ops.size() && ops[op + 2].instruction->structure == Structure::Jump && ops[op + 2].target <= op;
  if (counts_back && instruction.mnemonic.starts_with("DEC")) want(now[0], instruction.operand[0].width, true);
}

void WayCells::note_comparison(std::uint32_t op) {
  const Op& now = facts_.program.ops[op];
  const ContactForm form = contact_form(*now.instruction);
  if (form.kind != ContactForm::Kind::Numbers || form.type == ContactForm::Type::Real) return;
  const Width width = now.instruction->operand[0].width;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto cell = of(now[i], width);
    if (!cell) continue;
    cells_[*cell].compared = true;
    const auto value = constant_value(facts_.program, now[1 - i], width);
    if (value && (form.relation == Relation::Equal || form.relation == Relation::NotEqual))
      cells_[*cell].equals.insert(*value);
  }
}

void WayCells::want(const Operand& operand, Width width, bool limits) {
  if (operand.pointer || operand.unread() || operand.at >= image::kConstants) return;
  const Bits bits{operand.at * 8u, bytes_of(width) * 8u};
  if (!is_quiet(operand.at, bytes_of(width)) || is_local_place(operand.at)) return;
  const auto known = number_.find({bits.first, width});
  if (known != number_.end()) {
    cells_[known->second].limits |= limits;
    return;
  }
  if (cells_.size() >= kMostCells) return;
  number_[{bits.first, width}] = cells_.size();
  cells_.push_back({.at = operand.at, .width = width, .bits = bits, .limits = limits});
}

/// What boxes make a cell of is followed as well.
void WayCells::want_sources() {
  const auto limiting = [this] { return std::ranges::count_if(cells_, &Cell::limits); };
  for (bool more = true; more;) {
    const std::size_t cells = cells_.size();
    const auto limits = limiting();
    for (const Op& op : facts_.program.ops) {
      const auto box = value_box_of(*op.instruction);
      if (!box || op[box->to].pointer) continue;
      const Bits written{op[box->to].at * 8u, bytes_of(op.instruction->operand[box->to].width) * 8u};
      for (std::size_t i = 0; i < cells_.size(); ++i) {
        if (!written.contains(cells_[i].bits) || cells_[i].width == Width::Bit) continue;
        const bool limits_it = cells_[i].limits;
        if (box->from) want(op[*box->from], op.instruction->operand[*box->from].width, limits_it);
        want(op[box->to], op.instruction->operand[box->to].width, limits_it);
      }
    }
    more = cells_.size() != cells || limits != limiting();
  }
}

/// Nothing is ever known of what interrupt routines or the system write; accumulators are saved.
void WayCells::find_disturbed(const std::vector<bool>& disturbing) {
  for (std::uint32_t op = 0; op < facts_.effects.size(); ++op) {
    if (!disturbing[facts_.flow.nodes[op].routine] && !is_stored_by_the_system(facts_.program.ops[op])) continue;
    for (Cell& cell : cells_) cell.disturbed |= !is_accumulator(cell.at) && writes(op, cell.bits);
  }
}

/// Words of V memory that instructions only set to constants, and that are 0 before. What no instruction sets, somebody else
/// does.
void WayCells::find_constants() {
  const Program& program = facts_.program;
  for (Cell& cell : cells_) {
    cell.ever = ValueSet::all_of(cell.width);
    if (cell.width != Width::Word || area_of(cell.bits) != Area::V || is_set_by_data_block(program, cell.bits)) continue;
    ValueSet constants;
    bool only = true;
    for (std::uint32_t op = 0; op < program.ops.size() && only; ++op) {
      if (!writes(op, cell.bits)) continue;
      const Op& writer = program.ops[op];
      const auto value = constant_value(program, writer[0], Width::Word);
      only = writer.instruction->mnemonic == "MOVW" && !writer[1].pointer && writer[1].at == cell.at && value;
      if (only) constants.add({*value, *value});
    }
    if (!only || constants.empty()) continue;
    constants.add({0, 0});
    cell.ever = constants;
  }
}

void WayCells::find_uses() {
  writes_.resize(facts_.flow.routines.size());
  reads_.resize(facts_.flow.routines.size());
  compares_.resize(facts_.flow.routines.size());
  for (std::uint32_t op = 0; op < facts_.effects.size(); ++op) {
    const std::uint32_t routine = facts_.flow.nodes[op].routine;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell)
      if (is_written(op, cell)) writes_[routine].insert(cell);
    const std::set<std::size_t> read = read_by(op);
    reads_[routine].insert(read.begin(), read.end());
    if (facts_.program.ops[op].is_contact) compares_[routine].insert(read.begin(), read.end());
  }
  add_uses_of_callees(writes_);
  add_uses_of_callees(reads_);
  add_uses_of_callees(compares_);
}

void WayCells::add_uses_of_callees(std::vector<std::set<std::size_t>>& uses) const {
  for (bool more = true; more;) {
    more = false;
    for (const CallSite& site : facts_.flow.calls) {
      std::set<std::size_t>& caller = uses[facts_.flow.nodes[site.op].routine];
      const std::size_t before = caller.size();
      const std::set<std::size_t> called = uses[site.routine];
      caller.insert(called.begin(), called.end());
      more |= caller.size() != before;
    }
  }
}

/// The cells that an op looks at by name.
std::set<std::size_t> WayCells::read_by(std::uint32_t op) const {
  std::set<std::size_t> all;
  const Op& now = facts_.program.ops[op];
  for (std::size_t i = 0; i < now.instruction->rules().size(); ++i) {
    const OperandRule& rule = now.instruction->operand[i];
    if (rule.kind != OperandKind::Memory || rule.role == Role::Out || now[i].pointer) continue;
    const Bits bit{now[i].at * std::uint64_t{8} + now[i].bit, 1};
    const auto cell = rule.width == Width::Bit ? at(bit) : of(now[i], rule.width);
    for (std::size_t number = 0; number < cells_.size() && rule.width == Width::Bit; ++number)
      if (is_sign(number, bit)) all.insert(number);
    if (cell) all.insert(*cell);
    if (const auto count = rule.count ? of(now[i], Width::Byte) : std::nullopt) all.insert(*count);
  }
  return all;
}

/// A cell is looked at from an op on if some op on the way reads it by name before it is written as a whole.
void WayCells::find_live() {
  const std::vector<bool> none(cells_.size(), false);
  live_.assign(facts_.program.ops.size() + 1, none);
  live_after_.assign(facts_.flow.routines.size(), none);
  for (bool more = true; more;) {
    more = false;
    for (std::uint32_t op = static_cast<std::uint32_t>(facts_.program.ops.size()); op-- > 0;) {
      auto live = live_in_front_of(op);
      more |= live != live_[op];
      live_[op] = std::move(live);
    }
    for (const CallSite& site : facts_.flow.calls)
      for (std::size_t cell = 0; cell < cells_.size(); ++cell)
        if (live_[site.op + 1][cell] && !live_after_[site.routine][cell]) more = live_after_[site.routine][cell] = true;
  }
}

std::vector<bool> WayCells::live_in_front_of(std::uint32_t op) const {
  const Op& now = facts_.program.ops[op];
  const FlowNode& node = facts_.flow.nodes[op];
  std::vector<bool> live(cells_.size(), false);
  const auto add = [&](const std::vector<bool>& more) {
    for (std::size_t cell = 0; cell < live.size(); ++cell)
      if (more[cell]) live[cell] = true;
  };
  for (const std::uint32_t next : node.next) add(live_[next]);
  if (node.ends) add(live_after_[node.routine]);
  const bool surely = node.powered || !now.instruction->rung.needs_power_flow;
  for (const MemoryAccess& access : facts_.effects[op]) {
    if (access.role != Role::Out || access.by_pointer || access.certainty != Certainty::Must || !surely) continue;
    for (std::size_t cell = 0; cell < cells_.size(); ++cell)
      if (access.bits.contains(cells_[cell].bits) && !is_local_clearing(access)) live[cell] = false;
  }
  for (const std::size_t cell : read_by(op)) live[cell] = true;
  if (now.instruction->structure == Structure::Call) add(live_[now.target]);
  return live;
}

void WayCells::forget_all_but(WayMemory& memory, const std::vector<bool>& live) const {
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    if (live[cell] || (memory.sum && live[memory.sum->total] && memory.sum->is_of(cell))) continue;
    detach(memory, cell);
    memory.value[cell] = cells_[cell].ever;
  }
}

bool WayCells::writes(std::uint32_t op, const Bits& bits) const {
  return std::ranges::any_of(facts_.effects[op], [&](const MemoryAccess& access) {
    return access.writes() && !is_anywhere(facts_.program, access) && access.bits.overlaps(bits);
  });
}

bool WayCells::is_written(std::uint32_t op, std::size_t cell) const { return writes(op, cells_[cell].bits); }

std::optional<std::size_t> WayCells::known_at(std::uint64_t first_bit, Width width) const {
  const auto found = number_.find({first_bit, width});
  return found == number_.end() || cells_[found->second].disturbed ? std::nullopt : std::optional(found->second);
}

std::optional<std::size_t> WayCells::at(const Bits& bit) const { return known_at(bit.first, Width::Bit); }

std::optional<std::size_t> WayCells::of(const Operand& operand, Width width) const {
  if (operand.pointer || operand.unread()) return {};
  return known_at(operand.at * std::uint64_t{8}, width);
}

// --- what they hold ---

ValueSet WayCells::value_of(const Program& program, const Operand& operand, Width width, const WayMemory& memory) const {
  if (const auto value = constant_value(program, operand, width)) return {*value, *value};
  const auto cell = of(operand, width);
  return cell ? memory.value[*cell] : ValueSet::all_of(width);
}

bool WayCells::keep(WayMemory& memory, std::optional<std::size_t> cell, const ValueSet& values) const {
  if (!cell) return true;
  ValueSet kept;
  for (const ValueRange& range : values.ranges()) kept.join(memory.value[*cell].within(range.least, range.most));
  if (kept.empty()) return false;
  const std::size_t first = memory.like[*cell];
  for (std::size_t i = 0; i < memory.like.size(); ++i)
    if (memory.like[i] == first) memory.value[i] = kept;
  return true;
}

bool WayCells::is_sign(std::size_t number, const Bits& bit) const {
  const Cell& cell = cells_[number];
  const bool is_signed = cell.width == Width::Word || cell.width == Width::Double;
  return is_signed && !cell.disturbed && bit.first == cell.bits.first + 7;
}

bool WayCells::keep_sign(WayMemory& memory, const Bits& bit, bool on) const {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (!is_sign(i, bit)) continue;
    const ValueRange all = range_of(cells_[i].width);
    if (!keep(memory, i, on ? ValueSet(all.least, -1) : ValueSet(0, all.most))) return false;
  }
  return true;
}

void WayCells::note_no_overflow(WayMemory& memory) const {
  if (memory.sum && memory.sum->shown_by_overflow) memory.sum->fits = true;
}

bool WayCells::apply_sum(WayMemory& memory) const {
  if (!memory.sum || !memory.sum->fits) return true;
  const auto [total, first, second, fits, shown] = *memory.sum;
  const ValueSet &one = memory.value[first], &other = memory.value[second];
  if (one.empty() || other.empty() || one.least() < 0 || other.least() < 0) return true;
  const std::int64_t most = memory.value[total].most(), least = one.least() + other.least();
  if (most < least) return false;
  const ValueSet of_first(0, most - other.least()), of_second(0, most - one.least());
  return keep(memory, total, {least, most}) && keep(memory, first, of_first) && keep(memory, second, of_second);
}

std::optional<WayMemory::Sum> WayCells::sum_of(const WayMemory& memory, std::size_t total, std::size_t added) const {
  if (cells_[total].width != Width::Word || cells_[added].width != Width::Word || total == added) return {};
  for (std::size_t i = 0; i < memory.like.size(); ++i)
    if (i != total && i != added && memory.like[i] == memory.like[total] && cells_[i].width == Width::Word)
      return WayMemory::Sum{.total = total, .first = i, .second = added};
  return {};
}

void WayCells::detach(WayMemory& memory, std::size_t cell) const {
  if (memory.sum && (memory.sum->total == cell || memory.sum->is_of(cell))) memory.sum.reset();
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < memory.like.size(); ++i) {
    if (i == cell || memory.like[i] != memory.like[cell]) continue;
    if (!first) first = i;
    if (memory.like[cell] == cell) memory.like[i] = *first;
  }
  memory.like[cell] = cell;
}

void WayCells::write(WayMemory& memory, const Bits& bits, const std::optional<ValueSet>& result, bool each_bit) const {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Cell& cell = cells_[i];
    if (cell.disturbed || !bits.overlaps(cell.bits)) continue;
    detach(memory, i);
    const ValueSet before = std::exchange(memory.value[i], cell.ever);
    const bool within_cell =
        !each_bit && cell.width != Width::Bit && cell.bits.contains(bits) && bits.end() == cell.bits.end();
    if (within_cell && bits != cell.bits && bits.first % 8 == 0 && !before.empty()) {
      const std::int64_t size = std::int64_t{1} << bits.count;
      memory.value[i] = with_lower_part(before, size, result.value_or(ValueSet(0, size - 1)));
      continue;
    }
    if (!result || result->empty()) continue;
    const bool whole = each_bit ? cell.width == Width::Bit : bits == cell.bits;
    const ValueRange range = range_of(cell.width);
    const bool lower_part = !each_bit && cell.width != Width::Bit && bits.contains(cell.bits) &&
                            bits.end() == cell.bits.end() && result->least() >= 0 && result->most() <= range.most;
    if (whole || lower_part) memory.value[i] = *result;
  }
}

void WayCells::make_copy(WayMemory& memory, std::size_t original, const Bits& bits) const {
  if (cells_[original].bits.overlaps(bits)) return;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (bits != cells_[i].bits || cells_[i].width != cells_[original].width || cells_[i].disturbed) continue;
    const std::size_t before = memory.like[original], first = std::min(i, before);
    for (std::size_t& like : memory.like)
      if (like == before) like = first;
    memory.like[i] = first;
    memory.value[i] = memory.value[original];
  }
}

std::vector<ValueSet> WayCells::parts_of(const Cell& cell, const ValueSet& values) const {
  std::vector<ValueSet> parts;
  ValueSet rest = values;
  for (const std::int64_t value : cell.equals) {
    if (rest.empty()) break;
    parts.push_back(rest.within(value, value));
    rest = rest.that_are(Relation::NotEqual, {value, value});
  }
  if (rest.empty()) return parts;
  std::int64_t from = rest.least();
  for (const std::int64_t size : kSizes) {
    if (size <= from || size > rest.most()) continue;
    parts.push_back(rest.within(from, size - 1));
    from = size;
  }
  parts.push_back(rest.within(from, rest.most()));
  return parts;
}

std::vector<WayMemory> WayCells::split(const WayMemory& memory, std::uint32_t routine) const {
  std::vector<WayMemory> all{memory};
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Cell& cell = cells_[i];
    if (cell.disturbed || !cell.limits || !cell.compared || cell.equals.size() > kMostEquals) continue;
    if (is_accumulator(cell.at) || !reads_[routine].contains(i) || compares_[routine].contains(i)) continue;
    std::vector<WayMemory> parts;
    for (const WayMemory& each : all)
      for (const ValueSet& values : parts_of(cell, each.value[i])) {
        WayMemory part = each;
        if (!values.empty() && keep(part, i, values)) parts.push_back(std::move(part));
      }
    if (parts.size() <= kMostParts) all = std::move(parts);
  }
  return all;
}

void WayCells::forget_writes_of(std::uint32_t routine, WayMemory& memory) const {
  for (const std::size_t cell : writes_[routine]) {
    if (cells_[cell].disturbed) continue;
    detach(memory, cell);
    memory.value[cell] = cells_[cell].ever;
  }
}

}  // namespace s7200

#include "interpreter/analysis/effects/followed_cells.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <tuple>

#include "interpreter/analysis/effects/effects.hpp"
#include "interpreter/analysis/effects/value_boxes.hpp"
#include "interpreter/model/contact_form.hpp"

namespace s7200 {
namespace {

bool is_place_within(std::uint32_t at, std::uint32_t bytes, std::uint32_t from, std::uint32_t to) {
  return at >= from && at + bytes <= to;
}

/// Whether the system goes on writing memory after the op.
bool lets_the_system_write(const Op& op) {
  const std::string_view mnemonic = op.instruction->mnemonic;
  return op.instruction->effect == Effect::Receives || mnemonic == "NETR" || mnemonic == "NETW";
}

/// Saved for interrupts, or memory of its own in each routine.
bool is_own(const FollowedCell& cell) { return is_accumulator(cell.at) || is_local_place(cell.at); }

std::int64_t upper_limit(const FollowedCell& cell, std::int64_t value) {
  const std::int64_t end = ((value + kAreaSize / 2 - 1) & -kAreaSize) + kAreaSize / 2;
  const auto limit = cell.compared.lower_bound(value);
  return limit != cell.compared.end() ? std::min(*limit, end) : end;
}
std::int64_t lower_limit(const FollowedCell& cell, std::int64_t value) {
  const std::int64_t end = ((value - kAreaSize / 2) & -kAreaSize) + kAreaSize / 2;
  const auto limit = cell.compared.upper_bound(value);
  return limit != cell.compared.begin() ? std::max(*std::prev(limit), end) : end;
}

}  // namespace

bool is_accumulator(std::uint32_t at) { return is_place_within(at, 1, image::kAC, image::kTBits); }
bool is_local_place(std::uint32_t at) { return is_place_within(at, 1, image::kL, image::kConstants); }

bool is_quiet(std::uint32_t at, std::uint32_t bytes) {
  return is_place_within(at, bytes, image::kM, image::kSM) || is_accumulator(at) ||
         is_place_within(at, bytes, image::kV, image::kConstants);
}

bool is_of_operand(const MemoryAccess& access) {
  return access.operand != kNoOperand || access.by_pointer || access.bits.contains({0, image::kConstants * 8u});
}

bool is_local_clearing(const MemoryAccess& access) { return access.bits == Bits{image::kL * 8u, 64 * 8}; }

ValueSet widened(const FollowedCell& cell, const ValueSet& before, const ValueSet& now, bool all) {
  ValueSet wide = now;
  for (const ValueRange& range : now.ranges()) {
    bool grows_up = true, grows_down = true, is_new = true;
    for (const ValueRange& old : before.ranges()) {
      const bool overlaps = old.most >= range.least && old.least <= range.most;
      const bool near = all && old.least / kAreaSize == range.least / kAreaSize;
      if (!overlaps && !near) continue;
      is_new = false;
      grows_up &= range.most > old.most;
      grows_down &= range.least < old.least;
    }
    if (!is_new && grows_up) wide.add({range.most, upper_limit(cell, range.most)});
    if (!is_new && grows_down) wide.add({lower_limit(cell, range.least), range.least});
  }
  return wide.fitted(cell.width);
}

FollowedCells::FollowedCells(const Program& program, const ControlFlow& flow,
                             const std::vector<std::vector<MemoryAccess>>& effects, const Pointers& pointers,
                             const Calls& calls)
    : program_(program), flow_(flow), pointers_(pointers) {
  find();
  find_writers(effects, calls);
}

std::optional<std::size_t> FollowedCells::at(std::uint32_t at, Width width) const {
  const auto found = number_.find({at, width});
  return found == number_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::size_t> FollowedCells::of(const Operand& operand, Width width) const {
  return operand.pointer || operand.unread() ? std::nullopt : at(operand.at, width);
}

void FollowedCells::find() {
  for (const Op& op : program_.ops) {
    for (const Operand& operand : op.operand)
      if (operand.pointer) want(operand.at, Width::Double);
    if (op.instruction->structure != Structure::For) continue;
    want(op[1], Width::Word);
    want(op[2], Width::Word);
  }
  for (const Parameter& parameter : program_.parameters)
    if (parameter.actual.pointer) want(parameter.actual.at, Width::Double);
  for (std::size_t before = 0; before != cells_.size();) {
    before = cells_.size();
    want_sources();
  }
  for (const Op& op : program_.ops) {
    note_comparison(op);
    note_counting(op);
  }
}

/// What the program counts is its own.
void FollowedCells::note_counting(const Op& op) {
  if (!step_of(program_, op)) return;
  const ValueBox box = *value_box_of(*op.instruction);
  if (const auto cell = of(op[box.to], op.instruction->operand[box.to].width)) cells_[*cell].kept = true;
}

void FollowedCells::want(const Operand& operand, Width width) {
  if (!operand.pointer && !operand.unread() && operand.at < image::kConstants) want(operand.at, width);
}
void FollowedCells::want(std::uint32_t at, Width width) {
  if (is_accumulator(at)) std::tie(at, width) = std::pair(image::kAC + (at - image::kAC) / 4 * 4, Width::Double);
  if (!is_quiet(at, bytes_of(width)) || !number_.try_emplace({at, width}, cells_.size()).second) return;
  FollowedCell cell{.at = at, .width = width};
  cell.kept = is_accumulator(at) || (width == Width::Double && pointers_.at_any_time(at));
  cells_.push_back(cell);
}

void FollowedCells::want_sources() {
  for (const Op& op : program_.ops) {
    const auto box = value_box_of(*op.instruction);
    if (!box || !box->from || op[box->to].pointer || !is_followed(op[box->to].at, op.instruction->operand[box->to].width))
      continue;
    want(op[*box->from], op.instruction->operand[*box->from].width);
  }
  for (const Parameter& parameter : program_.parameters) {
    if (parameter.width == Width::Bit) continue;
    if (is_followed(parameter.local.at, parameter.width)) want(parameter.actual, parameter.width);
    if (!parameter.actual.pointer && is_followed(parameter.actual.at, parameter.width))
      want(parameter.local, parameter.width);
  }
}

bool FollowedCells::is_followed(std::uint32_t at, Width width) const {
  const Bits bits{at * 8u, bytes_of(width) * 8u};
  return std::ranges::any_of(cells_, [&](const FollowedCell& cell) { return cell.bits().overlaps(bits); });
}

/// Loops that a comparison ends go on to the constant beside it.
void FollowedCells::note_comparison(const Op& op) {
  const ContactForm form = contact_form(*op.instruction);
  if (form.kind != ContactForm::Kind::Numbers || form.type == ContactForm::Type::Real) return;
  const Width width = op.instruction->operand[0].width;
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const auto cell = of(op[i], width);
    const auto with = constant_value(program_, op[1 - i], width);
    if (cell && with) cells_[*cell].compared.insert({*with - 1, *with, *with + 1});
  }
}

void FollowedCells::find_writers(const std::vector<std::vector<MemoryAccess>>& effects, const Calls& calls) {
  writes_.assign(flow_.routines.size(), std::vector<bool>(cells_.size()));
  for (std::uint32_t op = 0; op < program_.ops.size(); ++op)
    for (const MemoryAccess& access : effects[op]) {
      const bool by_call = program_.ops[op].instruction->structure == Structure::Call && !is_local_clearing(access);
      if (!access.writes() || !(is_of_operand(access) || by_call)) continue;
      for (std::size_t i = 0; i < cells_.size(); ++i) {
        if (!access.bits.overlaps(cells_[i].bits())) continue;
        const std::size_t routine = flow_.nodes[op].routine;
        writes_[routine][i] = true;
        if (!access.by_pointer) cells_[i].set_by_name = true;
        if (calls.nodes[routine].by_interrupt && !is_own(cells_[i])) cells_[i].by_interrupt = true;
        if (lets_the_system_write(program_.ops[op])) cells_[i].by_system = true;
      }
    }
  add_writes_of_callees();
}

void FollowedCells::add_writes_of_callees() {
  for (bool more = true; more;) {
    more = false;
    for (const CallSite& site : flow_.calls)
      for (std::size_t i = 0; i < cells_.size(); ++i)
        if (writes_[site.routine][i] && !writes_[flow_.nodes[site.op].routine][i] && !is_local_place(cells_[i].at))
          more = writes_[flow_.nodes[site.op].routine][i] = true;
  }
}

}  // namespace s7200

#include "interpreter/analysis/flow/paths.hpp"

#include <algorithm>
#include <span>

namespace s7200 {

Paths::Paths(const Program& program, ControlFlow flow)
    : program_(program), flow_(std::move(flow)), count_(static_cast<std::uint32_t>(program.ops.size())) {
  find_blocks();
  find_necessary();
}

std::vector<Stretch> Paths::between(std::uint32_t first, std::uint32_t second) const {
  std::vector<bool> seen(block_end_.size());
  std::vector<Stretch> found;
  std::vector<std::uint32_t> open = flow_.nodes[first].next;
  while (!open.empty()) {
    const std::uint32_t from = open.back(), block = block_[from], end = block_end_[block];
    open.pop_back();
    if (seen[block]) continue;
    seen[block] = is_block_begin(from);
    const bool ends_there = from <= second && second < end;
    found.push_back({from, ends_there ? second : end});
    if (!ends_there) open.insert(open.end(), flow_.nodes[end - 1].next.begin(), flow_.nodes[end - 1].next.end());
  }
  return found;
}

std::vector<Stretch> Paths::interrupts() const {
  std::vector<Stretch> found;
  for (const Routine& each : flow_.routines)
    if (each.kind == Routine::Kind::Interrupt) found.push_back({each.first, each.end});
  return found;
}

bool Paths::in_every_scan(std::uint32_t op) {
  return necessary(op, flow_.routine_of(op).first) && routine_in_every_scan(routine(op));
}

/// Basic blocks: ops of which each leads to the next one and nowhere else, and nothing leads into their middle.
void Paths::find_blocks() {
  std::vector<bool> begins(count_ + 1);
  for (std::uint32_t i = 0; i < count_; ++i) {
    const bool goes_on = !flow_.nodes[i].ends && flow_.nodes[i].next.size() == 1 && flow_.nodes[i].next.front() == i + 1;
    if (goes_on) continue;
    begins[i + 1] = true;
    for (const std::uint32_t next : flow_.nodes[i].next) begins[next] = true;
  }
  for (std::uint32_t i = 0; i < count_; ++i) {
    if (i == 0 || begins[i]) block_end_.push_back(i);
    block_.push_back(static_cast<std::uint32_t>(block_end_.size() - 1));
    block_end_.back() = i + 1;
  }
}

/// Whether no way from `op` to the end of its routine leads around `other`; each op is on its own ways.
bool Paths::necessary(std::uint32_t other, std::uint32_t op) const {
  return !ends_[op] || (ends_[other] && span_[other].first <= span_[op].first && span_[op].second <= span_[other].second);
}

/// The tree of post-dominators (Cooper, Harvey, Kennedy, "A Simple, Fast Dominance Algorithm", 2001): the parent of an op
/// is the next one that all its ways to the end have in common, `count_` the end of all routines.
void Paths::find_necessary() {
  constexpr std::uint32_t kUnknown = 0xFFFF'FFFF;
  const std::vector<std::uint32_t> order = from_the_end();
  std::vector<std::uint32_t> parent(count_ + 1, kUnknown), rank(count_ + 1, 0);
  for (std::uint32_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
  parent[count_] = count_;
  const auto meet = [&](std::uint32_t a, std::uint32_t b) {
    while (a != b) (rank[a] > rank[b] ? a : b) = parent[rank[a] > rank[b] ? a : b];
    return a;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const std::uint32_t op : std::span(order).subspan(1)) {
      std::uint32_t common = flow_.nodes[op].ends ? count_ : kUnknown;
      for (const std::uint32_t next : flow_.nodes[op].next)
        if (parent[next] != kUnknown) common = common == kUnknown ? next : meet(common, next);
      changed |= std::exchange(parent[op], common) != common;
    }
  }
  number_tree(order, parent);
}

/// The end and all ops with a way to it, each after one that it leads to.
std::vector<std::uint32_t> Paths::from_the_end() const {
  std::vector<std::vector<std::uint32_t>> comes_from(count_ + 1);
  for (std::uint32_t i = 0; i < count_; ++i) {
    for (const std::uint32_t next : flow_.nodes[i].next) comes_from[next].push_back(i);
    if (flow_.nodes[i].ends) comes_from[count_].push_back(i);
  }
  std::vector<bool> seen(count_ + 1);
  std::vector<std::uint32_t> order;
  std::vector<std::pair<std::uint32_t, std::size_t>> open{{count_, 0}};  // op, how many of those before it are done
  seen[count_] = true;
  while (!open.empty()) {
    auto& [op, done] = open.back();
    if (done == comes_from[op].size()) {
      order.push_back(op);
      open.pop_back();
    } else if (const std::uint32_t before = comes_from[op][done++]; !seen[before]) {
      seen[before] = true;
      open.emplace_back(before, 0);
    }
  }
  std::ranges::reverse(order);
  return order;
}

/// Numbers the ops so that those below an op in the tree have the numbers of its span.
void Paths::number_tree(const std::vector<std::uint32_t>& order, const std::vector<std::uint32_t>& parent) {
  ends_.assign(count_ + 1, false);
  span_.assign(count_ + 1, {0, 0});
  std::vector<std::uint32_t> below(count_ + 1, 1), next(count_ + 1, 0);
  for (std::size_t i = order.size(); --i > 0;) below[parent[order[i]]] += below[order[i]];
  for (const std::uint32_t op : order) {
    const std::uint32_t first = op == count_ ? 0 : next[parent[op]];
    ends_[op] = true;
    span_[op] = {first, first + below[op] - 1};
    if (op != count_) next[parent[op]] = first + below[op];
    next[op] = first + 1;
  }
}

bool Paths::routine_in_every_scan(std::uint32_t routine) {
  if (routine == 0) return true;
  const auto [known, added] = called_.try_emplace(routine, false);  // until it is known; a recursive call finds this value
  if (!added) return known->second;
  for (const CallSite& call : flow_.calls)
    if (!called_[routine] && call.routine == routine && flow_.nodes[call.op].powered)
      called_[routine] = in_every_scan(call.op);
  return called_[routine];
}

}  // namespace s7200

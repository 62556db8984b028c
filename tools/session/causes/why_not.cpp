#include "tools/session/causes/why_not.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/cpu/units/forcing.hpp"
#include "tools/session/causes/contacts.hpp"
#include "tools/session/causes/last/last_changes.hpp"
#include "tools/session/causes/obstacles.hpp"
#include "tools/session/past/actions/access.hpp"
#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

constexpr Time kJustBefore = 50 * kMillisecond;  // at least; three scans if these are longer

/// The last execution of each instruction of a part of the past, and when its last whole scan began.
class LastOfEach final : public Reader {
 public:
  using Reader::Reader;
  void record(const TraceRecord& record) override {
    if (record.kind == TraceKind::ScanBegin) whole_scan = std::exchange(scan_, record.at);
  }
  void instruction(const InstructionRecord& record) override { last[record.op] = record; }

  LatelyExecuted last{};
  Time whole_scan = 0;

 private:
  Time scan_ = 0;
};

std::optional<Bits> bit_of(const MemoryRange& range) {
  if (range.width == Width::Bit) return bits_of(range);
  const AreaInfo& area = info(range.area);
  const bool has_bit = range.count == 1 && (range.area == Area::T || range.area == Area::C);
  if (!has_bit) return {};
  return Bits{std::uint64_t{area.bits} * 8 + range.number, 1};
}

/// As those outside see it: what is forced is as it is forced.
bool is_on_outside(const State& state, const Bits& bit) {
  std::uint8_t byte = state.image[bit.first / 8];
  forcing::put_over(state, static_cast<std::uint32_t>(bit.first / 8), {&byte, 1});
  return (byte >> (bit.first % 8) & 1) != 0;
}

bool is_on(const Cpu& cpu, const Bits& bit) { return (cpu.state().image[bit.first / 8] >> (bit.first % 8) & 1) != 0; }

/// The bits of memory that the answer names.
void collect(Obstacle& obstacle, std::vector<Obstacle*>& all) {
  if (obstacle.bits.count != 0) all.push_back(&obstacle);
  for (Obstacle& each : obstacle.because) collect(each, all);
}

bool add_times(History& history, std::size_t station, Obstacle& answer, StopToken stop_request) {
  std::vector<Obstacle*> nodes;
  collect(answer, nodes);
  std::vector<Bits> places;
  for (const Obstacle* node : nodes) places.push_back(node->bits);
  const auto changes = find_last_changes(history, station, places, stop_request);
  if (!changes) return false;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i]->since = (*changes)[i].at;
    nodes[i]->since_longer = (*changes)[i].earlier;
  }
  return true;
}

Obstacle tree_of(const Wish& wish, Obstacles& obstacles, const Cpu& cpu) {
  if (wish.bit) return obstacles.of_bit(*wish.bit, wish.on);
  const bool holds = holds_now(wish, cpu).value_or(false);
  Obstacle answer{.kind = "condition",
                  .text = fmt::format("{} {}: {}", stl::printable(wish.text), holds ? "holds" : "does not hold",
                                      wish.condition->places_text(cpu, Expression::SeenBy::Outside))};
  for (const Place& place : wish.condition->places_against(!holds, cpu)) {
    const auto range = range_now(place, cpu);
    if (!range) continue;
    const auto bit = range->width == Width::Bit ? bit_of(*range) : std::nullopt;
    answer.because.push_back(bit ? obstacles.of_bit(*bit, !is_on(cpu, *bit)) : obstacles.of_value(bits_of(*range)));
  }
  return answer;
}

Obstacle answer_to(const Wish& wish, Obstacles& obstacles, const Cpu& cpu) {
  Obstacle answer = tree_of(wish, obstacles, cpu);
  number_lines(answer);
  return answer;
}

}  // namespace

Result<Wish> parse_wish(std::string_view text, const Program& program) {
  Wish wish{.text = std::string(stl::trim(text))};
  std::string_view address = wish.text;
  const bool negated = stl::lower_case(address.substr(0, 4)) == "not ";
  if (negated) address = stl::trim(address.substr(4));
  const auto place = parse_place(address, program);
  const auto range = place && !place->pointer ? std::optional(place->range) : std::nullopt;
  if (range) wish.bit = bit_of(*range);
  wish.on = !negated;
  if (wish.bit) return wish;
  auto condition = Expression::parse(wish.text, program);
  if (!condition) return condition.trouble();
  wish.condition = *std::move(condition);
  return wish;
}

std::vector<Bits> bits_of(const Wish& wish) {
  if (wish.bit) return {*wish.bit};
  std::vector<Bits> all;
  for (const Place& place : wish.condition->places())
    if (!place.pointer && place.range.width == Width::Bit) all.push_back(bits_of(place.range));
  return all;
}

Result<bool> holds_now(const Wish& wish, const Cpu& cpu) {
  if (wish.bit) return is_on_outside(cpu.state(), *wish.bit) == wish.on;
  const auto value = wish.condition->value(cpu, Expression::SeenBy::Outside);
  if (!value) return value.trouble();
  return value->truth();
}

std::optional<Obstacle> why_not(History& history, std::size_t station, const Wish& wish, StopToken stop_request) {
  const Moment start = history.now();
  const State& state = history.station(station).cpu().state();
  const Time lately = std::max(kJustBefore, 2 * state.longest_scan + start.time - std::min(start.time, state.scan_begin));
  LastOfEach last(station, stop_request);
  const bool played = history.go_to(start.time - std::min(start.time, lately)) && history.play(last, start);
  history.go_to(start);
  if (!played) return {};
  const Cpu& cpu = history.station(station).cpu();
  const Facts facts = facts_of(cpu.program());
  Obstacles obstacles(cpu, facts, last.last, last.whole_scan);
  Obstacle answer = answer_to(wish, obstacles, cpu);
  const bool timed = add_times(history, station, answer, stop_request);
  history.go_to(start);
  if (!timed) return {};
  return answer;
}

Obstacle why_not(const Cpu& cpu, const Wish& wish) {
  const LatelyExecuted nothing;
  const Facts facts = facts_of(cpu.program());
  Obstacles obstacles(cpu, facts, nothing, 0);
  return answer_to(wish, obstacles, cpu);
}

Obstacle what_keeps(const Cpu& cpu, const Wish& wish) {
  Wish other = wish;
  if (other.bit) other.on = !is_on(cpu, *other.bit);
  Obstacle answer = why_not(cpu, other);
  answer.wanted.clear();
  return answer;
}

}  // namespace s7200::tools

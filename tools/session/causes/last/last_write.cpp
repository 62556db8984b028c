#include "tools/session/causes/last/last_write.hpp"

#include <algorithm>
#include <utility>

#include "tools/session/past/actions/access.hpp"
#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

class WriteFinder final : public Reader {
 public:
  WriteFinder(const History& history, std::size_t station, const MemoryRange& range, StopToken stop_request)
      : Reader(station, stop_request),
        cpu_(history.station(station).cpu()),
        history_(history),
        station_(station),
        range_(range),
        bits_(bits_of(range)),
        level_(level()) {
    for (std::uint32_t op = 0; op < cpu_.program().ops.size(); ++op)
      may_write_.push_back(may_access(cpu_, op, Access::Write, bits_));
  }

  void begin() {
    value_ = range_.bytes_in(cpu_.state().image);
    in_front_ = history_.now();
  }
  /// Whether there was a write, in this part or between its last instruction and its end.
  bool found() {
    in_front_ = history_.now();
    note_change_between();
    return last_.has_value();
  }
  const std::optional<LastWrite>& last() const { return last_; }

  bool before_action() override {
    in_front_ = history_.now();
    note_change_between();
    return true;
  }

  void before_planned(std::size_t) override { note_change_between(); }
  void planned_done(std::size_t number) override {
    if (!changed()) return;
    note(std::nullopt, history_.now().time);
    last_->planned = number;
  }

  void acted() override {
    const std::size_t number = in_front_.actions;
    const Action* const action = history_.action(number);
    const bool own = action && history_.station_of_action(number) == station_;
    if (!changed() && !(own && assigns(*action))) return;
    note(std::nullopt, cpu_.time());
    last_->action = number;
  }

  bool before(std::uint32_t op) override {
    if (!Reader::before(op)) return false;
    in_front_ = history_.in_front();
    note_change_between();
    writes_ = may_write_[op] && accesses(cpu_, op, Access::Write, bits_);
    call_ = writes_ ? call_that_ends(cpu_, op) : std::nullopt;
    errors_ = cpu_.state().error_count;
    in_interrupt_ = cpu_.state().in_interrupt;
    return true;
  }

  void instruction(const InstructionRecord& record) override {
    if (is_elsewhere()) return;
    const bool wrote = writes_ && record.powered && errors_ == cpu_.state().error_count;
    if (wrote || (changed() && !has_come_back(record.op))) note(record, record.end);
    if (changed()) value_ = range_.bytes_in(cpu_.state().image);
  }

 private:
  /// Which routine's local memory is in the image.
  struct Level {
    bool in_interrupt = false;
    std::uint8_t calls = 0;
    bool operator==(const Level&) const = default;
  };
  Level level() const { return {cpu_.state().in_interrupt, cpu_.state().call_depth}; }

  /// Local memory is that of another routine than the one that was asked about.
  bool is_elsewhere() const { return range_.area == Area::L && level() != level_; }

  /// Local memory that is there again after a subroutine or an interrupt routine is not written by its end.
  bool has_come_back(std::uint32_t op) const {
    const Op& by = cpu_.program().ops[op];
    return range_.area == Area::L && !writes_ &&
           (returns_from_subroutine(by) || by.instruction->structure == Structure::Call ||
            by.instruction->structure == Structure::InterruptEnd || by.instruction->effect == Effect::ConditionalEnd);
  }

  bool changed() const {
    const auto& image = cpu_.state().image;
    if (range_.width == Width::Bit) return (image[range_.at] >> range_.bit & 1) != value_[0];
    return !std::equal(value_.begin(), value_.end(), image.begin() + range_.at);
  }

  void note_change_between() {
    if (!is_elsewhere() && changed()) note(std::nullopt, cpu_.time());
  }

  /// Whether it has written the value that is there. Inputs get theirs when they are read.
  bool assigns(const Action& action) const {
    const auto holds = [this](const Assignment& one) {
      std::uint32_t value = 0;
      for (const std::uint8_t byte : one.place.bytes_in(cpu_.state().image)) value = value << 8 | byte;
      return value == one.value && bits_of(one.place).overlaps(bits_);
    };
    if (const auto* set = std::get_if<SetMemory>(&action)) return std::ranges::any_of(set->assignments, holds);
    const auto* const force = std::get_if<Force>(&action);
    return force && std::ranges::any_of(force->assignments, holds);
  }

  void note(const std::optional<InstructionRecord>& by, Time at) {
    const State& state = cpu_.state();
    std::vector<std::uint8_t> value = range_.bytes_in(state.image);
    last_ = {.moment = in_front_,
             .by = by,
             .call = {},
             .action = {},
             .planned = {},
             .at = at,
             .in_interrupt = by && in_interrupt_,
             .event = state.serving_event,
             .routine = state.serving_routine,
             .before = std::exchange(value_, value),
             .after = std::move(value)};
    if (by) last_->call = call_;
  }

  const Cpu& cpu_;
  const History& history_;
  std::size_t station_;
  MemoryRange range_;
  Bits bits_;
  std::vector<bool> may_write_;  ///< by op
  std::vector<std::uint8_t> value_;
  Moment in_front_;
  Level level_;  ///< where it was asked
  bool writes_ = false, in_interrupt_ = false;
  std::optional<std::uint32_t> call_{};  ///< that the instruction being executed ends
  std::uint64_t errors_ = 0;
  std::optional<LastWrite> last_;
};

}  // namespace

WriteSearch find_last_write(History& history, std::size_t station, const MemoryRange& range, StopToken stop_request) {
  const Moment start = history.now();
  WriteFinder finder(history, station, range, stop_request);
  const auto search = history.search_back(
      finder, start, [&] { finder.begin(); }, [&] { return finder.found(); }, history.may_have_written(station, range));
  history.go_to(start);
  return {search == History::Search::Found ? finder.last() : std::nullopt, search == History::Search::Interrupted};
}

}  // namespace s7200::tools

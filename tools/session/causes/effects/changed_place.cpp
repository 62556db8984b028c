#include "tools/session/causes/effects/changed_place.hpp"

#include <utility>

#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

class PlaceWatcher final : public Reader {
 public:
  PlaceWatcher(const History& history, std::size_t station, const Bits& place, StopToken stop_request)
      : Reader(station, stop_request), history_(history), cpu_(history.station(station).cpu()), place_(place) {}

  void begin() {
    value_ = bytes_at(cpu_.state(), place_);
    before_ = history_.now();
  }
  bool found() {
    look({});
    return last.has_value();
  }

  bool before(std::uint32_t op) override {
    look({});
    before_ = history_.in_front();
    return Reader::before(op);
  }
  bool before_action() override {
    look({});
    before_ = history_.now();
    return true;
  }
  void acted() override {
    const std::size_t number = before_.actions;
    look({.before = {}, .by = {}, .action = number, .planned = {}, .was = {}, .became = {}});
  }
  void planned_done(std::size_t number) override {
    look({.before = {}, .by = {}, .action = {}, .planned = number, .was = {}, .became = {}});
  }
  void instruction(const InstructionRecord& record) override {
    look({.before = {}, .at = record.at, .by = record, .action = {}, .planned = {}, .was = {}, .became = {}});
  }

  std::optional<ChangedPlace> last{};

 private:
  void look(ChangedPlace change) {
    std::vector<std::uint8_t> value = bytes_at(cpu_.state(), place_);
    if (value == value_) return;
    change.before = before_;
    if (!change.by) change.at = cpu_.time();
    change.was = std::exchange(value_, value);
    change.became = std::move(value);
    last = std::move(change);
  }

  const History& history_;
  const Cpu& cpu_;
  Bits place_;
  std::vector<std::uint8_t> value_{};
  Moment before_{};
};

}  // namespace

std::vector<std::uint8_t> bytes_at(const State& state, const Bits& place) {
  const std::size_t at = place.first / 8;
  if (place.count == 1) return {static_cast<std::uint8_t>(state.image[at] >> (place.first % 8) & 1)};
  return {state.image.begin() + static_cast<std::ptrdiff_t>(at),
          state.image.begin() + static_cast<std::ptrdiff_t>(at + place.count / 8)};
}

ChangeSearch find_changed_place(History& history, std::size_t station, const Bits& place, StopToken stop_request) {
  const Moment start = history.now();
  PlaceWatcher watcher(history, station, place, stop_request);
  const auto search = history.search_back(
      watcher, start, [&] { watcher.begin(); }, [&] { return watcher.found(); });
  history.go_to(start);
  return {search == History::Search::Found ? watcher.last : std::nullopt, search == History::Search::Interrupted};
}

}  // namespace s7200::tools

#include "tools/session/causes/last/last_changes.hpp"

#include <algorithm>

namespace s7200::tools {
namespace {

constexpr Time kLookedBack = 60 * kSecond;

std::uint64_t bits_at(const Cpu& cpu, const Bits& place) {
  std::uint64_t value = 0;
  for (std::uint64_t bit = place.first; bit < place.first + std::min<std::uint64_t>(place.count, 64); ++bit)
    value = value << 1 | (cpu.state().image[bit / 8] >> (bit % 8) & 1);
  return value;
}

/// Looks at the places at the beginning of each scan.
class ChangeFinder final : public Observer {
 public:
  ChangeFinder(const History& history, std::size_t station, const std::vector<Bits>& places)
      : Observer(station),
        cpu_(history.station(station).cpu()),
        places_(places),
        found_(places.size()),
        values_(places.size()),
        part_(places.size()) {}

  bool wants_scans() const override { return true; }
  void record(const TraceRecord& record) override {
    if (record.kind == TraceKind::ScanBegin) look(record.at);
  }

  void begin() {
    for (std::size_t i = 0; i < places_.size(); ++i) values_[i] = bits_at(cpu_, places_[i]);
    part_.assign(places_.size(), std::nullopt);
  }
  /// Whether all are found; what a later part has found stands.
  bool end(Time now) {
    look(now);
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (!found_[i]) found_[i] = part_[i];
    return std::ranges::all_of(found_, [](const std::optional<Time>& one) { return one.has_value(); });
  }
  const std::vector<std::optional<Time>>& found() const { return found_; }

 private:
  void look(Time at) {
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const std::uint64_t value = bits_at(cpu_, places_[i]);
      if (value == values_[i]) continue;
      values_[i] = value;
      part_[i] = at;
    }
  }

  const Cpu& cpu_;
  const std::vector<Bits>& places_;
  std::vector<std::optional<Time>> found_;
  std::vector<std::uint64_t> values_;
  std::vector<std::optional<Time>> part_;
};

}  // namespace

std::optional<std::vector<LastChange>> find_last_changes(History& history, std::size_t station,
                                                         const std::vector<Bits>& places, StopToken stop_request) {
  const Moment start = history.now();
  const Time bound = start.time - std::min(start.time, kLookedBack);
  ChangeFinder finder(history, station, places);
  Time looked_at = start.time;
  const auto begin = [&] {
    looked_at = history.now().time;
    finder.begin();
  };
  const auto found = [&] { return finder.end(history.now().time) || looked_at <= bound || stop_request.stop_requested(); };
  const History::Search search = history.search_back(finder, start, begin, found);
  history.go_to(start);
  if (search == History::Search::Interrupted || stop_request.stop_requested()) return {};
  std::vector<LastChange> changes;
  for (const auto& at : finder.found())
    changes.push_back({at.value_or(looked_at), !at && looked_at > history.usage().oldest.time});
  return changes;
}

}  // namespace s7200::tools

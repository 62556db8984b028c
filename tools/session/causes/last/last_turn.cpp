#include "tools/session/causes/last/last_turn.hpp"

#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

class TurnFinder final : public Reader {
 public:
  TurnFinder(const History& history, std::size_t station, const std::function<bool(const State& state)>& holds,
             StopToken stop_request)
      : Reader(station, stop_request), history_(history), cpu_(history.station(station).cpu()), holds_(holds) {}

  void begin() { held_ = holds_(cpu_.state()); }

  bool before(std::uint32_t op) override {
    look({.moment = history_.in_front(), .at = cpu_.time()});
    in_front_ = history_.in_front();
    return Reader::before(op);
  }
  bool before_action() override {
    look({.moment = history_.now(), .at = cpu_.time()});
    return true;
  }
  void acted() override { look({.moment = history_.now(), .at = cpu_.time(), .from_outside = true}); }
  void instruction(const InstructionRecord& record) override { look({.moment = in_front_, .at = record.at, .by = record}); }

  std::optional<LastTurn> last;

 private:
  void look(const LastTurn& now) {
    const bool holds = holds_(cpu_.state());
    if (holds && !held_) last = now;
    held_ = holds;
  }

  const History& history_;
  const Cpu& cpu_;
  const std::function<bool(const State& state)>& holds_;
  bool held_ = false;
  Moment in_front_;
};

}  // namespace

TurnSearch find_last_turn(History& history, std::size_t station, const std::function<bool(const State& state)>& holds,
                          StopToken stop_request) {
  const Moment start = history.now();
  TurnFinder finder(history, station, holds, stop_request);
  const auto search = history.search_back(
      finder, start, [&] { finder.begin(); }, [&] { return finder.last.has_value(); });
  history.go_to(start);
  return {search == History::Search::Found ? finder.last : std::nullopt, search == History::Search::Interrupted};
}

}  // namespace s7200::tools

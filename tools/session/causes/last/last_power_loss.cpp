#include "tools/session/causes/last/last_power_loss.hpp"

#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

class PowerLossFinder final : public Reader {
 public:
  PowerLossFinder(const History& history, std::size_t station, StopToken stop_request)
      : Reader(stop_request), history_(history), plc_(history.station(station).plc()) {}

  void begin() { powered_ = plc_.powered(); }

  bool before_action() override {
    action_ = history_.now().actions;
    return true;
  }
  void acted() override { look(action_, std::nullopt); }
  void planned_done(std::size_t number) override { look(std::nullopt, number); }

  std::optional<LastPowerLoss> last;

 private:
  void look(std::optional<std::size_t> action, std::optional<std::size_t> planned) {
    if (powered_ && !plc_.powered()) last = {.at = history_.now().time, .action = action, .planned = planned};
    powered_ = plc_.powered();
  }

  const History& history_;
  const serial::Plc& plc_;
  bool powered_ = false;
  std::size_t action_ = 0;
};

}  // namespace

PowerLossSearch find_last_power_loss(History& history, std::size_t station, StopToken stop_request) {
  const Moment start = history.now();
  PowerLossFinder finder(history, station, stop_request);
  const auto search = history.search_back(
      finder, start, [&] { finder.begin(); }, [&] { return finder.last.has_value(); });
  history.go_to(start);
  return {search == History::Search::Found ? finder.last : std::nullopt, search == History::Search::Interrupted};
}

}  // namespace s7200::tools

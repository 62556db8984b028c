#include "tools/session/observers/last_instructions.hpp"

#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

class Collector final : public Reader {
 public:
  Collector(const Cpu& cpu, std::size_t station, StopToken stop_request) : Reader(station, stop_request), cpu_(cpu) {}

  /// An earlier part is going to be played.
  void begin() {
    all.insert(all.begin(), part_.begin(), part_.end());
    part_.clear();
  }
  void instruction(const InstructionRecord& record) override { part_.push_back(execution_of(record, cpu_)); }
  std::size_t size() const { return all.size() + part_.size(); }

  std::vector<Execution> all;

 private:
  const Cpu& cpu_;
  std::vector<Execution> part_;  ///< of what is being played
};

}  // namespace

std::optional<std::vector<Execution>> last_instructions(History& history, std::size_t station, std::size_t count,
                                                        StopToken stop_request) {
  const Moment start = history.now();
  Collector collector(history.station(station).cpu(), station, stop_request);
  const auto search = history.search_back(
      collector, start, [&] { collector.begin(); }, [&] { return collector.size() >= count; });
  history.go_to(start);
  if (search == History::Search::Interrupted) return {};
  collector.begin();
  if (collector.all.size() > count)
    collector.all.erase(collector.all.begin(), collector.all.end() - static_cast<std::ptrdiff_t>(count));
  return collector.all;
}

}  // namespace s7200::tools

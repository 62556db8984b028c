#include "tools/debugger/attachment.hpp"

namespace s7200::tools {
namespace {

/// Sees every instruction until someone asks it to stop.
class Reader : public Observer {
 public:
  Reader(std::size_t station, const std::atomic<bool>* stop_request) : Observer(station), stop_request_(stop_request) {}
  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t) override { return !(stop_request_ && *stop_request_); }

 private:
  const std::atomic<bool>* stop_request_;
};

class AttachmentFinder final : public Reader {
 public:
  AttachmentFinder(const History& history, std::size_t station, std::uint8_t event, const std::atomic<bool>* stop_request)
      : Reader(station, stop_request), history_(history), event_(event) {}

  bool before(std::uint32_t op) override {
    in_front_ = history_.in_front();
    return Reader::before(op);
  }
  void record(const TraceRecord& record) override {
    const bool meant = record.kind == TraceKind::Attach || record.kind == TraceKind::Detach;
    if (meant && record.event == event_) now_ = record;
  }
  void instruction(const InstructionRecord& record) override {
    if (now_) last = {.moment = in_front_, .what = *now_, .by = record};
    now_.reset();
  }

  std::optional<LastAttachment> last;

 private:
  const History& history_;
  std::uint8_t event_;
  Moment in_front_;
  std::optional<TraceRecord> now_;  ///< done by the instruction being executed
};

class Collector final : public Reader {
 public:
  using Reader::Reader;

  void begin() {
    all.insert(all.begin(), part_.begin(), part_.end());
    part_.clear();
  }
  void instruction(const InstructionRecord& record) override { part_.push_back(record); }
  std::size_t size() const { return all.size() + part_.size(); }

  std::vector<InstructionRecord> all;

 private:
  std::vector<InstructionRecord> part_;  ///< of what is being played
};

}  // namespace

AttachmentSearch find_last_attachment(History& history, std::size_t station, std::uint8_t event,
                                      const std::atomic<bool>* stop_request) {
  const Moment start = history.now();
  AttachmentFinder finder(history, station, event, stop_request);
  const auto search = history.search_back(
      finder, start, [] {}, [&] { return finder.last.has_value(); });
  history.go_to(start);
  return {search == History::Search::Found ? finder.last : std::nullopt, search == History::Search::Interrupted};
}

std::optional<std::vector<InstructionRecord>> last_instructions(History& history, std::size_t station, std::size_t count,
                                                                const std::atomic<bool>* stop_request) {
  const Moment start = history.now();
  Collector collector(station, stop_request);
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

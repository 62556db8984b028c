#include "tools/session/causes/last/last_attachment.hpp"

#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

class AttachmentFinder final : public Reader {
 public:
  AttachmentFinder(const History& history, std::size_t station, std::uint8_t event, StopToken stop_request)
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

}  // namespace

AttachmentSearch find_last_attachment(History& history, std::size_t station, std::uint8_t event, StopToken stop_request) {
  const Moment start = history.now();
  AttachmentFinder finder(history, station, event, stop_request);
  const auto search = history.search_back(
      finder, start, [] {}, [&] { return finder.last.has_value(); });
  history.go_to(start);
  return {search == History::Search::Found ? finder.last : std::nullopt, search == History::Search::Interrupted};
}

}  // namespace s7200::tools

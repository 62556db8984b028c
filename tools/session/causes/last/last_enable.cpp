#include "tools/session/causes/last/last_enable.hpp"

#include "interpreter/trace/interrupt_enabling.hpp"
#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

class EnableFinder final : public Reader {
 public:
  EnableFinder(const History& history, std::size_t station, StopToken stop_request)
      : Reader(station, stop_request), history_(history), station_(station) {}

  /// A part of the past begins, and has ended: what is found in an earlier one began earlier. Whether it was the beginning
  /// is known if interrupts were enabled in the part, or the CPU went to RUN.
  void begin_part() {
    in_part_.reset();
    enabled_.reset();
    is_beginning_ = history_.station(station_).cpu().state().interrupts_enabled;
    if (is_beginning_) enabled_ = true;
  }
  bool end_part() {
    if (in_part_ && (in_part_->by || !last)) last = in_part_;
    return is_beginning_;
  }

  bool before(std::uint32_t op) override {
    in_front_ = history_.in_front();
    return Reader::before(op);
  }
  void record(const TraceRecord& record) override {
    if (record.kind == TraceKind::Enable) now_ = record;
    if (record.kind != TraceKind::ModeChange) return;
    in_part_ = {.moment = history_.now(), .at = record.at};
    enabled_.reset();
    is_beginning_ = true;
  }
  void instruction(const InstructionRecord& record) override {
    if (!now_) return;
    const bool enables = now_->code == 1;
    if (changes_interrupts(*now_, enabled_)) in_part_ = {.moment = in_front_, .at = now_->at, .by = record};
    enabled_ = enables;
    is_beginning_ |= enables;
    now_.reset();
  }

  std::optional<LastEnable> last;

 private:
  const History& history_;
  std::size_t station_;
  Moment in_front_;
  std::optional<TraceRecord> now_;  ///< done by the instruction being executed
  std::optional<LastEnable> in_part_;
  std::optional<bool> enabled_;  ///< by an instruction of the part, or at its beginning
  bool is_beginning_ = false;
};

}  // namespace

EnableSearch find_last_enable(History& history, std::size_t station, StopToken stop_request) {
  const Moment start = history.now();
  EnableFinder finder(history, station, stop_request);
  const auto search = history.search_back(
      finder, start, [&] { finder.begin_part(); }, [&] { return finder.end_part(); });
  history.go_to(start);
  const bool interrupted = search == History::Search::Interrupted;
  return {interrupted ? std::nullopt : finder.last, interrupted};
}

}  // namespace s7200::tools

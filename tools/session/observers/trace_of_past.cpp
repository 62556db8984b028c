#include "tools/session/observers/trace_of_past.hpp"

#include <algorithm>

#include "tools/session/causes/last/last_enable.hpp"
#include "tools/session/past/reader.hpp"

namespace s7200::tools {
namespace {

using Disabled = TraceReasons::Disabled;

/// The scan, two before it, which the watchdog allows 300 ms each, and most frames that are not answered yet.
constexpr Time kToldBefore = kSecond;

bool enables(const Op& op) { return op.instruction->effect == Effect::EnablesInterrupts; }

bool has_disi(const Program& program) {
  return std::ranges::any_of(program.ops, [](const Op& op) { return op.instruction->mnemonic == "DISI"; });
}

Time oldest_waiting(const History& history) {
  Time oldest = history.now().time;
  for (std::size_t number = 0; number < history.stations(); ++number)
    for (const InterruptQueue& queue : history.station(number).cpu().state().queue)
      for (std::size_t i = 0; i < queue.count; ++i) oldest = std::min(oldest, queue.entry[i].at);
  return oldest;
}

class TraceReader final : public Reader {
 public:
  TraceReader(const History& history, const std::vector<TraceLines*>& traces, StopToken stop_request)
      : Reader(stop_request), history_(history), traces_(traces) {}
  void record(const TraceRecord& record) override { traces_[history_.told_of()]->of(record); }
  void instruction(const InstructionRecord& record) override { traces_[history_.told_of()]->of(record); }

 private:
  const History& history_;
  const std::vector<TraceLines*>& traces_;
};

}  // namespace

Disabled interrupts_disabled(History& history, std::size_t station, StopToken stop_request) {
  const Cpu& cpu = history.station(station).cpu();
  if (cpu.state().interrupts_enabled) return {};
  if (!has_disi(cpu.program())) return {Disabled::By::NoEni};
  const EnableSearch search = find_last_enable(history, station, stop_request);
  if (search.enable && search.enable->by && !enables(cpu.program().ops[search.enable->by->op]))
    return {Disabled::By::Disi, search.enable->by->op};
  const bool known = search.enable || (!search.interrupted && history.usage().forgotten == 0);
  return {known ? Disabled::By::NoEni : Disabled::By::Forgotten};
}

bool tell_what_was_before(History& history, const std::vector<TraceLines*>& traces, StopToken stop_request) {
  const Moment now = history.now();
  const Time oldest = oldest_waiting(history);
  bool told = history.go_to(oldest - std::min(oldest, kToldBefore));
  if (now < history.now()) history.go_to(now);
  for (std::size_t number = 0; number < traces.size(); ++number)
    traces[number]->forget(interrupts_disabled(history, number, stop_request));
  TraceReader teller(history, traces, stop_request);
  told = told && history.play(teller, now);
  history.go_to(now);
  for (std::size_t number = 0; !told && number < traces.size(); ++number) traces[number]->forget({Disabled::By::Forgotten});
  return told;
}

}  // namespace s7200::tools

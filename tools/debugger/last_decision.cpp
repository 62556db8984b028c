#include "tools/debugger/last_decision.hpp"

#include <algorithm>

#include "interpreter/trace/trace_reasons.hpp"

namespace s7200::tools {
namespace {

constexpr Time kEarlier = kSecond;  // more than the watchdog gives a scan: what is known of it is complete

class Reader final : public Observer {
 public:
  Reader(const Program& program, const std::atomic<bool>* stop_request) : reasons(program), stop_request_(stop_request) {}
  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t) override { return !(stop_request_ && *stop_request_); }
  void record(const TraceRecord& record) override { reasons.note(record); }
  void instruction(const InstructionRecord& record) override { reasons.note(record); }

  TraceReasons reasons;

 private:
  const std::atomic<bool>* stop_request_;
};

/// Stops in front of an instruction, in an interrupt or not.
class Finder final : public Observer {
 public:
  Finder(const Cpu& cpu, std::uint32_t op, bool in_interrupt) : cpu_(cpu), op_(op), in_interrupt_(in_interrupt) {}
  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t op) override { return op != op_ || cpu_.state().in_interrupt != in_interrupt_; }

 private:
  const Cpu& cpu_;
  std::uint32_t op_;
  bool in_interrupt_;
};

}  // namespace

DecisionSearch find_last_decision(serial::Simulation& simulation, History& history, const std::atomic<bool>* stop_request) {
  const Moment start = history.now();
  Reader reader(simulation.cpu().program(), stop_request);
  const bool whole = history.go_to(start.time - std::min(start.time, kEarlier)) && history.play(reader, start);
  const auto cause = whole ? reader.reasons.cause() : std::nullopt;
  DecisionSearch search{.decision = {}, .interrupted = !whole};
  const auto in_front_of = [&](const InstructionRecord& from, std::uint32_t op) {
    Finder finder(simulation.cpu(), op, cause->in_interrupt);
    if (history.go_to(from.at)) history.play(finder, start);
    return history.now();
  };
  if (cause) {
    search.decision = LastDecision{in_front_of(cause->by, cause->by.op + (cause->contacts ? 1 : 0)), cause->text, cause->by};
    if (search.decision->moment == start) search.decision->moment = in_front_of(cause->first, cause->first.op);
  }
  history.go_to(start);
  return search;
}

}  // namespace s7200::tools

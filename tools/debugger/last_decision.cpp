#include "tools/debugger/last_decision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/model/ports.hpp"
#include "interpreter/trace/statement_text.hpp"
#include "interpreter/trace/trace_reasons.hpp"
#include "tools/debugger/expression.hpp"
#include "tools/debugger/last_attachment.hpp"
#include "tools/debugger/last_write.hpp"
#include "tools/debugger/line_account.hpp"
#include "tools/debugger/past_words.hpp"
#include "tools/debugger/reader.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr Time kEarlier = kSecond;  // who attached the routine that got a frame is mostly seen, too
constexpr Time kJust = 100 * kMillisecond;
constexpr Time kHostRequest = 2 * kSecond;  // when a master on a bridge has asked is not kept: with its time-out before now

/// Sees what a station executes, and what all do on its line.
class Witness final : public Reader {
 public:
  Witness(History& history, std::size_t station, const std::atomic<bool>* stop_request)
      : Reader(stop_request),
        reasons(history.station(station).cpu().program()),
        line(history, station),
        history_(history),
        station_(station) {}

  bool before_action() override {
    const std::size_t number = history_.now().actions;
    const Action* const action = history_.action(number);
    if (!action || !std::holds_alternative<SendFrame>(*action)) return true;
    const serial::Simulation& asked = history_.station(history_.station_of_action(number));
    if (&asked.line() == &history_.station(station_).line()) line.note_request();
    return true;
  }
  void record(const TraceRecord& record) override {
    line.note(history_.told_of(), record);
    if (history_.told_of() != station_) return;
    if (record.kind == TraceKind::Transmit) left_.clear();
    for (const auto& frame : reasons.unanswered(record)) left_.push_back({record.at, record.at, frame});
    if (record.kind == TraceKind::ModeChange) stopped_ = record.code == 0;
    if (!stopped_) reasons.note(record);  // in STOP what has led there stays known
  }
  void instruction(const InstructionRecord& record) override {
    if (history_.told_of() == station_) reasons.note(record);
  }

  struct Left {
    Time known = 0;  ///< since when
    Time at = 0;     ///< when nothing is known to have decided it
    TraceReasons::Unanswered frame;
  };
  /// Frames that the program has left, known since then.
  std::vector<Left> left_since(Time since, Time now) const {
    std::vector<Left> all = left_;
    for (const auto& frame : reasons.unread()) all.push_back({frame.since, now, frame});
    std::erase_if(all, [&](const Left& one) { return one.known < since; });
    return all;
  }

  TraceReasons reasons;
  LineAccount line;

 private:
  const History& history_;
  std::size_t station_;
  bool stopped_ = false;
  std::vector<Left> left_;
};

/// Stops in front of an instruction, in an interrupt or not.
class Finder final : public Observer {
 public:
  Finder(const History& history, std::size_t station, std::uint32_t op, bool in_interrupt)
      : Observer(station), cpu_(history.station(station).cpu()), op_(op), in_interrupt_(in_interrupt) {}
  bool wants_instructions() const override { return true; }
  bool before(std::uint32_t op) override { return op != op_ || cpu_.state().in_interrupt != in_interrupt_; }

 private:
  const Cpu& cpu_;
  std::uint32_t op_;
  bool in_interrupt_;
};

/// Sees when a CPU goes to STOP.
struct StopFinder final : Reader {
  using Reader::Reader;
  void record(const TraceRecord& record) override {
    if (record.kind == TraceKind::ModeChange && record.code == 0) at = record.at;
  }
  std::optional<Time> at{};
};

/// The request of the simulated master that waits for its answer, or has just been given up or answered.
struct LastRequest {
  serial::Exchange exchange{};
  bool unanswered = false;
};

std::optional<LastRequest> last_request(const serial::Simulation& simulation) {
  if (!simulation.has_master()) return {};
  const serial::Requester& master = simulation.master();
  const serial::Exchange& exchange = master.exchange();
  if (master.asks()) return LastRequest{exchange, true};
  if (exchange.request.empty() || exchange.given_up) return {};
  const Time given_up = exchange.request_end + master.state().request.timeout;
  const Time over = exchange.timed_out ? given_up : exchange.response_end;
  if (simulation.time() - over >= kJust) return {};
  return LastRequest{exchange, exchange.timed_out};
}

/// One search, step by step.
class DecisionFinder {
 public:
  DecisionFinder(History& history, std::size_t station, const std::atomic<bool>* stop_request)
      : history_(history),
        station_(station),
        stop_request_(stop_request),
        start_(history.now()),
        in_main_(!here().cpu().state().in_interrupt),
        bridged_(here().has_host_port() && here().host_port().state().attached),
        request_(last_request(here())),
        since_(beginning()),
        stopped_(when_stopped()),
        witness_(history, station, stop_request) {}

  DecisionSearch find() {
    if (!hear_the_witness()) {
      search_.interrupted = true;
    } else {
      find_frames_left();
      find_characters_untaken();
      find_what_the_line_lost();
      find_what_led_here();
    }
    history_.go_to(start_);
    return std::move(search_);
  }

 private:
  serial::Simulation& here() { return history_.station(station_); }
  serial::Simulation& here_at_start() {
    history_.go_to(start_);
    return here();
  }
  const Program& program() { return here().cpu().program(); }

  /// Since when frames without an answer count: the scan, which an interrupt routine never outlasts, and a request.
  Time beginning() {
    Time from = here().cpu().state().scan_begin;
    if (request_ && request_->unanswered) from = std::min(from, request_->exchange.request_start);
    if (bridged_) from = std::min(from, start_.time - std::min(start_.time, kHostRequest));
    return from;
  }

  std::optional<Time> when_stopped() {
    if (here().cpu().state().mode == Mode::Run) return {};
    StopFinder finder(station_, stop_request_);
    history_.search_back(
        finder, start_, [] {}, [&] { return finder.at.has_value(); });
    history_.go_to(start_);
    return finder.at;
  }

  bool hear_the_witness() {
    Time from = request_ ? std::min(since_, request_->exchange.request_start) : since_;
    if (stopped_) from = std::min(from, *stopped_);
    return history_.go_to(from - std::min(from, kEarlier)) && history_.play(witness_, start_);
  }

  void find_frames_left() {
    std::vector<Witness::Left> left = witness_.left_since(since_, start_.time);
    if (bridged_ && left.size() > 1) left.erase(left.begin(), left.end() - 1);
    for (const Witness::Left& one : left)
      search_.unanswered.push_back({one.frame.cause ? one.frame.cause->by.at : one.at, unanswered_text(one.frame)});
    if (in_main_ && !left.empty() && left.back().frame.cause) search_.left = decision_of(*left.back().frame.cause);
  }

  void find_characters_untaken() {
    std::vector<LineAccount::Untaken> untaken = witness_.line.untaken();
    std::erase_if(untaken, [&](const LineAccount::Untaken& one) { return one.first.at < since_; });
    if (bridged_ && untaken.size() > 1) untaken.erase(untaken.begin(), untaken.end() - 1);
    for (const auto& [first, characters, end] : untaken) {
      const Keeper keeper = what_kept(first);
      add(first.at,
          unanswered_text(
              {.characters = characters, .since = first.since, .decided_by = ignored_because(first) + keeper.text}),
          keeper);
    }
    const bool silent = request_ && request_->unanswered && request_->exchange.request_end != 0;
    if (silent && search_.unanswered.empty() && !here_at_start().freeport().active) find_port_in_ppi_mode();
  }

  /// PPI takes characters for its own as long as they may be a frame of it.
  void find_port_in_ppi_mode() {
    const Keeper keeper = what_left_freeport(here().port());
    add(request_->exchange.request_end, fmt::format("no answer: port {} is in PPI mode{}", here().port(), keeper.text),
        keeper);
  }

  /// What keeps characters from the program, after what is said of them: the instruction that has detached their event, or
  /// left Freeport mode, if one has.
  struct Keeper {
    std::string text{};
    std::optional<LastDecision> by{};
  };

  void add(Time at, std::string text, const Keeper& keeper) {
    search_.unanswered.push_back({at, std::move(text)});
    if (in_main_ && !search_.left) search_.left = keeper.by;
  }

  Keeper what_kept(const TraceRecord& ignored) {
    const bool detached = ignored.code == 0, in_ppi_mode = ignored.code == 1;
    if (ignored.kind != TraceKind::CharacterIgnored || !(detached || in_ppi_mode)) return {};
    if (in_ppi_mode && stopped_ && ignored.at >= *stopped_) return {.text = "; the CPU is in STOP"};  // Freeport ends there
    if (!history_.go_to(ignored.since)) return search_.interrupted = true, Keeper{};
    return detached ? what_detached(kPorts[ignored.port].received) : what_left_freeport(ignored.port);
  }

  Keeper what_detached(std::uint8_t event) {
    const AttachmentSearch search = find_last_attachment(history_, station_, event, stop_request_);
    search_.interrupted |= search.interrupted;
    if (search.interrupted) return {};
    if (!search.attachment) return {.text = "; no instruction has attached it " + since_oldest_text(history_)};
    const auto& [moment, what, by] = *search.attachment;
    if (what.kind != TraceKind::Detach) return {.text = "; the CPU has been in STOP since it was"};
    return kept_by(moment, by, "detached");
  }

  Keeper what_left_freeport(std::uint8_t port) {
    if (here().cpu().state().mode == Mode::Stop) return {.text = "; the CPU is in STOP"};
    const auto control = range_at(kPorts[port].control, Width::Byte, *program().model);
    const WriteSearch search = find_last_write(history_, station_, *control, stop_request_);
    search_.interrupted |= search.interrupted;
    if (search.interrupted) return {};
    const std::string name = control->name_of(0);
    if (!search.write) return {.text = fmt::format("; nothing has written {} {}", name, since_oldest_text(history_))};
    if (!search.write->by)
      return {.text = fmt::format("; {} was set from outside at {}", name, moment_text(search.write->at))};
    return kept_by(search.write->moment, *search.write->by, name + " was set");
  }

  Keeper kept_by(const Moment& moment, const InstructionRecord& by, std::string_view done) {
    LastDecision decision{moment, named_in_sentence(by.op, program()), by};
    return {fmt::format("; {} at {} by {}", done, moment_text(by.at), decision.text), std::move(decision)};
  }

  void find_what_the_line_lost() {
    here_at_start();
    if (const auto lost = request_ ? witness_.line.lost(request_->exchange) : std::nullopt)
      search_.unanswered.push_back(*lost);
  }

  void find_what_led_here() {
    if (stopped_ && here_at_start().cpu().state().stopped_by_master)
      search_.unanswered.push_back({*stopped_, "a programming device has switched the CPU to STOP"});
    else if (const auto cause = witness_.reasons.cause())
      search_.decision = decision_of(*cause);
  }

  LastDecision decision_of(const TraceReasons::Cause& cause) {
    LastDecision decision{in_front_of(cause.by, cause.by.op + (cause.contacts ? 1 : 0), cause.in_interrupt), cause.text,
                          cause.by};
    if (decision.moment == start_) decision.moment = in_front_of(cause.first, cause.first.op, cause.in_interrupt);
    return decision;
  }

  Moment in_front_of(const InstructionRecord& from, std::uint32_t op, bool in_interrupt) {
    Finder finder(history_, station_, op, in_interrupt);
    if (history_.go_to(from.at)) history_.play(finder, start_);
    return history_.now();
  }

  History& history_;
  std::size_t station_;
  const std::atomic<bool>* stop_request_;
  Moment start_;
  bool in_main_, bridged_;
  std::optional<LastRequest> request_;
  Time since_;
  std::optional<Time> stopped_;  // when it went to STOP, if it is there
  Witness witness_;
  DecisionSearch search_;
};

}  // namespace

DecisionSearch find_last_decision(History& history, std::size_t station, const std::atomic<bool>* stop_request) {
  return DecisionFinder(history, station, stop_request).find();
}

}  // namespace s7200::tools

#include "tools/session/causes/inquiry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "tools/session/causes/last/last_stop.hpp"
#include "tools/session/causes/last/last_turn.hpp"
#include "tools/session/causes/line/two_masters.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

constexpr Time kEarlier = kSecond;  // who attached the routine that got a frame is mostly seen, too

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

}  // namespace

Inquiry::Inquiry(History& history, std::size_t station, Time host_timeout, StopToken stop_request)
    : history_(history),
      station_(station),
      stop_request_(stop_request),
      start_(history.now()),
      in_main_(!here().cpu().state().in_interrupt),
      request_(last_asked(history, station, host_timeout)),
      since_(beginning()),
      stopped_(when_stopped()),
      witness_(history, station, port(), stop_request) {}

serial::Simulation& Inquiry::here_at_start() const {
  history_.go_to(start_);
  return here();
}

Time Inquiry::beginning() const {
  const Time from = here().plc().powered() ? here().cpu().state().scan_begin : start_.time;
  return request_ && request_->unanswered ? std::min(from, request_->start) : from;
}

std::optional<Time> Inquiry::when_stopped() const {
  if (here().cpu().state().mode == Mode::Run) return {};
  return find_last_stop(history_, station_, stop_request_);
}

/// What a fault holds back may have begun long before the request.
std::optional<Time> Inquiry::sending_since() const {
  const std::uint8_t port = this->port();
  if (!has_unanswered() || !here().cpu().state().port[port].transmitting) return {};
  const TurnSearch search = find_last_turn(
      history_, station_, [port](const State& state) { return state.port[port].transmitting; }, stop_request_);
  return search.turn ? std::optional(search.turn->at) : std::nullopt;
}

bool Inquiry::hear_the_witness() {
  Time from = request_ ? std::min(since_, request_->start) : since_;
  if (stopped_) from = std::min(from, *stopped_);
  if (const auto sending = sending_since()) from = std::min(from, *sending);
  if (!history_.go_to(from - std::min(from, kEarlier))) return false;
  witness_.line.begin();
  const bool heard = history_.play(witness_, start_);
  witness_.line.end();
  return heard;
}

/// In an interrupt routine it is what led there, unless it stands there because a request was given up.
bool Inquiry::goes_back_to_frames() const { return in_main_ || (request_ && request_->in_vain); }

void Inquiry::add(Time at, std::string text, const Keeper& keeper) {
  answers.unanswered.push_back({at, std::move(text)});
  if (goes_back_to_frames() && !answers.left) answers.left = keeper.by;
}

/// What was a request of another master was not lost.
void find_what_the_line_lost(Inquiry& inquiry) {
  inquiry.here_at_start();
  if (const auto& request = inquiry.request(); request && request->asker.kind == Asker::Kind::Send) {
    const std::size_t station = request->asker.number;
    const serial::Exchange& exchange = inquiry.history().station(station).master().exchange();
    if (took_a_request_for_its_answer(inquiry.history(), station, exchange)) {
      std::string text = not_an_answer_text(inquiry.history(), station, exchange);
      text.erase(text.find_last_not_of('\n') + 1);
      return inquiry.add_first(
          {exchange.response_end, fmt::format("what {} took for its answer was {}", request->by, stl::trim(text))});
    }
  }
  if (!inquiry.request()) return;
  std::vector<TraceLine> lost = inquiry.witness().line.lost(*inquiry.request());
  for (auto line = lost.rbegin(); line != lost.rend(); ++line) inquiry.add_lost(std::move(*line));
}

void Inquiry::add_lost(TraceLine line) {
  if (goes_back_to_frames()) answers.lost_on_line = line.at;
  add_first(std::move(line));
}

void Inquiry::note_left(const TraceReasons::Cause& cause) {
  if (goes_back_to_frames()) answers.left = decision_of(cause);
}

std::vector<Witness::Left> Inquiry::frames_left() const {
  std::vector<Witness::Left> all = witness_.left_since(since_, start_.time);
  if (has_unanswered()) std::erase_if(all, [&](const Witness::Left& one) { return one.frame.until <= request_->start; });
  return all;
}

std::string Inquiry::left_text(const TraceReasons::Unanswered& frame) const {
  if (!request_ || is_by_others()) return unanswered_text(frame);
  return fmt::format("the program has not taken {} since {}{}{}", characters_text(frame.characters),
                     moment_text(frame.since), frame.decided_by.empty() ? "" : ": ", frame.decided_by);
}

Keeper Inquiry::kept_by(const Moment& moment, const InstructionRecord& by, std::string_view done) const {
  LastDecision decision{moment, named_in_sentence(by.op, program()), by};
  return {.text = fmt::format("; {} at {} by {}", done, moment_text(by.at), decision.text),
          .by = std::move(decision),
          .since = by.at};
}

Keeper Inquiry::kept_by_rcv(std::uint8_t port) {
  const MessageReceiver message = here().cpu().state().port[port].message;
  if (message.phase == MessageReceiver::Phase::Off) return {};
  const auto is_at_work = [port](const State& state) {
    return state.port[port].message.phase != MessageReceiver::Phase::Off;
  };
  const TurnSearch search = find_last_turn(history_, station_, is_at_work, stop_request_);
  answers.interrupted |= search.interrupted;
  const bool is_known = search.turn && search.turn->by;
  Keeper keeper = is_known ? kept_by(search.turn->moment, *search.turn->by, "executed") : Keeper{};
  keeper.text = awaited_text(message, program().model->receive) + keeper.text;
  return keeper;
}

LastDecision Inquiry::decision_of(const TraceReasons::Cause& cause) {
  LastDecision decision{in_front_of(cause.by, cause.by.op + (cause.contacts ? 1 : 0), cause.in_interrupt), cause.text,
                        cause.by};
  if (decision.moment == start_) decision.moment = in_front_of(cause.first, cause.first.op, cause.in_interrupt);
  return decision;
}

Moment Inquiry::in_front_of(const InstructionRecord& from, std::uint32_t op, bool in_interrupt) {
  Finder finder(history_, station_, op, in_interrupt);
  if (history_.go_to(from.at)) history_.play(finder, start_);
  return history_.now();
}

}  // namespace s7200::tools

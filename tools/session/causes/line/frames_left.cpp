// Which frames has the program left without an answer, and which has it swallowed?
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/session/causes/inquiry.hpp"

namespace s7200::tools {

namespace {

/// `at`: when nothing is known to have decided it.
TraceLine line_of(const TraceReasons::Unanswered& frame, Time at, std::string text) {
  if (!frame.cause) return {.at = at, .text = std::move(text)};
  return {.at = frame.cause->by.at, .text = std::move(text), .power = frame.cause->power};
}

}  // namespace

void find_frames_left(Inquiry& inquiry) {
  const std::vector<Witness::Left> left = inquiry.frames_left();
  for (const Witness::Left& one : left)
    inquiry.answers.unanswered.push_back(line_of(one.frame, one.at, inquiry.left_text(one.frame)));
  if (left.empty()) return;
  // What a pause broke up was lost with its first part; without a request the last frame is in question.
  const TraceReasons::Unanswered& first = (inquiry.has_unanswered() ? left.front() : left.back()).frame;
  if (first.cause) inquiry.note_left(*first.cause);
}

namespace {

/// All of it has come, and a pause after it: a program that says so when it is silent has had its time.
bool has_ended(const AskedRequest& request, Time now) {
  return request.unanswered && request.end != 0 && now - request.end >= request.format.silence();
}

/// `no answer to 2 characters since 50.104800 ms: RCV took them and waits for the end of its message: …`
std::string open_message_text(const TraceReasons::Unanswered& frame, const Keeper& rcv) {
  TraceReasons::Unanswered taken = frame;
  taken.decided_by = fmt::format("RCV took {} and waits for {}", frame.characters == 1 ? "it" : "them", rcv.text);
  return unanswered_text(taken);
}

}  // namespace

/// What RCV did not take any more stands below what it took before.
bool is_rest_of_message(const Inquiry& inquiry) {
  const auto rest = std::ranges::count_if(inquiry.witness().line.untaken(), [&](const LineAccount::Untaken& one) {
    const bool is_ignored = one.first.kind == TraceKind::CharacterIgnored && one.first.at >= inquiry.since();
    return is_ignored && Ignored{one.first.code} == Ignored::NoRcvWaits;
  });
  return std::cmp_equal(rest, inquiry.answers.unanswered.size());
}

/// While an answer is waited for, a program that has changed who gets the next characters may be about to send it; where to
/// go back to is what has led to where it stands, if that is known.
void find_frames_swallowed(Inquiry& inquiry) {
  if (!inquiry.is_by_others() || !is_rest_of_message(inquiry)) return;
  const bool has_rest = !inquiry.answers.unanswered.empty();
  const bool in_vain = inquiry.request()->in_vain;
  if (!in_vain && !has_ended(*inquiry.request(), inquiry.start().time)) return;
  if (inquiry.here_at_start().cpu().state().port[inquiry.port()].transmitting) return;
  const TraceReasons& reasons = inquiry.witness().reasons;
  for (const TraceReasons::Unanswered& one : reasons.taken(inquiry.since())) {
    if (!in_vain && !one.open) continue;
    if (has_rest) {
      if (!one.message_open) inquiry.add_first(line_of(one, inquiry.start().time, unanswered_text(one)));
      continue;
    }
    if (one.message_open) {
      inquiry.here_at_start();
      const Keeper rcv = inquiry.kept_by_rcv(inquiry.port());
      inquiry.add(inquiry.start().time, open_message_text(one, rcv), rcv);
      continue;
    }
    inquiry.answers.unanswered.push_back(line_of(one, inquiry.start().time, unanswered_text(one)));
    if (one.cause && (in_vain || !reasons.cause())) inquiry.note_left(*one.cause);
  }
}

}  // namespace s7200::tools

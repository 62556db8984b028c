// Which frames has the program left without an answer, and which has it swallowed?
#include "tools/debugger/inquiry.hpp"

namespace s7200::tools {

void find_frames_left(Inquiry& inquiry) {
  const std::vector<Witness::Left> left = inquiry.witness().left_since(inquiry.since(), inquiry.start().time);
  for (const Witness::Left& one : left)
    inquiry.answers.unanswered.push_back({one.frame.cause ? one.frame.cause->by.at : one.at, inquiry.left_text(one.frame)});
  if (!left.empty() && left.back().frame.cause) inquiry.note_left(*left.back().frame.cause);
}

namespace {

/// All of it has come, and a pause after it: a program that says so when it is silent has had its time.
bool has_ended(const AskedRequest& request, Time now) {
  return request.unanswered && request.end != 0 && now - request.end >= request.format.silence();
}

}  // namespace

/// While an answer is waited for, a program that has changed who gets the next characters may be about to send it; where to
/// go back to is what has led to where it stands, if that is known.
void find_frames_swallowed(Inquiry& inquiry) {
  if (!inquiry.is_by_others() || !inquiry.answers.unanswered.empty()) return;
  const bool in_vain = inquiry.request()->in_vain;
  if (!in_vain && !has_ended(*inquiry.request(), inquiry.start().time)) return;
  if (inquiry.here_at_start().cpu().state().port[inquiry.port()].transmitting) return;
  const TraceReasons& reasons = inquiry.witness().reasons;
  for (const TraceReasons::Unanswered& one : reasons.taken(inquiry.since())) {
    if (!in_vain && !one.open) continue;
    inquiry.answers.unanswered.push_back({one.cause ? one.cause->by.at : inquiry.start().time, unanswered_text(one)});
    if (one.cause && (in_vain || !reasons.cause())) inquiry.note_left(*one.cause);
  }
}

}  // namespace s7200::tools

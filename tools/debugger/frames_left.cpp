// Which frames has the program left without an answer, and which has it swallowed?
#include "tools/debugger/inquiry.hpp"

namespace s7200::tools {

void find_frames_left(Inquiry& inquiry) {
  const std::vector<Witness::Left> left = inquiry.witness().left_since(inquiry.since(), inquiry.start().time);
  for (const Witness::Left& one : left)
    inquiry.answers.unanswered.push_back({one.frame.cause ? one.frame.cause->by.at : one.at, inquiry.left_text(one.frame)});
  if (!left.empty() && left.back().frame.cause) inquiry.note_left(*left.back().frame.cause);
}

void find_frames_swallowed(Inquiry& inquiry) {
  const bool in_vain = inquiry.is_by_others() && inquiry.request()->in_vain;
  if (!in_vain || !inquiry.answers.unanswered.empty()) return;
  if (inquiry.here_at_start().cpu().state().port[inquiry.port()].transmitting) return;
  for (const TraceReasons::Unanswered& one : inquiry.witness().reasons.taken(inquiry.since())) {
    inquiry.answers.unanswered.push_back({one.cause ? one.cause->by.at : inquiry.start().time, unanswered_text(one)});
    if (one.cause) inquiry.note_left(*one.cause);
  }
}

}  // namespace s7200::tools

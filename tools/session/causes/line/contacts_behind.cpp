// What switched the bits on or off that decided about a frame without an answer?
#include <utility>

#include "tools/session/causes/inquiry.hpp"
#include "tools/session/causes/memory_cause.hpp"

namespace s7200::tools {

/// A program that has RCV again where a flag says so has found before what was wrong with the message.
void find_what_switched_contacts(Inquiry& inquiry) {
  const auto& left = inquiry.answers.left;
  if (!left || inquiry.answers.unanswered.empty()) return;
  inquiry.history().go_to(left->moment);
  auto lines = rung_cause(inquiry.history(), inquiry.station(), inquiry.stop_request());
  if (!lines) inquiry.answers.interrupted = true;
  if (lines)
    for (std::string& line : *lines) inquiry.answers.unanswered.push_back({.at = left->by.at, .text = std::move(line)});
}

}  // namespace s7200::tools

#include "tools/debugger/last_decision.hpp"

#include <fmt/format.h>

#include <utility>

#include "tools/debugger/inquiry.hpp"
#include "tools/views/machine_text.hpp"

namespace s7200::tools {

DecisionSearch find_last_decision(History& history, std::size_t station, Time host_timeout,
                                  const std::atomic<bool>* stop_request) {
  const Moment start = history.now();
  Inquiry inquiry(history, station, host_timeout, stop_request);
  if (!inquiry.hear_the_witness()) {
    inquiry.answers.interrupted = true;
  } else {
    find_frames_left(inquiry);
    find_characters_untaken(inquiry);
    const std::size_t named = find_characters_waiting(inquiry);
    find_frames_swallowed(inquiry);
    find_characters_lost(inquiry, named);
    find_what_the_line_lost(inquiry);
    find_station_asked(inquiry);
    find_what_led_here(inquiry);
  }
  history.go_to(start);
  return std::move(inquiry.answers);
}

std::string DecisionSearch::why_no_origin() const {
  if (!lost_on_line) return "no instruction is named that it could go back to";
  return fmt::format("it was lost on the line, which no instruction has decided; 'at {}' leads to that moment",
                     moment_text(*lost_on_line));
}

}  // namespace s7200::tools

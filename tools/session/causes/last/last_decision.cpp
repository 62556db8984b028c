#include "tools/session/causes/last/last_decision.hpp"

#include <fmt/format.h>

#include <utility>

#include "tools/session/causes/inquiry.hpp"
#include "tools/views/state/machine_text.hpp"

namespace s7200::tools {
namespace {

/// `SBR 51, network 6 "SBR 51: is it undisturbed?"`
std::string routine_text(const Listing& listing, std::uint32_t op) {
  const std::string& network = listing.network_of(op);
  return listing.routine_of(op) + (network.empty() ? "" : ", ") + network;
}

}  // namespace

std::vector<std::string> cause_lines(const DecisionSearch& search) {
  std::vector<std::string> lines;
  for (const TraceLine& line : search.unanswered) lines.push_back(fmt::format("{}  {}", moment_text(line.at), line.text));
  return lines;
}

std::vector<std::string> to_lines(const DecisionSearch& search, const Listing& listing) {
  std::vector<std::string> lines = cause_lines(search);
  if (search.decision)
    lines.push_back(fmt::format("{}  {}{}: {}", moment_text(search.decision->by.at), lines.empty() ? "" : "what led here: ",
                                routine_text(listing, search.decision->by.op), search.decision->text));
  if (lines.empty() && !search.interrupted) lines.emplace_back(kNothingDecided);
  return lines;
}

DecisionSearch find_last_decision(History& history, std::size_t station, Time host_timeout, StopToken stop_request) {
  const Moment start = history.now();
  Inquiry inquiry(history, station, host_timeout, stop_request);
  if (!inquiry.hear_the_witness()) {
    inquiry.answers.interrupted = true;
  } else {
    find_frames_left(inquiry);
    find_characters_untaken(inquiry);
    const std::size_t named = find_characters_waiting(inquiry);
    find_transmissions_refused(inquiry);
    find_frames_swallowed(inquiry);
    find_characters_lost(inquiry, named);
    find_what_the_line_lost(inquiry);
    find_station_asked(inquiry);
    find_what_switched_contacts(inquiry);
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

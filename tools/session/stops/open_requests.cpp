#include "tools/session/stops/open_requests.hpp"

#include <algorithm>

namespace s7200::tools {

OpenRequests::OpenRequests(const History& history)
    : common_{.history = history, .tell = [](const EndedRequest&) {}},
      send_(common_),
      pollers_(common_),
      programs_(common_),
      bridges_(common_),
      all_{&send_, &bridges_, &pollers_, &programs_} {}

void OpenRequests::begin(Time now, const std::vector<HeardFrames::Frame>& before) {
  for (AskedBy* const kind : all_) kind->begin(now, before);
}

void OpenRequests::note_record(std::size_t station, const TraceRecord& record) {
  for (AskedBy* const kind : all_) kind->note_record(station, record);
}

void OpenRequests::note_frame(const HeardFrames::Frame& frame) {
  for (AskedBy* const kind : all_) kind->note_frame(frame);
}

void OpenRequests::look(Time now) {
  for (AskedBy* const kind : all_) kind->look(now);
}

Time OpenRequests::next_timeout() const {
  Time next = kNever;
  for (const AskedBy* const kind : all_) next = std::min(next, kind->next_timeout());
  return next;
}

bool OpenRequests::has_patient_one() const {
  return std::ranges::any_of(all_, [](const AskedBy* kind) { return kind->has_patient_one(); });
}

}  // namespace s7200::tools

#include "serial_sim/system/shared_line.hpp"

#include <cassert>

namespace s7200::serial {

SharedLine::SharedLine(Dispatcher& events) : faults_(line_, events.shared_queue(), events.add(Rank::Line, *this)) {}

int SharedLine::add_driver() {
  assert(drivers_ < Line::kDrivers);
  return drivers_++;
}

void SharedLine::note_activity(const Uart::Report& report) {
  if (report.sent) note_activity(*report.sent);
  if (report.received) note_activity(report.received->end);
}

void SharedLine::restore(const State& state) {
  line_ = state.line;
  faults_.restore(state.faults);
  last_activity_ = state.last_activity;
}

}  // namespace s7200::serial

#include "interpreter/trace/text/event_lines.hpp"

#include "interpreter/stl/printer.hpp"
#include "interpreter/trace/text/line_parts.hpp"
#include "interpreter/trace/text/statement_text.hpp"
#include "interpreter/trace/trace_rows.hpp"

namespace s7200 {

const std::string& EventText::event(std::uint8_t number) {
  std::string& text = events_[number];
  if (text.empty()) text = fmt::format("event {} ({})", number, find_event(number)->cause);
  return text;
}

const std::string& EventText::duration(Time time) {
  Duration& known = durations_[static_cast<std::size_t>(time) / 100 % durations_.size()];
  if (known.time != time) known = {time, format_duration(time)};
  return known.text;
}

std::string EventText::place(std::uint32_t op) const {
  if (op == kNoRoutine) return "between two scans";
  return fmt::format("{}: {}", line_of(op, program_), stl::to_text(program_.statement(op)));
}

void EventText::append_to(fmt::memory_buffer& text, const TraceRecord& record) {
  const TraceRow& row = row_of(record.kind);
  // Port 0 goes without saying: most CPUs have no other.
  if (row.of_port && record.port != 0) append(text, "port ", record.port, ": ");
  row.say(*this, text, record);
}

std::string describe(const TraceRecord& record, const Program& program) {
  fmt::memory_buffer text;
  EventText(program).append_to(text, record);
  return fmt::to_string(text);
}

}  // namespace s7200

#include "interpreter/trace/text_trace.hpp"

#include <ostream>
#include <utility>

namespace s7200 {

TextTrace::TextTrace(std::ostream& out, std::shared_ptr<const Program> program, TraceDetail detail)
    : out_(out),
      program_(std::move(program)),
      detail_(detail),
      event_lines_(*program_),
      lines_(*program_),
      instruction_lines_(*program_) {
  out_ << kFirstLine << '\n';
}

void TextTrace::record(const TraceRecord& record) {
  const bool wanted = record.kind != TraceKind::ScanBegin || detail_ == TraceDetail::Instructions;
  if (detail_ == TraceDetail::Events) {
    line_.clear();
    if (wanted) event_lines_.append_line(line_, record);
    return put_line();
  }
  const std::vector<TraceLine> lines = lines_.of(record);
  if (wanted) write(lines);
}

void TextTrace::instruction(const InstructionRecord& record) {
  if (detail_ == TraceDetail::Instructions) {
    line_.clear();
    instruction_lines_.append_line(line_, record);
    put_line();
  }
  write(lines_.of(record));
}

void TextTrace::write(const std::vector<TraceLine>& lines) {
  for (const TraceLine& line : lines) {
    line_.clear();
    append_clock(line_, line.at);
    append(line_, "  ", line.text, "\n");
    put_line();
  }
}

void TextTrace::put_line() { out_.write(line_.data(), static_cast<std::streamsize>(line_.size())); }

}  // namespace s7200

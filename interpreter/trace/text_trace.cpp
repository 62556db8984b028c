#include "interpreter/trace/text_trace.hpp"

#include <ostream>
#include <utility>

namespace s7200 {

TextTrace::TextTrace(std::ostream& out, std::shared_ptr<const Program> program, TraceDetail detail)
    : TextTrace([&out](Time, std::string_view line) { out.write(line.data(), static_cast<std::streamsize>(line.size())); },
                std::move(program), detail) {
  out << kFirstLine << '\n';
}

TextTrace::TextTrace(TakeLine take, std::shared_ptr<const Program> program, TraceDetail detail)
    : take_(std::move(take)),
      program_(std::move(program)),
      detail_(detail),
      event_lines_(*program_),
      lines_(*program_),
      instruction_lines_(*program_) {}

bool TextTrace::wants(const TraceRecord& record) const {
  if (record.kind == TraceKind::ScanBegin) return detail_ == TraceDetail::Instructions;
  return is_shown(record);
}

void TextTrace::record(const TraceRecord& record) {
  const bool wanted = wants(record);
  if (detail_ == TraceDetail::Events) {
    line_.clear();
    if (wanted) event_lines_.append_line(line_, record);
    return put_line(record.at);
  }
  const std::vector<TraceLine> lines = lines_.of(record);
  if (wanted) write(lines);
}

void TextTrace::instruction(const InstructionRecord& record) {
  if (detail_ == TraceDetail::Instructions) {
    line_.clear();
    instruction_lines_.append_line(line_, record);
    put_line(record.end);
  }
  write(lines_.of(record));
}

void TextTrace::note(Time at, std::string_view what) { write({{at, std::string(what)}}); }

void TextTrace::write(const std::vector<TraceLine>& lines) {
  for (const TraceLine& line : lines) {
    line_.clear();
    begin_line(line_, line.at);
    append(line_, line.text, "\n");
    put_line(line.at);
  }
}

void TextTrace::put_line(Time at) {
  if (line_.size() > 0) take_(at, {line_.data(), line_.size()});
}

}  // namespace s7200

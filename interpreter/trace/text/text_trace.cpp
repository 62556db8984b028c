#include "interpreter/trace/text/text_trace.hpp"

#include <ostream>
#include <utility>

namespace s7200 {

TextTrace::TextTrace(std::ostream& out, std::shared_ptr<const Program> program, TraceDetail detail)
    : TextTrace([&out](Time, std::string_view line) { out.write(line.data(), static_cast<std::streamsize>(line.size())); },
                std::move(program), detail) {
  out << kFirstLine << '\n';
}

TextTrace::TextTrace(TakeLine take, std::shared_ptr<const Program> program, TraceDetail detail)
    : TraceWriter(detail),
      take_(std::move(take)),
      program_(std::move(program)),
      lines_(*program_),
      instruction_lines_(*program_) {}

void TextTrace::record(const TraceRecord& record) {
  if (has(record)) {
    line_.clear();
    begin_line(line_, record.at);
    lines_.append_to(line_, record);
    append(line_, "\n");
    put_line(record.at);
  }
  for (const TraceLine& line : lines_.besides(record)) note(line.at, line.text);
}

void TextTrace::instruction(const InstructionRecord& record) {
  if (has_instructions()) {
    line_.clear();
    instruction_lines_.append_line(line_, record);
    put_line(record.end);
  }
  if (const auto line = lines_.of(record)) note(line->at, line->text);
}

void TextTrace::note(Time at, std::string_view what) {
  line_.clear();
  begin_line(line_, at);
  append(line_, what, "\n");
  put_line(at);
}

void TextTrace::put_line(Time at) { take_(at, {line_.data(), line_.size()}); }

}  // namespace s7200

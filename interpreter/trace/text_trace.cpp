#include "interpreter/trace/text_trace.hpp"

#include <fmt/format.h>

#include <ostream>
#include <utility>

#include "interpreter/trace/line_parts.hpp"

namespace s7200 {

std::string clock_text(Time at) {
  fmt::memory_buffer text;
  append_clock(text, at);
  return fmt::to_string(text);
}

TextTrace::TextTrace(std::ostream& out, std::shared_ptr<const Program> program, bool instructions)
    : out_(out),
      program_(std::move(program)),
      instructions_(instructions),
      event_lines_(*program_),
      instruction_lines_(*program_) {
  out_ << kFirstLine << '\n';
}

void TextTrace::record(const TraceRecord& record) {
  if (record.kind == TraceKind::ScanBegin && !instructions_) return;
  line_.clear();
  event_lines_.append_line(line_, record);
  out_.write(line_.data(), static_cast<std::streamsize>(line_.size()));
}

void TextTrace::instruction(const InstructionRecord& record) {
  line_.clear();
  instruction_lines_.append_line(line_, record);
  out_.write(line_.data(), static_cast<std::streamsize>(line_.size()));
}

}  // namespace s7200

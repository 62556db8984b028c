#include "interpreter/trace/text/trace_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "interpreter/trace/text/line_parts.hpp"

namespace s7200 {
namespace {

bool is_trouble(TraceKind kind) {
  return kind == TraceKind::RuntimeError || kind == TraceKind::EventLost || kind == TraceKind::CharacterIgnored ||
         kind == TraceKind::CharacterDropped;
}

}  // namespace

bool is_shown(const TraceRecord& record) {
  if (record.kind != TraceKind::CharacterIgnored) return true;
  return Ignored{record.code} != Ignored::NoPower && record.count == 0;
}

std::string characters_text(std::size_t count) { return count == 1 ? "a character" : fmt::format("{} characters", count); }

std::string unanswered_text(const TraceReasons::Unanswered& frame) {
  return fmt::format("no answer to {} since {}.{:06} ms{}{}", characters_text(frame.characters), frame.since / kMillisecond,
                     frame.since % kMillisecond, frame.decided_by.empty() ? "" : ": ", frame.decided_by);
}

std::vector<TraceLine> TraceLines::of(const TraceRecord& record) {
  fmt::memory_buffer text;
  append_to(text, record);
  std::vector<TraceLine> lines{{record.at, fmt::to_string(text), is_trouble(record.kind)}};
  std::ranges::move(besides(record), std::back_inserter(lines));
  return lines;
}

void TraceLines::append_to(fmt::memory_buffer& text, const TraceRecord& record) {
  text_.append_to(text, record);
  append(text, reasons_.of(record));
}

std::vector<TraceLine> TraceLines::besides(const TraceRecord& record) {
  std::vector<TraceLine> lines;
  for (const auto& unanswered : reasons_.unanswered(record)) lines.push_back({record.at, unanswered_text(unanswered), true});
  if (std::string way = path_.of(record); !way.empty()) lines.push_back({record.at, std::move(way)});
  reasons_.note(record);
  return lines;
}

std::optional<TraceLine> TraceLines::of(const InstructionRecord& record) {
  reasons_.note(record);
  const std::string* const way = path_.of(record);
  if (!way) return {};
  return TraceLine{record.end, *way};
}

void TraceLines::forget(const TraceReasons::Disabled& interrupts) {
  reasons_.forget(interrupts);
  path_.forget();
}

}  // namespace s7200

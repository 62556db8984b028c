#include "tools/record/trace_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "interpreter/base/text.hpp"
#include "interpreter/trace/line_parts.hpp"
#include "interpreter/trace/text_trace.hpp"
#include "tools/record/json_trace.hpp"

namespace s7200::tools {
namespace {

std::unique_ptr<TraceWriter> text_writer(TakeLine take, std::shared_ptr<const Program> program, TraceDetail detail,
                                         const std::string&) {
  return std::make_unique<TextTrace>(std::move(take), std::move(program), detail);
}

std::unique_ptr<TraceWriter> json_writer(TakeLine take, std::shared_ptr<const Program> program, TraceDetail detail,
                                         const std::string& station) {
  return std::make_unique<JsonTrace>(std::move(take), std::move(program), detail, station);
}

std::string text_note(Time at, std::string_view, std::string_view what) {
  fmt::memory_buffer line;
  begin_line(line, at);
  append(line, what, "\n");
  return fmt::to_string(line);
}

constexpr std::string_view kJsonFirstLine = "{\"s7200\":\"trace\"}\n";

/// The last one takes every name.
constexpr TraceFormat kFormats[] = {
    {".jsonl", kJsonFirstLine, kJsonFirstLine, json_writer, json_note, false},
    {"", "# time in ms   what\n", "# station, time in ms, what\n", text_writer, text_note, true},
};

}  // namespace

const TraceFormat& trace_format_of(const std::string& path) {
  const std::string name = stl::lower_case(path);
  return *std::ranges::find_if(kFormats, [&](const TraceFormat& format) { return name.ends_with(format.extension); });
}

}  // namespace s7200::tools

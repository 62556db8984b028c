#include "tools/record/trace_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "interpreter/base/text/text.hpp"
#include "interpreter/trace/text/line_parts.hpp"
#include "interpreter/trace/text/text_trace.hpp"
#include "tools/record/chrome_trace.hpp"
#include "tools/record/json_trace.hpp"
#include "tools/record/signal_trace.hpp"

namespace s7200::tools {
namespace {

std::unique_ptr<TraceWriter> text_writer(TraceWanted wanted) {
  return std::make_unique<TextTrace>(std::move(wanted.take), std::move(wanted.program), wanted.detail);
}

std::unique_ptr<TraceWriter> json_writer(TraceWanted wanted) {
  return std::make_unique<JsonTrace>(std::move(wanted.take), std::move(wanted.program), wanted.detail,
                                     std::move(wanted.station));
}

template <class Writer>
std::unique_ptr<TraceWriter> signal_writer(TraceWanted wanted) {
  return std::make_unique<Writer>(std::move(wanted));
}

std::string text_note(Time at, std::string_view, std::string_view what) {
  fmt::memory_buffer line;
  begin_line(line, at);
  append(line, what, "\n");
  return fmt::to_string(line);
}

using Signals = TraceFormat::Signals;

constexpr std::string_view kJsonFirstLine = "{\"s7200\":\"trace\"}\n";

/// The last one takes every name.
constexpr TraceFormat kFormats[] = {
    {".jsonl", kJsonFirstLine, kJsonFirstLine, json_writer, Signals::None, json_note, false},
    {".json", ChromeTrace::kFirstLine, "", signal_writer<ChromeTrace>, Signals::Some, nullptr, false},
    {".vcd", VcdTrace::kFirstLine, "", signal_writer<VcdTrace>, Signals::Needed, nullptr, false},
    {".csv", CsvTrace::kFirstLine, "", signal_writer<CsvTrace>, Signals::Needed, nullptr, false},
    {"", "# time in ms   what\n", "# station, time in ms, what\n", text_writer, Signals::None, text_note, true},
};

}  // namespace

const TraceFormat& trace_format_of(const std::string& path) {
  const std::string name = stl::lower_case(path);
  return *std::ranges::find_if(kFormats, [&](const TraceFormat& format) { return name.ends_with(format.extension); });
}

std::string why_not_signals(const TraceFormat& format, const std::vector<Signal>& signals) {
  if (signals.empty() && format.signals == Signals::Needed)
    return fmt::format("a trace as {} shows signals: name some, for example --signals Q0.0,VW20,INT", format.extension);
  if (!signals.empty() && format.signals == Signals::None)
    return "--signals are shown by a trace as .vcd, .csv or .json, and this is none";
  return {};
}

}  // namespace s7200::tools

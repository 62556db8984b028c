#include "interpreter/trace/output_record.hpp"

#include <fmt/format.h>

#include <ostream>

namespace s7200 {
namespace {

std::string milliseconds(Time at) { return fmt::format("{}.{:06}", at / kMillisecond, at % kMillisecond); }

}  // namespace

OutputRecord::OutputRecord(std::ostream& out) : out_(out) { out_ << kFirstLine << '\n'; }

void OutputRecord::record(const TraceRecord& r) {
  if (r.kind == TraceKind::AnalogChanged)
    out_ << fmt::format("{},AQW{},{}\n", milliseconds(r.at), r.op, static_cast<std::int16_t>(r.count));
  if (r.kind != TraceKind::OutputChanged) return;
  const int changed = points_[r.op] ^ r.byte;
  points_[r.op] = r.byte;
  for (int bit = 0; bit < 8; ++bit)
    if (changed >> bit & 1) out_ << fmt::format("{},Q{}.{},{}\n", milliseconds(r.at), r.op, bit, r.byte >> bit & 1);
}

}  // namespace s7200

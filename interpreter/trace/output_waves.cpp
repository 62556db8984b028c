#include "interpreter/trace/output_waves.hpp"

#include <fmt/format.h>

#include <ostream>

namespace s7200 {

OutputWaves::OutputWaves(std::ostream& out, const CpuModel& model) : out_(out) {
  const std::uint32_t points = model.size_of(Area::Q), words = model.size_of(Area::AQ) / 2;
  out_ << kBeginning << model.name << " $end\n$timescale 1 ns $end\n$scope module outputs $end\n";
  for (std::uint32_t byte = 0; byte < points; ++byte)
    for (int bit = 0; bit < 8; ++bit) out_ << fmt::format("$var wire 1 q{0}.{1} Q{0}.{1} $end\n", byte, bit);
  for (std::uint32_t word = 0; word < words; ++word) out_ << fmt::format("$var wire 16 a{0} AQW{0} $end\n", 2 * word);
  out_ << "$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n";
  for (std::uint32_t byte = 0; byte < points; ++byte)
    for (int bit = 0; bit < 8; ++bit) out_ << fmt::format("0q{}.{}\n", byte, bit);
  for (std::uint32_t word = 0; word < words; ++word) out_ << fmt::format("b0 a{}\n", 2 * word);
  out_ << "$end\n";
}

void OutputWaves::record(const TraceRecord& r) {
  if (r.kind == TraceKind::AnalogChanged) {
    go_to(r.at);
    out_ << fmt::format("b{:b} a{}\n", static_cast<std::uint16_t>(r.count), r.op);
  }
  if (r.kind != TraceKind::OutputChanged) return;
  const int changed = points_[r.op] ^ r.byte;
  if (changed == 0) return;
  points_[r.op] = r.byte;
  go_to(r.at);
  for (int bit = 0; bit < 8; ++bit)
    if (changed >> bit & 1) out_ << fmt::format("{}q{}.{}\n", r.byte >> bit & 1, r.op, bit);
}

void OutputWaves::go_to(Time at) {
  if (at == at_) return;
  out_ << '#' << at << '\n';
  at_ = at;
}

}  // namespace s7200

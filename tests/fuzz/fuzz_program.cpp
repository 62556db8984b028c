// Any bytes as the files of a program: listings, exports, symbol tables, data blocks, status charts, documents.
//
// Files are separated by the byte 1E. Promises: each diagnostic has its place in the text; what checks runs; what converts
// reads back as the same program in every notation.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <vector>

#include "interpreter/program/convert.hpp"
#include "interpreter/program/load.hpp"
#include "serial_sim/system/simulation.hpp"

namespace {

using namespace s7200;

void must(bool promise) {
  if (!promise) std::abort();
}

std::optional<SourceText> read_files(std::string_view bytes) {
  std::vector<SourceText> files;
  for (;;) {
    const std::size_t end = bytes.find('\x1E');
    std::string why;
    auto file = read_source(bytes.substr(0, end), "fuzz.awl", why);
    must(file.has_value() != !why.empty());
    if (!file) return {};
    files.push_back(std::move(*file));
    if (end == std::string_view::npos) return join_files(std::move(files));
    bytes.remove_prefix(end + 1);
  }
}

void look_at_places(const CheckResult& result) {
  for (const stl::Diagnostic& d : result.diagnostics) {
    must(!d.message.empty() && d.position.line <= result.source.text.size() + 1);
    must(!render(d, result.source, false).empty());
  }
}

void run(const std::shared_ptr<const Program>& program) {
  serial::Simulation simulation(program);
  simulation.power_up();
  simulation.run_until(20 * kMillisecond);
}

bool same(const Op& a, const Op& b) {
  return a.instruction == b.instruction && a.operand == b.operand && a.target == b.target;
}

void look_at_notations(const SourceText& files, const Program& program) {
  for (const Notation notation : {Notation::Iec, Notation::MicroDos, Notation::MicroWin, Notation::German}) {
    stl::ParseResult parsed = files.parsed;
    const auto text = convert(parsed, notation);
    must(text.has_value() || has_errors(parsed.diagnostics));
    if (!text) continue;
    std::string why;
    auto again = read_source(*text, "again.awl", why);
    must(again.has_value());
    const CheckResult result = check(std::move(again->parsed), *program.model, program.times);
    must(result.program != nullptr);
    must(std::equal(program.ops.begin(), program.ops.end(), result.program->ops.begin(), result.program->ops.end(), same));
    must(program.constants == result.program->constants);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array kModels{&cpu212(), &cpu214(), &cpu224(), find_cpu("226XM")};
  static const std::array kTimes{default_times(*kModels[0]), default_times(*kModels[1]), default_times(*kModels[2]),
                                 default_times(*kModels[3])};
  const auto files = read_files({reinterpret_cast<const char*>(data), size});
  if (!files) return 0;
  for (std::size_t i = 0; i < kModels.size(); ++i) {
    const CheckResult result = check(files->parsed, *kModels[i], kTimes[i]);
    look_at_places(result);
    must((result.program == nullptr) == has_errors(result.diagnostics));
    if (!result.program) continue;
    run(result.program);
    look_at_notations(*files, *result.program);
  }
  return 0;
}

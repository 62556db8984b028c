// Any bytes as the files of a program: listings, exports, symbol tables, data blocks, status charts, documents.
//
// Files are separated by the byte 1E. Promises: each diagnostic has its place in the text; what checks runs; what converts
// reads back as the same program. The input itself chooses the CPU and the notation, by its hash: each input is looked at
// once, and its relatives with other CPUs and notations, which finds more in the same time than all of them for each.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/program/load.hpp"
#include "interpreter/program/loading/convert.hpp"
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
    auto file = read_source(bytes.substr(0, end), "fuzz.awl");
    must(file.has_value() != !file.why().empty());
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

/// A program in a notation, with its symbol table where it needs one.
SourceText read_again(const std::string& text, const stl::ParseResult& parsed, Notation notation) {
  std::vector<SourceText> files;
  const std::string table = notation == Notation::MicroWin ? symbol_table_text(parsed.source) : "";
  for (const std::string& each : {text, table}) {
    if (each.empty()) continue;
    auto again = read_source(each, "again.awl");
    must(again.has_value());
    files.push_back(std::move(*again));
  }
  return join_files(std::move(files));
}

void look_at_notation(const SourceText& files, const Program& program, Notation notation) {
  stl::ParseResult parsed = files.parsed;
  const auto text = convert(parsed, notation);
  must(text.has_value() || has_errors(parsed.diagnostics));
  if (!text) return;
  const CheckResult result = check(read_again(*text, parsed, notation).parsed, *program.model, program.times);
  must(result.program != nullptr);
  must(std::equal(program.ops.begin(), program.ops.end(), result.program->ops.begin(), result.program->ops.end(), same));
  must(program.constants == result.program->constants);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array kModels{&cpu212(), &cpu214(), &cpu224(), find_cpu("226XM")};
  static const std::array kTimes{default_times(*kModels[0]), default_times(*kModels[1]), default_times(*kModels[2]),
                                 default_times(*kModels[3])};
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t choice = std::hash<std::string_view>{}(bytes);
  const std::size_t model = choice % kModels.size();
  const auto notation = static_cast<Notation>(choice / kModels.size() % 4);
  const auto files = read_files(bytes);
  if (!files) return 0;
  const CheckResult result = check(files->parsed, *kModels[model], kTimes[model]);
  look_at_places(result);
  must((result.program == nullptr) == has_errors(result.diagnostics));
  if (!result.program) return 0;
  run(result.program);
  look_at_notation(*files, *result.program, notation);
  return 0;
}

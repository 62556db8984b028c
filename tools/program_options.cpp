#include "tools/program_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/exit_code.hpp"
#include "tools/terminal.hpp"

namespace s7200::tools {
namespace {

std::string unknown_cpu(std::string_view name) {
  std::string known;
  for (const CpuModel* each : all_cpus()) known.append(known.empty() ? "" : ", ").append(each->name);
  return fmt::format("there is no model of CPU '{}'; modelled: {}", name, known);
}

}  // namespace

void add_cpu_option(CLI::App& app, std::string& cpu, const std::string& text) {
  app.add_option("--cpu", cpu, text)
      ->check([](const std::string& name) { return find_cpu(name) ? "" : unknown_cpu(name); })
      ->capture_default_str()
      ->type_name("TYPE");
}

void CpuOptions::add_to(CLI::App& app) {
  add_cpu_option(app, cpu, "CPU to run on");
  app.add_option("--times", times_file, "corrected execution times, a CSV file as `s7200 times --csv` writes it")
      ->type_name("FILE");
}

const CpuModel* CpuOptions::model() const {
  const CpuModel* found = find_cpu(cpu);
  if (!found) print_error(unknown_cpu(cpu));
  return found;
}

std::optional<TimeTable> CpuOptions::times(const CpuModel& model) const {
  TimeTable table = default_times(model);
  if (times_file.empty()) return table;
  std::string why;
  const auto csv = read_file(times_file, why);
  if (!csv) {
    print_error(fmt::format("cannot read {}: {}", times_file, why));
    return {};
  }
  const auto errors = table.add(*csv, times_file);
  for (const std::string& error : errors) print_error(error);
  if (!errors.empty()) return {};
  return table;
}

void ProgramOptions::add_to(CLI::App& app) {
  app.add_option("PROGRAM", path, "STL file (.stl, .awl, .txt) or published document with STL in it")->required();
  CpuOptions::add_to(app);
}

std::shared_ptr<const Program> ProgramOptions::load(int& exit_code) const {
  exit_code = kUnusable;
  const CpuModel* cpu_model = model();
  if (!cpu_model) return nullptr;
  const auto table = times(*cpu_model);
  if (!table) return nullptr;
  auto text = read_program_text(path);
  if (!text) return nullptr;
  const CheckResult result = check(std::move(text->parsed), *cpu_model, *table);
  print_diagnostics(result, false);
  if (!result.program) print_error(fmt::format("{} has errors; nothing was run", path));
  exit_code = result.program ? kFine : kCheckFailed;
  return result.program;
}

std::optional<SourceText> read_program_text(const std::string& path, bool force_document) {
  std::string why;
  const auto bytes = read_file(path, why);
  auto text = bytes ? read_source(*bytes, path, why, force_document) : std::nullopt;
  if (!text) print_error(fmt::format("cannot read {}: {}", path, why));
  return text;
}

void print_diagnostics(const CheckResult& result, bool warnings) {
  const bool colour = colour_wanted(stderr);
  for (const stl::Diagnostic& diagnostic : result.diagnostics)
    if (warnings || diagnostic.severity == stl::Severity::Error)
      fmt::print(stderr, "{}", stl::render(diagnostic, result.source, colour));
}

}  // namespace s7200::tools

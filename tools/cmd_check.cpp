#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/commands.hpp"
#include "tools/exit_code.hpp"
#include "tools/program_options.hpp"
#include "tools/results_json.hpp"
#include "tools/terminal.hpp"

namespace s7200::tools {
namespace {

struct CheckOptions {
  CpuOptions cpu;
  std::vector<std::string> paths;
  bool json = false;
};

nlohmann::ordered_json to_json(const stl::Diagnostic& d) {
  return {{"severity", d.severity == stl::Severity::Error ? "error" : "warning"},
          {"line", d.position.line},
          {"column", d.position.column},
          {"length", d.position.length},
          {"message", d.message},
          {"hint", d.hint}};
}

/// The CPUs, other than the one asked for, that the program is fine for.
std::vector<std::string_view> other_cpus(const std::string& path, const CpuModel& asked) {
  std::vector<std::string_view> fitting;
  for (const CpuModel* model : all_cpus()) {
    if (model == &asked) continue;
    auto text = read_program_text(path);
    if (text && check(std::move(text->parsed), *model, default_times(*model)).program) fitting.push_back(model->name);
  }
  return fitting;
}

nlohmann::ordered_json to_json(const std::string& path, const SourceText& text, const CheckResult& result,
                               const CpuModel& model) {
  nlohmann::ordered_json diagnostics = nlohmann::ordered_json::array();
  for (const stl::Diagnostic& d : result.diagnostics) diagnostics.push_back(to_json(d));
  return {{"file", path},
          {"ok", result.program != nullptr},
          {"cpu", model.name},
          {"fine_for", result.program ? std::vector<std::string_view>{} : other_cpus(path, model)},
          {"kind", text.as_document ? "document" : "stl"},
          {"encoding", text.encoding},
          {"instructions", result.program ? result.program->ops.size() : 0},
          {"diagnostics", diagnostics}};
}

std::string counted(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void print_summary(const std::string& path, const SourceText& text, const CheckResult& result, const CpuModel& model) {
  const auto errors =
      static_cast<std::size_t>(std::count_if(result.diagnostics.begin(), result.diagnostics.end(),
                                             [](const auto& d) { return d.severity == stl::Severity::Error; }));
  const std::size_t warnings = result.diagnostics.size() - errors;
  if (!result.program) {
    const auto others = other_cpus(path, model);
    fmt::print("{}: {}, {} for CPU {}{}\n", path, counted(errors, "error"), counted(warnings, "warning"), model.name,
               others.empty() ? "" : fmt::format("; fine for CPU {}", fmt::join(others, ", ")));
  } else
    fmt::print("{}: fine, {} for CPU {}{}{}\n", path, counted(result.program->ops.size(), "instruction"),
               result.program->model->name, text.as_document ? ", out of a document" : "",
               warnings ? ", " + counted(warnings, "warning") : "");
}

int run_check(const CheckOptions& options) {
  const CpuModel* model = options.cpu.model();
  if (!model) return kUnusable;
  const auto times = options.cpu.times(*model);
  if (!times) return kUnusable;
  int exit_code = kFine;
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const std::string& path : options.paths) {
    auto text = read_program_text(path);
    if (!text) {
      exit_code = kUnusable;
      continue;
    }
    const CheckResult result = check(std::move(text->parsed), *model, *times);
    if (!result.program) exit_code = std::max<int>(exit_code, kCheckFailed);
    if (options.json) {
      files.push_back(to_json(path, *text, result, *model));
    } else {
      print_diagnostics(result, true);
      print_summary(path, *text, result, *model);
    }
  }
  if (options.json) {
    auto results = results_of("check");
    results["files"] = std::move(files);
    print_results(results);
  }
  return exit_code;
}

}  // namespace

void add_check(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* verb = app.add_subcommand("check", "check STL programs: every error with its place and what to do about it");
  verb->add_option("PROGRAM", options->paths, "STL files or published documents")->required();
  options->cpu.add_to(*verb);
  verb->add_flag("--json", options->json, "print the results as JSON");
  verb->footer("Example: s7200 check stl_programs/modbus_slave.stl");
  verb->callback([options, &exit_code] { exit_code = run_check(*options); });
}

}  // namespace s7200::tools

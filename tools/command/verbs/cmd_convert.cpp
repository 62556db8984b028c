#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "interpreter/analysis/warnings/check.hpp"
#include "interpreter/base/text/text.hpp"
#include "interpreter/program/checking/routine_ends.hpp"
#include "interpreter/program/loading/convert.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/reading/convert_output.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"

namespace s7200::tools {
namespace {

/// False after the mistakes are printed. What is not modelled can be converted.
bool is_right_for(const CpuModel& model, const SourceText& source) {
  CheckResult result = check(source.parsed, model, default_times(model));
  std::erase_if(result.diagnostics, [](const stl::Diagnostic& d) {
    return d.severity == stl::Severity::Warning || d.message.find("not modelled") != std::string::npos;
  });
  print_diagnostics(result.diagnostics, result.source);
  return result.diagnostics.empty();
}

int run_convert(const ConvertOptions& options) {
  if (!options.program.model()) return kUnusable;
  auto source = read_project(options.program.path, options.program.parts);
  if (!source) return kUnusable;
  if (!repair(*source, options.program.repairs)) return kUnusable;
  print_notes(reading_notes(*source));
  const CpuModel* const model = options.program.model_for(*source, options.program.path);
  if (!model) return kUnusable;
  if (!is_right_for(*model, *source)) return print_error("nothing was written"), kCheckFailed;
  if (model->self & kCpu22x) forget_missing_ends(source->parsed);
  const Notation notation = *notation_named(options.notation);
  const auto text = convert(source->parsed, notation);
  if (!text) {
    print_diagnostics(source->parsed.diagnostics, source->parsed.source);
    print_error("nothing was written");
    return kCheckFailed;
  }
  if (notation != Notation::MicroWin && !source->parsed.source.data.empty())
    print_note("the data block is not part of a listing: give its file beside the new one");
  return write_converted(options, *source, *text);
}

}  // namespace

void add_convert(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* verb = app.add_subcommand("convert", "print a program in another notation, which reads back as the same");
  options->program.add_files_to(*verb);
  add_cpu_option(*verb, options->program.cpu, fmt::format("CPU that it is for {}", kCpuFound));
  add_repair_option(*verb, options->program.repairs);
  verb->add_option(
          "--to", options->notation,
          "iec (one listing, 16#FF), microdos (K4, KHFF), microwin (blocks of an export, with names), german (E, A, U)")
      ->required()
      ->check([](const std::string& name) {
        return notation_named(name)
                   ? std::string()
                   : fmt::format("there is no notation '{}'; there are {}", stl::shortened(name), notation_names());
      })
      ->type_name("NOTATION");
  verb->add_option(
          "--encoding", options->encoding,
          "UTF-8, UTF-16, Windows-1250 to -1254, CP437, GBK or Shift-JIS; Micro/WIN reads the code page of its Windows")
      ->capture_default_str()
      ->type_name("NAME");
  verb->add_option("-o,--output", options->output,
                   "file to write, and FILE_symbols.txt for the symbols of microwin; standard output if not given")
      ->type_name("FILE");
  verb->add_flag("--force", options->force, "overwrite an existing file");
  verb->add_flag("--json", options->json, "print what was converted as JSON, with the STL if no file is written");
  verb->footer("Example: s7200 convert stl_programs/modbus_slave.stl --to microwin");
  verb->callback([options, &exit_code] { exit_code = run_convert(*options); });
}

}  // namespace s7200::tools

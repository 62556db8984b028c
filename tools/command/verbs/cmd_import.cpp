#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "interpreter/base/text/text.hpp"
#include "interpreter/program/loading/convert.hpp"
#include "interpreter/stl/tables/symbols.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/input.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/reading/stl_output.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/views/program/import_report.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct ImportOptions {
  std::string document, output;
  std::string from = "stl";
  bool compare = false, force = false, json = false;
  Repairs repairs;
};

void print_json(const ImportOptions& options, const SourceText& text, const std::string& stl) {
  auto results = results_of("import");
  results["document"] = options.document;
  add_import_results(results, text, options.output == "-" ? "" : options.output, stl);
  fmt::print("{}", lines_of(results));
}

int run_compare(const ImportOptions& options) {
  std::string name;
  const auto bytes = read_input(options.document, name);
  if (!bytes) return kUnusable;
  const auto comparison = compare_drawings(*bytes, name);
  if (!comparison) return print_error(fmt::format("cannot read {}: {}", name, comparison.why())), kUnusable;
  if (options.json) {
    auto results = results_of("import");
    results["document"] = options.document;
    add_comparison(results, *comparison);
    fmt::print("{}", lines_of(results));
  } else {
    print_diagnostics(comparison->diagnostics, comparison->source);
    fmt::print("{}", comparison_summary(*comparison));
  }
  return has_errors(comparison->diagnostics) ? kCheckFailed : kFine;
}

int run_import(const ImportOptions& options) {
  if (options.compare) return run_compare(options);
  auto text = options.from == "ladder" ? read_drawings(options.document) : read_program_text(options.document, true);
  if (!text) return kUnusable;
  if (text->kind == SourceKind::Blocks) stl::resolve_symbols(text->parsed);
  if (options.from == "ladder" || has_errors(text->parsed.diagnostics))
    print_diagnostics(text->parsed.diagnostics, text->parsed.source);
  if (has_errors(text->parsed.diagnostics)) return print_error("nothing was written"), kCheckFailed;
  if (!repair(*text, options.repairs)) return kUnusable;
  print_notes(reading_notes(*text));
  stl::resolve_symbols(text->parsed);  // a listing without blocks knows no routine by its name
  const std::string stl = imported_text(text->parsed.source);
  if (options.output.empty() || options.output == "-") {
    if (options.json)
      print_json(options, *text, stl);
    else
      print_file(stl);
    return kFine;
  }
  const int exit_code = write_stl(options.output, {options.document}, options.force, stl);
  if (exit_code == kFine && options.json)
    print_json(options, *text, stl);
  else if (exit_code == kFine)
    fmt::print(stderr, "{}: {} instructions out of {} ({})\n", stl::printable(options.output),
               count_statements(text->parsed.source), stl::printable(text->parsed.source.name), text->encoding);
  return exit_code;
}

}  // namespace

void add_import(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* verb = app.add_subcommand("import", "write the STL of a published document, or of its ladder drawings");
  verb->add_option("DOCUMENT", options->document, "document with an STL listing or ladder drawings; - is standard input")
      ->required();
  auto* from =
      verb->add_option("--from", options->from, "what to read of the document: its STL listing or its ladder drawings")
          ->check(CLI::IsMember({"stl", "ladder"}))
          ->capture_default_str()
          ->type_name("WHAT");
  auto* output =
      verb->add_option("-o,--output", options->output, "file to write; standard output if not given")->type_name("FILE.stl");
  verb->add_flag("--compare", options->compare,
                 "write nothing: set the drawings against the STL beside them, network by network")
      ->excludes(from)
      ->excludes(output);
  add_repair_option(*verb, options->repairs);
  verb->add_flag("--force", options->force, "overwrite an existing file");
  verb->add_flag("--json", options->json, "print what was imported as JSON, with the STL if no file is written");
  verb->footer("Example: s7200 import tip41.txt -o tip41.stl\nExample: s7200 import --compare tip41.txt");
  verb->callback([options, &exit_code] { exit_code = run_import(*options); });
}

}  // namespace s7200::tools

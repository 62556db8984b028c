#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "interpreter/base/text.hpp"
#include "interpreter/stl/printer.hpp"
#include "interpreter/stl/symbols.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/written_files.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct ImportOptions {
  std::string document, output;
  bool force = false, json = false;
  Repairs repairs;
};

std::size_t count_statements(const stl::Source& source) {
  return static_cast<std::size_t>(std::count_if(source.lines.begin(), source.lines.end(), [](const stl::Line& line) {
    return std::holds_alternative<stl::Statement>(line);
  }));
}

int write(const ImportOptions& options, const std::string& text) {
  WrittenFiles files;
  files.reads(options.document);
  std::string why;
  const auto destination = files.claim("-o", options.output, {"STL"}, options.force ? Replace::Judged : Replace::Never, why);
  if (!destination) return print_error(why), kUnusable;
  catch_interruption();  // the file is written to its end
  if (write_result(*destination, text, why)) return kFine;
  print_error(why);
  return kUnusable;
}

void print_json(const ImportOptions& options, const SourceText& text, const std::string& stl) {
  const bool to_file = !options.output.empty() && options.output != "-";
  auto results = results_of("import");
  results["document"] = options.document;
  results["encoding"] = text.encoding;
  results["instructions"] = count_statements(text.parsed.source);
  results["left_out"] = text.parsed.left_out;
  results["output"] = to_file ? nlohmann::ordered_json(options.output) : nullptr;
  results["stl"] = to_file ? nullptr : nlohmann::ordered_json(stl);
  fmt::print("{}", lines_of(results));
}

int run_import(const ImportOptions& options) {
  auto text = read_program_text(options.document, true);
  if (!text) return kUnusable;
  if (text->kind == SourceKind::Blocks) stl::resolve_symbols(text->parsed);
  if (has_errors(text->parsed.diagnostics)) {
    print_diagnostics(text->parsed.diagnostics, text->parsed.source);
    print_error("nothing was written");
    return kCheckFailed;
  }
  if (!repair(*text, options.repairs)) return kUnusable;
  print_note_if_any(left_out_note(*text));
  stl::resolve_symbols(text->parsed);  // a listing without blocks knows no routine by its name
  const std::string stl = stl::to_text(text->parsed.source);
  if (options.output.empty() || options.output == "-") {
    if (options.json)
      print_json(options, *text, stl);
    else
      print_file(stl);
    return kFine;
  }
  const int exit_code = write(options, stl);
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
  CLI::App* verb = app.add_subcommand("import", "write the STL of a published document as a clean .stl file");
  verb->add_option("DOCUMENT", options->document, "document with an STL listing; - is standard input")->required();
  verb->add_option("-o,--output", options->output, "file to write; standard output if not given")->type_name("FILE.stl");
  add_repair_option(*verb, options->repairs);
  verb->add_flag("--force", options->force, "overwrite an existing file");
  verb->add_flag("--json", options->json, "print what was imported as JSON, with the STL if no file is written");
  verb->footer("Example: s7200 import tip41.txt -o tip41.stl");
  verb->callback([options, &exit_code] { exit_code = run_import(*options); });
}

}  // namespace s7200::tools

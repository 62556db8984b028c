#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "interpreter/base/text.hpp"
#include "interpreter/program/convert.hpp"
#include "interpreter/stl/encoding.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/command/stl_output.hpp"
#include "tools/command/terminal.hpp"
#include "tools/views/check_report.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct ConvertOptions {
  ProgramOptions program;
  std::string notation, output, encoding = "UTF-8";
  bool force = false, json = false;

  bool to_file() const { return !output.empty() && output != "-"; }
};

/// The table of the names that stay in the text; empty if none do.
std::string symbols_of(const ConvertOptions& options, const SourceText& source) {
  return options.notation == name_of(Notation::MicroWin) ? symbol_table_text(source.parsed.source) : "";
}

/// Beside the program: `plant.awl` has its symbols in `plant_symbols.txt`.
std::string table_path(const ConvertOptions& options) {
  const std::filesystem::path program(options.output);
  return (program.parent_path() / (program.stem().string() + "_symbols.txt")).string();
}

void print_json(const ConvertOptions& options, const SourceText& source, const std::string& text) {
  auto results = results_of("convert");
  results["program"] = options.program.path;
  results["encoding"] = source.encoding;
  results["notation"] = options.notation;
  results["output"] = options.to_file() ? nlohmann::ordered_json(options.output) : nullptr;
  results["stl"] = options.to_file() ? nullptr : nlohmann::ordered_json(text);
  const std::string table = symbols_of(options, source);
  results["symbols_output"] = options.to_file() && !table.empty() ? nlohmann::ordered_json(table_path(options)) : nullptr;
  results["symbols"] = options.to_file() || table.empty() ? nullptr : nlohmann::ordered_json(table);
  fmt::print("{}", lines_of(results));
}

/// False after the mistakes are printed, for the CPU that it has the fewest for. What is not modelled can be converted.
bool is_right_for_any_cpu(const SourceText& source) {
  const CheckResult best = check_for_best_cpu(source);
  print_diagnostics(best.diagnostics, best.source);
  return best.diagnostics.empty();
}

/// What reads the file again guesses its encoding.
std::string encoding_note(const std::string& text, const std::string& encoded, const std::string& encoding) {
  std::string why;
  const auto again = stl::decode(encoded, why);
  if (!again || again->text == text) return {};
  return fmt::format("when this is read again it is taken for {}, not for {}: comments and texts will look different",
                     again->encoding, encoding);
}

int run_convert(const ConvertOptions& options) {
  auto source = read_project(options.program.path, options.program.parts);
  if (!source) return kUnusable;
  if (!repair(*source, options.program.repairs)) return kUnusable;
  print_note_if_any(left_out_note(*source));
  if (!is_right_for_any_cpu(*source)) return print_error("nothing was written"), kCheckFailed;
  const Notation notation = *notation_named(options.notation);
  const auto text = convert(source->parsed, notation);
  if (!text) {
    print_diagnostics(source->parsed.diagnostics, source->parsed.source);
    print_error("nothing was written");
    return kCheckFailed;
  }
  if (notation != Notation::MicroWin && !source->parsed.source.data.empty())
    print_note("the data block is not part of a listing: give its file beside the new one");
  std::string why;
  const auto encoded = stl::encode(*text, options.encoding, why);
  if (!encoded) return print_error("--encoding: " + why + "; nothing was written"), kUnusable;
  print_note_if_any(encoding_note(*text, *encoded, options.encoding));
  const std::string symbols = symbols_of(options, *source);
  const auto table = symbols.empty() ? std::nullopt : stl::encode(symbols, options.encoding, why);
  if (!symbols.empty() && !table) return print_error("--encoding: " + why + "; nothing was written"), kUnusable;
  std::vector<std::string> inputs = options.program.parts;
  inputs.push_back(options.program.path);
  int exit_code = kFine;
  if (options.to_file()) {
    std::vector<StlFile> files{{options.output, *encoded}};
    if (table) files.push_back({table_path(options), *table});
    exit_code = write_stl(files, inputs, options.force);
    if (exit_code == kFine && table) print_note(fmt::format("its symbols are in {}", table_path(options)));
  } else if (table && !options.json) {
    print_note("the program keeps its names and needs their symbol table; -o FILE writes that too");
  }
  if (exit_code == kFine && options.json)
    print_json(options, *source, *text);
  else if (!options.to_file())
    print_file(*encoded);
  return exit_code;
}

}  // namespace

void add_convert(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* verb =
      app.add_subcommand("convert", "print a program in another notation, which reads back as the same program");
  options->program.add_files_to(*verb);
  add_repair_option(*verb, options->program.repairs);
  verb->add_option("--to", options->notation,
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
  verb->add_option("-o,--output", options->output, "file to write, and FILE_symbols.txt for the symbols of microwin; standard output if not given")->type_name("FILE");
  verb->add_flag("--force", options->force, "overwrite an existing file");
  verb->add_flag("--json", options->json, "print what was converted as JSON, with the STL if no file is written");
  verb->footer("Example: s7200 convert stl_programs/modbus_slave.stl --to microwin");
  verb->callback([options, &exit_code] { exit_code = run_convert(*options); });
}

}  // namespace s7200::tools

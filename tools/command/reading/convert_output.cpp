#include "tools/command/reading/convert_output.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "interpreter/base/file_path.hpp"
#include "interpreter/program/loading/convert.hpp"
#include "interpreter/stl/text/encoding.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/reading/stl_output.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

/// The table of the names that stay in the text; empty if none do.
std::string symbols_of(const ConvertOptions& options, const SourceText& source) {
  return options.notation == name_of(Notation::MicroWin) ? symbol_table_text(source.parsed.source) : "";
}

/// Beside the program: `plant.awl` has its symbols in `plant_symbols.txt`.
std::string table_path(const ConvertOptions& options) {
  const std::filesystem::path program = file_path(options.output);
  return (program.parent_path() / file_path(program.stem().string() + "_symbols.txt")).generic_string();
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

/// What reads the file again guesses its encoding.
std::string encoding_note(const std::string& text, const std::string& encoded, const std::string& encoding) {
  const auto again = stl::decode(encoded);
  if (!again || again->text == text) return {};
  return fmt::format("when this is read again it is taken for {}, not for {}: comments and texts will look different",
                     again->encoding, encoding);
}

}  // namespace

int write_converted(const ConvertOptions& options, const SourceText& source, const std::string& text) {
  const auto encoded = stl::encode(text, options.encoding);
  if (!encoded) return print_error("--encoding: " + encoded.why() + "; nothing was written"), kUnusable;
  print_note_if_any(encoding_note(text, *encoded, options.encoding));
  const std::string symbols = symbols_of(options, source);
  const auto table = symbols.empty() ? std::nullopt : stl::encode(symbols, options.encoding);
  if (!symbols.empty() && !table) return print_error("--encoding: " + table.why() + "; nothing was written"), kUnusable;
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
    print_json(options, source, text);
  else if (!options.to_file())
    print_file(*encoded);
  return exit_code;
}

}  // namespace s7200::tools

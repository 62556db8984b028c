#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <stdexcept>

#include "interpreter/base/file_path.hpp"
#include "interpreter/base/file_source.hpp"
#include "interpreter/base/text/text.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/verb/import_capture_options.hpp"
#include "tools/command/reading/stl_output.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/plan/reading/system_reader.hpp"
#include "tools/scenario/limits.hpp"
#include "tools/scenario/scenario.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

/// As the scenario's file has to name it.
std::string seen_from(const std::string& path, const ImportCaptureOptions& options) {
  if (path.empty() || !options.to_file()) return path;
  const auto folder = std::filesystem::absolute(file_path(options.output)).parent_path();
  return std::filesystem::absolute(file_path(path))
      .lexically_normal()
      .lexically_relative(folder.lexically_normal())
      .generic_string();
}

/// False after a message: `test` could not run it.
bool is_a_program(const std::string& path) {
  if (path.empty()) return true;
  if (is_standard_input(path) || is_system_file(path))
    return print_error(fmt::format("--program {}: the scenario names an STL file or a document here", path)), false;
  return read_program_text(path).has_value();
}

/// `scenario`: null if nothing was written.
void print_results(const ImportCaptureOptions& options, const nlohmann::ordered_json& scenario) {
  auto results = results_of("import-capture");
  const bool to_file = options.to_file() && !scenario.is_null();
  results["file"] = options.recording.file;
  results["output"] = to_file ? nlohmann::ordered_json(options.output) : nullptr;
  results["scenario"] = to_file ? nullptr : scenario;
  fmt::print("{}", lines_of(results));
}

int run_import_capture(const ImportCaptureOptions& options) {
  if (!is_a_program(options.program)) return kUnusable;
  if (const CpuModel* model = find_cpu(options.cpu); model && options.choices.port >= model->ports)
    return print_error(fmt::format("CPU {} has no port {}: --cpu names one that has", options.cpu, options.choices.port)),
           kUnusable;
  const auto read = read_conversation(options.recording);
  if (!read) return kUnusable;
  if (read->frames.empty() && options.recording.was_cut_short()) {
    if (options.json) print_results(options, nullptr);
    return print_interruption(), kCheckFailed;
  }
  PlaybackChoices choices = options.choices;
  choices.name = read->name;
  const RecordedProtocol protocol = options.recording.spoken();
  if (protocol.of_the_cpu) choices.ppi_station = ppi_station_asked(read->frames, choices.station);
  choices.program = seen_from(options.program, options);
  if (options.cpu != Scenario{}.cpu) choices.cpu = options.cpu;
  const auto [scenario, notes] = playback(read->frames, read->stamps, choices);
  print_notes(notes);
  if (scenario.empty())
    return print_error(fmt::format("{}: {}", read->name, why_nothing_is_asked(read->frames, choices))), kUnusable;
  const std::string text =
      fmt::format("{} {} by s7200 import-capture. {}\n{}{}", kImportBeginning, stl::printable(read->name),
                  how_to_run(protocol, choices), read->silences_comment(), scenario);
  const int exit_code =
      options.to_file() ? write_stl(options.output, {options.recording.file, options.program}, options.force, text) : kFine;
  if (exit_code == kFine && options.json) {
    print_results(options, text);
  } else if (!options.to_file()) {
    print_file(text);
  }
  if (exit_code != kFine || !options.recording.was_cut_short()) return exit_code;
  return print_interruption(), kCheckFailed;
}

}  // namespace

void add_import_capture(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ImportCaptureOptions>();
  CLI::App* verb = app.add_subcommand("import-capture", "write a recording, or what is heard on a line, as a scenario");
  options->add_to(*verb);
  verb->footer(std::string(kEndOfListening) +
               "Topics: recordings, protocols\n"
               "Example: s7200 import-capture tests/recordings/plant.log --program stl_programs/modbus_slave.stl");
  verb->callback([options, &exit_code] {
    try {
      exit_code = run_import_capture(*options);
    } catch (const std::invalid_argument& error) {
      print_error(error.what());
      exit_code = kUnusable;
    }
  });
}

}  // namespace s7200::tools

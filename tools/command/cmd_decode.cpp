#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/recording_options.hpp"
#include "tools/command/terminal.hpp"
#include "tools/recordings/decoded.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct DecodeOptions {
  RecordingOptions recording;
  bool json = false;
};

int run_decode(const DecodeOptions& options) {
  const auto read = read_conversation(options.recording);
  if (!read) return kUnusable;
  if (options.json) {
    auto results = results_of("decode");
    results["file"] = options.recording.file;
    results["form"] = read->recording.form;
    results["protocol"] = options.recording.protocol;
    add_decoded(results, read->frames, read->stamps);
    fmt::print("{}", lines_of(results));
  } else {
    fmt::print("{}", decoded_text(read->frames, read->stamps, colour_wanted(stdout)));
  }
  return kFine;
}

}  // namespace

void add_decode(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DecodeOptions>();
  CLI::App* verb =
      app.add_subcommand("decode", "show a recording of a line as requests and answers, with gaps and latencies");
  options->recording.add_to(*verb);
  verb->add_flag("--json", options->json, "print the frames as JSON");
  verb->footer("Example: s7200 decode tests/recordings/plant.log");
  verb->callback([options, &exit_code] { exit_code = run_decode(*options); });
}

}  // namespace s7200::tools

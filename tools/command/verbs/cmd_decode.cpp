#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "tools/command/exit_code.hpp"
#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/verb/recording_options.hpp"
#include "tools/command/options/verb/report_option.hpp"
#include "tools/command/reading/decode_results.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/host/serial_device.hpp"
#include "tools/recordings/decoded.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct DecodeOptions {
  RecordingOptions recording;
  ReportOption report;
  bool json = false;
};

nlohmann::ordered_json head_of(const DecodeOptions& options, const std::string& form,
                               const std::optional<SerialFormat>& line) {
  auto results = results_of("decode");
  results["file"] = options.recording.file;
  results["form"] = form.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(form);
  results["protocol"] = options.recording.protocol;
  results["line"] = line ? nlohmann::ordered_json(format_text(*line)) : nullptr;
  return results;
}

/// An interruption is said.
int exit_code_of(const DecodeOptions& options, const DecodedSummary& summary) {
  const bool cut_short = options.recording.was_cut_short();
  if (cut_short) print_interruption();
  return cut_short || summary.all_wrong() ? kCheckFailed : kFine;
}

/// Frame by frame as they come.
int run_live(const DecodeOptions& options, const SlaveTarget& target) {
  const auto line = open_line(options.recording, target);
  if (!line) return kUnusable;
  DecodeResults results(head_of(options, "live", options.recording.format()), options.json, options.report);
  std::fflush(stdout);
  const bool heard = listen(*line, options.recording, [&](const ReadFrame& frame) {
    results.add(frame, false);
    std::fflush(stdout);
  });
  const bool written = results.end();
  return heard && written ? exit_code_of(options, results.summary()) : kUnusable;
}

/// As it is read: the recording may be long.
int run_file(const DecodeOptions& options) {
  const auto read = read_file(options.recording);
  if (!read) return kUnusable;
  DecodeResults results(head_of(options, read->recording.form, read->line), options.json, options.report);
  const auto answered =
      results.marks_unanswered() ? answered_requests(read->recording, options.recording.spoken(), read->stamps) : std::vector<bool>{};
  std::size_t number = 0;
  tell_frames(*read, options.recording, [&](const ReadFrame& frame) {
    const bool is_open = frame.direction == Direction::Request && !frame.needs_no_answer;
    results.add(frame, is_open && number < answered.size() && !answered[number]);
    ++number;
  });
  const bool written = results.end();
  if (!options.json && read->line)
    print_report(fmt::format("{}; --baud and --parity say otherwise\n", read->silences_text()));
  return written ? exit_code_of(options, results.summary()) : kUnusable;
}

int run_decode(DecodeOptions& options) {
  if (!options.report.prepare()) return kUnusable;
  const auto target = options.recording.live();
  return target ? run_live(options, *target) : run_file(options);
}

}  // namespace

void add_decode(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<DecodeOptions>();
  CLI::App* verb = app.add_subcommand("decode", "show a recording of a line, or what is heard, as requests and answers");
  options->recording.add_to(*verb);
  options->report.add_to(*verb, "a page for browsers with the frames as a table, latencies and a filter");
  verb->add_flag("--json", options->json, "print the frames as JSON")->group(help_group::kResults);
  verb->footer(std::string(kEndOfListening) +
               "Exit code 1 too if there were frames and none of them was right.\n"
               "Topics: recordings, protocols\n"
               "Example: s7200 decode tests/recordings/plant.log\n" +
               fmt::format("Example: s7200 decode {} --protocol ppi", example_of_serial_device()));
  verb->callback([options, &exit_code] {
    try {
      exit_code = run_decode(*options);
    } catch (const std::invalid_argument& error) {
      print_error(error.what());
      exit_code = kUnusable;
    }
  });
}

}  // namespace s7200::tools

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <stdexcept>

#include "tools/command/exit_code.hpp"
#include "tools/command/options/plc/stand_in_options.hpp"
#include "tools/command/options/verb/test_options.hpp"
#include "tools/command/options/wanted_file.hpp"
#include "tools/command/polling/growing_transcript.hpp"
#include "tools/command/terminal/terminal.hpp"
#include "tools/command/testing/mutants_output.hpp"
#include "tools/command/testing/test_output.hpp"
#include "tools/command/testing/test_report.hpp"
#include "tools/command/verbs/commands.hpp"
#include "tools/host/interruption.hpp"
#include "tools/scenario/reading/keys.hpp"
#include "tools/slave/slave_target.hpp"

namespace s7200::tools {
namespace {

/// False after a message, but for an interruption, which is said besides.
bool write_transcript(const Destination& to, const TestOptions& options, const SuiteResult& result) {
  const Time tolerance = tolerance_for(options.tolerance, result.live);
  const std::string text = transcript_text(result.reports, {options.record, result.tested, tolerance, result.live});
  const std::string why = why_not_recorded(result.reports, text.size());
  if (why.empty()) return write_wanted(to, text);
  print_error(fmt::format("cannot write {}: {}", options.record, why));
  return interrupted();
}

/// Says why nothing was run, and returns the exit code. An interruption explains by itself what could not be read.
int nothing_run(const Messages& messages, const TestOptions& options, const TestOptions::Destinations& to) {
  if (interrupted()) end_before_anything_ran(options.json, !options.against.empty());
  if (interrupted()) return write_reports(to, {{.text = "interrupted before anything was run"}}), kCheckFailed;
  print_messages(messages);
  write_reports(to, messages);
  return kUnusable;
}

int run_all(Suite& suite, const TestOptions& options, const TestOptions::Destinations& to) {
  TestOutput output(suite.scenarios().size(), options.json, !options.suite.conformance.empty());
  Messages messages;
  Suite::Watcher<Report> watcher{.finished = [&](const Report& report) { output.show(report); },
                                 .waiting = [&](std::size_t done) { output.show_progress(done); }};
  std::optional<GrowingTranscript> growing;
  if (to.record) growing.emplace(*to.record, options.record, options.tolerance);
  if (options.is_random_alone())
    watcher.exchange = [&](const SuiteResult& so_far, const Scenario& scenario, const Seen& seen) {
      output.show(scenario, seen);
      if (growing) growing->add(so_far, scenario, seen);
    };
  const auto result = suite.run(watcher, messages);
  if (!result) return nothing_run(messages, options, to);
  print_messages(messages);
  output.end(*result, options.coverage, options.profile);
  const std::string nothing = result->why_nothing_was_checked();
  if (!nothing.empty() && !to.record) print_note("nothing was checked: " + nothing);
  bool all_written = write_reports(options, to, result->reports);
  all_written &= !options.coverage.wanted() || options.coverage.show(result->coverage, options.json);
  all_written &= show_profile(options, *result);
  if (to.record) all_written &= growing->any() ? growing->complete() : write_transcript(*to.record, options, *result);
  print_interruption();
  if (!result->unreachable.empty()) print_error(result->unreachable);
  if (!all_written || !result->unreachable.empty() || (!interrupted() && !result->any_had_a_program())) return kUnusable;
  const bool enough = options.coverage.is_enough(result->coverage);
  return interrupted() || !result->passed() || !enough ? kCheckFailed : kFine;
}

int run_against(Suite& suite, const TestOptions& options) {
  TestOutput output(suite.scenarios().size(), options.json, false);
  Messages messages;
  const auto result = suite.compare(
      options.against, options.tolerance, options.ignore_timing, colour_wanted(stdout) && !options.json,
      {[&](const Compared& compared) { output.show(compared); }, [&](std::size_t done) { output.show_progress(done); }},
      messages);
  if (!result) return nothing_run(messages, options, {});
  print_messages(messages);
  output.end(*result);
  print_interruption();
  return result->same() && !interrupted() ? kFine : kCheckFailed;
}

int run_test(TestOptions& options) {
  if (options.keys) return fmt::print("{}", scenario_keys_markdown()), kFine;
  options.check();
  const TestOptions::Destinations to = options.claim_files();
  if (!options.report.prepare()) return kUnusable;
  options.complete_suite();
  catch_interruption();  // from here on there is something to complete
  Messages messages;
  auto suite = Suite::collect(options.suite, messages);
  if (!suite) return nothing_run(messages, options, to);
  print_messages(messages);
  if (options.list) return print_list(suite->scenarios(), options.json), kFine;
  if (options.mutants) return run_mutants(*suite, options);
  return options.against.empty() ? run_all(*suite, options, to) : run_against(*suite, options);
}

}  // namespace

void add_test(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<TestOptions>();
  CLI::App* verb = app.add_subcommand("test", "run regression tests of a program's protocol, written in YAML");
  options->add_to(*verb);
  verb->footer(
      "A SYSTEM.yaml and a westinghouse:MODEL are new for each scenario, and nothing but their line is seen; scenarios that "
      "set memory are skipped.\n"
      "With --times-band the table in use decides; the others are counted, and decide where a scenario has 'robust: 95%'.\n"
      "Exit codes: 0 all passed; 1 a scenario failed, a rule that says must is broken, --against found a difference, or too "
      "little was covered; "
      "2 nothing could be run, or the slave cannot be reached.\n"
      "Topics: keys, targets, faults, times, westinghouse\n"
      "Example: s7200 test tests/programs/modbus_slave --jobs 2");
  verb->callback([options, &exit_code] { exit_code = run_test(*options); });
}

}  // namespace s7200::tools

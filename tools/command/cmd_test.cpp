#include <fmt/format.h>
#include <fnmatch.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <map>
#include <mutex>
#include <thread>

#include "interpreter/base/text.hpp"
#include "tools/command/commands.hpp"
#include "tools/command/exit_code.hpp"
#include "tools/command/options/line_options.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/program_options.hpp"
#include "tools/command/terminal.hpp"
#include "tools/host/interruption.hpp"
#include "tools/host/written_files.hpp"
#include "tools/scenario/comparison.hpp"
#include "tools/scenario/conformance_suite.hpp"
#include "tools/scenario/junit.hpp"
#include "tools/scenario/reader.hpp"
#include "tools/scenario/report_json.hpp"
#include "tools/scenario/runner.hpp"
#include "tools/scenario/transcript.hpp"
#include "tools/slave/slave_target.hpp"
#include "tools/views/results_json.hpp"

namespace s7200::tools {
namespace {

struct TestOptions {
  std::vector<std::string> files;
  std::string with, conformance, target, against, record, junit, only;
  std::size_t random = 0;
  std::uint32_t seed = 1;
  unsigned station = 1, jobs = 1;
  CpuOptions cpu;  // of random traffic
  serial::MasterSettings line;
  Time tolerance = kNever;                         // kNever: not given
  std::optional<Destination> record_to, junit_to;  // of the files of these names
  bool ignore_timing = false, force = false, json = false, list = false, fail_fast = false, keys = false;

  /// Times of a slave that is no program are of this computer's clock.
  Time tolerance_with(bool live_slave) const {
    if (tolerance != kNever) return tolerance;
    return live_slave ? 50 * kMillisecond : 0;
  }
};

/// The way of a message up to where the exit code is.
struct Unusable {
  int exit_code = kUnusable;
};

[[noreturn]] void fail(const std::string& message) {
  print_error(message);
  throw Unusable{};
}

// --- what there is to run ---

std::vector<std::string> scenario_files(const std::vector<std::string>& paths) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    std::error_code error;
    if (!fs::is_directory(path, error)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    for (fs::recursive_directory_iterator it(path, fs::directory_options::skip_permission_denied, error), end;
         it != end && !error; it.increment(error))
      if (const auto extension = it->path().extension(); extension == ".yaml" || extension == ".yml")
        found.push_back(it->path().string());
    if (error) fail(fmt::format("cannot read {}: {}", path, error.message()));
    if (found.empty()) fail(fmt::format("there is no .yaml file in {}", path));
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

std::string text_of_file(const std::string& path) {
  std::string why;
  const auto text = read_file(path, why);
  if (!text) fail(fmt::format("cannot read {}: {}", path, why));
  return *text;
}

void print(const stl::Diagnostics& diagnostics, const stl::SourceLines& source) {
  for (const stl::Diagnostic& diagnostic : diagnostics)
    fmt::print(stderr, "{}", stl::render(diagnostic, source, colour_wanted(stderr)));
}

/// Values for `${…}` out of --with or --conformance.
std::optional<GivenParameters> given_parameters(const std::string& path) {
  if (path.empty()) return {};
  stl::Diagnostics diagnostics;
  const std::string text = text_of_file(path);
  auto given = read_parameters(text, path, diagnostics);
  if (given) return given;
  stl::SourceLines source{.name = path, .text = stl::split_lines(text)};
  print(diagnostics, source);
  throw Unusable{};
}

/// Takes over the scenarios of a file; false after messages.
bool take(ScenarioFile file, const GivenParameters* given, std::vector<Scenario>& scenarios) {
  print(file.diagnostics, *file.source);
  if (given && !file.diagnostics.empty()) print_note(fmt::format("values for ${{…}} are from {}", given->source->name));
  if (given) print(file.given_diagnostics, *given->source);
  std::move(file.scenarios.begin(), file.scenarios.end(), std::back_inserter(scenarios));
  return file.diagnostics.empty() && file.given_diagnostics.empty();
}

bool is_chosen(const Scenario& scenario, const std::string& pattern) {
  if (pattern.empty()) return true;
  const std::string anywhere = "*" + pattern + "*";
  for (const std::string& text : {scenario.name, scenario.source->name, scenario.rule.id})
    if (fnmatch(anywhere.c_str(), text.c_str(), FNM_CASEFOLD) == 0) return true;
  return false;
}

std::vector<Scenario> read_all(const TestOptions& options) {
  std::vector<Scenario> scenarios;
  const auto given = given_parameters(options.conformance.empty() ? options.with : options.conformance);
  const GivenParameters* parameters = given ? &*given : nullptr;
  bool good = true;
  if (!options.conformance.empty())
    good &= take(read_scenarios(std::string(kConformanceSuite), "modbus_rtu_slave.yaml", parameters), parameters, scenarios);
  for (const std::string& file : scenario_files(options.files))
    good &= take(read_scenarios(text_of_file(file), file, parameters), parameters, scenarios);
  if (!good) throw Unusable{};
  if (options.random > 0) {
    scenarios.push_back(random_traffic(options.random, options.seed, static_cast<std::uint8_t>(options.station)));
    scenarios.back().cpu = options.cpu.cpu;
    scenarios.back().times_file = options.cpu.times_file;
  }
  for (Scenario& scenario : scenarios) scenario.line.override_with(options.line);
  std::erase_if(scenarios, [&](const Scenario& s) { return !is_chosen(s, options.only); });
  if (scenarios.empty())
    fail(options.only.empty() ? "nothing to test: give files or folders, --conformance, or --random with --target"
                              : fmt::format("no scenario has '{}' in its name or file; --list shows them", options.only));
  return scenarios;
}

// --- what they are run on ---

/// Each program is read once, and checked once for each CPU and table of times.
class Programs {
 public:
  /// `named`: by the scenario, which a message then mentions.
  std::shared_ptr<const Program> get(const std::string& path, const Scenario& scenario, bool named) {
    const auto key = std::tuple(path, scenario.cpu, scenario.times_file);
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    ProgramOptions options;
    options.path = path;
    options.cpu = scenario.cpu;
    options.times_file = scenario.times_file;
    int exit_code = kFine;
    const SourceText* text = text_of(path);
    auto program = text ? options.load(*text, exit_code) : nullptr;
    if (!program) {
      if (named)
        print_note(fmt::format("'{}' in {}:{} names it", scenario.name, scenario.source->name, scenario.position.line));
      throw Unusable{};
    }
    return known_[key] = std::move(program);
  }

 private:
  /// Null after a message.
  const SourceText* text_of(const std::string& path) {
    const auto [found, added] = texts_.try_emplace(path);
    if (added) found->second = read_program_text(path);
    return found->second ? &*found->second : nullptr;
  }

  std::map<std::string, std::optional<SourceText>> texts_;
  std::map<std::tuple<std::string, std::string, std::string>, std::shared_ptr<const Program>> known_;
};

/// A bench for each scenario: `target` if it is given, else what the scenario names.
struct Benches {
  std::vector<Bench> of;
  std::unique_ptr<Slave> slave;
  std::string name;
};

Benches benches_for(const std::vector<Scenario>& scenarios, const std::string& target, const TestOptions& options,
                    Programs& programs) {
  Benches benches;
  benches.name = target;
  std::optional<SlaveTarget> parsed;
  if (!target.empty()) parsed = parse_slave_target(target);
  if (parsed && parsed->kind == SlaveTarget::Kind::ModbusTcp && !options.conformance.empty())
    fail(
        "--conformance judges what a slave does on its serial line, which Modbus TCP hides; name a program, pty, device or "
        "tcp://");
  SerialFormat format;
  if (parsed && parsed->kind != SlaveTarget::Kind::Program) {
    format = options.line.over(SerialFormat{});
    benches.slave = connect(*parsed, format);
    benches.name = benches.slave->name();
  }
  for (const Scenario& scenario : scenarios) {
    const bool exchanges_wanted = options.json || !options.record.empty() || !options.against.empty();
    Bench bench{.slave = benches.slave.get(), .format = format, .exchanges_wanted = exchanges_wanted};
    if (!bench.slave && scenario.skipped.empty()) {
      const std::string path = parsed ? parsed->path : scenario.program;
      if (path.empty())
        fail(fmt::format("{}: '{}' names no program; give it 'program:', or name one with --target", scenario.source->name,
                         scenario.name));
      bench.program = programs.get(path, scenario, !parsed);
      if (benches.name.empty()) benches.name = path;
    }
    benches.of.push_back(std::move(bench));
  }
  return benches;
}

// --- running ---

/// What is going on, on a terminal, when it takes longer than two seconds.
class Progress {
 public:
  explicit Progress(std::size_t all) : all_(all), on_(isatty(STDERR_FILENO)) {}
  ~Progress() { clear(); }
  void show(std::size_t done) {
    if (!on_ || std::chrono::steady_clock::now() - begin_ < std::chrono::seconds(2)) return;
    fmt::print(stderr, "\r{} of {} scenarios", done, all_);
    std::fflush(stderr);
    shown_ = true;
  }
  void clear() {
    if (shown_) fmt::print(stderr, "\r\x1b[K");
    shown_ = false;
  }

 private:
  std::size_t all_;
  bool on_, shown_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Runs all scenarios, `jobs` at a time, and hands over each result in the order of the scenarios, in this thread.
/// `finished` returns false to end it there.
class Runner {
 public:
  Runner(const std::vector<Scenario>& scenarios, const Benches& benches, unsigned jobs)
      : scenarios_(scenarios), benches_(benches), results_(scenarios.size()) {
    for (unsigned i = 0; i < std::min<std::size_t>(jobs, scenarios.size()); ++i) threads_.emplace_back([this] { work(); });
  }
  ~Runner() {
    stop_ = true;
    for (std::thread& thread : threads_) thread.join();
  }

  template <class Finished>
  void each(Finished finished) {
    Progress progress(scenarios_.size());
    for (std::size_t i = 0; i < scenarios_.size(); ++i) {
      std::unique_lock lock(mutex_);
      while (!ready_.wait_for(lock, std::chrono::milliseconds(200), [&] { return results_[i] || failed_; }))
        progress.show(i);
      if (!results_[i]) std::rethrow_exception(failed_);
      ScenarioResult result = std::move(*results_[i]);
      lock.unlock();
      progress.clear();
      if (!finished(i, std::move(result))) return;
    }
  }

 private:
  void work() {
    for (std::size_t i; !stop_ && (i = next_++) < scenarios_.size();) {
      std::optional<ScenarioResult> result;
      std::exception_ptr failed;
      try {
        result = run_scenario(scenarios_[i], benches_.of[i]);
      } catch (...) {
        failed = std::current_exception();
      }
      const std::lock_guard lock(mutex_);
      results_[i] = std::move(result);
      if (failed && !failed_) failed_ = failed;
      if (failed) stop_ = true;
      ready_.notify_all();
    }
  }

  const std::vector<Scenario>& scenarios_;
  const Benches& benches_;
  std::mutex mutex_;
  std::condition_variable ready_;
  std::vector<std::optional<ScenarioResult>> results_;
  std::exception_ptr failed_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<bool> stop_ = false;
  std::vector<std::thread> threads_;
};

unsigned jobs_on(const Benches& benches, const TestOptions& options) {
  return benches.slave ? 1 : std::max(1u, options.jobs);
}

void print_file_heading(const Scenario& scenario, const stl::SourceLines*& last) {
  if (scenario.source.get() == last) return;
  last = scenario.source.get();
  fmt::print("{}\n", stl::printable(scenario.source->name));
}

/// Empty if something was.
std::string why_nothing_was_checked(const std::vector<Report>& reports) {
  std::size_t checks = 0;
  for (const Report& report : reports) checks += report.result.checks + report.result.findings.size();
  if (checks > 0 || reports.empty()) return "";
  const bool skipped = std::all_of(reports.begin(), reports.end(),
                                   [](const Report& r) { return r.result.outcome == ScenarioResult::Outcome::Skipped; });
  return skipped ? "every scenario was skipped" : "no step that was done expects anything";
}

int run_all(const std::vector<Scenario>& scenarios, const TestOptions& options, Programs& programs) {
  const Benches benches = benches_for(scenarios, options.target, options, programs);
  const bool conformance = !options.conformance.empty();
  const bool lines = !options.json && !conformance;
  std::vector<Report> reports;
  const stl::SourceLines* heading = nullptr;
  std::string unreachable;
  try {
    Runner runner(scenarios, benches, jobs_on(benches, options));
    runner.each([&](std::size_t i, ScenarioResult result) {
      reports.push_back({&scenarios[i], std::move(result)});
      if (lines) {
        print_file_heading(scenarios[i], heading);
        fmt::print("{}", report_text(reports.back(), colour_wanted(stdout)));
        std::fflush(stdout);
      }
      return !interrupted() && !(options.fail_fast && counts_as_failed(reports.back()));
    });
  } catch (const SlaveUnreachable& error) {
    unreachable = error.what();
  }
  if (options.json) {
    auto results = results_of("test");
    results.update(to_json(reports));
    results["not_run"] = scenarios.size() - reports.size();
    fmt::print("{}", lines_of(results));
  } else if (conformance) {
    fmt::print("{}", conformance_text(reports, benches.name, colour_wanted(stdout)));
  } else {
    fmt::print("{}", summary_text(reports));
  }
  if (const std::size_t left = scenarios.size() - reports.size(); left > 0)
    fmt::print(stderr, "s7200: note: {} not run\n", left == 1 ? "1 scenario was" : fmt::format("{} scenarios were", left));
  if (const std::string why = why_nothing_was_checked(reports); !why.empty() && options.record.empty())
    print_note("nothing was checked: " + why);
  std::vector<Scenario> as_run = scenarios;
  for (Scenario& scenario : as_run)
    if (!options.target.empty()) scenario.program = benches.slave ? "" : options.target;
  for (Report& report : reports) report.scenario = &as_run[static_cast<std::size_t>(report.scenario - scenarios.data())];
  bool all_written = true;
  const auto write = [&](const Destination& to, const std::string& text) {
    std::string why;
    if (write_result(to, text, why)) return;
    print_error(why);
    all_written = false;
  };
  if (options.junit_to) write(*options.junit_to, to_junit(reports));
  if (options.record_to) {
    const Time tolerance = options.tolerance_with(benches.slave != nullptr);
    write(*options.record_to, transcript_text(reports, {options.record, benches.name, tolerance, benches.slave != nullptr}));
  }
  print_interruption();
  if (!all_written) throw Unusable{};
  if (!unreachable.empty()) fail(unreachable);
  return interrupted() || std::any_of(reports.begin(), reports.end(), counts_as_failed) ? kCheckFailed : kFine;
}

// --- two programs ---

int run_against(const std::vector<Scenario>& scenarios, const TestOptions& options, Programs& programs) {
  const Benches one = benches_for(scenarios, options.target, options, programs);
  const Benches other = benches_for(scenarios, options.against, options, programs);
  const Comparison comparison{!options.ignore_timing, options.tolerance_with(one.slave || other.slave)};
  const auto name = [&](const std::string& path) { return stl::printable(std::filesystem::path(path).filename().string()); };
  Runner others(scenarios, other, jobs_on(other, options));
  std::vector<ScenarioResult> of_other;
  others.each([&](std::size_t, ScenarioResult result) {
    of_other.push_back(std::move(result));
    return !interrupted();
  });
  auto results = results_of("test");
  nlohmann::ordered_json& comparisons = results["comparisons"] = nlohmann::ordered_json::array();
  const stl::SourceLines* heading = nullptr;
  bool same = true;
  Runner ones(scenarios, one, jobs_on(one, options));
  ones.each([&](std::size_t i, ScenarioResult result) {
    if (interrupted()) return false;
    const ScenarioResult* skipped = nullptr;
    for (const ScenarioResult* each : {&result, &of_other[i]})
      if (each->outcome == ScenarioResult::Outcome::Skipped) skipped = each;
    const std::string one_name = name(one.name.empty() || options.target.empty() ? scenarios[i].program : one.name);
    const bool colour = colour_wanted(stdout) && !options.json;
    const Difference difference =
        skipped ? Difference{} : compare(scenarios[i], result, of_other[i], one_name, name(other.name), comparison, colour);
    same &= !difference.found;
    if (options.json) {
      comparisons.push_back({{"file", scenarios[i].source->name},
                             {"name", scenarios[i].name},
                             {"skipped", skipped != nullptr},
                             {"exchanges", result.seen.size()},
                             {"same", !difference.found},
                             {"difference", difference.text}});
    } else {
      print_file_heading(scenarios[i], heading);
      const std::string remark =
          skipped ? fmt::format("   ({})", skipped->reason) : fmt::format("   {} exchanges", result.seen.size());
      fmt::print("  {}  {}{}\n{}",
                 skipped            ? "skip  "
                 : difference.found ? "DIFFER"
                                    : "same  ",
                 stl::printable(scenarios[i].name), stl::printable(remark), difference.text);
    }
    return same || !options.fail_fast;
  });
  if (options.json) fmt::print("{}", lines_of(results));
  print_interruption();
  return same && !interrupted() ? kFine : kCheckFailed;
}

// --- the verb ---

void claim_files(TestOptions& options) {
  for (const std::string& path : {options.record, options.junit})
    if (path == "-") fail("--record and --junit write files; '-' is none");
  WrittenFiles files;
  std::string why;
  if (!options.record.empty()) {
    options.record_to =
        files.claim("--record", options.record, {"a transcript", std::string(kTranscriptBeginning)}, Replace::Own, why);
    if (!options.record_to) fail(why);
    if (options.record_to->replaced && !options.force) fail(fmt::format("{} exists; --force overwrites it", options.record));
  }
  if (options.junit.empty()) return;
  options.junit_to =
      files.claim("--junit", options.junit, {"a JUnit file of s7200 test", std::string(kJunitBeginning)}, Replace::Own, why);
  if (!options.junit_to) fail(why);
}

void check_usage(const TestOptions& options) {
  const bool one_of_files = !options.files.empty() || options.random > 0 || !options.conformance.empty();
  if (!one_of_files) fail("nothing to test: give files or folders, --conformance, or --random with --target");
  if (!options.conformance.empty() && (!options.files.empty() || !options.with.empty() || options.random > 0))
    fail("--conformance runs its own suite: give no files, --with or --random beside it");
  if (options.random > 0 && options.target.empty())
    fail("--random needs --target, which says what the requests are sent to");
  if (options.ignore_timing && options.against.empty()) fail("--ignore-timing goes with --against");
  if (options.tolerance != kNever && options.against.empty() && options.record.empty())
    fail("--tolerance goes with --against or --record; a scenario has 'tolerance:'");
  if (!options.against.empty() && (!options.record.empty() || !options.junit.empty()))
    fail("--against neither records nor writes JUnit");
}

void print_list(const std::vector<Scenario>& scenarios, bool json) {
  if (json) {
    auto results = results_of("test");
    for (const Scenario& scenario : scenarios) results["scenarios"].push_back(scenario_json(scenario));
    fmt::print("{}", lines_of(results));
    return;
  }
  const stl::SourceLines* heading = nullptr;
  for (const Scenario& scenario : scenarios) {
    print_file_heading(scenario, heading);
    const std::string id = scenario.rule.id.empty() ? "" : scenario.rule.id + "  ";
    fmt::print("  {}\n", stl::printable(id + scenario.name));
  }
}

int run_test(TestOptions& options) {
  if (options.keys) {
    fmt::print("{}", scenario_keys_markdown());
    return kFine;
  }
  try {
    check_usage(options);
    claim_files(options);
    const std::vector<Scenario> scenarios = read_all(options);
    if (options.list) {
      print_list(scenarios, options.json);
      return kFine;
    }
    catch_interruption();
    Programs programs;
    return options.against.empty() ? run_all(scenarios, options, programs) : run_against(scenarios, options, programs);
  } catch (const Unusable& unusable) {
    return unusable.exit_code;
  }
}

}  // namespace

void add_test(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<TestOptions>();
  CLI::App* verb = app.add_subcommand("test", "run regression tests of a program's protocol: scenarios written in YAML");
  verb->add_option("FILE", options->files, "scenarios, or folders with .yaml files");
  verb->add_option("--with", options->with, "values for the parameters of the scenarios, a YAML map")->type_name("FILE");
  verb->add_option("--conformance", options->conformance,
                   "look whether a slave keeps the rules of Modbus RTU; the file describes the slave")
      ->type_name("DESCRIPTION");
  verb->add_option("--target", options->target, "what is tested, instead of the program a scenario names; see below")
      ->type_name("TARGET");
  verb->add_option("--against", options->against,
                   "send the same to another program and show where the answers or their times differ first")
      ->type_name("TARGET");
  verb->add_flag("--ignore-timing", options->ignore_timing, "with --against: only answers count");
  add_duration(
      *verb, "--tolerance", options->tolerance,
      "by which times may differ: with --against, or in a replay of --record [0; 50ms if the target is not a program]");
  add_whole_number(*verb, "--random", options->random, {1, 100'000}, "send so many random requests to the --target");
  add_whole_number(*verb, "--seed", options->seed, {0, UINT32_MAX}, "seed of the random requests", "1");
  add_whole_number(*verb, "--station", options->station, {1, 247}, "station that most random requests go to", "1");
  add_cpu_option(*verb, options->cpu.cpu, "CPU of a program that gets random requests; scenarios say theirs themselves");
  verb->add_option("--record", options->record, "write what went over the line as a transcript, which is a scenario again")
      ->type_name("FILE");
  verb->add_flag("--force", options->force, "overwrite an existing transcript");
  add_line_options(*verb, options->line, "as scenarios and programs say");
  verb->add_option("--only", options->only, "scenarios with PATTERN in their name, file or rule; * is anything")
      ->type_name("PATTERN");
  verb->add_flag("--list", options->list, "name the scenarios and run none");
  verb->add_flag("--fail-fast", options->fail_fast, "end at the first failure");
  add_whole_number(*verb, "--jobs", options->jobs, {1, 64}, "scenarios at a time; the output is the same", "1");
  verb->add_option("--junit", options->junit, "write the results as JUnit XML, too")->type_name("FILE");
  verb->add_flag("--json", options->json, "print the results as JSON");
  verb->add_flag("--keys", options->keys, "print what a scenario may contain, as Markdown")->excludes("--json");
  verb->footer(
      slave_targets_help() +
      "Exit codes: 0 all passed; 1 a scenario failed, a rule that says must is broken, or --against found a difference; "
      "2 nothing could be run,\nor the slave cannot be reached.\nExample: s7200 test tests/programs/modbus_slave --jobs 2");
  verb->callback([options, &exit_code] { exit_code = run_test(*options); });
}

}  // namespace s7200::tools

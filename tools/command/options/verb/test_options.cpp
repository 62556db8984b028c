#include "tools/command/options/verb/test_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <stdexcept>

#include "tools/command/options/help_groups.hpp"
#include "tools/command/options/number_option.hpp"
#include "tools/command/options/plc/line_options.hpp"
#include "tools/command/options/plc/program_options.hpp"
#include "tools/command/options/plc/stand_in_options.hpp"
#include "tools/command/options/wanted_file.hpp"
#include "tools/host/interruption.hpp"
#include "tools/scenario/reporting/junit.hpp"
#include "tools/scenario/reporting/markdown.hpp"
#include "tools/scenario/transcripts/transcript.hpp"
#include "tools/slave/slave_target.hpp"

namespace s7200::tools {
namespace {

void refuse_if(bool condition, const char* why) {
  if (condition) throw std::invalid_argument(why);
}

}  // namespace

void TestOptions::add_to(CLI::App& app) {
  app.add_option("FILE", suite.files, "scenarios, or folders with .yaml files");
  app.add_option("--with", suite.with, "values for the parameters of the scenarios, a YAML map")
      ->type_name("FILE")
      ->group(help_group::kRun);
  app.add_option("--conformance", suite.conformance,
                 "look whether a slave keeps the rules of Modbus RTU; the file describes the slave")
      ->type_name("DESCRIPTION")
      ->group(help_group::kRun);
  app.add_option("--target", suite.target, "what is tested, instead of the program a scenario names: s7200 help targets")
      ->type_name("TARGET")
      ->group(help_group::kRun);
  app.add_option("--against", against,
                 "send the same to another program and show where the answers or their times differ first")
      ->type_name("TARGET")
      ->group(help_group::kRun);
  app.add_option(
         "--at", suite.at,
         "where the master joins a target that is a system: a line or a PLC on it, gateway.1 for port 1 [the only line]")
      ->type_name("NAME");
  of_protocol_ = add_protocol_option(app, protocol, protocols_of_other_plcs(), "what westinghouse:MODEL speaks");
  other.add_to(app);
  app.add_flag("--ignore-timing", ignore_timing, "with --against: only answers count");
  add_duration(
      app, "--tolerance", tolerance,
      "by which times may differ: with --against, or in a replay of --record [0; 50ms if the target is not a program]");
  add_whole_number(app, "--random", suite.random, {1, 100'000}, "send so many random requests to the --target")
      ->group(help_group::kRun);
  add_whole_number(app, "--seed", suite.seed, {0, UINT32_MAX}, "seed of the random requests", "1");
  add_whole_number(app, "--station", suite.station, {1, 247}, "station that most random requests go to", "1");
  add_cpu_option(app, suite.random_cpu, "CPU of a program that gets random requests [214]; scenarios say theirs themselves");
  app.add_option("--record", record, "write what went over the line as a transcript, which is a scenario again")
      ->type_name("FILE")
      ->group(help_group::kResults);
  app.add_flag("--force", force, "overwrite an existing transcript");
  add_line_options(app, suite.line, "as scenarios and programs say");
  app.add_option("--only", suite.only, "scenarios with PATTERN in their name, file or rule; * is anything")
      ->type_name("PATTERN")
      ->group(help_group::kRun);
  app.add_flag("--list", list, "name the scenarios and run none")->group(help_group::kRun);
  app.add_flag("--fail-fast", suite.fail_fast, "end at the first failure")->group(help_group::kRun);
  band.add_tables_to(app);
  add_whole_number(app, "--jobs", jobs, {1, 64}, "scenarios, or tables of --times-band, at a time",
                   "1; with --times-band every core")
      ->group(help_group::kRun);
  add_no_stand_ins_option(app, suite.no_stand_ins);
  add_no_skip_option(app, suite.every_scan);
  app.add_option("--junit", junit, "write the results as JUnit XML, too")->type_name("FILE")->group(help_group::kResults);
  app.add_option("--markdown", markdown, "write the results as Markdown, too, for the summary of a job")
      ->type_name("FILE")
      ->group(help_group::kResults);
  coverage.add_to(app, help_group::kResults);
  profile.add_to(app, help_group::kResults);
  report.add_to(app,
                "a page for browsers of the results, that computes each run again; JUnit and Markdown files link to it");
  app.add_flag("--mutants", mutants, "change the program one thing at a time and list what no scenario notices")
      ->group(help_group::kRun);
  app.add_flag("--json", json, "print the results as JSON")->group(help_group::kResults);
  app.add_flag("--keys", keys, "print what a scenario may contain, as Markdown")->excludes("--json");
}

void TestOptions::complete_suite() {
  suite.band = band.settings();
  suite.jobs = jobs > 0 ? jobs : band.wanted() ? band.jobs() : 1;
  suite.plc = other.settings();
  suite.protocol = protocol->name;
  suite.runs_wanted = report.wanted();
  suite.exchanges_wanted = json || !record.empty() || !against.empty();
  suite.observed = {.coverage = coverage.wanted(), .profile = profile.wanted()};
  suite.stop = interruption();
}

void TestOptions::check() const {
  const bool conformance = !suite.conformance.empty(), random = suite.random > 0, compared = !against.empty();
  refuse_if(suite.files.empty() && !random && !conformance,
            "nothing to test: give files or folders, --conformance, or --random with --target");
  refuse_if(conformance && (!suite.files.empty() || !suite.with.empty() || random),
            "--conformance runs its own suite: give no files, --with or --random beside it");
  refuse_if(random && suite.target.empty(), "--random needs --target, which says what the requests are sent to");
  const auto any_is = [&](SlaveTarget::Kind kind) {
    return std::ranges::any_of(std::array{&suite.target, &against}, [&](const std::string* target) {
      return !target->empty() && parse_slave_target(*target).kind == kind;
    });
  };
  refuse_if(!suite.at.empty() && !any_is(SlaveTarget::Kind::System),
            "--at names a place in a system file: give one to --target or --against");
  refuse_if(!other.settings().empty() && !any_is(SlaveTarget::Kind::Peer),
            "--plc needs westinghouse:MODEL as --target or --against");
  refuse_if(of_protocol_->count() > 0 && !any_is(SlaveTarget::Kind::Peer),
            "--protocol needs westinghouse:MODEL as --target or --against");
  refuse_if(ignore_timing && !compared, "--ignore-timing goes with --against");
  refuse_if(tolerance != kNever && !compared && record.empty(),
            "--tolerance goes with --against or --record; a scenario has 'tolerance:'");
  refuse_if(compared && coverage.wanted(), "--against runs two programs; coverage is of one: leave out --against");
  refuse_if(compared && profile.wanted(), "--against runs two programs; a profile is of one: leave out --against");
  refuse_if(mutants && (compared || coverage.wanted() || profile.wanted() || !record.empty() || !junit.empty() ||
                        !markdown.empty() || report.wanted() || band.wanted()),
            "--mutants runs changed programs: it neither compares, records nor observes, and has one table of times");
  refuse_if(compared && (!record.empty() || !junit.empty() || !markdown.empty()),
            "--against neither records nor writes JUnit or Markdown");
  refuse_if(band.wanted() && (compared || !record.empty()),
            "--times-band runs scenarios with many tables; --against and --record are about one");
  refuse_if(report.wanted() && (compared || is_random_alone()),
            "--report is about scenarios; --against compares two of them, and --random alone has none");
  refuse_if(record == "-" || junit == "-" || markdown == "-", "--record, --junit and --markdown write files; '-' is none");
}

TestOptions::Destinations TestOptions::claim_files() {
  Destinations to;
  WrittenFiles files;
  to.record = claim_wanted(files, "--record", record, {"a transcript", std::string(kTranscriptBeginning)});
  if (to.record && to.record->replaces_content() && !force)
    throw std::invalid_argument(fmt::format("{} exists; --force overwrites it", record));
  to.junit = claim_wanted(files, "--junit", junit, {"a JUnit file of s7200 test", std::string(kJunitBeginning)});
  to.markdown =
      claim_wanted(files, "--markdown", markdown, {"a Markdown file of s7200 test", std::string(kMarkdownBeginning)});
  coverage.claim(files);
  profile.claim(files);
  return to;
}

}  // namespace s7200::tools

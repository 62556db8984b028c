// The options of `s7200 test`.
#pragma once

#include <optional>
#include <string>

#include "tools/command/options/plc/other_plc_options.hpp"
#include "tools/command/options/verb/band_options.hpp"
#include "tools/command/options/verb/coverage_options.hpp"
#include "tools/command/options/verb/profile_options.hpp"
#include "tools/command/options/verb/report_option.hpp"
#include "tools/host/files/written_files.hpp"
#include "tools/scenario/suite_settings.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace s7200::tools {

struct TestOptions {
  SuiteSettings suite;
  OtherPlcOptions other;
  const Protocol* protocol = nullptr;  ///< of other
  std::string against, record, junit, markdown;
  BandOptions band;
  CoverageOptions coverage;
  ProfileOptions profile;
  ReportOption report;
  unsigned jobs = 0;        ///< 0: not given
  Time tolerance = kNever;  ///< kNever: not given
  bool ignore_timing = false, force = false, json = false, list = false, keys = false, mutants = false;

  void add_to(CLI::App& app);

  /// Nothing but random requests, to one program or slave: there may be many.
  bool is_random_alone() const { return suite.random > 0 && suite.files.empty() && !band.wanted(); }

  /// Throws std::invalid_argument for options that do not go together.
  void check() const;

  /// What `suite` has from the other options, and that an interruption ends it.
  void complete_suite();

  /// Where --record, --junit and --markdown write; the files of coverage and profile are claimed too.
  struct Destinations {
    std::optional<Destination> record{}, junit{}, markdown{};
  };

  /// Throws std::invalid_argument if one cannot write there.
  Destinations claim_files();

 private:
  CLI::Option* of_protocol_ = nullptr;
};

}  // namespace s7200::tools

// --times-band on the command line: how sure results are that depend on execution times.
#pragma once

#include <memory>
#include <string>

#include "tools/command/options/plc/program_options.hpp"
#include "tools/measuring/band.hpp"

namespace s7200::tools {

class BandOptions {
 public:
  /// --times-band, --band-seed, --jobs and --tip41.
  void add_to(CLI::App& app);

  /// The first two, where there is a band without --times-band too.
  void add_tables_to(CLI::App& app);

  bool wanted() const { return settings_.random > 0; }
  const BandSettings& settings() const { return settings_; }
  unsigned jobs() const { return jobs_; }
  const std::string& tip41() const { return tip41_; }  ///< the document of Application Tip 41, or empty

  /// A program, checked, with each table. Null after messages: `exit_code` says which way to end.
  std::unique_ptr<ProgramBand> load(const ProgramOptions& program, int& exit_code) const;

 private:
  BandSettings settings_;
  unsigned jobs_ = every_core();
  std::string tip41_;

  static unsigned every_core();
};

/// `execution times: cpu214, cpu214_from_22x, and 200 random tables around them (seed 1)`
std::string band_title(const CpuModel& model, const std::string& times_table, const BandSettings& settings);

/// How far the work has come: on a terminal, from the second second on.
class BandProgress {
 public:
  explicit BandProgress(std::size_t all);
  ~BandProgress() { clear(); }
  void operator()(std::size_t done);
  void clear();

 private:
  std::size_t all_;
  Time from_;  ///< of the host
  bool wanted_, shown_ = false;
};

}  // namespace s7200::tools

// What watches the CPU of a PLC while a program is tested or run.
#pragma once

#include <memory>
#include <optional>

#include "interpreter/trace/fan_out.hpp"
#include "tools/coverage/coverage_report.hpp"
#include "tools/coverage/profile_report.hpp"

namespace s7200::tools {

/// What is to be observed of each PLC. Nothing of it changes what the program does.
struct Observed {
  bool coverage = false, profile = false;
};

/// The observers of one PLC, over all its power-ups.
class PlcObservers {
 public:
  PlcObservers(std::shared_ptr<const Program> program, const Observed& observed);

  /// To the sinks of the PLC's CPU; this outlives them.
  void add_to(FanOut& sinks);
  /// The CPU, before it is powered up. It is not owned.
  void begin(const Cpu& cpu);

  /// Adds what was tried so far.
  void report(CoverageOfPrograms& coverage) const;
  /// Adds where time went so far.
  void report(ProfileOfPrograms& profile, const std::string& plc) const;

 private:
  std::optional<CoverageSink> coverage_;
  std::optional<ProfileSink> profile_;
};

}  // namespace s7200::tools

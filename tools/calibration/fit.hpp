// Figures out of the times of loops.
#pragma once

#include <string>
#include <vector>

#include "tools/calibration/forms.hpp"
#include "tools/calibration/measurement.hpp"

namespace s7200::tools {

/// A form and what it takes, as far as the loops tell it apart from others.
struct Fitted {
  Form form;
  bool found = false;
  double ns = 0, within = 0;
};

struct Fit {
  std::vector<Fitted> forms;
  double contradiction = 0;  ///< ns by which loops contradict each other more than the clock explains
};

/// Each loop is an equation. They are solved by elimination, so that a form is found exactly if the loops tell it apart; the
/// errors of the loops add up in the worst way. `times`: of the first loops.
Fit fit(const Loops& loops, const std::vector<LoopTime>& times);

/// How much slower the CPU is than the table that is corrected says: the middle one of all figures that were measured.
double ratio_to_known(const Fit& fit);

/// The table of the CPU: what was found, where and when as `source` says, and for all else the figures of `known` times that
/// ratio, as unsure as they are and as the ratio makes them. `known` is told_apart(), `own` what the CPU runs with.
TimeTable calibrated(const Fit& fit, const TimeTable& known, const TimeTable& own, const std::string& source);

/// The instructions of the CPU that it does not have.
std::vector<std::string> not_measured(const Fit& fit, const CpuModel& model);

}  // namespace s7200::tools

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
/// errors of the loops add up in the worst way.
Fit fit(const Loops& loops, const std::vector<LoopTime>& times);

/// The table with what was found, as lines of their own; `source` says where and when it was measured.
std::string fitted_csv(const Fit& fit, const std::string& source);

/// The instructions of the CPU that it does not have.
std::vector<std::string> not_measured(const Fit& fit, const CpuModel& model);

}  // namespace s7200::tools

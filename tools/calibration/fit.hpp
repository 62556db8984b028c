// Computes figures from the times of loops.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/calibration/forms.hpp"
#include "tools/calibration/measurement.hpp"

namespace s7200::tools {

/// A form and what it takes, as far as the loops tell it apart from others.
struct Fitted {
  Form form;
  bool found = false;
  double ns = 0, within = 0;
  std::optional<std::size_t> sum = {};  ///< it is not found, but a part of this one
  bool pending = false;                 ///< a loop that has it did not run
};

/// Forms that no loop has one without the other.
struct Sum {
  std::string text;  ///< `CALL + RET`
  double ns = 0, within = 0;
  std::vector<std::size_t> parts = {};  ///< by their numbers in Fit::forms
};

struct Fit {
  std::vector<Fitted> forms;
  std::vector<Sum> sums;
  double residual = 0;       ///< ns by which loops that say the same disagree at most
  double contradiction = 0;  ///< ns by which loops contradict each other more than the clock explains
};

/// Each loop is an equation. They are solved by elimination, so that a form is found exactly if the loops tell it apart; the
/// errors of the loops add up in the worst way. A part of a sum is what all tables of the CPU say of it, as much faster or
/// slower as the figures that were found, and as far as the sum leaves it that; its figure is in the middle. `times`: of the
/// first loops.
Fit fit(const Loops& loops, const std::vector<LoopTime>& times);

/// How much slower the CPU is than the corrected table says: the median of all figures that were measured. Nothing if loops
/// that did not run have more forms than were measured: the first loops alone do not tell.
std::optional<double> ratio_to_known(const Fit& fit);

/// The table of the CPU: what was found, where and when as `source` says, and for all else the figures of `known` times that
/// ratio if there is one, within bounds that hold what the CPU's tables say, with that ratio and without. `known` is
/// told_apart(), `own` what the CPU runs with.
TimeTable calibrated(const Fit& fit, const TimeTable& known, const TimeTable& own, const std::string& source);

/// A time that the table has no measured figure for, not even as a part of a sum.
struct NotMeasured {
  std::string name;
  std::string_view why;
};

/// The instructions of the CPU, and times of its system.
std::vector<NotMeasured> not_measured(const Fit& fit, const CpuModel& model);

}  // namespace s7200::tools

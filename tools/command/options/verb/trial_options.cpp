#include "tools/command/options/verb/trial_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/command/options/number_option.hpp"

namespace s7200::tools {

void add_trial_options(CLI::App& app, TrialBound& bound) {
  add_real_number(
      app, "--seconds", [&bound](double seconds) { bound.seconds = seconds; }, {0, 1'000'000}, "end after so many seconds",
      fmt::format("{}", bound.seconds));
  add_whole_number(app, "--runs", bound.runs, {1, 1'000'000'000'000},
                   "end after so many runs; the same runs give the same results",
                   bound.runs == 0 ? "any number" : fmt::format("{}", bound.runs));
  add_whole_number(app, "--seed", bound.seed, {0, 1'000'000'000'000}, "of the inputs", "1");
}

}  // namespace s7200::tools

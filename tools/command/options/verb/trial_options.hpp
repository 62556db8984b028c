// How long programs are tried with inputs by chance: --seconds, --runs, --seed.
#pragma once

#include <cstdint>

namespace CLI {
class App;
}

namespace s7200::tools {

struct TrialBound {
  std::uint64_t runs = 0;  ///< 0: any number
  double seconds = 10;     ///< of the host
  std::uint64_t seed = 1;
};

/// The help says what holds in `bound` without them.
void add_trial_options(CLI::App& app, TrialBound& bound);

}  // namespace s7200::tools

// What `s7200 run` prints of a PLC.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "tools/command/options/run_options.hpp"
#include "tools/host/pace.hpp"
#include "tools/rig/rig.hpp"

namespace s7200::tools {

/// How a run has ended.
struct Ending {
  std::string_view reason;
  std::optional<Pace::Report> pace{};  // of a run in real time
  std::uint64_t collisions = 0;        // of a master on its bridge with what the PLC sent
};

void print_text(const Rig& rig, const Ending& ending, const RunOptions& options);
void print_json(const Rig& rig, const Ending& ending, const RunOptions& options);

}  // namespace s7200::tools

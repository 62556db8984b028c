// A trial as a scenario for `s7200 test`.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interpreter/base/result.hpp"
#include "interpreter/program/program.hpp"
#include "tools/trials/trial.hpp"

namespace s7200::tools {

/// What a scenario says of its program; paths as they are to stand in the file.
struct ScenarioOrigin {
  std::string program;
  std::vector<std::string> with{};  ///< the other files of the project
  std::string head{};               ///< other keys of the scenario, in YAML
};

struct TrialScenario {
  std::string name;  ///< one line
  ScenarioOrigin origin;
  std::uint8_t port = 0;
  Trial trial{};
  std::vector<Time> begun{};          ///< when each stimulus begins, since power-up
  std::vector<std::string> beside{};  ///< of each stimulus that is a frame: what stands beside `send`; empty: nothing
  std::string end{};                  ///< steps after it, in YAML
};

std::string scenario_text(const TrialScenario& scenario, const Program& program);

/// Runs a text as `s7200 test` does. Returns what it found, empty if it passes; trouble if it cannot be run.
Result<std::vector<std::string>> findings_of(const std::string& text, const std::string& path,
                                             const std::shared_ptr<const Program>& program);

/// The characters of a frame in hex, with `p` after the one whose parity is wrong: `01 03p 00`
std::string frame_text(const Stimulus& frame);

/// An address of a byte, word or double word in the image, as scenarios name it: `VW10`, `AIW0`, `MB3`.
std::string place_text(std::uint32_t place, std::size_t bytes);

}  // namespace s7200::tools

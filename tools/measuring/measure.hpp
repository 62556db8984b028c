// How fast a program is simulated on this computer.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "interpreter/program/program.hpp"

namespace s7200::tools {

struct Figure {
  std::string_view name, unit;
  double per_second = 0;
};

/// The best of five rounds on one core, each figure for `each` of the host's time. The program is a Modbus slave at address
/// 1; throws std::runtime_error if it does not answer.
std::vector<Figure> measure(const std::shared_ptr<const Program>& program, Time each);

/// The same of mixed programs of three lengths (mixed_program.hpp), every scan run.
std::vector<Figure> measure_mixed(Time each);

/// How fast files are checked, as `s7200 check` does it: lines of a listing of 100,000 (long_listing.hpp).
std::vector<Figure> measure_files(Time each);

}  // namespace s7200::tools

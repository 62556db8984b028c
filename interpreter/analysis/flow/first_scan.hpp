// What a program executes in the first scan only, as far as its contacts say so.
#pragma once

#include <vector>

#include "interpreter/program/program.hpp"

namespace s7200 {

/// For each op whether it has power flow in the first scan only: SM0.1, or SM0.3, is in series with all else of its rung.
std::vector<bool> ops_of_first_scan(const Program& program);

}  // namespace s7200

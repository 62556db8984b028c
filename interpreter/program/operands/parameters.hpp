// Parameters of CALL, checked against the variables of the subroutine.
#pragma once

#include <optional>
#include <vector>

#include "interpreter/program/operands/operands.hpp"

namespace s7200 {

/// The parameters of a CALL of `block`: as many as its input, in-out and output variables, in their order, each of the type
/// of its variable. Adds diagnostics and returns nothing if they do not fit.
///
/// Not documented, modelled so: a subroutine has at most 16 parameters. [Parameters.ThereAreAtMostSixteen]
std::optional<std::vector<Parameter>> place_parameters(const Instruction& call, const stl::Statement& statement,
                                                       const stl::Block& block, const CpuModel& model,
                                                       ConstantPool& constants, stl::Diagnostics& diagnostics);

}  // namespace s7200

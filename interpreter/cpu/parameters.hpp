// Parameters of subroutines: copied into the local memory of the subroutine when it is called, and the outputs out of it
// when it returns (S7-200 manual, CALL).
//
// Not documented, modelled so:
// - All inputs are read before the subroutine begins; a pointer that points nowhere is error 0006 and the call does not take
//   place. [Parameters.ABadPointerOfAnInputPreventsTheCall]
// - A pointer to an output is followed when the subroutine returns. [Parameters.APointerToAnOutputIsFollowedAtTheReturn]
// - Parameters take no time of their own. [Parameters.TakeNoTimeOfTheirOwn]
#pragma once

#include <array>

#include "interpreter/cpu/core.hpp"

namespace s7200::parameters {

/// The parameters of one CALL, in order.
using Values = std::array<std::uint32_t, kMostParameters>;

/// The values of the outputs when a subroutine returns, out of its local memory. `call`: the CALL that began it.
Values results(const Core& core, const Op& call);

/// Puts them where the caller wants them. Its own local memory is in place again.
void hand_back(Core& core, const Op& call, const Values& values);

}  // namespace s7200::parameters

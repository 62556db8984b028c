// Chooses the link of each op, for the fast loop (instructions/linked.hpp).
#pragma once

#include "interpreter/program/program.hpp"

namespace s7200 {

/// Contacts that stand one after the other, with the coils that follow them, become a chain that is executed in one go. One
/// begins at every contact, so a jump or a deadline may end up inside.
void link(Program& program);

}  // namespace s7200

// Listings in the German set of Micro/WIN: addresses E, A, AE, AA, Z, HZ, and U for the A of the AND instructions.
#pragma once

#include "interpreter/stl/parser.hpp"

namespace s7200 {

/// Turns a source into the international set if it is wholly in the German one: nothing in it is international only, such as
/// I0.0 or AN. Otherwise the sets are mixed; nothing changes, and the German parts are reported one by one.
void read_german(stl::ParseResult& parsed);

}  // namespace s7200

// Listings in the German set of Micro/WIN: addresses E, A, AE, AA, Z, HZ, and U for the A of the AND instructions.
#pragma once

#include <string>
#include <string_view>

#include "interpreter/stl/parser.hpp"

namespace s7200 {

/// `UN` for `AN`; empty for a mnemonic that is the same in both sets.
std::string german_mnemonic(std::string_view mnemonic);

/// A statement of the international set in the German one.
void to_german(stl::Statement& statement);

/// Turns a source that is in the German set into the international one. A line of the other set than that of the listing is
/// an error that says how the line reads in the listing's set; so many lines of both sets that neither is clearly that of
/// the listing change nothing, and the German parts are reported one by one.
void read_german(stl::ParseResult& parsed);

}  // namespace s7200

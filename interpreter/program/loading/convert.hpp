// A program in another notation. Whatever is printed reads back as the same program.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "interpreter/stl/parser.hpp"

namespace s7200 {

enum class Notation : std::uint8_t {
  Iec,       ///< one listing, international, 16#FF
  MicroDos,  ///< one listing, constants as S7-Micro/DOS writes them: K4, KHFF
  MicroWin,  ///< the blocks of an export
  German     ///< one listing, addresses E and A, U for A
};

/// `iec`, `microdos`, `microwin`, `german`.
std::optional<Notation> notation_named(std::string_view name);
std::string_view name_of(Notation notation);
/// `iec, microdos, microwin and german`
std::string notation_names();

/// The source in a notation. Names stay among blocks and become addresses in a listing; the data block is printed among blocks
/// only. Returns nothing and adds diagnostics to `parsed` if it cannot be printed: names that nothing defines, parameters of
/// CALL outside of blocks.
///
/// Not documented, modelled so: Micro/DOS writes numbers of labels and routines without K, as the published tip does. The
/// German set is U for A and the letters of addresses; all else is as in the international set.
/// [Convert.MicroDosWritesConstantsWithKButNotLabelsAndRoutines, Convert.GermanLettersAndU]
std::optional<std::string> convert(stl::ParseResult& parsed, Notation notation);

/// The source as STL, with its symbols beside the addresses: as one listing, or if its blocks hand over parameters, which a
/// listing cannot say, as the blocks of an export.
std::string imported_text(stl::Source source);

/// The symbols of a source that convert() has read, also those with their address in the text, as a table that Micro/WIN takes:
/// name, address and comment, with tabs between. Empty without any.
std::string symbol_table_text(const stl::Source& source);

}  // namespace s7200

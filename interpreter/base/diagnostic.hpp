// A diagnostic says what is wrong with a source text, where, and what to do about it.
#pragma once

#include <string>
#include <vector>

#include "interpreter/base/source.hpp"

namespace s7200::stl {

enum class Severity : std::uint8_t { Error, Warning };

struct Diagnostic {
  Severity severity = Severity::Error;
  Position position{};
  std::string message;  ///< one line, no full stop
  std::string hint{};   ///< what to do; may be empty
  std::string cause{};  ///< equal in all diagnostics that one change would fix; empty: a cause of its own
  std::string name{};   ///< of a warning: the name that switches it off

  bool operator==(const Diagnostic&) const = default;
};

using Diagnostics = std::vector<Diagnostic>;

bool has_errors(const Diagnostics& diagnostics);

/// Sorts by line and column; diagnostics at the same place keep their order.
void sort(Diagnostics& diagnostics);

/// `file:line:column: error: message`, the source line, a caret line, and `hint: …`; a warning's name is in brackets. The
/// caret line repeats the tabs of the source line, so that the caret is right at any tab width. Of a very long line only the
/// part around the place is shown. Every line ends with a line end. `colour`: with ANSI colours.
std::string render(const Diagnostic& diagnostic, const SourceLines& source, bool colour);

/// All diagnostics as text. Of those with the same cause only the first is shown, with a line `also: …` that says how many
/// more there are and where.
std::string render(const Diagnostics& diagnostics, const SourceLines& source, bool colour);

/// The number of causes.
std::size_t count_causes(const Diagnostics& diagnostics);

}  // namespace s7200::stl

// What is wrong with a source text, where, and what to do about it.
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
  std::string cause{};  ///< the same for all that one change would mend; empty: it stands by itself
  std::string name{};   ///< of a warning, by which it can be switched off

  bool operator==(const Diagnostic&) const = default;
};

using Diagnostics = std::vector<Diagnostic>;

bool has_errors(const Diagnostics& diagnostics);

/// Orders by line and column; of equal places the first stays first.
void sort(Diagnostics& diagnostics);

/// `file:line:column: error: message`, the source line, a caret line, and `hint: …`; a warning's name in brackets. Tabs of
/// the source line stand in the caret line too, so that the caret is right at any tab width; very long lines are shown
/// around the place only. Every line ends with a line end. `colour` is ANSI.
std::string render(const Diagnostic& diagnostic, const SourceLines& source, bool colour);

/// All of them; those of one cause as the first of them, and a line `also: …` with how often and where else.
std::string render(const Diagnostics& diagnostics, const SourceLines& source, bool colour);

/// How many causes there are.
std::size_t count_causes(const Diagnostics& diagnostics);

}  // namespace s7200::stl

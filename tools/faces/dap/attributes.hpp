// The attributes of a launch or an attach: for whom each of them is.
#pragma once

#include <cstdint>
#include <string_view>

namespace s7200::tools::dap {

enum class AttributeUse : std::uint8_t {
  Program,   ///< how a program runs: any name that is none of the others
  Session,   ///< how the session goes, for the session itself
  Editor,    ///< for the editor alone, which sends it all the same
  OfOthers,  ///< of other debuggers: editors and their templates have it for every program
};

AttributeUse use_of(std::string_view key);

}  // namespace s7200::tools::dap

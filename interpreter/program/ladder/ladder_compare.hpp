// Sets the drawings of a document against the STL beside them, network by network, by what they do.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "interpreter/base/diagnostic.hpp"
#include "interpreter/base/result.hpp"

namespace s7200 {

struct LadderComparison {
  stl::SourceLines source;       ///< the document
  std::string encoding;          ///< what it was taken for
  stl::Diagnostics diagnostics;  ///< damage of the page, and errors where the two differ, in the order of their places
  std::size_t networks = 0;      ///< that are drawn, heads and labels included
  std::size_t same = 0;          ///< of them: do what the STL does
};

/// Compares routine by routine, and in a routine the networks in their order, whether or not the STL has NETWORK lines.
/// Trouble if the bytes are not text.
Result<LadderComparison> compare_drawings(std::string_view bytes, const std::string& name);

}  // namespace s7200

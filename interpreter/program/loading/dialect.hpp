// Programs in another language, or for another family of controllers, that are taken for STL of the S7-200, and texts of
// other products.
#pragma once

#include <optional>
#include <string_view>

#include "interpreter/base/diagnostic.hpp"

namespace s7200 {

/// One message at the first line that shows it, if a text (UTF-8, plain) is STL of STEP 7 for the S7-300 and S7-400, IL or
/// ST of IEC 61131-3 (SCL), or a program of Mitsubishi or Omron. Nothing for STL of the S7-200, also with some words of the
/// others in it, which have messages of their own. Looks at the first 300 lines of code.
std::optional<stl::Diagnostic> other_dialect(std::string_view text);

/// Whether the first line of code is the head of a block of STEP 7 for the S7-300 and S7-400: `DATA_BLOCK DB 10`.
bool begins_as_step7(std::string_view text);

/// What `why_other_product` says of a file in XML and of STEP 5, whose lines may look like STL; empty for any other text.
std::string_view why_surely_other_product(std::string_view text);

/// Texts that are no STL of any kind. The product whose programming software has written a text, and what to do; empty if
/// none is known.
std::string_view why_other_product(std::string_view text);

}  // namespace s7200

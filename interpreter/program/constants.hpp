// Constants of a program that are set without writing it anew.
#pragma once

#include <cstdint>
#include <string_view>

#include "interpreter/stl/ast.hpp"

namespace s7200 {

/// Whatever constant the program moves to `address` with MOVB, MOVW or MOVD is `value` then: `VB4095`, `smb30`. False if it
/// moves none there.
bool set_constant(stl::Source& source, std::string_view address, std::int64_t value);

}  // namespace s7200

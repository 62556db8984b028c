// Constants of a program that are set without writing it anew.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "interpreter/stl/ast.hpp"

namespace s7200 {

/// Whatever constant the program moves to `address` with MOVB, MOVW or MOVD is `value` then: `VB4095`, `smb30`.
/// `comment_holds`: what the program says beside it is true of any value, else it goes. False if it moves none there.
bool set_constant(stl::Source& source, std::string_view address, const stl::Integer& value, bool comment_holds);

/// The constant that the program moves there; nothing if it moves none, or several that differ.
std::optional<std::int64_t> constant_at(const stl::Source& source, std::string_view address);

}  // namespace s7200

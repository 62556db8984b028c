// Codes of errors of the CPU, as the reports show them: four hex digits.
#pragma once

#include <cstdint>
#include <optional>

#include "tools/scenario/reading/value_reader.hpp"

namespace s7200::tools {

/// 0 is `none`, where that is allowed.
std::optional<std::uint16_t> read_error_code(ValueReader& values, const YamlNode& node, bool none_allowed);

}  // namespace s7200::tools

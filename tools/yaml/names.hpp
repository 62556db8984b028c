// Names in a YAML file: of something, or of a file.
#pragma once

#include <optional>
#include <string>

#include "tools/yaml/values.hpp"

namespace s7200::tools {

/// Reads a name like YamlValues::text(), but complains about NUL too, at which the name would end for the system.
std::optional<std::string> name_from(const YamlNode& node, YamlValues& values);

}  // namespace s7200::tools
